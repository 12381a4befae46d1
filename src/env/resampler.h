/* SPDX-License-Identifier: MIT
 * resampler.h - from the pixels of a layout to the texels of the cube, by averaging over solid angle. */
#ifndef HELIOSTAT_SRC_RESAMPLER_H
#define HELIOSTAT_SRC_RESAMPLER_H

#include "env/map_pixels.h"

#include <heliostat/image.h>

typedef struct resampler resampler;

/* Finds all overlaps of pixels and texels, which depend on the shapes alone. The shape must fit the layout. */
helio_status resampler_create(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                              uint32_t cube_size, resampler **out);
void resampler_destroy(helio_context *context, resampler *resampler);

/* Whether every pixel of a map is under some texel: not the corners of crosses and discs. */
bool resampler_sees_all(const resampler *resampler);

/* Pixels count as pixel_clean() makes them. Returns whether some were no light. cube: [6][R][R][3], finite and >= 0.
 * Takes no memory. */
bool resampler_run(helio_context *context, resampler *resampler, const map_pixels *pixels, float *cube);

#endif
