/* SPDX-License-Identifier: MIT
 * frame.h - what a renderer holds on a device; renderer.c makes it, frame.c makes frames with it. */
#ifndef HELIOSTAT_SRC_VULKAN_FRAME_H
#define HELIOSTAT_SRC_VULKAN_FRAME_H

#include "vulkan/device_choice.h"
#include "vulkan/light.h"
#include "vulkan/points.h"
#include "vulkan/raster.h"
#include "vulkan/read_back.h"
#include "vulkan/renderer.h"
#include "vulkan/textures.h"

enum { PRIMARY_EDGE = 8, MISSES_OF_GROUP = 64 }; /* pixels of a work group: along its edges; those of misses */

/* How work is shared out when points are lit, see shade.comp. */
typedef struct shade_shape {
    uint32_t threads, points, lanes;
} shade_shape;

/* Marks of a list of commands. */
typedef struct step_marks {
    uint32_t start, uploaded, traced, cube, tables, pools, shaded, back;
} step_marks;

/* A frame that may still be on its way while the next is begun. */
typedef struct frame_slot {
    vulkan_commands commands;
    step_marks marks;
    vulkan_buffer counts_back, lists_back;
    bool counts_points;    /* those of this step are new */
    helio_frame_info info; /* as far as it is known */
    bool is_pending;
} frame_slot;

struct vulkan_renderer {
    helio_context *context;
    helio_device *device;
    frame_slot slots[LIGHT_SLOTS];
    uint32_t next;                /* slot */
    helio_frame_info latest_info; /* of the latest frame that is known to be over */
    vulkan_light light;
    vulkan_points points;
    bool traces;      /* camera rays too; else the CPU does */
    bool catches;     /* shadows, on the ground */
    struct hits seen; /* what the lists of points belong to, without arrays */
    bool has_points;  /* the lists are those of the step in hand */
    shade_shape shape;
    VkPipeline primary, list_groups, shade, background;
    primary_way way;                             /* how camera rays find triangles */
    vulkan_raster raster;                        /* where that is not by rays; else nothing, as is: */
    VkPipeline primary_drawn;                    /* for triangles that the rasteriser found */
    VkPipeline shade_tiles;                      /* where points that shine weigh tiles; else nothing */
    vulkan_buffer step, counts, picture, object; /* on the device */
    vulkan_buffer caught, caught_back;           /* for a shadow catcher; else nothing, as is: */
    vulkan_read_back back;
    vulkan_buffer nodes, triangles, normals; /* for rays; else nothing */
    vulkan_textures textures;                /* for camera rays; else nothing */
    vulkan_buffer surfaces, surfaces_back;   /* for layers found by the device; else nothing */
    bool has_new_surfaces;                   /* which are not in the picture yet */
};

/* Does the device find the layers of the picture? */
static inline bool finds_layers(const struct vulkan_renderer *v, const helio_renderer *renderer)
{
    return v->traces && renderer->desc.aovs;
}

/* Is the ground a shadow catcher? */
static inline bool catches_shadows(const helio_renderer *renderer)
{
    return renderer->desc.scene->ground == HELIO_GROUND_SHADOW;
}

/* Are shadow rays wanted? */
static inline bool casts_rays(const helio_renderer *renderer)
{
    return !renderer->desc.no_visibility;
}

#endif
