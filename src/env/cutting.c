/* SPDX-License-Identifier: MIT */
#include "env/cutting.h"

/* The four edges of an outline bend one way each, or at most a few, so that a cut adds some points only. */
enum { FACE_POINTS = 2 * OUTLINE_POINTS };

/* ---- on the sphere ---- */

static double dot_axis(vec3 axis, direction d)
{
    return (double)axis.x * d.x + (double)axis.y * d.y + (double)axis.z * d.z;
}

/* How far inside of one of the four borders of a face's pyramid a direction is. */
static double depth_in_face(const cube_face *face, int border, direction d)
{
    double side = dot_axis(border & 1 ? face->right : face->down, d);
    return dot_axis(face->axis, d) + (border & 2 ? side : -side);
}

static bool is_in_face(const cube_face *face, const outline *polygon)
{
    for (int i = 0; i < polygon->count; i++)
        for (int border = 0; border < 4; border++)
            if (depth_in_face(face, border, polygon->points[i]) < 0.0)
                return false;
    return true;
}

typedef struct sphere_polygon {
    int count;
    direction points[FACE_POINTS];
} sphere_polygon;

static direction between(direction a, direction b, double t)
{
    return (direction){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/* Keeps what is inside of a border. */
static void clip(const cube_face *face, int border, const sphere_polygon *whole, sphere_polygon *inside)
{
    inside->count = 0;
    for (int i = 0; i < whole->count; i++) {
        direction a = whole->points[i], b = whole->points[i + 1 < whole->count ? i + 1 : 0];
        double depth_a = depth_in_face(face, border, a), depth_b = depth_in_face(face, border, b);
        if (depth_a >= 0.0)
            inside->points[inside->count++] = a;
        if ((depth_a > 0.0 && depth_b < 0.0) || (depth_a < 0.0 && depth_b > 0.0))
            inside->points[inside->count++] = between(a, b, depth_a / (depth_a - depth_b));
    }
}

/* ---- on a face ---- */

typedef struct face_point {
    double at[2]; /* u, v */
} face_point;

typedef struct face_polygon {
    int count;
    face_point points[FACE_POINTS];
} face_polygon;

static void project(const cube_face *face, const direction *points, int count, face_polygon *polygon)
{
    polygon->count = count;
    for (int i = 0; i < count; i++) {
        double scale_by = 1.0 / dot_axis(face->axis, points[i]);
        polygon->points[i] =
            (face_point){{dot_axis(face->right, points[i]) * scale_by, dot_axis(face->down, points[i]) * scale_by}};
    }
}

/* Cuts along the line where one coordinate has this value. */
static void split(const face_polygon *whole, int coordinate, double border, face_polygon *before, face_polygon *after)
{
    before->count = after->count = 0;
    for (int i = 0; i < whole->count; i++) {
        const face_point *a = &whole->points[i], *b = &whole->points[i + 1 < whole->count ? i + 1 : 0];
        double from_a = a->at[coordinate] - border, from_b = b->at[coordinate] - border;
        if (from_a <= 0.0)
            before->points[before->count++] = *a;
        if (from_a >= 0.0)
            after->points[after->count++] = *a;
        if ((from_a < 0.0 && from_b > 0.0) || (from_a > 0.0 && from_b < 0.0)) {
            double other = a->at[!coordinate], t = from_a / (from_a - from_b);
            face_point crossing;
            crossing.at[coordinate] = border;
            crossing.at[!coordinate] = other + t * (b->at[!coordinate] - other);
            before->points[before->count++] = after->points[after->count++] = crossing;
        }
    }
}

static double distance_to(const face_point *p)
{
    return sqrt(1.0 + p->at[0] * p->at[0] + p->at[1] * p->at[1]);
}

static double dot_points(const face_point *a, const face_point *b)
{
    return 1.0 + a->at[0] * b->at[0] + a->at[1] * b->at[1];
}

/* Twice the angle whose tangent is y / x. */
static double twice_angle(double y, double x)
{
    double t = y / x, square = t * t;
    if (x > 0.0 && square < 1.0 / 1024)
        return 2.0 * t * (1.0 - square * (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7))));
    return 2.0 * atan2(y, x);
}

/* Solid angle, sr, with the sign of the way around: triangles from the first point, by van Oosterom and Strackee, "The
 * Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering 30(2), 1983. */
static double solid_angle(const face_polygon *polygon)
{
    if (polygon->count < 3)
        return 0.0;
    const face_point *a = &polygon->points[0], *b = &polygon->points[1];
    double sum = 0.0, length_a = distance_to(a), length_b = distance_to(b), dot_b = dot_points(a, b);
    for (int i = 2; i < polygon->count; i++) {
        const face_point *c = &polygon->points[i];
        double length_c = distance_to(c), dot_c = dot_points(a, c);
        double volume = (b->at[0] - a->at[0]) * (c->at[1] - a->at[1]) - (b->at[1] - a->at[1]) * (c->at[0] - a->at[0]);
        sum += twice_angle(volume, length_a * length_b * length_c + dot_b * length_c + dot_c * length_b +
                                       dot_points(b, c) * length_a);
        b = c;
        length_b = length_c;
        dot_b = dot_c;
    }
    return sum;
}

/* ---- texels ---- */

typedef struct texel_range {
    uint32_t first, last;
} texel_range;

static uint32_t find_texel(double coordinate, uint32_t size)
{
    double place = (coordinate + 1.0) * 0.5 * size;
    return place <= 0.0 ? 0 : place >= size ? size - 1 : (uint32_t)place;
}

static texel_range find_range(const face_polygon *polygon, int coordinate, uint32_t size)
{
    double least = 1.0, greatest = -1.0;
    for (int i = 0; i < polygon->count; i++) {
        double at = polygon->points[i].at[coordinate];
        least = at < least ? at : least;
        greatest = at > greatest ? at : greatest;
    }
    return (texel_range){find_texel(least, size), find_texel(greatest, size)};
}

static void take_part(const face_polygon *polygon, uint32_t texel, cutting *result)
{
    double area = -solid_angle(polygon);
    if (!(area > result->least))
        return;
    if (result->parts != NULL)
        result->parts[result->count] = (texel_part){texel, (float)area};
    result->count++;
}

static void cut_row(const face_polygon *polygon, const texel_window *window, uint32_t first_texel, cutting *result)
{
    face_polygon parts[3]; /* what is left, the next texel, and what will be left */
    const face_polygon *rest = polygon;
    texel_range columns = find_range(polygon, 0, result->size);
    for (uint32_t column = columns.first; column <= columns.last && column < window->end_column; column++) {
        const face_polygon *part = rest;
        if (column < columns.last) {
            face_polygon *later = rest == &parts[0] ? &parts[1] : &parts[0];
            split(rest, 0, 2.0 * (column + 1) / result->size - 1.0, &parts[2], later);
            part = &parts[2];
            rest = later;
        }
        if (column >= window->first_column)
            take_part(part, first_texel + column, result);
    }
}

static void cut_face(uint32_t face, const direction *points, int count, cutting *result)
{
    face_polygon parts[3], rows;
    const face_polygon *rest = &rows;
    const texel_window *window = &result->windows[face];
    project(&cube_faces[face], points, count, &rows);
    texel_range range = find_range(&rows, 1, result->size);
    for (uint32_t row = range.first; row <= range.last && row < window->end_row; row++) {
        const face_polygon *part = rest;
        if (row < range.last) {
            face_polygon *later = rest == &parts[0] ? &parts[1] : &parts[0];
            split(rest, 1, 2.0 * (row + 1) / result->size - 1.0, &parts[2], later);
            part = &parts[2];
            rest = later;
        }
        if (row >= window->first_row)
            cut_row(part, window, (face * result->size + row) * result->size, result);
    }
}

static bool is_wanted(const texel_window *window)
{
    return window->first_row < window->end_row && window->first_column < window->end_column;
}

static void clip_to_face(uint32_t face, const outline *polygon, cutting *result)
{
    sphere_polygon a, b;
    a.count = polygon->count;
    for (int i = 0; i < polygon->count; i++)
        a.points[i] = polygon->points[i];
    for (int border = 0; border < 4; border += 2) {
        clip(&cube_faces[face], border, &a, &b);
        clip(&cube_faces[face], border + 1, &b, &a);
    }
    if (a.count >= 3)
        cut_face(face, a.points, a.count, result);
}

void cut_outline(const outline *polygon, cutting *result)
{
    const direction *d = &polygon->points[0];
    uint32_t face = cube_meet((vec3){(float)d->x, (float)d->y, (float)d->z}).face;
    if (is_in_face(&cube_faces[face], polygon)) {
        if (is_wanted(&result->windows[face]))
            cut_face(face, polygon->points, polygon->count, result);
        return;
    }
    for (face = 0; face < CUBE_FACES; face++)
        if (is_wanted(&result->windows[face]))
            clip_to_face(face, polygon, result);
}
