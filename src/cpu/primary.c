/* SPDX-License-Identifier: MIT
 *
 * Camera rays: what each pixel sees for one camera sample. */
#include "core/random.h"
#include "cpu/renderer.h"

/* Scrambled Sobol' points. */
static void scatter_positions(const struct frame *frame, uint32_t row, uint32_t column, uint32_t count, float *x,
                              float *y)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t pixel = row * frame->renderer->film.width + column + i;
        uint32_t seed = hash_combine(hash_combine(frame->seed, 0xca3e7au), pixel);
        x[i] = (float)(column + i) + unit_float(scrambled_sobol(frame->step.camera_sample, 0, seed));
        y[i] = (float)row + unit_float(scrambled_sobol(frame->step.camera_sample, 1, seed));
    }
}

void primary_positions(const struct frame *frame, uint32_t row, uint32_t column, uint32_t count, float *x, float *y)
{
    if (frame->renderer->desc.aa != 1) {
        scatter_positions(frame, row, column, count, x, y);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        x[i] = (float)(column + i) + 0.5f; /* the centre, as it is the only one */
        y[i] = (float)row + 0.5f;
    }
}

void primary_directions(const struct frame *frame, uint32_t count, const float *x, const float *y,
                        float *restrict direction_x, float *restrict direction_y, float *restrict direction_z)
{
    const camera_frame camera = frame->camera; /* a copy: nothing written below can change it */
    const float width = (float)frame->renderer->film.width, height = (float)frame->renderer->film.height;
    for (uint32_t i = 0; i < count; i++) {
        vec3 direction = camera_direction(&camera, x[i] / width, y[i] / height);
        direction_x[i] = direction.x;
        direction_y[i] = direction.y;
        direction_z[i] = direction.z;
    }
}

static hit_kind kind_of(const scene_hit *hit, helio_ground ground)
{
    if (!hit->is_ground)
        return HIT_OBJECT;
    return ground == HELIO_GROUND_SHADOW ? HIT_CATCHER : HIT_PLANE;
}

static void keep_hit(const helio_renderer *renderer, size_t pixel, const scene_hit *surface)
{
    const struct hits *hits = &renderer->hits;
    hits->kinds[pixel] = (uint8_t)kind_of(surface, renderer->desc.scene->ground);
    hits->surfaces[pixel] = (hit_surface){surface->position, surface->normal, surface->geometric_normal};
    if (hits->materials)
        hits->materials[pixel] = surface->material;
}

static void trace_row(const struct frame *frame, uint32_t row, uint32_t x0, uint32_t count)
{
    const helio_renderer *renderer = frame->renderer;
    size_t first = (size_t)row * renderer->film.width + x0;
    float x[TILE], y[TILE], direction_x[TILE], direction_y[TILE], direction_z[TILE];
    scene_hit surfaces[TILE];
    bool met[TILE];
    primary_positions(frame, row, x0, count, x, y);
    primary_directions(frame, count, x, y, direction_x, direction_y, direction_z);
    scene_intersect_many(renderer->desc.scene, frame->camera.eye, count, direction_x, direction_y, direction_z,
                         surfaces, met);
    for (uint32_t i = 0; i < count; i++)
        if (met[i])
            keep_hit(renderer, first + i, &surfaces[i]);
        else
            renderer->hits.kinds[first + i] = HIT_NOTHING;
}

void primary_tile(const struct frame *frame, struct tile tile)
{
    for (uint32_t row = tile.y0; row < tile.y1; row++)
        trace_row(frame, row, tile.x0, tile.x1 - tile.x0);
}
