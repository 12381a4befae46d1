/* SPDX-License-Identifier: MIT */
#include "vulkan/light.h"

#include "core/error.h"
#include "env/environment.h"

#include <string.h>

enum { THREADS = 128, THREADS_OF_SOFTWARE = 8 };

/* ---- creation ----------------------------------------------------------------------------- */

uint32_t light_threads(const vulkan_light *light)
{
    return device_is_software(light->device) ? THREADS_OF_SOFTWARE : THREADS;
}

helio_status light_create_buffers(vulkan_light *light, const light_buffer *buffers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        HELIO_TRY(buffer_create(light->device, buffers[i].place, buffers[i].count, buffers[i].size, buffers[i].name,
                                buffers[i].buffer));
    return HELIO_OK;
}

static helio_status create_parts(vulkan_light *light, vulkan_commands *commands)
{
    const light_buffer state = {&light->state_memory, BUFFER_ON_DEVICE, 1, sizeof light->state, "the state"};
    HELIO_TRY(light_create_buffers(light, &state, 1));
    HELIO_TRY(light_create_tables(light, commands));
    HELIO_TRY(light_create_pools(light));
    if (light->shape->bins != NULL)
        HELIO_TRY(light_create_bins(light, commands));
    return commands_upload(commands, &light->state_memory, &light->state, sizeof light->state);
}

helio_status light_create(helio_device *device, vulkan_commands *commands, const helio_pools *shape,
                          vulkan_light *light)
{
    *light = (vulkan_light){.device = device, .shape = shape, .environment = shape->tables->environment};
    helio_status status = create_parts(light, commands);
    if (status != HELIO_OK)
        light_destroy(light);
    return status;
}

void light_destroy(vulkan_light *light)
{
    if (light->device == NULL)
        return;
    vulkan_buffer *const all[] = {&light->state_memory,
                                  &light->staging,
                                  &light->cube,
                                  &light->solid_angles,
                                  &light->rows,
                                  &light->marginals,
                                  &light->row_densities,
                                  &light->weights,
                                  &light->fluxes,
                                  &light->sums,
                                  &light->pools,
                                  &light->tile_grid,
                                  &light->tile_positions,
                                  &light->tiles,
                                  &light->tile_totals,
                                  &light->tile_sums,
                                  &light->segment_densities,
                                  &light->bins,
                                  &light->bin_sums,
                                  &light->bin_shares,
                                  &light->greatest,
                                  &light->list_starts,
                                  &light->listed};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        buffer_destroy(light->device, all[i]);
    for (int pass = 0; pass < LIGHT_PASSES; pass++)
        pipeline_destroy(light->device, &light->passes[pass]);
    *light = (vulkan_light){0};
}

/* ---- a frame ------------------------------------------------------------------------------ */

uint64_t light_cube_bytes(const vulkan_light *light)
{
    const uint64_t size = light->state.size;
    return CUBE_FACES * size * size * 3 * sizeof(float);
}

void light_stage(vulkan_light *light)
{
    memcpy(light->staging.mapped, light->environment->cube, light_cube_bytes(light));
}

void light_record_upload(vulkan_light *light, vulkan_commands *commands)
{
    commands_copy(commands, &light->staging, &light->cube, light_cube_bytes(light));
    commands_barrier(commands);
}

struct layout_push light_push(const vulkan_light *light, uint64_t step, uint32_t parameter)
{
    const uint64_t state = light->state_memory.address;
    return (struct layout_push){.state = {(uint32_t)state, (uint32_t)(state >> 32)},
                                .step = {(uint32_t)step, (uint32_t)(step >> 32)},
                                .parameter = {parameter}};
}
