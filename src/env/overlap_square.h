/* SPDX-License-Identifier: MIT
 * overlap_square.h - overlaps of the texels with the pixels of octahedral, equal-area and angular maps and mirror
 * balls.
 *
 * Found pixel by pixel, by cutting their outlines along the borders of the texels, and then sorted by texel. */
#ifndef HELIOSTAT_SRC_OVERLAP_SQUARE_H
#define HELIOSTAT_SRC_OVERLAP_SQUARE_H

#include "env/cube.h"
#include "env/overlap.h"

#include <heliostat/image.h>

/* Of all texels that see the upper left quarter of the map. */
typedef struct square_overlaps {
    uint32_t size, map_size; /* R, and pixels each way */
    uint32_t *starts;        /* [6 R^2 + 1], where the overlaps of a texel begin */
    uint32_t *pixels;        /* row map_size + column; grows within a texel. A pixel may come several times in a row. */
    float *areas;            /* sr */
} square_overlaps;

helio_status square_overlaps_create(helio_context *context, helio_layout layout, uint32_t map_size, uint32_t size,
                                    square_overlaps *overlaps);
void square_overlaps_release(helio_context *context, square_overlaps *overlaps); /* {0} is fine */

/* A quarter of a face that sees the upper left quarter of the map. */
typedef struct square_quarter {
    const square_overlaps *overlaps;
    uint32_t face;
    bool from_right, from_below; /* where its rows and columns are counted from */
} square_quarter;

/* An overlap_generator for a square_quarter. */
void overlap_square(const void *quarter, uint32_t row, uint32_t first_column, uint32_t end_column,
                    overlap_writer *writer);

/* The axis-aligned quarter of a face in one octant of the sphere, where the axis of this number (0 to 2) is the
 * longest. signs: of x, y and z there. */
square_quarter square_quarter_in(const int signs[3], int axis);

#endif
