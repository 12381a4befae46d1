/* SPDX-License-Identifier: MIT
 * light.h - a map on its way from a cube to pools of samples, all on a device: what src/sampling does on the CPU.
 *
 * tables.c makes tables of the cube, pools.c draws pools from the tables, bins.c those of bins of normals. */
#ifndef HELIOSTAT_SRC_VULKAN_LIGHT_H
#define HELIOSTAT_SRC_VULKAN_LIGHT_H

#include "sampling/pools.h"
#include "vulkan/commands.h"
#include "vulkan/map.h"
#include "vulkan/pipeline.h"

typedef enum light_pass {
    PASS_ROWS,
    PASS_MARGINALS,
    PASS_FACES,
    PASS_POOLS,
    PASS_MOMENTS,
    PASS_EVENNESS,
    PASS_TILES,
    PASS_TILE_LIGHT,
    PASS_BINS,
    PASS_LOBES,
    PASS_GREATEST,
    PASS_LISTS,
    PASS_DRAW_LISTS,
    PASS_DRAW_BINS,
    PASS_TILE_CONTROL,
    PASS_KNOWN,
    PASS_CONTROL_SUMS,
    LIGHT_PASSES
} light_pass;

enum { LIGHT_SLOTS = 2 };

/* What frames have of their own, so that the cube of the next can come while one is worked on. */
typedef struct light_slot {
    vulkan_buffer staging, cube;
    bool is_map, is_sky; /* what was sent is a map or a sky, and the cube is to be made of it */
    vulkan_buffer state; /* with that cube */
    vulkan_buffer sums_back;
    vulkan_commands upload;
    uint32_t started, done; /* marks of the upload */
    VkSemaphore uploaded;
    bool is_unheard; /* the semaphore is, or will be, signalled, and no list waits for it */
} light_slot;

typedef struct vulkan_light {
    helio_device *device;
    const helio_pools *shape; /* the CPU's, of which this is the image */
    const helio_environment *environment;
    struct layout_state state; /* as the shaders have it */
    light_slot slots[LIGHT_SLOTS];
    uint32_t slot;  /* of the frame in hand */
    vulkan_map map; /* {0} unless maps are taken */
    vulkan_buffer solid_angles, rows, marginals, row_densities, weights, fluxes, sums;
    vulkan_buffer pools;
    /* Of bins of normals; nothing for other strategies. */
    vulkan_buffer tile_grid, tile_positions, tiles, tile_totals, tile_sums, segment_densities, tile_spreads;
    vulkan_buffer groups, tile_angles, lobe_variances;
    vulkan_buffer moments; /* where the strategy may be left */
    vulkan_buffer bins, bin_sums, bin_shares, greatest, list_starts, listed;
    vulkan_buffer tile_light, tile_hues, known, control_sums;
    VkPipeline passes[LIGHT_PASSES]; /* those that the strategy needs */
} vulkan_light;

/* shape: pools whose strategy, weighting and sizes are wanted; they need not be drawn, and must outlive the light.
 * commands: to upload with, free again when this returns. */
helio_status light_create(helio_device *device, vulkan_commands *commands, const helio_pools *shape,
                          vulkan_light *light);
void light_destroy(vulkan_light *light);

/* Bytes of the cube. */
uint64_t light_cube_bytes(const vulkan_light *light);

/* Takes the environment's maps and skies, which will be sent instead of cubes. The light must stay where it is. */
helio_status light_take_maps(vulkan_light *light, helio_environment *environment);

/* Sends the environment's map, sky or cube to the device, for a frame of this slot. No list that reads the slot may be
 * on its way. */
helio_status light_send(vulkan_light *light, uint32_t slot);

/* The same, of the cube, as part of a list that makes the tables as well, without a barrier behind. */
void light_record_cube(vulkan_light *light, vulkan_commands *commands, uint32_t slot);

/* When the cube has come: what the list that makes the tables is to be submitted after, and to be told once it was. */
VkSemaphore light_sent(const vulkan_light *light);
void light_heard(vulkan_light *light);

/* How long that took, ms, once it is over. */
double light_send_milliseconds(const vulkan_light *light, uint32_t slot);

/* Records the making of the cube of the slot in hand, if a map or a sky was sent, with a barrier behind. */
void light_record_resampling(vulkan_light *light, vulkan_commands *commands);

/* Records that what is known of the map as a whole comes back; and what came, of a slot whose frame is over. */
void light_record_report(vulkan_light *light, vulkan_commands *commands);
const struct layout_sums *light_sums(const vulkan_light *light, uint32_t slot);

/* Records the making of the tables of the slot in hand, with a barrier behind. */
void light_record_tables(vulkan_light *light, vulkan_commands *commands);

/* Records the drawing of the pools, for the pass whose seed is in a step at this address. What depends on the frame
 * alone is only done where the pass is its first. */
void light_record_pools(vulkan_light *light, vulkan_commands *commands, uint64_t step, bool is_first_pass);

/* What passes over the light push. */
struct layout_push light_push(const vulkan_light *light, uint64_t step, uint32_t parameter);

/* ---- parts -------------------------------------------------------------------------------- */

/* A buffer that is to be made. */
typedef struct light_buffer {
    vulkan_buffer *buffer;
    buffer_place place;
    uint64_t count, size;
    const char *name;
} light_buffer;

helio_status light_create_buffers(vulkan_light *light, const light_buffer *buffers, size_t count);

/* Threads of a work group: many on hardware, few where software plays it. */
uint32_t light_threads(const vulkan_light *light);

helio_status light_create_tables(vulkan_light *light, vulkan_commands *commands);
helio_status light_create_pools(vulkan_light *light);
helio_status light_create_bins(vulkan_light *light, vulkan_commands *commands);
void light_record_bins(vulkan_light *light, vulkan_commands *commands, uint64_t step, bool is_first_pass);

#endif
