/* SPDX-License-Identifier: MIT
 *
 * What a point needs before its first sample: directions in the map's space, expected and realised counts, windows of
 * the pools. One lane for each point, in steps that each are a plain loop. */
#include "core/random.h"
#include "sampling/kernels.h"
#include "sampling/rules.h"

#include <string.h>

static uint32_t padded(const point_block *block)
{
    return (block->count + HELIO_LANES - 1) / HELIO_LANES * HELIO_LANES;
}

/* ---- directions ---- */

static void turn(const helio_environment *environment, uint32_t count, point_vectors *vectors)
{
    const vec3 a = environment->map_axes[0], b = environment->map_axes[1], c = environment->map_axes[2];
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        float x = vectors->x[i], y = vectors->y[i], z = vectors->z[i];
        vectors->x[i] = a.x * x + b.x * y + c.x * z;
        vectors->y[i] = a.y * x + b.y * y + c.y * z;
        vectors->z[i] = a.z * x + b.z * y + c.z * z;
    }
}

static void lift_views(point_block *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        vec3 normal = point_vector(&block->normal, i), view = point_vector(&block->view, i);
        if (!(dot(normal, view) >= BRDF_LEAST_VIEW_COSINE))
            point_vector_put(&block->view, i, brdf_lift_view(normal, view));
    }
}

/* ---- pools ---- */

/* Every technique has a pool of its own, except that the only one of STRATEGY_LIGHT_BINS reads that of the bin which
 * the normal falls into when shaken. */
static void choose_pools(const helio_pools *pools, point_block *block)
{
    const uint32_t count = padded(block);
    for (uint32_t k = 0; k < pools->techniques; k++)
        for (uint32_t i = 0; i < count; i++)
            block->pools[k][i] = k;
    if (pools->bins == NULL)
        return;
    const normal_bins bins = *pools->bins;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const vec3 normal = {block->normal.x[i], block->normal.y[i], block->normal.z[i]};
        uint32_t random = hash_combine(block->seed[i], STREAM_BIN);
        block->pools[0][i] = normal_bins_cell(bins.per_edge, normal_bins_shaken(&bins, normal, random));
    }
}

/* ---- lobes ---- */

/* The mirror image of the view is shaken before it looks for its cell, as the normal is for pools; and where what is
 * found there is nearly too much chance decides. So no edge shows. */
static bool is_calm(const normal_bins *bins, const point_block *block, uint32_t i)
{
    const uint32_t random = hash_combine(block->seed[i], STREAM_LOBE);
    const vec3 normal = point_vector(&block->normal, i), view = point_vector(&block->view, i);
    const vec3 mirror = add_scaled(scale(view, -1.0f), normal, 2.0f * dot(normal, view));
    const uint32_t cell = normal_bins_cell(bins->per_edge, normal_bins_shaken(bins, mirror, random));
    const float variance = bins->lobe_variances[cell * LOBE_CLASSES + block->lobe_class[i]];
    return variance < lobe_class_most(block->lobe_class[i], block->is_free) * (0.5f + unit_float(hash(random)));
}

/* Which points weigh tiles. They find the surface's share later, those in calm lobes have it here. */
static void look_at_lobes(const helio_pools *pools, float brdf_share, point_block *block)
{
    const bool has_tiles = pools->bins != NULL && !pools->is_even;
    for (uint32_t i = 0; i < block->count; i++) {
        block->weighs_tiles[i] = has_tiles && block->surface_share[i] > 0.0f;
        if (!block->weighs_tiles[i] || block->lobe_class[i] == LOBE_UNASKED || !is_calm(pools->bins, block, i))
            continue;
        block->weighs_tiles[i] = false;
        block->surface_share[i] = strategy_share_of_need(1.0f - LOBE_POOL_PART, brdf_share);
    }
}

/* ---- expected counts ---- */

/* What the pools are worth to a point. */
typedef struct pool_worths {
    alignas(64) float of_pool[CUBE_FACES][POINT_BLOCK]; /* beta_f x flux_f, in proportion, for faces */
    alignas(64) float total[POINT_BLOCK];
} pool_worths;

/* no_beta is a constant where this is expanded. */
static inline __attribute__((always_inline)) void weigh_face(const point_block *block, uint32_t count, uint32_t face,
                                                             float flux, bool no_beta, pool_worths *worths)
{
    const float *const axes[3] = {block->normal.x, block->normal.y, block->normal.z};
    const float *along = axes[face / 2], *across = axes[face / 2 == 0 ? 1 : 0], *beside = axes[face / 2 == 2 ? 1 : 2];
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const float beta = strategy_beta(sign * along[i], across[i], beside[i]);
        const float worth = (no_beta && beta > 0.0f ? 1.0f : beta) * flux;
        worths->of_pool[face][i] = worth;
        worths->total[i] += worth;
    }
}

static void weigh_pools(const helio_pools *pools, const point_block *block, bool no_beta, pool_worths *worths)
{
    const helio_tables *tables = pools->tables;
    const uint32_t count = padded(block);
    for (uint32_t i = 0; i < count; i++) {
        bool lit =
            pools->bins != NULL ? pools->bins->shares[block->pools[0][i]] > 0.0f : tables->faces[CUBE_FACES] != 0;
        worths->total[i] = worths->of_pool[0][i] = lit ? 1.0f : 0.0f;
    }
    if (pools->parts.light != STRATEGY_LIGHT_FACES)
        return;
    for (uint32_t i = 0; i < count; i++)
        worths->total[i] = 0.0f;
    for (uint32_t face = 0; face < CUBE_FACES && !no_beta; face++)
        weigh_face(block, count, face, tables->worth[face], false, worths);
    for (uint32_t face = 0; face < CUBE_FACES && no_beta; face++)
        weigh_face(block, count, face, tables->worth[face], true, worths);
}

/* least: of each pool that is worth anything. */
static void expect(uint32_t count, const float *worths, const float *shares, const float *least, float *expected)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const float worth = worths[i], more = least[i];
        expected[i] = worth * shares[i] + (worth >= RULE_FACE_LEAST ? more : 0.0f);
    }
}

/* Expected counts m_k, but for rounding: samples in proportion to beta_f x flux_f, and a share for the surface. All are
 * 0 where no light can come from above the horizon; where compensated tables only say that there is nothing to
 * compensate, the surface gets all. */
static void expect_counts(const helio_pools *pools, const helio_estimate_desc *desc, point_block *block)
{
    const uint32_t count = padded(block);
    const float samples = (float)desc->samples, of_any = pools->techniques > 1 ? RULE_FACE_EXTRA : 0.0f;
    const bool is_compensated = pools->tables->weighting == HELIO_WEIGHTING_COMPENSATED;
    pool_worths worths;
    alignas(64) float shares[POINT_BLOCK], least[POINT_BLOCK];
    memset(block->expected, 0, sizeof block->expected);
    if (pools->techniques > 0)
        weigh_pools(pools, block, desc->no_beta, &worths);
    else
        for (uint32_t i = 0; i < count; i++)
            worths.total[i] = 1.0f;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        bool lit = worths.total[i] >= RULE_FACE_LEAST;
        float by_surface = samples * (lit ? block->surface_share[i] : is_compensated ? 1.0f : 0.0f);
        float by_light = lit ? samples - by_surface : 0.0f;
        least[i] = by_light * of_any;
        shares[i] = by_light * (1.0f - CUBE_FACES * of_any) / (lit ? worths.total[i] : 1.0f);
        block->expected[TECHNIQUE_SURFACE][i] = by_surface;
    }
    for (uint32_t k = 0; k < pools->techniques; k++)
        expect(count, worths.of_pool[k], shares, least, block->expected[k]);
}

/* ---- realised counts ---- */

/* Sums of expected counts begin with 1, so that they are multiples of 2^-23, and with `rounding`, a multiple of 2^-24,
 * reach the next whole number exactly as often as they should. The last technique that adds to them gets what is left
 * of the samples. What lies between two sums is from then on the expected count. */
void KERNEL(round_counts)(uint32_t samples, point_block *block)
{
    const uint32_t count = padded(block);
    const float all = 1.0f + (float)(int32_t)samples;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const float least = 1.0f - block->rounding[i]; /* what is rounded up */
        float total = 1.0f, sum = 1.0f, reached = 1.0f;
        int32_t given = 1;
        for (int k = 0; k < TECHNIQUES; k++)
            total += block->expected[k][i];
        const float end = total > 1.0f ? all : 1.0f;
        for (int k = 0; k < TECHNIQUES; k++) {
            sum += block->expected[k][i];
            const float to = sum < total && sum < end ? sum : end;
            const int32_t whole = (int32_t)to, up_to = whole + (to - (float)whole >= least);
            block->expected[k][i] = to - reached;
            block->realised[k][i] = (uint32_t)(up_to - given);
            reached = to;
            given = up_to;
        }
    }
}

/* ---- windows ---- */

static void choose_windows(const helio_pools *pools, uint32_t technique, point_block *block)
{
    const uint32_t count = padded(block), length = pools->pool_length;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        uint32_t pool = block->pools[technique][i], realised = block->realised[technique][i];
        uint32_t choice = hash_combine(hash_combine(block->seed[i], STREAM_WINDOW), pool);
        float expected = block->expected[technique][i];
        block->windows[technique][i] = pool * length + pools_window(length, realised, choice);
        block->scales[technique][i] = (realised > 0 ? 1.0f : 0.0f) / (realised > 0 ? expected : 1.0f);
    }
}

/* ---- all of it ---- */

void KERNEL(prepare_points)(const helio_pools *pools, const helio_estimate_desc *desc, point_block *block)
{
    const helio_environment *environment = pools->tables->environment;
    const uint32_t count = padded(block);
    turn(environment, count, &block->normal);
    turn(environment, count, &block->geometric_normal);
    turn(environment, count, &block->view);
    lift_views(block);
    choose_pools(pools, block);
    look_at_lobes(pools, desc->brdf_share, block);
    expect_counts(pools, desc, block);
#pragma omp simd
    for (uint32_t i = 0; i < count; i++)
        block->rounding[i] = unit_float(hash_combine(block->seed[i], STREAM_ROUNDING));
    KERNEL(round_counts)(desc->samples, block);
    for (uint32_t k = 0; k < pools->techniques; k++)
        choose_windows(pools, k, block);
}
