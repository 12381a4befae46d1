/* SPDX-License-Identifier: MIT
 *
 * Pools for those who look at them. */
#include "core/error.h"
#include "sampling/pools.h"

#include <string.h>

uint32_t helio_pools_count(const helio_pools *pools)
{
    return pools->count;
}

uint32_t helio_pools_techniques(const helio_pools *pools)
{
    return pools->techniques;
}

uint32_t helio_pools_length(const helio_pools *pools)
{
    return pools->pool_length;
}

uint32_t helio_pools_listed(const helio_pools *pools)
{
    return pools->bins != NULL && pools->frame != 0 ? normal_bins_listed(pools->bins) : 0;
}

static helio_pool_sample read_listed(const normal_bins *bins, uint32_t index)
{
    const listed_sample *from = &bins->listed[index];
    helio_pool_sample sample = {.density = from->density};
    memcpy(sample.direction, from->direction, sizeof sample.direction);
    memcpy(sample.radiance, from->radiance, sizeof sample.radiance);
    return sample;
}

static helio_pool_sample read_sample(const helio_pools *pools, uint32_t pool, uint32_t index)
{
    float numbers[SAMPLE_ARRAYS];
    for (int array = 0; array < SAMPLE_ARRAYS; array++)
        numbers[array] = pools_array(pools, pool, (enum sample_array)array)[index];
    return (helio_pool_sample){
        .direction = {numbers[SAMPLE_X], numbers[SAMPLE_Y], numbers[SAMPLE_Z]},
        .radiance = {numbers[SAMPLE_RED], numbers[SAMPLE_GREEN], numbers[SAMPLE_BLUE]},
        .density = numbers[SAMPLE_DENSITY],
    };
}

helio_status helio_pools_read(const helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count,
                              helio_pool_sample *samples)
{
    if (pools == NULL || samples == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_pools_read needs pools and a place for the samples");
    const bool is_of_tiles = pool == HELIO_POOL_OF_TILES && pools->bins != NULL;
    const uint32_t length = is_of_tiles ? helio_pools_listed(pools) : pools->pool_length;
    if (pool >= pools->count && !is_of_tiles)
        return fail(HELIO_ERR_ARGUMENT, "there is no pool %u; there are %u, counted from 0", pool, pools->count);
    if (pools->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "the pools are empty; call helio_pools_draw");
    if (first > length || count > length - first)
        return fail(HELIO_ERR_ARGUMENT, "a pool has no %u samples from number %u on; it has %u", count, first, length);
    for (uint32_t i = 0; i < count; i++)
        samples[i] = is_of_tiles ? read_listed(pools->bins, first + i) : read_sample(pools, pool, first + i);
    return HELIO_OK;
}
