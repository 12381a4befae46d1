/* SPDX-License-Identifier: MIT
 * rays.h - the triangles of a mesh made ready for rays; rays.c is the only file that knows Embree. */
#ifndef HELIOSTAT_SRC_RAYS_H
#define HELIOSTAT_SRC_RAYS_H

#include "core/error.h"
#include "core/vector.h"

#include <heliostat/scene.h>

typedef struct rays rays;

#define RAYS_NOTHING UINT32_MAX /* instead of a triangle */

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

/* The same for many rays from one origin, faster than one by one; directions in three arrays [count]. hits: [count],
 * with the triangle RAYS_NOTHING where there is none; occluded: [count]. */
void rays_intersect_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                         rays_hit *hits);
void rays_occluded_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y, const float *z,
                        bool *occluded);

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

static inline void rays_intersect_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y,
                                       const float *z, rays_hit *hits)
{
    (void)r;
    (void)origin;
    (void)x;
    (void)y;
    (void)z;
    for (uint32_t i = 0; i < count; i++)
        hits[i].triangle = RAYS_NOTHING;
}

static inline void rays_occluded_many(const rays *r, vec3 origin, uint32_t count, const float *x, const float *y,
                                      const float *z, bool *occluded)
{
    (void)r;
    (void)origin;
    (void)x;
    (void)y;
    (void)z;
    for (uint32_t i = 0; i < count; i++)
        occluded[i] = false;
}

#endif
#endif
