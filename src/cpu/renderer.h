/* SPDX-License-Identifier: MIT
 * renderer.h - a frame in progress on the CPU: passes, camera samples, tiles. */
#ifndef HELIOSTAT_SRC_RENDERER_H
#define HELIOSTAT_SRC_RENDERER_H

#include "core/vector.h"
#include "cpu/film.h"
#include "scene/camera.h"
#include "scene/scene.h"

#include <heliostat/renderer.h>

#include <stdatomic.h>

enum { TILE = 16 }; /* pixels along the edge of a tile: the piece of work of one thread */

typedef enum primary_kind {
    PRIMARY_MISS = 0,
    PRIMARY_OBJECT,
    PRIMARY_PLANE,
    PRIMARY_CATCHER,
} primary_kind;

/* What a camera ray met. */
typedef struct primary_hit {
    primary_kind kind;
    vec3 direction; /* of the ray, away from the eye */
    vec3 position, normal, geometric_normal;
    helio_material material;
    float depth;
} primary_hit;

struct helio_renderer {
    helio_context *context;
    helio_renderer_desc desc; /* with defaults resolved */
    helio_tables *tables;
    helio_pools *pools;
    struct film film;
    primary_hit *hits; /* [height][width], of the current camera sample */
};

/* One camera sample with all or a part of its light samples. Light samples beyond what the pools give to a point at
 * once come in parts, each from pools of its own. */
typedef struct frame_step {
    uint32_t pass;          /* pools of this number */
    uint32_t camera_sample; /* 0 ... aa - 1 */
    uint32_t part;          /* of the camera sample */
    uint32_t samples;       /* per point */
} frame_step;

/* A frame while it is rendered; shared by all threads. */
struct frame {
    const helio_renderer *renderer;
    camera_frame camera;
    uint32_t seed;
    frame_step step;
    helio_estimate_desc settings; /* of every estimate, before defaults */
    helio_estimate_desc estimate; /* of the step in progress, resolved */
    uint32_t tiles_across;
    size_t first_tile; /* of the batch in progress */
    atomic_uint_fast64_t samples, useful, rays, points;
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

/* Loop bodies; index counts tiles from first_tile. */
void primary_tile(void *data, size_t index); /* fills hits */
void shade_tile(void *data, size_t index);   /* lights hits and adds them to the film */

/* The function that tells whether light reaches a point of the scene (given as user); NULL if it passes everything. */
helio_visibility shade_visibility(const helio_renderer *renderer);

#endif
