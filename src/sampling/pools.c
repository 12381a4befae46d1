/* SPDX-License-Identifier: MIT */
#include "sampling/pools.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "sampling/evenness.h"
#include "sampling/kernels.h"

#include <string.h>

enum {
    DEFAULT_LENGTH = 1024,
    DEFAULT_LENGTH_OF_BIN = 256,
    LEAST_LENGTH = 64,
    GREATEST_LENGTH = 65536,
    PIECE = 256 /* samples that a thread draws at a time */
};

static helio_status resolve_desc(const helio_pools_desc *given, helio_pools_desc *desc)
{
    *desc = given ? *given : (helio_pools_desc){0};
    HELIO_TRY(strategy_check(desc->strategy));
    desc->strategy = helio_strategy_resolve(desc->strategy);
    if (desc->length == 0)
        desc->length =
            strategy_divide(desc->strategy).light == STRATEGY_LIGHT_BINS ? DEFAULT_LENGTH_OF_BIN : DEFAULT_LENGTH;
    if (desc->bins == 0)
        desc->bins = NORMAL_BINS_DEFAULT;
    if (desc->length < LEAST_LENGTH || desc->length > GREATEST_LENGTH || (desc->length & (desc->length - 1)) != 0)
        return fail(HELIO_ERR_ARGUMENT, "a pool of %u samples cannot be made; use a power of two from %d to %d",
                    desc->length, LEAST_LENGTH, GREATEST_LENGTH);
    if (desc->bins > NORMAL_BINS_MOST)
        return fail(HELIO_ERR_ARGUMENT, "%u x %u bins of normals on each face are too many; use at most %d x %d",
                    desc->bins, desc->bins, NORMAL_BINS_MOST, NORMAL_BINS_MOST);
    return HELIO_OK;
}

static helio_status allocate_arrays(helio_pools *pools)
{
    helio_context *context = pools->tables->environment->context;
    pools->stride = (size_t)pools->count * pools->pool_length + POOL_PADDING;
    pools->samples = context_allocate(context, pools->stride, POOL_ARRAYS * sizeof(float));
    return pools->samples != NULL ? HELIO_OK : HELIO_ERR_MEMORY;
}

static void choose_sizes(helio_pools *pools, const helio_pools_desc *desc)
{
    pools->length = pools->pool_length = desc->length;
    switch (pools->parts.light) {
    case STRATEGY_LIGHT_NONE: break;
    case STRATEGY_LIGHT_WHOLE:
        pools->count = pools->techniques = 1;
        pools->pool_length = CUBE_FACES * desc->length;
        break;
    case STRATEGY_LIGHT_FACES: pools->count = pools->techniques = CUBE_FACES; break;
    case STRATEGY_LIGHT_BINS:
        pools->count = CUBE_FACES * desc->bins * desc->bins;
        pools->techniques = 1;
        break;
    }
}

helio_status helio_pools_create(helio_tables *tables, const helio_pools_desc *given, helio_pools **out)
{
    if (out != NULL)
        *out = NULL;
    if (tables == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_pools_create needs tables and a place for the result");
    helio_pools_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    HELIO_TRY(helio_strategy_check_weighting(desc.strategy, tables->weighting));
    helio_pools *pools = context_allocate(tables->environment->context, 1, sizeof *pools);
    if (pools == NULL)
        return HELIO_ERR_MEMORY;
    pools->tables = tables;
    pools->strategy = desc.strategy;
    pools->is_automatic = given == NULL || given->strategy == HELIO_STRATEGY_AUTO;
    pools->parts = strategy_divide(desc.strategy);
    choose_sizes(pools, &desc);
    helio_status status = allocate_arrays(pools);
    if (status == HELIO_OK && pools->parts.light == STRATEGY_LIGHT_BINS)
        status = normal_bins_create(tables->environment->context, desc.bins, tables->size, pools->pool_length,
                                    pools->parts.surface == STRATEGY_SURFACE_BRDF, &pools->bins);
    if (status == HELIO_OK && pools->bins != NULL)
        status = control_create(tables->environment->context, pools->bins, &pools->control);
    if (status != HELIO_OK) {
        helio_pools_destroy(pools);
        return status;
    }
    *out = pools;
    return HELIO_OK;
}

void helio_pools_destroy(helio_pools *pools)
{
    if (pools == NULL)
        return;
    helio_context *context = pools->tables->environment->context;
    control_destroy(pools->control);
    normal_bins_destroy(pools->bins);
    context_release(context, pools->samples);
    context_release(context, pools);
}

uint32_t helio_pools_sample_limit(const helio_pools *pools)
{
    return pools->length / (pools->parts.light == STRATEGY_LIGHT_BINS ? POOL_SHARE_OF_BIN : POOL_SHARE);
}

/* ---- drawing ---- */

typedef struct drawing {
    helio_pools *pools;
    const kernel_set *kernels;
    uint32_t seed;
} drawing;

static uint32_t pieces_per_pool(const helio_pools *pools)
{
    return (pools->pool_length + PIECE - 1) / PIECE;
}

static bool is_black(const helio_pools *pools, uint32_t pool)
{
    if (pools->bins != NULL)
        return pools->bins->shares[pool] == 0.0f;
    if (pools->parts.light == STRATEGY_LIGHT_WHOLE)
        return pools->tables->faces[CUBE_FACES] == 0;
    return pools->tables->marginals[(size_t)pool * (pools->tables->size + 1) + pools->tables->size] == 0;
}

/* A black pool is left at density 0; no point ever reads it. */
static void clear_samples(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count)
{
    for (int array = 0; array < POOL_ARRAYS; array++)
        memset(pools_array(pools, pool, (enum sample_array)array) + first, 0, count * sizeof(float));
}

static void draw_piece(void *data, size_t piece)
{
    const drawing *work = data;
    helio_pools *pools = work->pools;
    uint32_t pieces = pieces_per_pool(pools);
    uint32_t pool = (uint32_t)piece / pieces, first = (uint32_t)piece % pieces * PIECE;
    uint32_t count = pools->pool_length - first < PIECE ? pools->pool_length - first : PIECE;
    if (is_black(pools, pool))
        clear_samples(pools, pool, first, count);
    else
        work->kernels->draw_pool(pools, pool, first, count, hash_combine(work->seed, pool));
}

/* Whole, as their sums run through all samples. */
static void draw_pool_of_bin(void *data, size_t index)
{
    const drawing *work = data;
    helio_pools *pools = work->pools;
    const uint32_t bin = (uint32_t)index;
    if (is_black(pools, bin)) {
        clear_samples(pools, bin, 0, pools->pool_length);
        memset(control_sums(pools->control, bin), 0, (pools->control->chunks + (size_t)1) * sizeof(control_matrix));
    } else
        work->kernels->draw_bin(pools, bin, hash_combine(work->seed, bin));
}

static void draw_bins(drawing *work)
{
    helio_pools *pools = work->pools;
    const helio_tables *tables = pools->tables;
    normal_bins_update(pools->bins, tables);
    if (pools->frame != tables->frame) {
        control_update(pools->control, pools->bins);
        pools->is_even = pools->is_automatic && evenness_holds(pools->bins->tiles, tables);
    }
    normal_bins_draw_lists(pools->bins, tables, hash_combine(work->seed, pools->count));
    context_parallel_for(tables->environment->context, pools->count, draw_pool_of_bin, work);
}

helio_status helio_pools_draw(helio_pools *pools, uint32_t seed, uint32_t pass)
{
    if (pools == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_pools_draw needs pools");
    const helio_environment *environment = pools->tables->environment;
    if (environment->frame == 0 || pools->tables->frame != environment->frame)
        return fail(HELIO_ERR_ARGUMENT,
                    "the tables are those of frame %llu but the environment is at frame %llu; call helio_tables_update",
                    (unsigned long long)pools->tables->frame, (unsigned long long)environment->frame);
    drawing work = {pools, kernels_of(context_isa(environment->context)), hash_combine(seed, pass)};
    if (pools->bins != NULL)
        draw_bins(&work);
    else
        context_parallel_for(environment->context, (size_t)pools->count * pieces_per_pool(pools), draw_piece, &work);
    pools->frame = environment->frame;
    return HELIO_OK;
}
