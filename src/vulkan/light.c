/* SPDX-License-Identifier: MIT */
#include "vulkan/light.h"

#include "core/error.h"
#include "env/environment.h"

#include <string.h>

static helio_status create_parts(vulkan_light *light, vulkan_commands *commands, const light_desc *desc)
{
    HELIO_TRY(
        buffer_create(light->device, BUFFER_ON_DEVICE, 1, sizeof light->state, "the state", &light->state_memory));
    return light_create_tables(light, commands, desc->weighting);
}

helio_status light_create(helio_device *device, vulkan_commands *commands, const light_desc *desc, vulkan_light *light)
{
    *light =
        (vulkan_light){.device = device, .environment = desc->environment, .parts = strategy_divide(desc->strategy)};
    light->state.size = desc->environment->size;
    helio_status status = create_parts(light, commands, desc);
    if (status == HELIO_OK)
        status = commands_upload(commands, &light->state_memory, &light->state, sizeof light->state);
    if (status != HELIO_OK)
        light_destroy(light);
    return status;
}

void light_destroy(vulkan_light *light)
{
    if (light->device == NULL)
        return;
    light_destroy_tables(light);
    buffer_destroy(light->device, &light->state_memory);
    for (int pass = 0; pass < LIGHT_PASSES; pass++)
        pipeline_destroy(light->device, &light->passes[pass]);
    *light = (vulkan_light){0};
}

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
