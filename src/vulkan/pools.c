/* SPDX-License-Identifier: MIT
 *
 * Pools on a device: the same samples as on the CPU, but for the rounding of directions and densities. */
#include "core/error.h"
#include "vulkan/light.h"

enum { THREADS = 64 };

helio_status light_create_pools(vulkan_light *light)
{
    const helio_pools *shape = light->shape;
    struct layout_state *state = &light->state;
    const uint64_t samples = (uint64_t)shape->count * shape->pool_length;
    const light_buffer pools = {&light->pools, BUFFER_ON_DEVICE, samples * LAYOUT_POOL_PLANES, 4 * sizeof(float),
                                "the pools"};
    const pipeline_desc draw = {"pools", 1, {THREADS}};
    HELIO_TRY(light_create_buffers(light, &pools, 1));
    state->pools = light->pools.address;
    state->light = (uint32_t)shape->parts.light;
    state->surface = (uint32_t)shape->parts.surface;
    state->pool_count = shape->count;
    state->techniques = shape->techniques;
    state->pool_length = shape->pool_length;
    state->pool_stride = (uint32_t)samples;
    if (shape->count == 0 || shape->bins != NULL)
        return HELIO_OK;
    return pipeline_create(light->device, &draw, &light->passes[PASS_POOLS]);
}

void light_record_pools(vulkan_light *light, vulkan_commands *commands, uint64_t step, bool is_first_pass)
{
    const struct layout_push push = light_push(light, step, 0);
    const uint64_t samples = light->state.pool_stride;
    if (samples == 0)
        return;
    commands_label(commands, "pools");
    if (light->shape->bins != NULL)
        light_record_bins(light, commands, step, is_first_pass);
    else
        commands_dispatch(commands, light->passes[PASS_POOLS], &push, (samples + THREADS - 1) / THREADS);
    commands_barrier(commands);
    commands_label_end(commands);
}
