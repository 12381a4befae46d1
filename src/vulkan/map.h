/* SPDX-License-Identifier: MIT
 * map.h - maps on a device, where they become cubes: what src/env/resampler.h does on the CPU.
 *
 * The environment hands each frame's map over (map_sink.h); it is copied to where both the device and the CPU can read
 * it, which may still want a cube of its own. Of what the CPU knows about the shape of the map, the weights above all,
 * the device has got a copy when the first map of a shape comes. */
#ifndef HELIOSTAT_SRC_VULKAN_MAP_H
#define HELIOSTAT_SRC_VULKAN_MAP_H

#include "env/map_sink.h"
#include "vulkan/commands.h"
#include "vulkan/pipeline.h"
#include "vulkan/sky.h"

enum { MAP_COPIES = 2, MAP_KINDS_OF_NUMBERS = MAP_WORDS + 1 };

/* A frame's map in memory of the host. */
typedef struct map_copy {
    vulkan_buffer staging;
    map_pixels pixels; /* there */
    uint64_t frame;    /* of the environment; 0: none */
} map_copy;

/* What frames have of their own: see light_slot. */
typedef struct map_slot {
    vulkan_commands *upload;
    const map_copy *sent; /* the copy that the upload reads */
    vulkan_buffer pixels; /* on the device */
    vulkan_buffer map;    /* struct layout_map */
    vulkan_buffer faults_back;
} map_slot;

/* What memory was taken for. */
typedef struct map_shape {
    uint32_t width, height, channels;
    map_numbers numbers;
    helio_layout layout;
} map_shape;

typedef struct vulkan_map {
    helio_device *device; /* NULL: no maps are taken */
    map_sink sink;
    vulkan_commands commands; /* to upload with */
    map_shape shape;          /* width 0: none yet */
    bool is_refused;          /* the shape is too large for the device */
    map_copy copies[MAP_COPIES];
    uint32_t latest; /* copy */
    map_slot slots[MAP_COPIES];
    vulkan_buffer starts, patches, weights, large, faults;
    size_t large_count; /* texels whose pixels threads share */
    /* Of each kind of numbers, those that were needed so far. */
    VkPipeline count[MAP_KINDS_OF_NUMBERS], resample[MAP_KINDS_OF_NUMBERS], resample_large[MAP_KINDS_OF_NUMBERS];
    vulkan_sky sky; /* skies come the same way */
} vulkan_map;

/* Joins the environment: from now on its maps and skies come here. uploads: of the slots. */
helio_status map_create(helio_device *device, helio_environment *environment, vulkan_commands *const *uploads,
                        vulkan_map *map);
void map_destroy(vulkan_map *map); /* {0} is fine */

/* Whether the environment's present frame is a map that has come here; else its cube must be sent. */
bool map_is_here(const vulkan_map *map);

/* The same of a sky. */
bool map_is_sky(const vulkan_map *map);

/* Records the sending of that map, in the slot's upload. */
void map_record_send(vulkan_map *map, uint32_t slot);

/* Records the making of the cube of the map that was sent, with a barrier behind. push: of the light. */
void map_record_cube(vulkan_map *map, vulkan_commands *commands, uint32_t slot, struct layout_push push,
                     uint32_t cube_size);

/* What was found in the map that was sent for a slot, whose frame is over. */
helio_bad_pixels map_bad_pixels(const vulkan_map *map, uint32_t slot);

#endif
