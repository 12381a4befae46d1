/* SPDX-License-Identifier: MIT
 *
 * How uneven the light is in lobes about one direction. */
#include "sampling/kernels.h"
#include "sampling/tile_sums.h"

#include <string.h>

/* Groups whose middle is nearer to the axis are looked at tile by tile, others as a whole: cos 35 degrees. */
static const float NEAR_COSINE = RULE_LOBE_NEAR_COSINE;

/* Samples of the pool follow the light so evenly that they leave about this part of the variance of as many that do
 * not. */
static const float POOL_VARIANCE = RULE_LOBE_POOL_VARIANCE;

/* Of lobe_at() over all directions. */
static const float LOBE_INTEGRAL = 4.0f * (float)PI;

/* Lobes of all classes about one axis, and the samples of a point in each: the lobe's part of them over the lobe's
 * integral, the pool's part over the pool's light. */
typedef struct sampled_lobes {
    vec3 axis;
    float widths[LOBE_CLASSES];
    float by_lobe, by_pool;
} sampled_lobes;

/* In sixteen sums each. */
typedef struct lobe_sums {
    alignas(64) float angle[TILE_GROUP];  /* the lobe */
    alignas(64) float light[TILE_GROUP];  /* lobe x light */
    alignas(64) float square[TILE_GROUP]; /* (lobe x light)^2 / density of the samples, those of the pool for less */
} lobe_sums;

/* Sixteen parts of the sky that follow each other. */
typedef struct sky_parts {
    const float *x, *y, *z, *angle, *light, *peak;
    const float *variance; /* of the directions in each, where that is more than a tile's; else NULL */
} sky_parts;

static inline float cosine_to(vec3 axis, const sky_parts *parts, uint32_t i)
{
    return axis.x * parts->x[i] + axis.y * parts->y[i] + axis.z * parts->z[i];
}

/* GGX's distribution x pi for the direction half-way between light and an axis that is normal and view at once. */
static inline float lobe_at(float cosine, float width)
{
    const float rest = 1.0f - 0.5f * (1.0f + cosine) * (1.0f - width);
    return width / (rest * rest);
}

/* counted: 1 or 0. sums: of each class. */
static inline __attribute__((always_inline)) void add_parts(const sampled_lobes *given, const sky_parts *of_sky,
                                                            const float *restrict counted, lobe_sums *restrict sums)
{
    const sampled_lobes lobes = *given;
    const sky_parts parts = *of_sky;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++) {
        const float cosine = cosine_to(lobes.axis, &parts, i), peak = parts.peak[i], of_pool = lobes.by_pool * peak;
        const float variance = parts.variance != NULL ? parts.variance[i] : 0.0f;
#pragma GCC unroll 3
        for (uint32_t class = 0; class < LOBE_CLASSES; class ++) {
            const float value = counted[i] * lobe_at(cosine, lobes.widths[class] + variance);
            const float light = value * parts.light[i];
            const float of_lobe = lobes.by_lobe * value, density = of_lobe + of_pool;
            const float safe = density > 0.0f ? density : 1.0f; /* 0 where both the lobe and the light are */
            const float part = of_lobe + POOL_VARIANCE * of_pool;
            sums[class].angle[i] += value * parts.angle[i];
            sums[class].light[i] += light;
            sums[class].square[i] += light * (value * peak * part / (safe * safe));
        }
    }
}

static void add_tiles(const sampled_lobes *lobes, const tiles *t, uint32_t group, lobe_sums *sums)
{
    static const float all[TILE_GROUP] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    const uint32_t first = group * TILE_GROUP;
    const sky_parts parts = {.x = t->x + first,
                             .y = t->y + first,
                             .z = t->z + first,
                             .angle = t->angle + first,
                             .light = t->light + first,
                             .peak = t->peak + first};
    add_parts(lobes, &parts, all, sums);
}

/* Of a run of groups those that are far, and the tiles of the others. */
static void add_run(const sampled_lobes *lobes, const tiles *t, uint32_t first, lobe_sums *sums)
{
    const tile_groups *g = &t->groups;
    const sky_parts middles = {.x = g->x + first, .y = g->y + first, .z = g->z + first};
    const sky_parts parts = {.x = g->light_x + first,
                             .y = g->light_y + first,
                             .z = g->light_z + first,
                             .angle = g->angle + first,
                             .light = g->light + first,
                             .peak = g->peak + first,
                             .variance = g->variance + first};
    int32_t is_near[TILE_RUN];
    float is_far[TILE_RUN];
#pragma omp simd
    for (uint32_t i = 0; i < TILE_RUN; i++) {
        is_near[i] = cosine_to(lobes->axis, &middles, i) > NEAR_COSINE;
        is_far[i] = is_near[i] ? 0.0f : 1.0f;
    }
    add_parts(lobes, &parts, is_far, sums);
    for (uint32_t rest = bits_of(is_near); rest != 0; rest &= rest - 1)
        add_tiles(lobes, t, first + (uint32_t)__builtin_ctz(rest), sums);
}

/* 0 under a black sky. */
static float variance_of(const lobe_sums *sums)
{
    const float light = sum_of_tiles(sums->light), square = sum_of_tiles(sums->square);
    if (!(light > 0.0f))
        return 0.0f;
    return square / light * (sum_of_tiles(sums->angle) / LOBE_INTEGRAL) / light - 1.0f;
}

void KERNEL(find_lobe_variances)(const tiles *t, vec3 axis, float variances[LOBE_CLASSES])
{
    const float irradiance = 0.5f * sum_of_groups(t->groups.light); /* of a surface that faces most of it */
    sampled_lobes lobes = {.axis = axis,
                           .by_lobe = (1.0f - LOBE_POOL_PART) / LOBE_INTEGRAL,
                           .by_pool = irradiance > 0.0f ? LOBE_POOL_PART / irradiance : 0.0f};
    lobe_sums sums[LOBE_CLASSES];
    for (uint32_t class = 0; class < LOBE_CLASSES; class ++)
        lobes.widths[class] = lobe_class_width(class) * t->edge * t->edge;
    memset(sums, 0, sizeof sums);
    for (uint32_t run = 0; run < TILE_RUNS; run++)
        add_run(&lobes, t, run * TILE_RUN, sums);
    for (uint32_t class = 0; class < LOBE_CLASSES; class ++)
        variances[class] = variance_of(&sums[class]);
}
