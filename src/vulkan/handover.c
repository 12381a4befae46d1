/* SPDX-License-Identifier: MIT
 *
 * Light for engines: on their device, in their command buffers. */
#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "vulkan/device_choice.h"
#include "vulkan/light.h"

#include <heliostat/vulkan.h>

_Static_assert(HELIO_VULKAN_SLOTS == LIGHT_SLOTS, "as many as lights have");

/* ---- devices ------------------------------------------------------------------------------ */

static bool is_complete(const helio_vulkan_desc *desc)
{
    return desc != NULL && desc->get_instance_proc_addr != NULL && desc->instance != VK_NULL_HANDLE &&
           desc->physical_device != VK_NULL_HANDLE && desc->device != VK_NULL_HANDLE && desc->queue != VK_NULL_HANDLE;
}

static helio_status adopt(helio_device *device, const helio_vulkan_desc *desc)
{
    device_choice choice;
    device->is_imported = true;
    device->vk.GetInstanceProcAddr = desc->get_instance_proc_addr;
    vulkan_functions_of_instance(&device->vk, desc->instance);
    device_choice_describe(&device->vk, desc->physical_device, &choice);
    if (choice.info.lacks[0] != 0)
        return fail(HELIO_ERR_UNSUPPORTED, "%s lacks %s, without which nothing can be computed", choice.info.name,
                    choice.info.lacks);
    device->instance = desc->instance;
    device->physical = desc->physical_device;
    device->device = desc->device;
    device->queue = device->upload_queue = desc->queue;
    device->queue_family = device->upload_family = desc->queue_family;
    device->timestamp_period = choice.timestamp_period;
    device->info = choice.info;
    device->info.has_timestamps = false; /* who knows what the family can do */
    device->vk.GetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    vulkan_functions_of_device(&device->vk, device->device);
    return device_create_layout(device);
}

helio_status helio_device_import(helio_context *context, const helio_vulkan_desc *desc, helio_device **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || out == NULL || !is_complete(desc))
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_device_import needs a context, all of a desc and a place for the result");
    helio_device *device = context_allocate(context, 1, sizeof *device);
    if (device == NULL)
        return HELIO_ERR_MEMORY;
    device->context = context;
    helio_status status = adopt(device, desc);
    if (status != HELIO_OK) {
        helio_device_destroy(device);
        return status;
    }
    *out = device;
    return HELIO_OK;
}

/* ---- light -------------------------------------------------------------------------------- */

struct helio_vulkan_light {
    vulkan_light light;
    vulkan_buffer step;
};

static helio_status create_parts(helio_vulkan_light *light, helio_device *device, const helio_pools *pools)
{
    vulkan_commands commands;
    HELIO_TRY(commands_create(device, false, &commands));
    helio_status status = light_create(device, &commands, pools, &light->light);
    if (status == HELIO_OK)
        status = buffer_create(device, BUFFER_ON_DEVICE, 1, sizeof(struct layout_step), "a step", &light->step);
    commands_destroy(&commands);
    return status;
}

helio_status helio_vulkan_light_create(helio_device *device, const helio_pools *pools, helio_vulkan_light **out)
{
    if (out != NULL)
        *out = NULL;
    if (device == NULL || pools == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_vulkan_light_create needs a device, pools and a place for the result");
    helio_vulkan_light *light = context_allocate(device->context, 1, sizeof *light);
    if (light == NULL)
        return HELIO_ERR_MEMORY;
    light->light.device = device;
    helio_status status = create_parts(light, device, pools);
    if (status != HELIO_OK) {
        light->light.device = device; /* which a light that could not be made forgets */
        helio_vulkan_light_destroy(light);
        return status;
    }
    *out = light;
    return HELIO_OK;
}

void helio_vulkan_light_destroy(helio_vulkan_light *light)
{
    if (light == NULL)
        return;
    helio_device *device = light->light.device;
    buffer_destroy(device, &light->step);
    light_destroy(&light->light);
    context_release(device->context, light);
}

/* To all shaders that come behind. */
static void show_shaders(const helio_device *device, VkCommandBuffer commands)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_SHADER_READ_BIT};
    device->vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                                  VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

helio_status helio_vulkan_light_record(helio_vulkan_light *light, VkCommandBuffer buffer, uint32_t slot, uint32_t seed,
                                       uint32_t pass)
{
    if (light == NULL || buffer == VK_NULL_HANDLE || slot >= LIGHT_SLOTS)
        return fail(HELIO_ERR_ARGUMENT, "helio_vulkan_light_record needs a light, a command buffer and a slot below %d",
                    LIGHT_SLOTS);
    if (light->light.environment->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "the environment holds no map yet; call helio_environment_update first");
    vulkan_commands commands = {.device = light->light.device, .buffer = buffer};
    const struct layout_step step = {.pool_seed = hash_combine(seed, pass)};
    commands_barrier_all(&commands);
    commands_write(&commands, &light->step, &step, sizeof step);
    light_record_cube(&light->light, &commands, slot);
    commands_barrier(&commands);
    light_record_tables(&light->light, &commands);
    light_record_pools(&light->light, &commands, light->step.address, true);
    show_shaders(light->light.device, buffer);
    return HELIO_OK;
}

VkDeviceAddress helio_vulkan_light_address(const helio_vulkan_light *light, uint32_t slot)
{
    return light->light.slots[slot % LIGHT_SLOTS].state.address;
}

helio_vulkan_buffers helio_vulkan_light_buffers(const helio_vulkan_light *light, uint32_t slot)
{
    return (helio_vulkan_buffers){.cube = light->light.slots[slot % LIGHT_SLOTS].cube.buffer,
                                  .rows = light->light.rows.buffer,
                                  .marginals = light->light.marginals.buffer,
                                  .pools = light->light.pools.buffer};
}
