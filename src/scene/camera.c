/* SPDX-License-Identifier: MIT */
#include "scene/camera.h"

#include "core/error.h"
#include "core/specification.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* The part of the picture's width and height that an object fills at distance 1. */
#define FILL 0.92

/* Farther out than any mesh reaches. */
#define MAX_COORDINATE 1e15f

static const float MIN_FOV = 1.0f, MAX_FOV = 170.0f;
static const float MIN_ASPECT = 1.0f / 65536.0f, MAX_ASPECT = 65536.0f;

/* ---- frame --------------------------------------------------------------------------- */

static helio_status check_aspect(float aspect)
{
    if (aspect >= MIN_ASPECT && aspect <= MAX_ASPECT)
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT, "the picture's aspect is %g; use %g to %g", (double)aspect, (double)MIN_ASPECT,
                (double)MAX_ASPECT);
}

static helio_status check_numbers(const helio_camera *camera)
{
    for (int i = 0; i < 3; i++)
        if (!(fabsf(camera->eye[i]) <= MAX_COORDINATE && fabsf(camera->at[i]) <= MAX_COORDINATE &&
              fabsf(camera->up[i]) <= MAX_COORDINATE))
            return fail(HELIO_ERR_ARGUMENT,
                        "the camera's eye, at and up have %c = %g, %g and %g; use finite numbers up to %g", "xyz"[i],
                        (double)camera -> eye[i], (double)camera -> at[i], (double)camera -> up[i],
                        (double)MAX_COORDINATE);
    if (!(camera->fov >= MIN_FOV && camera->fov <= MAX_FOV))
        return fail(HELIO_ERR_ARGUMENT, "the camera's fov is %g degrees; use %g to %g", (double)camera->fov,
                    (double)MIN_FOV, (double)MAX_FOV);
    return HELIO_OK;
}

/* The unit vector along a; zero where a is zero. A power of two brings a near 1 first, as the square of a tiny mesh's
 * size would vanish. */
static vec3 direction_of(vec3 a)
{
    float greatest = fmaxf(fabsf(a.x), fmaxf(fabsf(a.y), fabsf(a.z)));
    if (!(greatest > 0.0f))
        return a;
    int exponent;
    frexpf(greatest, &exponent);
    return normalize((vec3){ldexpf(a.x, -exponent), ldexpf(a.y, -exponent), ldexpf(a.z, -exponent)});
}

helio_status camera_frame_create(const helio_camera *camera, float aspect, camera_frame *frame)
{
    HELIO_TRY(check_aspect(aspect));
    HELIO_TRY(check_numbers(camera));
    vec3 eye = vec3_from(camera->eye);
    vec3 forward = direction_of(subtract(vec3_from(camera->at), eye));
    if (!(length(forward) > 0.0f))
        return fail(HELIO_ERR_ARGUMENT, "the camera's eye and at are both %g,%g,%g; they must differ",
                    (double)camera->eye[0], (double)camera->eye[1], (double)camera->eye[2]);
    vec3 up = vec3_from(camera->up);
    float up_length = length(up);
    vec3 right = cross(forward, up_length > 0.0f ? scale(up, 1.0f / up_length) : up);
    if (!(length(right) > 1e-5f))
        return fail(HELIO_ERR_ARGUMENT,
                    "the camera's up is %g,%g,%g; it must have a length and not point along the view",
                    (double)camera->up[0], (double)camera->up[1], (double)camera->up[2]);
    right = normalize(right);
    *frame = (camera_frame){
        .eye = eye,
        .forward = forward,
        .right = right,
        .up = cross(right, forward),
        .tan_half_fov = (float)tan((double)camera->fov * PI / 360.0),
        .aspect = aspect,
    };
    return HELIO_OK;
}

/* ---- framing --------------------------------------------------------------------------- */

/* Double precision: an object far from the origin should still fit. */
typedef struct point {
    double x, y, z; /* to the right, up, forward */
} point;

/* A view direction and the mesh seen along it, about the middle of its bounds. */
typedef struct view {
    const helio_mesh *mesh;
    double axes[3][3]; /* right, up, forward; orthonormal */
    double centre[3];
} view;

static point seen_from(const view *v, const float *position)
{
    double p[3], seen[3];
    for (int i = 0; i < 3; i++)
        p[i] = (double)position[i] - v->centre[i];
    for (int i = 0; i < 3; i++)
        seen[i] = v->axes[i][0] * p[0] + v->axes[i][1] * p[1] + v->axes[i][2] * p[2];
    return (point){seen[0], seen[1], seen[2]};
}

/* Vertices outside the bounds belong to no triangle. */
static bool is_in_bounds(const helio_mesh *mesh, const float *position)
{
    bool inside = true;
    for (int i = 0; i < 3; i++)
        inside &= position[i] >= mesh->bounds[0][i] && position[i] <= mesh->bounds[1][i];
    return inside;
}

/* What limits the eye: a point is in a picture with half width t (at depth 1) if x - t z <= eye.x - t eye.z and
 * -x - t z <= -eye.x - t eye.z, and likewise up and down. So the greatest left-hand sides say all about the mesh. */
typedef struct limits {
    double right, left, top, bottom;                                /* greatest x - t z, -x - t z, y - t z, -y - t z */
    double leftmost, rightmost, lowest, highest, nearest, farthest; /* x, y and z themselves */
} limits;

/* fmax() and fmin() without their care for NaN, which these loops would wait for. */
static inline void raise_to(double *greatest, double value)
{
    *greatest = value > *greatest ? value : *greatest;
}

static inline void lower_to(double *least, double value)
{
    *least = value < *least ? value : *least;
}

static limits measure_limits(const view *v, double across, double upward)
{
    limits l = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, HUGE_VAL,
                -HUGE_VAL, HUGE_VAL,  -HUGE_VAL, HUGE_VAL,  -HUGE_VAL};
    for (size_t i = 0; i < v->mesh->vertex_count; i++) {
        const float *position = v->mesh->positions + 3 * i;
        if (!is_in_bounds(v->mesh, position))
            continue;
        point p = seen_from(v, position);
        raise_to(&l.right, p.x - across * p.z);
        raise_to(&l.left, -p.x - across * p.z);
        raise_to(&l.top, p.y - upward * p.z);
        raise_to(&l.bottom, -p.y - upward * p.z);
        lower_to(&l.leftmost, p.x);
        raise_to(&l.rightmost, p.x);
        lower_to(&l.lowest, p.y);
        raise_to(&l.highest, p.y);
        lower_to(&l.nearest, p.z);
        raise_to(&l.farthest, p.z);
    }
    return l;
}

/* The least distance between eye and mesh. It matters where the limits allow none: for a point, and for a line seen end
 * on. A mesh so small that floats hardly resolve it counts as a point. */
static double least_room(const view *v)
{
    double squared = 0.0, away = 0.0;
    for (int i = 0; i < 3; i++) {
        double side = (double)v->mesh->bounds[1][i] - (double)v->mesh->bounds[0][i];
        squared += side * side;
        away = fmax(away, fabs(v->centre[i]));
    }
    double size = sqrt(squared);
    return size > 1e-5 * away ? 0.01 * size : fmax(1e-3 * away, 1.0);
}

/* The point that touches a side of the picture: place is its x, -x, y or -y. */
typedef struct extreme {
    double place, depth, slope; /* slope: place seen from the eye, over depth */
} extreme;

typedef struct extremes {
    extreme right, left, top, bottom;
} extremes;

static void widen(extreme *e, double place, double eye, double depth)
{
    double slope = (place - eye) / depth;
    if (slope > e->slope)
        *e = (extreme){place, depth, slope};
}

static extremes measure_extremes(const view *v, point eye)
{
    const extreme none = {0.0, 1.0, -HUGE_VAL};
    extremes e = {none, none, none, none};
    for (size_t i = 0; i < v->mesh->vertex_count; i++) {
        const float *position = v->mesh->positions + 3 * i;
        if (!is_in_bounds(v->mesh, position))
            continue;
        point p = seen_from(v, position);
        double depth = p.z - eye.z;
        widen(&e.right, p.x, eye.x, depth);
        widen(&e.left, -p.x, -eye.x, depth);
        widen(&e.top, p.y, eye.y, depth);
        widen(&e.bottom, -p.y, -eye.y, depth);
    }
    return e;
}

/* The place of the eye from which these two points have the same slope. */
static double balance(extreme one, extreme other)
{
    return (one.place * other.depth - other.place * one.depth) / (one.depth + other.depth);
}

/* The search for the place of the eye, in one direction, from which both sides of the picture have equal margins. */
typedef struct search {
    double low, high;   /* it is between these */
    double next;        /* to be tried */
    double best, width; /* what fills least so far, and how much that is */
    bool done;
} search;

static search search_between(double low, double high, double first)
{
    return (search){.low = low, .high = high, .next = fmin(fmax(first, low), high), .width = HUGE_VAL};
}

/* Takes what was seen from next. As the eye moves towards a side, that side's slope falls and the other rises: that
 * keeps the answer between low and high. Mostly the two points stay the extreme ones, and the next step is the last. */
static void search_step(search *s, extreme one, extreme other)
{
    double width = fmax(one.slope, other.slope), skew = one.slope - other.slope;
    if (width < s->width) {
        s->width = width;
        s->best = s->next;
    }
    *(skew > 0.0 ? &s->low : &s->high) = s->next;
    s->done = fabs(skew) <= 1e-3 * width;
    if (s->done)
        return; /* the other direction may need more rounds */
    double step = balance(one, other);
    s->next = step > s->low && step < s->high ? step : 0.5 * (s->low + s->high);
}

/* Moves the eye sideways until the margins are equal, which also makes them greatest: what fitted before still fits. */
static point centre_eye(const view *v, const limits *l, point eye)
{
    enum { ROUNDS = 16 };
    search x = search_between(l->leftmost, l->rightmost, eye.x);
    search y = search_between(l->lowest, l->highest, eye.y);
    for (int round = 0; round < ROUNDS && !(x.done && y.done); round++) {
        extremes e = measure_extremes(v, (point){x.next, y.next, eye.z});
        search_step(&x, e.right, e.left);
        search_step(&y, e.top, e.bottom);
    }
    return (point){x.best, y.best, eye.z};
}

/* The eye from which the mesh just fits, and the depth of the mesh's middle. Both limits of a direction can be met if
 * eye.z <= -(right + left) / (2 t); eye.x then lies half way. */
static point fit_eye(const view *v, double across, double upward, double *middle)
{
    limits l = measure_limits(v, across, upward);
    double z = fmin(-(l.right + l.left) / (2.0 * across), -(l.top + l.bottom) / (2.0 * upward));
    z = fmin(z, l.nearest - least_room(v));
    *middle = 0.5 * (l.nearest + l.farthest);
    return centre_eye(v, &l, (point){0.5 * (l.right - l.left), 0.5 * (l.top - l.bottom), z});
}

/* ---- specifications ---------------------------------------------------------------------- */

typedef struct orbit {
    float azimuth, elevation, distance, fov;
} orbit;

static view orbit_view(const helio_mesh *mesh, const orbit *o)
{
    double a = (double)o->azimuth * PI / 180.0, e = (double)o->elevation * PI / 180.0;
    view v = {
        .mesh = mesh,
        .axes = {{cos(a), 0.0, -sin(a)},
                 {-sin(a) * sin(e), cos(e), -cos(a) * sin(e)},
                 {-sin(a) * cos(e), -sin(e), -cos(a) * cos(e)}},
    };
    for (int i = 0; i < 3; i++)
        v.centre[i] = 0.5 * ((double)mesh->bounds[0][i] + (double)mesh->bounds[1][i]);
    return v;
}

static helio_camera place_orbit(const helio_mesh *mesh, const orbit *o, float aspect)
{
    view v = orbit_view(mesh, o);
    double t = FILL * tan((double)o->fov * PI / 360.0), middle;
    point eye = fit_eye(&v, t * (double)aspect, t, &middle);
    double distance = (double)o->distance * (middle - eye.z);
    /* +Y serves all views but those along it, where up is what it is nearby. */
    bool steep = fabsf(o->elevation) > 89.9f;
    helio_camera camera = {.fov = o->fov};
    for (int i = 0; i < 3; i++) {
        double at = v.centre[i] + eye.x * v.axes[0][i] + eye.y * v.axes[1][i] + middle * v.axes[2][i];
        camera.at[i] = (float)at;
        camera.eye[i] = (float)(at - distance * v.axes[2][i]);
        camera.up[i] = steep ? (float)v.axes[1][i] : i == 1 ? 1.0f : 0.0f;
    }
    return camera;
}

static helio_status parse_orbit(const char *text, const helio_mesh *mesh, float aspect, helio_camera *camera)
{
    orbit o = {.azimuth = 30.0f, .elevation = 15.0f, .distance = 1.0f, .fov = 40.0f};
    specification_field fields[] = {
        {.key = "azimuth", .count = 1, .least = -36000.0f, .greatest = 36000.0f, .values = &o.azimuth},
        {.key = "elevation", .count = 1, .least = -90.0f, .greatest = 90.0f, .values = &o.elevation},
        {.key = "distance", .count = 1, .least = 0.001f, .greatest = 1000.0f, .values = &o.distance},
        {.key = "fov", .count = 1, .least = MIN_FOV, .greatest = MAX_FOV, .values = &o.fov},
    };
    bool automatic = specification_has_name(text, "auto");
    HELIO_TRY(specification_parse("camera", text, fields, automatic ? 0 : COUNT(fields)));
    if (mesh != NULL)
        *camera = place_orbit(mesh, &o, aspect);
    return HELIO_OK;
}

static helio_status parse_lookat(const char *text, const helio_mesh *mesh, helio_camera *camera)
{
    *camera = (helio_camera){.up = {0.0f, 1.0f, 0.0f}, .fov = 36.0f};
    for (int i = 0; i < 3 && mesh != NULL; i++)
        camera->at[i] = 0.5f * mesh->bounds[0][i] + 0.5f * mesh->bounds[1][i];
    const float far = MAX_COORDINATE;
    specification_field fields[] = {
        {.key = "eye", .count = 3, .least = -far, .greatest = far, .values = camera->eye},
        {.key = "at", .count = 3, .least = -far, .greatest = far, .values = camera->at},
        {.key = "fov", .count = 1, .least = MIN_FOV, .greatest = MAX_FOV, .values = &camera->fov},
    };
    HELIO_TRY(specification_parse("camera", text, fields, COUNT(fields)));
    if (!fields[0].given)
        return fail(HELIO_ERR_ARGUMENT, "camera \"%.200s\": eye is missing; write lookat:eye=X,Y,Z", text);
    vec3 view_along = subtract(vec3_from(camera->at), vec3_from(camera->eye));
    if (hypotf(view_along.x, view_along.z) <= 1e-4f * fabsf(view_along.y)) {
        camera->up[1] = 0.0f;
        camera->up[2] = 1.0f;
    }
    return HELIO_OK;
}

helio_status helio_camera_parse(const char *specification, const helio_mesh *mesh, float aspect, helio_camera *camera)
{
    if (specification == NULL || (mesh != NULL && camera == NULL))
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_camera_parse needs a specification and, with a mesh, a place for the camera");
    HELIO_TRY(check_aspect(aspect));
    helio_camera parsed;
    if (specification_has_name(specification, "auto") || specification_has_name(specification, "orbit"))
        HELIO_TRY(parse_orbit(specification, mesh, aspect, &parsed));
    else if (specification_has_name(specification, "lookat"))
        HELIO_TRY(parse_lookat(specification, mesh, &parsed));
    else
        return fail(HELIO_ERR_ARGUMENT,
                    "camera \"%.200s\" is unknown; use auto, orbit:azimuth=30,elevation=15,distance=1.0,fov=40 or "
                    "lookat:eye=X,Y,Z,at=X,Y,Z,fov=36",
                    specification);
    if (mesh == NULL)
        return HELIO_OK;
    camera_frame frame;
    helio_status status = camera_frame_create(&parsed, aspect, &frame);
    if (status != HELIO_OK)
        return fail(status, "camera \"%.200s\": %s", specification, helio_last_error());
    *camera = parsed;
    return HELIO_OK;
}
