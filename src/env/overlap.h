/* SPDX-License-Identifier: MIT
 * overlap.h - which pixels of a map each texel of the cube covers, and with what share of its solid angle.
 *
 * Each layout has one generator of overlaps. They depend on the shapes alone, so they are found once; a frame only
 * sums. */
#ifndef HELIOSTAT_SRC_OVERLAP_H
#define HELIOSTAT_SRC_OVERLAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A pixel under a texel. weight: the part of the texel's solid angle that the pixel covers; a texel's weights sum to 1.
 */
typedef struct overlap {
    uint32_t row, column; /* of the pixel */
    float weight;
} overlap;

/* One face of the cube over one map: what a generator needs. */
typedef struct overlap_geometry {
    uint32_t size;                  /* R */
    uint32_t map_width, map_height; /* pixels; of one face of a strip */
    /* Lat-long: [map_height + 1], sine of the latitude of the borders between rows, from 1 down to -1.
     * Strips: [map_width + 1], face coordinates of the borders between pixels, from -1 to 1. */
    const double *borders;
} overlap_geometry;

/* Overlaps of texel (row, column) of a face, at most overlap_..._bound() of them. Returns their number. */
typedef uint32_t (*overlap_generator)(const overlap_geometry *geometry, uint32_t row, uint32_t column,
                                      overlap *overlaps);
typedef size_t (*overlap_bound)(const overlap_geometry *geometry, uint32_t row, uint32_t column);

/* Lat-long maps: the faces +Z and +Y. */
uint32_t overlap_side(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps);
size_t overlap_side_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column);
uint32_t overlap_pole(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps);
size_t overlap_pole_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column);

/* A square face of a strip. */
uint32_t overlap_strip(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps);
size_t overlap_strip_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column);

/* Face coordinate of the border before texel `index` of a cube of this size. */
static inline double texel_border(uint32_t index, uint32_t size)
{
    return 2.0 * index / size - 1.0;
}

#endif
