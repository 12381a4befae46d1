/* SPDX-License-Identifier: MIT
 * raster.h - which triangles pixels see through their centres, found by the rasteriser in place of camera rays. */
#ifndef HELIOSTAT_SRC_VULKAN_RASTER_H
#define HELIOSTAT_SRC_VULKAN_RASTER_H

#include "vulkan/commands.h"

enum { RASTER_IMAGES = 2 }; /* numbers of triangles; depths */

typedef struct vulkan_raster {
    helio_device *device;
    uint32_t width, height, vertex_count;
    VkImage images[RASTER_IMAGES];
    VkDeviceMemory memory[RASTER_IMAGES];
    VkImageView views[RASTER_IMAGES];
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    vulkan_buffer seen; /* [height][width]: numbers of triangles, LAYOUT_NOTHING_SEEN where there is none */
} vulkan_raster;

/* Can the device draw pictures of this size on the queue that it computes on? */
bool raster_is_possible(const helio_device *device, uint32_t width, uint32_t height);

helio_status raster_create(helio_device *device, uint32_t width, uint32_t height, uint32_t triangle_count,
                           vulkan_raster *raster);
void raster_destroy(vulkan_raster *raster);

/* Records the drawing of the step's triangles, with a barrier behind. */
void raster_record(const vulkan_raster *raster, vulkan_commands *commands, const struct layout_push *push);

#endif
