/* SPDX-License-Identifier: MIT
 * rays.h - the triangles of a mesh made ready for rays; rays.c is the only file that knows Embree. */
#ifndef HELIOSTAT_SRC_RAYS_H
#define HELIOSTAT_SRC_RAYS_H

#include "core/error.h"
#include "core/vector.h"

#include <heliostat/scene.h>

typedef struct rays rays;

typedef struct rays_hit {
    uint32_t triangle;
    float u, v;     /* position = (1 - u - v) corner 0 + u corner 1 + v corner 2 */
    float distance; /* in units of the direction's length */
} rays_hit;

#ifdef HELIO_WITH_EMBREE

/* The mesh must outlive the rays. What rays hit does not depend on the number of threads. */
helio_status rays_create(helio_context *context, const helio_mesh *mesh, rays **out);
void rays_destroy(rays *r);

/* The nearest hit, from either side; triangles without area are never hit. */
bool rays_intersect(const rays *r, vec3 origin, vec3 direction, rays_hit *hit);
bool rays_occluded(const rays *r, vec3 origin, vec3 direction);

#else

/* Without Embree there never is an object to ask. */
static inline helio_status rays_create(helio_context *context, const helio_mesh *mesh, rays **out)
{
    (void)context;
    (void)mesh;
    *out = NULL;
    return fail(HELIO_ERR_UNSUPPORTED,
                "this build has no Embree, so there are no rays; build with HELIO_WITH_EMBREE=ON");
}

static inline void rays_destroy(rays *r)
{
    (void)r;
}

static inline bool rays_intersect(const rays *r, vec3 origin, vec3 direction, rays_hit *hit)
{
    (void)r;
    (void)origin;
    (void)direction;
    (void)hit;
    return false;
}

static inline bool rays_occluded(const rays *r, vec3 origin, vec3 direction)
{
    (void)r;
    (void)origin;
    (void)direction;
    return false;
}

#endif
#endif
