/* SPDX-License-Identifier: MIT
 *
 * Camera rays: what each pixel sees for one camera sample. */
#include "core/random.h"
#include "cpu/renderer.h"

/* Where in the pixel a camera sample looks through: the centre if it is the only one, else scrambled Sobol' points. */
static void pixel_position(const struct frame *frame, uint32_t pixel, float *x, float *y)
{
    if (frame->renderer->desc.aa == 1) {
        *x = *y = 0.5f;
        return;
    }
    uint32_t seed = hash_combine(hash_combine(frame->seed, 0xca3e7au), pixel);
    *x = unit_float(scrambled_sobol(frame->step.camera_sample, 0, seed));
    *y = unit_float(scrambled_sobol(frame->step.camera_sample, 1, seed));
}

static primary_kind kind_of(const scene_hit *hit, helio_ground ground)
{
    if (!hit->is_ground)
        return PRIMARY_OBJECT;
    return ground == HELIO_GROUND_SHADOW ? PRIMARY_CATCHER : PRIMARY_PLANE;
}

static void trace_pixel(const struct frame *frame, uint32_t column, uint32_t row)
{
    const helio_renderer *renderer = frame->renderer;
    const struct film *film = &renderer->film;
    uint32_t pixel = row * film->width + column;
    primary_hit *hit = &renderer->hits[pixel];
    float x, y;
    scene_hit surface;
    pixel_position(frame, pixel, &x, &y);
    *hit = (primary_hit){0};
    hit->direction = camera_direction(&frame->camera, ((float)column + x) / (float)film->width,
                                      ((float)row + y) / (float)film->height);
    if (!scene_intersect(renderer->desc.scene, frame->camera.eye, hit->direction, &surface))
        return;
    hit->kind = kind_of(&surface, renderer->desc.scene->ground);
    hit->position = surface.position;
    hit->normal = surface.normal;
    hit->geometric_normal = surface.geometric_normal;
    hit->material = surface.material;
    hit->depth = dot(subtract(surface.position, frame->camera.eye), frame->camera.forward);
}

void primary_tile(void *data, size_t index)
{
    const struct frame *frame = data;
    struct tile tile = frame_tile(frame, frame->first_tile + index);
    for (uint32_t row = tile.y0; row < tile.y1; row++)
        for (uint32_t column = tile.x0; column < tile.x1; column++)
            trace_pixel(frame, column, row);
}
