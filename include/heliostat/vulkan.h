/* SPDX-License-Identifier: MIT
 *
 * vulkan.h - this frame's light on your own Vulkan device, in your own command buffers: for engines.
 *
 *   helio_device_import(), helio_vulkan_light_create()               once
 *   helio_environment_update(), helio_vulkan_light_record()          each frame
 *   your shaders: #include "heliostat_sample.glsl", helio_use(address)
 *
 * Not part of heliostat.h, as it needs Vulkan's own header. heliostat_sample.glsl and what it includes are installed in
 * share/heliostat/shaders. A build without Vulkan has none of these functions.
 */
#ifndef HELIOSTAT_VULKAN_H
#define HELIOSTAT_VULKAN_H

#include <heliostat/device.h>
#include <heliostat/sampling.h>

#include <vulkan/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Objects that you have made and keep. The instance and the device are for Vulkan 1.2 or later, and of the device these
 * features are enabled, which nobody can check: bufferDeviceAddress, scalarBlockLayout, shaderInt64. */
typedef struct helio_vulkan_desc {
    PFN_vkGetInstanceProcAddr get_instance_proc_addr; /* required, as are: */
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue; /* that computes. While these run on another thread, nobody else may use it: functions named create,
                      helio_renderer_render(), helio_device_measure_copy(), and, of an environment that a renderer of
                      this device has, helio_environment_update() and helio_sky_update(). Recording uses no queue */
    uint32_t queue_family;
} helio_vulkan_desc;

/* A device for the functions below and for helio_renderer_desc. Its destruction leaves yours. HELIO_ERR_UNSUPPORTED
 * where the physical device lacks something. */
HELIO_API helio_status helio_device_import(helio_context *context, const helio_vulkan_desc *desc,
                                           helio_device **device);

/* Frames that may be on their way at once: each has a slot, 0 or 1. */
#define HELIO_VULKAN_SLOTS 2

typedef struct helio_vulkan_light helio_vulkan_light;

/* Takes the memory and builds the shaders. pools: tell strategy, sizes and environment, need not be drawn, and must
 * outlive the light. */
HELIO_API helio_status helio_vulkan_light_create(helio_device *device, const helio_pools *pools,
                                                 helio_vulkan_light **light);

/* When no command buffer that uses it is on its way. */
HELIO_API void helio_vulkan_light_destroy(helio_vulkan_light *light);

/* Records, outside of a render pass, all that the environment's current frame needs: its cube, copied now, is sent,
 * tables are made and pools drawn as helio_pools_draw() does with this seed and pass. Commands before are waited for
 * where they use the same slot's buffers or tables and pools, which both slots share; commands behind that read in any
 * shader wait for it. No list with the same slot may be on its way when this is called. Takes no memory. */
HELIO_API helio_status helio_vulkan_light_record(helio_vulkan_light *light, VkCommandBuffer commands, uint32_t slot,
                                                 uint32_t seed, uint32_t pass);

/* What helio_use() takes in shaders, for frames of this slot. */
HELIO_API VkDeviceAddress helio_vulkan_light_address(const helio_vulkan_light *light, uint32_t slot);

/* The buffers themselves, to be bound or read; written by the recorded commands only. */
typedef struct helio_vulkan_buffers {
    VkBuffer cube;      /* of the slot: float [6][R][R][3], see environment.h */
    VkBuffer rows;      /* uint32_t [6][R][R + 1], see helio_table_view */
    VkBuffer marginals; /* uint32_t [6][R + 1] */
    VkBuffer pools;     /* float [2][pools][length][4]: direction and density given the pool; radiance / density and, of
                           PRODUCT, the number of the tile that the sample is of, else 0 */
} helio_vulkan_buffers;

HELIO_API helio_vulkan_buffers helio_vulkan_light_buffers(const helio_vulkan_light *light, uint32_t slot);

#ifdef __cplusplus
}
#endif
#endif
