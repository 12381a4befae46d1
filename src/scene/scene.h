/* SPDX-License-Identifier: MIT
 * scene.h - what a ray meets: the mesh, the ground, or nothing. */
#ifndef HELIOSTAT_SRC_SCENE_H
#define HELIOSTAT_SRC_SCENE_H

#include "core/vector.h"
#include "cpu/rays.h"
#include "scene/texture.h"

#include <heliostat/scene.h>

struct helio_scene {
    helio_context *context;
    const helio_mesh *mesh;
    rays *rays;
    helio_material material; /* of triangles, unless the mesh's own materials are used */
    bool own_materials;      /* use those of the mesh, with their textures */
    texture_curve srgb, linear;
    helio_ground ground;
    helio_material ground_material;
    float ground_height; /* y of the plane: the mesh's lowest point */
    float extent;        /* longest side of the mesh's bounds */
    double centre[3];    /* of the sphere around the bounds */
    double radius_squared;
};

typedef struct scene_hit {
    float distance;
    vec3 position;
    vec3 normal;             /* for shading, interpolated; in the hemisphere of geometric_normal */
    vec3 geometric_normal;   /* of the surface itself, turned towards the ray's origin */
    helio_material material; /* at this point, textures included */
    bool is_ground;
} scene_hit;

enum { SCENE_RAYS = 64 }; /* at most in one call */

/* What rays from one origin meet first, and whether they meet anything; directions have unit length, in three arrays
 * [count]. hits: [count], written where met[i]. The ground is seen from both sides. */
void scene_intersect_many(const helio_scene *scene, vec3 origin, uint32_t count, const float *x, const float *y,
                          const float *z, scene_hit *hits, bool *met);

/* The square of a distance from the mesh's centre from which on all rays count as passing by: the mesh is smaller than
 * the roundings of a direction there, and a ray tracer would search all of it for nothing. */
double scene_far_squared(const helio_scene *scene);

/* What shadow rays of a point begin with: where, and what is known without them. */
typedef struct scene_shadow {
    vec3 origin;
    bool underside; /* the point is below the ground, where only open space is left */
    bool far;       /* the mesh is too far away to be met */
} scene_shadow;

scene_shadow scene_prepare_shadow(const helio_scene *scene, vec3 position, vec3 geometric_normal);

/* Does light from these directions, of unit length, reach a point that scene_intersect() found? Light from behind the
 * surface does not. visible: [count]. */
void scene_find_visible(const helio_scene *scene, vec3 position, vec3 geometric_normal, uint32_t count, const float *x,
                        const float *y, const float *z, bool *visible);

/* The same for a single direction. */
bool scene_intersect(const helio_scene *scene, vec3 origin, vec3 direction, scene_hit *hit);
bool scene_occluded(const helio_scene *scene, vec3 position, vec3 geometric_normal, vec3 direction);

#endif
