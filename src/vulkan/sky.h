/* SPDX-License-Identifier: MIT
 * sky.h - skies on a device, where they become cubes: what src/env/sky_cube.h does on the CPU.
 *
 * A sky is some forty numbers and the texels that see the sun, whose parts of its disc the CPU has found. */
#ifndef HELIOSTAT_SRC_VULKAN_SKY_H
#define HELIOSTAT_SRC_VULKAN_SKY_H

#include "env/sky_cube.h"
#include "vulkan/commands.h"
#include "vulkan/pipeline.h"

enum { SKY_COPIES = 2 };

/* A frame's sky in memory of the host. */
typedef struct sky_copy {
    vulkan_buffer staging; /* struct layout_sky, and behind it texels of the sun */
    uint64_t bytes;        /* of it that count */
    sky_parts parts;       /* the same, with the texels there */
    uint64_t frame;        /* of the environment; 0: none */
} sky_copy;

/* What frames have of their own: see light_slot. */
typedef struct sky_slot {
    vulkan_commands *upload;
    const sky_copy *sent; /* the copy that the upload reads */
    vulkan_buffer sky;    /* on the device */
} sky_slot;

/* Nothing is taken before the first sky comes. */
typedef struct vulkan_sky {
    helio_device *device;
    uint32_t cube_size;
    sky_copy copies[SKY_COPIES];
    uint32_t latest; /* copy */
    sky_slot slots[SKY_COPIES];
    VkPipeline fill, add_sun;
    bool is_made, is_refused; /* refused: there is no memory */
} vulkan_sky;

/* uploads: of the slots. */
void vulkan_sky_begin(helio_device *device, uint32_t cube_size, vulkan_commands *const *uploads, vulkan_sky *sky);
void vulkan_sky_end(vulkan_sky *sky); /* {0} is fine */

/* Copies the sky of a frame of the environment. NULL where the CPU should make the cube: of small ones, or as there is
 * no memory, of which it tells once. */
const sky_parts *vulkan_sky_take(vulkan_sky *sky, helio_context *context, const sky_parts *parts, uint64_t frame);

/* Whether this frame is a sky that has come here. */
bool vulkan_sky_is_here(const vulkan_sky *sky, uint64_t frame);

/* Records the sending of that sky, in the slot's upload. */
void vulkan_sky_record_send(vulkan_sky *sky, uint32_t slot);

/* Records the making of the cube of the sky that was sent, with a barrier behind. push: of the light. */
void vulkan_sky_record_cube(const vulkan_sky *sky, vulkan_commands *commands, uint32_t slot, struct layout_push push);

#endif
