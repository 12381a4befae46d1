/* SPDX-License-Identifier: MIT
 * background.h - the environment behind the scene, for many pixels at a time. */
#ifndef HELIOSTAT_SRC_BACKGROUND_H
#define HELIOSTAT_SRC_BACKGROUND_H

#include "env/environment.h"
#include "sampling/kernels.h"
#include "scene/camera.h"

enum { BACKGROUND_PIXELS = 16 }; /* at most in one call */

/* A camera before an environment. The direction of the point (x, y) of the picture, counted in pixels from its upper
 * left corner, is corner + x across + y down, of any length, in the map's space. */
struct background {
    const helio_environment *environment;
    const kernel_set *kernels;
    vec3 corner, across, down;
};

struct background background_prepare(const helio_environment *environment, const kernel_set *kernels,
                                     const camera_frame *camera, uint32_t width, uint32_t height);

static inline vec3 background_direction(const struct background *b, float x, float y)
{
    return add_scaled(add_scaled(b->corner, b->across, x), b->down, y);
}

/* helio_environment_filtered() in the directions of these points, with an alpha of 1. x, y: [count]; rgba: [count].
 * Directions are rounded otherwise than those of camera_direction(), which moves a point by some millionths of a face:
 * the radiance may differ by as much of what differs between neighbouring texels. The same bits with every instruction
 * set. */
void background_fill(const struct background *b, uint32_t count, const float *x, const float *y, float (*rgba)[4]);

#endif
