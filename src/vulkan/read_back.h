/* SPDX-License-Identifier: MIT
 * read_back.h - a picture's way from a device: as radiance, or as what a screen shows of it. */
#ifndef HELIOSTAT_SRC_VULKAN_READ_BACK_H
#define HELIOSTAT_SRC_VULKAN_READ_BACK_H

#include "cpu/film.h"
#include "vulkan/commands.h"

typedef struct vulkan_read_back {
    helio_device *device; /* NULL: there is nothing here */
    uint32_t pixels;
    const vulkan_buffer *picture, *object; /* on the device: four floats of a pixel, and one; somebody else's */
    vulkan_buffer shown;                   /* there, too: four bytes */
    vulkan_buffer picture_back, object_back, shown_back;
    VkPipeline show;
} vulkan_read_back;

helio_status read_back_create(helio_device *device, const vulkan_buffer *picture, const vulkan_buffer *object,
                              uint32_t pixels, vulkan_read_back *back);
void read_back_destroy(vulkan_read_back *back);

/* Records what a frame is asked for: the making of shown, and copies. There is a barrier before it. */
void read_back_record(const vulkan_read_back *back, vulkan_commands *commands, const helio_frame_desc *desc);

/* Writes that into the film, when the list is over. */
void read_back_take(const vulkan_read_back *back, const helio_frame_desc *desc, const struct film *film);

#endif
