/* SPDX-License-Identifier: MIT */
#include "scene/scene.h"

#include "core/context.h"
#include "core/error.h"
#include "core/name_list.h"
#include "scene/material.h"
#include "scene/mesh.h"

#include <float.h>

/* Hits of the ground beyond this, within a hair of the horizon, count as misses: their squares would not fit a float.
 */
#define GROUND_REACH 1e15f

/* Shadow rays start this many roundings above the surface; see offset_origin(). With 2 the tests find spheres that
 * shade themselves, with 4 they find none. */
#define OFFSET_ROUNDINGS 16.0f

static const char *const NAMES[] = {"none", "plane", "shadow"};
static const name_list GROUNDS = NAME_LIST("ground", NAMES);

const char *helio_ground_name(helio_ground ground)
{
    return name_list_get(&GROUNDS, (int)ground);
}

helio_status helio_ground_parse(const char *name, helio_ground *ground)
{
    int value;
    HELIO_TRY(name_list_find(&GROUNDS, ground ? name : NULL, &value));
    *ground = (helio_ground)value;
    return HELIO_OK;
}

/* ---- life ---------------------------------------------------------------------------- */

static helio_status check_desc(const helio_scene_desc *desc)
{
    if (desc->mesh == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_scene_desc has no mesh");
    HELIO_TRY(name_list_check(&GROUNDS, (int)desc->ground));
    return desc->material ? helio_material_check(desc->material) : HELIO_OK;
}

static void measure(helio_scene *scene)
{
    const helio_mesh *mesh = scene->mesh;
    for (int axis = 0; axis < 3; axis++) {
        double low = (double)mesh->bounds[0][axis], high = (double)mesh->bounds[1][axis];
        scene->extent = fmaxf(scene->extent, (float)(high - low));
        scene->centre[axis] = 0.5 * (low + high);
        scene->radius_squared += 0.25 * (high - low) * (high - low);
    }
    scene->ground_height = mesh->bounds[0][1];
}

helio_status helio_scene_create(helio_context *context, const helio_scene_desc *desc, helio_scene **out)
{
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_scene_create needs a place for the scene");
    *out = NULL;
    if (context == NULL || desc == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_scene_create needs a context and a desc");
    HELIO_TRY(check_desc(desc));
    helio_scene *scene = context_allocate(context, 1, sizeof *scene);
    if (scene == NULL)
        return HELIO_ERR_MEMORY;
    scene->context = context;
    scene->mesh = desc->mesh;
    scene->material = desc->material ? *desc->material : material_default();
    scene->own_materials = desc->material == NULL && desc->mesh->material_count != 0;
    scene->ground = desc->ground;
    scene->ground_material = (helio_material){.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.5f, 0.5f, 0.5f}};
    scene->srgb = texture_curve_srgb();
    scene->linear = texture_curve_linear();
    measure(scene);
    helio_status status = rays_create(context, desc->mesh, &scene->rays);
    if (status != HELIO_OK) {
        helio_scene_destroy(scene);
        return status;
    }
    *out = scene;
    return HELIO_OK;
}

void helio_scene_destroy(helio_scene *scene)
{
    if (scene == NULL)
        return;
    rays_destroy(scene->rays);
    context_release(scene->context, scene);
}

/* ---- what a ray meets ------------------------------------------------------------------ */

static vec3 interpolate(const float *values, const uint32_t corners[3], const rays_hit *hit)
{
    vec3 a = vec3_from(values + 3 * (size_t)corners[0]);
    vec3 b = vec3_from(values + 3 * (size_t)corners[1]);
    vec3 c = vec3_from(values + 3 * (size_t)corners[2]);
    return add_scaled(add_scaled(scale(a, 1.0f - hit->u - hit->v), b, hit->u), c, hit->v);
}

static void interpolate_texture_coordinates(const helio_mesh *mesh, const rays_hit *hit, float uv[2])
{
    const uint32_t *corners = mesh->triangles + 3 * (size_t)hit->triangle;
    const float weights[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    for (size_t axis = 0; axis < 2; axis++) {
        uv[axis] = 0.0f;
        for (size_t corner = 0; corner < 3; corner++)
            uv[axis] += weights[corner] * mesh->texture_coordinates[2 * (size_t)corners[corner] + axis];
    }
}

static helio_material material_at(const helio_scene *scene, const rays_hit *hit)
{
    const helio_mesh *mesh = scene->mesh;
    if (!scene->own_materials)
        return scene->material;
    uint32_t number = mesh->triangle_materials[hit->triangle];
    helio_material material = mesh->materials[number];
    if (mesh->texture_count == 0)
        return material;
    helio_material_textures textures = mesh->material_textures[number];
    float uv[2], rgb[3];
    interpolate_texture_coordinates(mesh, hit, uv);
    if (textures.base_colour != 0) {
        texture_lookup(&mesh->textures[textures.base_colour - 1], &scene->srgb, uv[0], uv[1], rgb);
        for (int c = 0; c < 3; c++)
            material.diffuse[c] *= rgb[c];
    }
    if (textures.metallic_roughness != 0 && material.kind == HELIO_MATERIAL_GGX) {
        texture_lookup(&mesh->textures[textures.metallic_roughness - 1], &scene->linear, uv[0], uv[1], rgb);
        material.roughness *= rgb[1];
        material.metallic *= rgb[2];
    }
    return material;
}

/* Turns what a ray found into what it saw. false for a triangle without area, which none should find. */
static bool resolve_mesh(const helio_scene *scene, vec3 direction, const rays_hit *found, scene_hit *hit)
{
    const helio_mesh *mesh = scene->mesh;
    vec3 face;
    if (!mesh_triangle_normal(mesh, found->triangle, &face))
        return false;
    const uint32_t *corners = mesh->triangles + 3 * (size_t)found->triangle;
    if (dot(face, direction) > 0.0f)
        face = scale(face, -1.0f);
    vec3 smooth = interpolate(mesh->normals, corners, found);
    float size = length(smooth);
    smooth = size > 1e-6f ? scale(smooth, 1.0f / size) : face;
    if (dot(smooth, face) < 0.0f)
        smooth = scale(smooth, -1.0f);
    *hit = (scene_hit){
        .distance = found->distance,
        .position = interpolate(mesh->positions, corners, found), /* nearer to the surface than along the ray */
        .normal = smooth,
        .geometric_normal = face,
        .material = material_at(scene, found),
    };
    return true;
}

/* Only asked for rays that do cross the plane's height, or run beside it. */
static bool intersect_ground(const helio_scene *scene, vec3 origin, vec3 direction, scene_hit *hit)
{
    float distance = (scene->ground_height - origin.y) / direction.y;
    if (!(distance >= 0.0f && distance < GROUND_REACH))
        return false;
    vec3 position = add_scaled(origin, direction, distance);
    position.y = scene->ground_height;
    vec3 normal = {0.0f, direction.y < 0.0f ? 1.0f : -1.0f, 0.0f};
    *hit = (scene_hit){
        .distance = distance,
        .position = position,
        .normal = normal,
        .geometric_normal = normal,
        .material = scene->ground_material,
        .is_ground = true,
    };
    return true;
}

bool scene_intersect(const helio_scene *scene, vec3 origin, vec3 direction, scene_hit *hit)
{
    bool met;
    scene_intersect_many(scene, origin, 1, &direction.x, &direction.y, &direction.z, hit, &met);
    return met;
}

void scene_intersect_many(const helio_scene *scene, vec3 origin, uint32_t count, const float *x, const float *y,
                          const float *z, scene_hit *hits, bool *met)
{
    /* The whole mesh stands on the plane. So from below the plane comes first, and from above the mesh does, however
     * close they are: no rounding can mix them up. */
    bool has_ground = scene->ground != HELIO_GROUND_NONE, below = has_ground && origin.y < scene->ground_height;
    rays_hit found[SCENE_RAYS];
    if (!below)
        rays_intersect_many(scene->rays, origin, count, x, y, z, found);
    for (uint32_t i = 0; i < count; i++) {
        vec3 direction = {x[i], y[i], z[i]};
        bool towards_ground = has_ground && (below ? direction.y > 0.0f : direction.y < 0.0f);
        met[i] = (!below && found[i].triangle != RAYS_NOTHING && resolve_mesh(scene, direction, &found[i], &hits[i])) ||
                 (towards_ground && intersect_ground(scene, origin, direction, &hits[i]));
    }
}

/* ---- shadows --------------------------------------------------------------------------- */

/* Moves a point off its surface, so that the surface does not shade itself. What was computed lies off the true surface
 * by the roundings of its interpolation, a few for each coordinate and in proportion to the corners' coordinates, which
 * are at most the point's own plus the mesh's extent; the intersection with a neighbouring triangle adds some in
 * proportion to the extent. The offset is the length of this box of errors along the normal, with a margin: it follows
 * the size of the mesh and its distance from the origin, and is no larger than it must. */
static vec3 offset_origin(const helio_scene *scene, vec3 position, vec3 normal)
{
    float rounding = OFFSET_ROUNDINGS * 0.5f * FLT_EPSILON;
    float error = fabsf(normal.x) * (fabsf(position.x) + scene->extent) +
                  fabsf(normal.y) * (fabsf(position.y) + scene->extent) +
                  fabsf(normal.z) * (fabsf(position.z) + scene->extent);
    return add_scaled(position, normal, rounding * error);
}

/* The sphere around the mesh, as seen from a point. */
typedef struct sphere_view {
    double x, y, z, squared; /* from the point to the centre */
    double radius_squared;
    bool inside, far;
} sphere_view;

double scene_far_squared(const helio_scene *scene)
{
    const double radii = 1e7;
    return radii * radii * scene->radius_squared;
}

static sphere_view view_sphere(const helio_scene *scene, vec3 origin)
{
    sphere_view view = {
        .x = scene->centre[0] - (double)origin.x,
        .y = scene->centre[1] - (double)origin.y,
        .z = scene->centre[2] - (double)origin.z,
        .radius_squared = scene->radius_squared,
    };
    view.squared = view.x * view.x + view.y * view.y + view.z * view.z;
    view.inside = view.squared <= view.radius_squared;
    view.far = view.squared > scene_far_squared(scene);
    return view;
}

/* Does the ray stay clear of the sphere? Most rays from the ground do. */
static bool passes_by(const sphere_view *view, vec3 direction)
{
    if (view->inside || view->far)
        return view->far;
    double x = (double)direction.x, y = (double)direction.y, z = (double)direction.z;
    double along = view->x * x + view->y * y + view->z * z;
    return along <= 0.0 || view->squared - along * along / (x * x + y * y + z * z) > 1.001 * view->radius_squared;
}

bool scene_occluded(const helio_scene *scene, vec3 position, vec3 geometric_normal, vec3 direction)
{
    bool visible;
    scene_find_visible(scene, position, geometric_normal, 1, &direction.x, &direction.y, &direction.z, &visible);
    return !visible;
}

/* Seen points lie on the plane's underside, where only open space is left, or above it, where it hides all light from
 * below. Heights are not compared: the lowest points of the mesh are on the plane. */
static bool is_underside(const helio_scene *scene, vec3 position, vec3 geometric_normal)
{
    return scene->ground != HELIO_GROUND_NONE && geometric_normal.y == -1.0f && position.y == scene->ground_height;
}

scene_shadow scene_prepare_shadow(const helio_scene *scene, vec3 position, vec3 geometric_normal)
{
    return (scene_shadow){.origin = offset_origin(scene, position, geometric_normal),
                          .underside = is_underside(scene, position, geometric_normal),
                          .far = view_sphere(scene, position).far};
}

void scene_find_visible(const helio_scene *scene, vec3 position, vec3 geometric_normal, uint32_t count, const float *x,
                        const float *y, const float *z, bool *visible)
{
    bool has_ground = scene->ground != HELIO_GROUND_NONE;
    bool underside = is_underside(scene, position, geometric_normal);
    sphere_view sphere = view_sphere(scene, position);
    float ray_x[SCENE_RAYS], ray_y[SCENE_RAYS], ray_z[SCENE_RAYS];
    uint32_t index[SCENE_RAYS], ray_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        vec3 direction = {x[i], y[i], z[i]};
        bool below = has_ground && direction.y < 0.0f;
        visible[i] = dot(geometric_normal, direction) > 0.0f && (!below || underside);
        if (!visible[i] || below || passes_by(&sphere, direction))
            continue;
        ray_x[ray_count] = direction.x;
        ray_y[ray_count] = direction.y;
        ray_z[ray_count] = direction.z;
        index[ray_count++] = i;
    }
    bool occluded[SCENE_RAYS];
    if (ray_count == 0)
        return;
    rays_occluded_many(scene->rays, offset_origin(scene, position, geometric_normal), ray_count, ray_x, ray_y, ray_z,
                       occluded);
    for (uint32_t i = 0; i < ray_count; i++)
        visible[index[i]] = !occluded[i];
}
