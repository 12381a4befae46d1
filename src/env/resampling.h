/* SPDX-License-Identifier: MIT
 * resampling.h - a frame on its way from the map into the cube, as the kernels see it. */
#ifndef HELIOSTAT_SRC_RESAMPLING_H
#define HELIOSTAT_SRC_RESAMPLING_H

#include "env/map_pixels.h"
#include "env/resampler_plan.h"

struct resampling {
    const resampler *plan;
    map_pixels pixels;
    float *cube;
    bool streams;                    /* past the caches, which the cube is too large for */
    const unsigned char *last_pixel; /* in memory: nothing may be read behind it; NULL if there is alpha behind it */
    /* The pixel where a view finds row 0 of the list and column 0 of a quarter. */
    const unsigned char *origins[MAX_GROUPS][MAP_QUARTERS][GROUP_VIEWS];
};

#endif
