/* SPDX-License-Identifier: MIT */
#include "sampling/pools.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"

enum { DEFAULT_LENGTH = 1024, LEAST_LENGTH = 64, GREATEST_LENGTH = 65536, PIECE = 256, POOL_ARRAYS = 7 };

static helio_status resolve_desc(const helio_pools_desc *given, helio_pools_desc *desc)
{
    *desc = given ? *given : (helio_pools_desc){0};
    if (desc->length == 0)
        desc->length = DEFAULT_LENGTH;
    if (desc->length < LEAST_LENGTH || desc->length > GREATEST_LENGTH || (desc->length & (desc->length - 1)) != 0)
        return fail(HELIO_ERR_ARGUMENT, "a pool of %u samples cannot be made; use a power of two from %d to %d",
                    desc->length, LEAST_LENGTH, GREATEST_LENGTH);
    HELIO_TRY(strategy_check(desc->strategy));
    desc->strategy = helio_strategy_resolve(desc->strategy);
    return HELIO_OK;
}

static helio_status allocate_arrays(helio_pools *pools)
{
    size_t samples = (size_t)pools->count * pools->pool_length;
    pools->memory = context_allocate(pools->tables->environment->context, samples, POOL_ARRAYS * sizeof(float));
    if (pools->memory == NULL)
        return HELIO_ERR_MEMORY;
    float **arrays[POOL_ARRAYS] = {&pools->direction_x, &pools->direction_y, &pools->direction_z, &pools->red,
                                   &pools->green,       &pools->blue,        &pools->density};
    for (int i = 0; i < POOL_ARRAYS; i++)
        *arrays[i] = pools->memory + (size_t)i * samples;
    return HELIO_OK;
}

helio_status helio_pools_create(helio_tables *tables, const helio_pools_desc *given, helio_pools **out)
{
    if (out != NULL)
        *out = NULL;
    if (tables == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_pools_create needs tables and a place for the result");
    helio_pools_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    helio_pools *pools = context_allocate(tables->environment->context, 1, sizeof *pools);
    if (pools == NULL)
        return HELIO_ERR_MEMORY;
    pools->tables = tables;
    pools->strategy = desc.strategy;
    pools->parts = strategy_divide(desc.strategy);
    pools->length = desc.length;
    pools->count = pools->parts.light == STRATEGY_LIGHT_FACES ? CUBE_FACES : pools->parts.light ? 1 : 0;
    pools->pool_length = pools->parts.light == STRATEGY_LIGHT_WHOLE ? CUBE_FACES * desc.length : desc.length;
    helio_status status = allocate_arrays(pools);
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
    context_release(context, pools->memory);
    context_release(context, pools);
}

uint32_t helio_pools_sample_limit(const helio_pools *pools)
{
    return pools->length / POOL_SHARE;
}

/* ---- drawing ---- */

typedef struct drawing {
    helio_pools *pools;
    uint32_t seed;
} drawing;

/* One sample of one pool. A black pool is left at density 0; no point ever reads it. */
static void draw_sample(helio_pools *pools, uint32_t pool, uint32_t index, uint32_t seed)
{
    uint32_t x = scrambled_sobol(index, 0, seed), y = scrambled_sobol(index, 1, seed);
    helio_table_sample sample = {0};
    if (pools->parts.light == STRATEGY_LIGHT_WHOLE)
        tables_sample_whole(pools->tables, x, y, &sample);
    else
        tables_sample(pools->tables, pool, x, y, &sample);
    size_t i = (size_t)pool * pools->pool_length + index;
    pools->direction_x[i] = sample.direction[0];
    pools->direction_y[i] = sample.direction[1];
    pools->direction_z[i] = sample.direction[2];
    pools->red[i] = sample.radiance[0];
    pools->green[i] = sample.radiance[1];
    pools->blue[i] = sample.radiance[2];
    pools->density[i] = sample.density;
}

static uint32_t pieces_per_pool(const helio_pools *pools)
{
    return (pools->pool_length + PIECE - 1) / PIECE;
}

static void draw_piece(void *data, size_t piece)
{
    const drawing *work = data;
    uint32_t pieces = pieces_per_pool(work->pools);
    uint32_t pool = (uint32_t)piece / pieces, first = (uint32_t)piece % pieces * PIECE;
    uint32_t end = first + PIECE < work->pools->pool_length ? first + PIECE : work->pools->pool_length;
    uint32_t seed = hash_combine(work->seed, pool);
    for (uint32_t index = first; index < end; index++)
        draw_sample(work->pools, pool, index, seed);
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
    drawing work = {.pools = pools, .seed = hash_combine(seed, pass)};
    context_parallel_for(environment->context, (size_t)pools->count * pieces_per_pool(pools), draw_piece, &work);
    pools->frame = environment->frame;
    return HELIO_OK;
}

uint32_t pools_window(const helio_pools *pools, uint32_t wanted, uint32_t choice)
{
    uint32_t width = 1;
    while (width < wanted)
        width *= 2;
    uint32_t windows = pools->pool_length / width;
    return (uint32_t)(((uint64_t)choice * windows) >> 32) * width;
}
