/* SPDX-License-Identifier: MIT
 * vulkan_support.h - what the tests of the Vulkan backend share: a device that is watched, and maps. */
#ifndef HELIOSTAT_TESTS_VULKAN_SUPPORT_H
#define HELIOSTAT_TESTS_VULKAN_SUPPORT_H

#include "support.h"

#include "vulkan/light.h"

#include <heliostat/heliostat.h>

/* A device on which every use is validated, synchronization included; where the layer is not installed it says so and
 * does without. Skips the test, and says so, where there is no device. */
helio_device *open_test_device(helio_context *context);

/* Fails if the validation layer had something to say. Destroys the device. */
void close_test_device(helio_device *device);

/* A device and, from world_make_light() to world_destroy_light(), light on it and on the CPU. */
typedef struct vulkan_world {
    helio_context *context;
    helio_device *device;
    vulkan_commands commands;
    helio_environment *environment;
    helio_tables *tables;
    helio_pools *pools;
    vulkan_light light;
    vulkan_buffer step; /* struct layout_step */
} vulkan_world;

vulkan_world world_make(void);
void world_destroy(vulkan_world *w);
void world_make_light(vulkan_world *w, uint32_t size, helio_weighting weighting, const helio_pools_desc *pools);
void world_destroy_light(vulkan_world *w);

/* Tables and pools of the current cube, on both. */
void world_update(vulkan_world *w, uint32_t seed, uint32_t pass);

/* Fails unless so many bytes of a buffer are these. */
void world_compare_bits(vulkan_world *w, const vulkan_buffer *buffer, const void *expected, size_t bytes,
                        const char *what);

/* Kinds of maps that tables may have trouble with. */
typedef enum map_kind {
    MAP_RANDOM, /* some texels and a whole row black, one a sun */
    MAP_BLACK,
    MAP_ONE_TEXEL,
    MAP_SUN, /* 16 texels of 10^6 times the sky */
    MAP_KINDS
} map_kind;

const char *map_kind_name(map_kind kind);

/* Puts such a map into the cube of an environment, and begins a new frame. */
void fill_cube(helio_environment *environment, map_kind kind, uint64_t seed);

/* Copies so many bytes of a buffer of the device; to be freed. */
void *read_buffer(vulkan_commands *commands, const vulkan_buffer *buffer, size_t bytes);

#endif
