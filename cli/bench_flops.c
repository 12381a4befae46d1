/* SPDX-License-Identifier: MIT
 *
 * Counted in the source of the library's kernels: additions, subtractions, multiplications, divisions and square roots
 * of floats, one each. What depends on the point alone and what is written twice counts once; comparisons, selections,
 * conversions and integers do not count at all. */
#include "bench_flops.h"

typedef struct operation_count {
    double sum;     /* a light sample that only pools can have drawn, its BRDF included */
    double weigh;   /* a light sample of a mixture, likewise */
    double mixture; /* more where BRDF samples are in the mixture: their density */
    double draw;    /* a BRDF sample: point, direction, texel */
} operation_count;

/* Summing begins with two cosines (10), the weights of the pool (3) and three sums (6); weighing with two cosines (10),
 * density (1), factor (2), light x BRDF (6) and the sum (5). */
static const operation_count counts[] = {
    [HELIO_MATERIAL_DIFFUSE] = {19, 24, 6, 55},
    /* Summing, as exponents up to 512 do it: cosine 5, logarithm 21, exponential 14, lobe 1, three sums 6.
     * Weighing: distance 9, logarithm 21, exponential 14, scale 1, three channels 6. */
    [HELIO_MATERIAL_PHONG] = {19 + 47, 24 + 51, 7, 135},
    /* Half vector 13, Fresnel 10, distribution 24, visibility 6; summing: lobes 6, six sums 12; weighing: lobe 2, three
     * channels 21. */
    [HELIO_MATERIAL_GGX] = {19 + 71, 24 + 76, 7, 108},
};

static const double COSINE_MIXTURE = 11; /* a cosine of its own */
static const double LIGHT_DENSITY = 9;   /* of the tables, in a direction that the BRDF drew */

double bench_flops_per_sample(helio_strategy strategy, helio_material_kind kind)
{
    const operation_count *count = &counts[kind];
    switch (helio_strategy_resolve(strategy)) {
    case HELIO_STRATEGY_COSINE: return count->weigh + COSINE_MIXTURE + counts[HELIO_MATERIAL_DIFFUSE].draw;
    case HELIO_STRATEGY_BRDF: return count->weigh + count->mixture + count->draw;
    case HELIO_STRATEGY_LIGHT_BRDF:
    case HELIO_STRATEGY_FACE_BRDF:
    case HELIO_STRATEGY_PRODUCT_BRDF: return count->weigh + count->mixture + 0.5 * (count->draw + LIGHT_DENSITY);
    case HELIO_STRATEGY_LIGHT:
    case HELIO_STRATEGY_FACE:
    case HELIO_STRATEGY_PRODUCT:
    case HELIO_STRATEGY_AUTO: break;
    }
    return count->sum;
}
