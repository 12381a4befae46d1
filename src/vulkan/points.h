/* SPDX-License-Identifier: MIT
 * points.h - what camera rays met, as lists on a device: points to be lit, and pixels that show the background. */
#ifndef HELIOSTAT_SRC_VULKAN_POINTS_H
#define HELIOSTAT_SRC_VULKAN_POINTS_H

#include "cpu/renderer.h"
#include "vulkan/commands.h"

typedef struct vulkan_points {
    helio_device *device;
    uint32_t point_count, miss_count;
    bool has_own_materials, casts_rays;
    vulkan_buffer points, materials, misses, origins; /* on the device, as are: */
    vulkan_buffer counts, groups;                     /* see counts_of_lists and groups_of_lists in layout.h */
    vulkan_buffer points_staging, materials_staging, misses_staging, origins_staging; /* where the host writes them */
} vulkan_points;

/* For pictures of this size of the scene. casts_rays: where shadow rays start is wanted as well. */
helio_status points_create(helio_device *device, const helio_scene *scene, bool casts_rays, uint32_t width,
                           uint32_t height, vulkan_points *points);
void points_destroy(vulkan_points *points);

/* Makes lists of the hits of a frame; not while a list of commands that copies them is on its way. */
void points_stage(vulkan_points *points, const struct frame *frame);

/* The materials of all points and of the triangles, at once, for a device that traces camera rays itself. Where there
 * are textures, those of single points come behind. */
helio_status points_upload_materials(vulkan_points *points, vulkan_commands *commands, const helio_scene *scene);

/* Records the copy, without a barrier behind. */
void points_record_upload(const vulkan_points *points, vulkan_commands *commands);

/* Kinds of materials that points of the scene may have, as bits. */
uint32_t points_kinds(const helio_scene *scene);

#endif
