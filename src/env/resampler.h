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

/* How the pixels of a row of the map are read; the results are those of pixel_clean() in any case. */
typedef enum row_reading {
    ROW_AS_IT_IS,
    ROW_CLAMPED,  /* negative channels as 0 */
    ROW_BY_PIXEL, /* one by one, each through pixel_clean() */
} row_reading;

/* readings: [height], row_reading of each row; ROW_BY_PIXEL for those with NaN or infinite channels, and for the one
 * behind which nothing may be read. cube: [6][R][R][3], finite and >= 0. Takes no memory. */
void resampler_run(helio_context *context, const resampler *resampler, const map_pixels *pixels,
                   const uint8_t *readings, float *cube);

#endif
