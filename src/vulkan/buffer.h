/* SPDX-License-Identifier: MIT
 * buffer.h - memory of a device. */
#ifndef HELIOSTAT_SRC_VULKAN_BUFFER_H
#define HELIOSTAT_SRC_VULKAN_BUFFER_H

#include "vulkan/device.h"

typedef enum buffer_place {
    BUFFER_ON_DEVICE, /* the host cannot see it */
    BUFFER_SHARED,    /* the same, for both queues */
    BUFFER_UPLOAD,    /* the host writes it, from one end to the other, and does not read */
    BUFFER_READBACK,  /* the host reads it */
} buffer_place;

typedef struct vulkan_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceAddress address;
    void *mapped; /* NULL on the device */
    uint64_t bytes;
} vulkan_buffer;

/* name: of what it holds, as in "no memory for NAME", and for tools. count x size may overflow: that is an error, too.
 * A buffer of nothing becomes one of a few bytes. HELIO_ERR_MEMORY where the device has too little. */
helio_status buffer_create(helio_device *device, buffer_place place, uint64_t count, uint64_t size, const char *name,
                           vulkan_buffer *out);
void buffer_destroy(helio_device *device, vulkan_buffer *buffer);

/* Takes memory of the device for an image. */
helio_status buffer_allocate_image(const helio_device *device, VkImage image, const char *name, VkDeviceMemory *memory);

/* All of a list that ends with NULL. */
void buffers_destroy(helio_device *device, vulkan_buffer *const *buffers);

#endif
