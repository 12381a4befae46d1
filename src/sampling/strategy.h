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

/* How much, at most, each face of the cube can light a surface with this normal (in the map's space): the largest
 * cosine, times the distance, over the face's corners, max(0, n.c + |n.a| + |n.b|) with the face's axis c and tangent
 * axes a and b. Continuous in the normal; 0 exactly when the whole face is below the horizon. This is the paper's
 * beta_f. */
static inline void strategy_betas(vec3 normal, float betas[6])
{
    float x = fabsf(normal.x), y = fabsf(normal.y), z = fabsf(normal.z);
    const float sums[6] = {normal.x + y + z,  -normal.x + y + z, normal.y + x + z,
                           -normal.y + x + z, normal.z + x + y,  -normal.z + x + y};
    for (int face = 0; face < 6; face++)
        betas[face] = sums[face] > 0.0f ? sums[face] : 0.0f;
}

/* Realised counts: systematic rounding of the expected ones, offset in [0, 1). Each has its expected value as mean over
 * offsets, and they sum to samples exactly (or to 0, if all expected counts are 0). */
void strategy_round(const float expected[TECHNIQUES], uint32_t samples, float offset, uint32_t realised[TECHNIQUES]);

#endif
