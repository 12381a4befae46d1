/* SPDX-License-Identifier: MIT
 * strategy.h - what a strategy is: which pools there are, and how a point divides its samples among techniques. */
#ifndef HELIOSTAT_SRC_STRATEGY_H
#define HELIOSTAT_SRC_STRATEGY_H

#include "core/vector.h"

#include <heliostat/sampling.h>

typedef enum strategy_light {
    STRATEGY_LIGHT_NONE = 0,
    STRATEGY_LIGHT_WHOLE, /* one pool over the map */
    STRATEGY_LIGHT_FACES, /* one pool per face */
    STRATEGY_LIGHT_BINS,  /* one pool per bin of normals */
} strategy_light;

typedef enum strategy_surface {
    STRATEGY_SURFACE_NONE = 0,
    STRATEGY_SURFACE_COSINE,
    STRATEGY_SURFACE_BRDF,
} strategy_surface;

/* A strategy is one light technique, one surface technique, or both by multiple importance sampling. */
typedef struct strategy_parts {
    strategy_light light;
    strategy_surface surface;
} strategy_parts;

/* helio_counts: entries 0..5 are light techniques, this one is the surface technique. */
enum { TECHNIQUE_SURFACE = 6, TECHNIQUES = 7 };

/* The parts of a strategy; AUTO is resolved. */
strategy_parts strategy_divide(helio_strategy strategy);

/* HELIO_ERR_ARGUMENT for a value that is no strategy. */
helio_status strategy_check(helio_strategy strategy);

/* How much, at most, a face of the cube can light a surface with this normal (in the map's space): the largest cosine,
 * times the distance, over the face's corners, max(0, n.c + |n.a| + |n.b|) with the face's axis c (n.c: along) and its
 * tangent axes a and b (across, beside). Continuous in the normal; 0 exactly when the whole face is below the horizon.
 * This is the paper's beta_f. */
static inline float strategy_beta(float along, float across, float beside)
{
    float beta = along + fabsf(across) + fabsf(beside);
    return beta > 0.0f ? beta : 0.0f;
}

/* Of all faces. */
static inline void strategy_betas(vec3 normal, float betas[6])
{
    betas[0] = strategy_beta(normal.x, normal.y, normal.z);
    betas[1] = strategy_beta(-normal.x, normal.y, normal.z);
    betas[2] = strategy_beta(normal.y, normal.x, normal.z);
    betas[3] = strategy_beta(-normal.y, normal.x, normal.z);
    betas[4] = strategy_beta(normal.z, normal.x, normal.y);
    betas[5] = strategy_beta(-normal.z, normal.x, normal.y);
}

/* need is what is best at an even split; any other moves the odds. */
static inline float strategy_share_of_need(float need, float even)
{
    float for_surface = need * even, for_light = (1.0f - need) * (1.0f - even);
    return for_surface > 0.0f ? for_surface / (for_surface + for_light) : 0.0f;
}

#endif
