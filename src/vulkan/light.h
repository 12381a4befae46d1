/* SPDX-License-Identifier: MIT
 * light.h - a map on its way from a cube to pools of samples, all on a device: what src/sampling does on the CPU.
 *
 * tables.c makes tables of the cube, pools.c draws pools from the tables, bins.c those of bins of normals. */
#ifndef HELIOSTAT_SRC_VULKAN_LIGHT_H
#define HELIOSTAT_SRC_VULKAN_LIGHT_H

#include "sampling/strategy.h"
#include "vulkan/commands.h"
#include "vulkan/pipeline.h"

#include <heliostat/sampling.h>

typedef enum light_pass { PASS_ROWS, PASS_MARGINALS, PASS_FACES, LIGHT_PASSES } light_pass;

typedef struct vulkan_light {
    helio_device *device;
    const helio_environment *environment;
    strategy_parts parts;
    struct layout_state state; /* as the shaders have it */
    vulkan_buffer state_memory;
    vulkan_buffer staging; /* for the cube */
    vulkan_buffer cube, solid_angles, rows, marginals, row_densities, weights, fluxes, sums;
    VkPipeline passes[LIGHT_PASSES];
} vulkan_light;

typedef struct light_desc {
    const helio_environment *environment;
    helio_weighting weighting;
    helio_strategy strategy;
    uint32_t pool_length; /* M, 0: the default */
    uint32_t bins;        /* B, likewise */
} light_desc;

/* commands: to upload with, free again when this returns. */
helio_status light_create(helio_device *device, vulkan_commands *commands, const light_desc *desc, vulkan_light *light);
void light_destroy(vulkan_light *light);

/* Bytes of the cube. */
uint64_t light_cube_bytes(const vulkan_light *light);

/* Copies the environment's cube to where the device finds it; not while a list that reads it is on its way. */
void light_stage(vulkan_light *light);

/* Record: the copy, and the tables of what was copied. With barriers between, and one behind. */
void light_record_upload(vulkan_light *light, vulkan_commands *commands);
void light_record_tables(vulkan_light *light, vulkan_commands *commands);

/* What passes over the light push. */
struct layout_push light_push(const vulkan_light *light, uint64_t step, uint32_t parameter);

/* ---- parts -------------------------------------------------------------------------------- */

helio_status light_create_tables(vulkan_light *light, vulkan_commands *commands, helio_weighting weighting);
void light_destroy_tables(vulkan_light *light);

#endif
