/* SPDX-License-Identifier: MIT
 * renderer.h - a frame in progress on the CPU: passes, camera samples, tiles. */
#ifndef HELIOSTAT_SRC_RENDERER_H
#define HELIOSTAT_SRC_RENDERER_H

#include "cpu/background.h"
#include "cpu/film.h"
#include "cpu/hits.h"
#include "sampling/estimate.h"
#include "scene/scene.h"

#include <heliostat/renderer.h>

#include <stdatomic.h>

enum { TILE = 16 }; /* pixels along the edge of a tile: the piece of work of one thread */
_Static_assert((int)TILE <= (int)BACKGROUND_PIXELS && (int)TILE <= (int)SCENE_RAYS,
               "a row of a tile is handled at once");

/* Finds the light that leaves a point, in place of an estimate from samples. Called for a pixel by one thread at a
 * time.
 */
typedef void (*renderer_lighting)(void *user, size_t pixel, const helio_shading_point *point, estimate_result *result);

/* What only references and tests ask for. */
typedef struct renderer_extras {
    bool keeps_sums; /* film.lights holds the sums of the latest frame when it is done, but no picture is made */
    renderer_lighting lighting; /* default: estimates */
    void *user;                 /* handed to it */
    bool
        cpu_rays; /* trace camera rays on the CPU although a device computes: to compare the light of the same points */
} renderer_extras;

struct helio_renderer {
    helio_context *context;
    renderer_extras extras;
    helio_renderer_desc desc; /* with defaults resolved */
    helio_tables *tables;
    helio_pools *pools;
    struct film film;
    struct hits hits;                /* of the current camera sample */
    struct vulkan_renderer *vulkan;  /* where a device computes; else NULL */
    bool has_shown, has_no_radiance; /* what the latest frame that made a picture was asked for */
};

/* helio_renderer_create() with extras. */
helio_status renderer_create(helio_context *context, const helio_renderer_desc *desc, const renderer_extras *extras,
                             helio_renderer **renderer);

/* One camera sample with all or a part of its light samples. Light samples beyond what the pools give to a point at
 * once come in parts, each from pools of its own. */
typedef struct frame_step {
    uint32_t pass;          /* pools of this number */
    uint32_t camera_sample; /* 0 ... aa - 1 */
    uint32_t part;          /* of the camera sample */
    uint32_t samples;       /* per point */
    bool is_first, is_last; /* of the frame */
} frame_step;

/* What threads count, each for itself. */
typedef struct frame_counts {
    uint64_t samples, useful, rays, points, camera_rays;
    double primary_ms, shade_ms;
} frame_counts;

/* A frame while it is rendered; shared by all threads. */
struct frame {
    const helio_renderer *renderer;
    camera_frame camera;
    struct background background;
    uint32_t seed;
    frame_step step;
    double weight;                /* of the light samples that a pixel has after this step */
    uint32_t step_seed;           /* of all points of the step */
    bool traces;                  /* the step begins with camera rays */
    helio_estimate_desc settings; /* of every estimate, before defaults */
    helio_estimate_desc estimate; /* of the step in progress, resolved */
    size_t tiles_across, tile_count;
    double deadline;         /* when to stop for a while and tell how far the frame is */
    atomic_size_t next_tile; /* to be done; those before it are done or in hand */
    atomic_uint_fast64_t samples, useful, rays, points, camera_rays;
    atomic_uint_fast64_t primary_ns, shade_ns; /* sums over the threads */
};

/* Pixels of tile `index`: columns x0 ... x1 - 1, rows y0 ... y1 - 1. */
struct tile {
    uint32_t x0, x1, y0, y1;
};

static inline struct tile frame_tile(const struct frame *frame, size_t index)
{
    const struct film *film = &frame->renderer->film;
    uint32_t x = (uint32_t)(index % frame->tiles_across) * TILE, y = (uint32_t)(index / frame->tiles_across) * TILE;
    return (struct tile){x, x + TILE < film->width ? x + TILE : film->width, y,
                         y + TILE < film->height ? y + TILE : film->height};
}

/* Where the camera sample looks through `count` pixels of a row, in pixels from the picture's upper left corner, and in
 * which directions. All arrays: [count] */
void primary_positions(const struct frame *frame, uint32_t row, uint32_t column, uint32_t count, float *x, float *y);
void primary_directions(const struct frame *frame, uint32_t count, const float *x, const float *y, float *direction_x,
                        float *direction_y, float *direction_z);

/* Fills the tile's hits. */
void primary_tile(const struct frame *frame, struct tile tile);

/* What is to be lit in a pixel that hit something. direction: of its camera ray. */
void shade_point(const struct frame *frame, size_t index, vec3 direction, helio_shading_point *point);

/* Adds a point to the sums of a pixel's arbitrary output variables. */
void shade_add_surface(const struct frame *frame, const helio_shading_point *point, film_surface *surface);

/* Lights the tile's hits and adds them to the film. */
void shade_tile(const struct frame *frame, struct tile tile, frame_counts *counts);

/* The function that tells whether light reaches a point of the scene (given as user); NULL if it passes everything. */
helio_visibility shade_visibility(const helio_renderer *renderer);

/* How many steps the frames of a renderer take. */
uint32_t frame_step_count(const helio_renderer *renderer);
frame_step frame_plan_step(const helio_renderer *renderer, uint32_t index);

/* Starts a frame, and sets it up for a step. The hits of the only camera sample are kept from frame to frame; others
 * make way for those of the next. */
struct frame frame_begin(const helio_renderer *renderer, const camera_frame *camera, uint32_t seed);
helio_status frame_begin_step(helio_renderer *renderer, struct frame *frame, uint32_t index, bool keeps_hits);

/* Works on the tiles of the step for a while, until all are done if slice_ms is infinite, and adds to the times of
 * info. Returns how many tiles of the step are done: the first ones. */
size_t frame_work(struct frame *frame, double slice_ms, helio_frame_info *info);

/* Makes the picture of a frame that stopped when the first tiles of its step were done. */
void frame_finish(struct frame *frame, size_t tiles_done);

/* Monotonic. */
double frame_milliseconds(void);

#endif
