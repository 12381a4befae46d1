/* SPDX-License-Identifier: MIT
 *
 * Pools for those who look at them. */
#include "core/error.h"
#include "sampling/pools.h"

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
    if (pool >= pools->count)
        return fail(HELIO_ERR_ARGUMENT, "there is no pool %u; there are %u, counted from 0", pool, pools->count);
    if (first > pools->pool_length || count > pools->pool_length - first)
        return fail(HELIO_ERR_ARGUMENT, "a pool has no %u samples from number %u on; it has %u", count, first,
                    pools->pool_length);
    if (pools->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "the pools are empty; call helio_pools_draw");
    for (uint32_t i = 0; i < count; i++)
        samples[i] = read_sample(pools, pool, first + i);
    return HELIO_OK;
}
