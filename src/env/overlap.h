/* SPDX-License-Identifier: MIT
 * overlap.h - which pixels of a map each texel of the cube covers, and with what share of its solid angle.
 *
 * Each layout has generators of overlaps. They depend on the shapes alone, so they are found once, and kept in lists
 * (overlap_list.h); a frame only sums. */
#ifndef HELIOSTAT_SRC_OVERLAP_H
#define HELIOSTAT_SRC_OVERLAP_H

#include <heliostat/core.h>

enum { OVERLAP_RUN_LIMIT = 32 };

/* A rectangle of pixels under one texel, at most OVERLAP_RUN_LIMIT of them. A lat-long map is taken in quarters of its
 * width, so that it can be turned by quarters and mirrored without wrapping a run around. */
typedef struct overlap_run {
    uint32_t column; /* of the first pixel, in its quarter */
    uint16_t row;
    uint8_t count;                      /* pixels in a row; each has a weight */
    uint8_t quarter : 2, more_rows : 5; /* rows, not counting the first */
} overlap_run;

/* One face of the cube over one map. */
typedef struct overlap_geometry {
    uint32_t size;                  /* R */
    uint32_t map_width, map_height; /* pixels; of one face of a strip. Lat-long: four divides the width */
    /* Borders between rows of a lat-long map: [map_height + 1], sine of latitude, from 1 down to -1.
     * Borders between pixels of a strip: [map_width + 1], face coordinates, from -1 to 1. */
    double *borders;
    double *cosines;      /* lat-long: [map_height + 1], of the same latitudes */
    double *column_sines; /* lat-long: [map_width / 4 + 1], sine of column k's border's angle, 2 pi k / map_width */
} overlap_geometry;

/* Takes the overlaps of the texels of a row, one after the other. A weight is the part of the texel's solid angle that
 * the pixel covers; a texel's weights sum to 1. */
typedef struct overlap_writer {
    overlap_run *runs; /* NULL: they are only counted */
    float *weights;
    uint32_t *run_ends, *weight_ends;      /* of the texels */
    size_t texel, run_count, weight_count; /* so far */
    size_t texel_run, texel_weight;        /* before this texel */
    overlap_run latest;                    /* the run written last */
    double area;                           /* of this texel so far */
} overlap_writer;

/* Writes the overlaps of the texels first_column ... end_column - 1 of a row. A writer that only counts may get any
 * positive areas. geometry: what the generator needs to know. */
typedef void (*overlap_generator)(const void *geometry, uint32_t row, uint32_t first_column, uint32_t end_column,
                                  overlap_writer *writer);

/* Lat-long maps: the faces +Z and +Y. */
helio_status overlap_latlong_geometry(helio_context *context, uint32_t size, uint32_t width, uint32_t height,
                                      overlap_geometry *geometry);
void overlap_side(const void *geometry, uint32_t row, uint32_t first_column, uint32_t end_column,
                  overlap_writer *writer);
void overlap_pole(const void *geometry, uint32_t row, uint32_t first_column, uint32_t end_column,
                  overlap_writer *writer);

/* A square face of a strip. */
helio_status overlap_strip_geometry(helio_context *context, uint32_t size, uint32_t map_size, bool openexr,
                                    overlap_geometry *geometry);
void overlap_strip(const void *geometry, uint32_t row, uint32_t first_column, uint32_t end_column,
                   overlap_writer *writer);

void overlap_geometry_release(helio_context *context, overlap_geometry *geometry);

/* For generators: the areas, sr, that the texel covers of some neighbours in a row, at most OVERLAP_RUN_LIMIT. begin:
 * the first of them and its place. Pixels with an area of 0 are left out. */
void overlap_write(overlap_writer *writer, overlap_run begin, const double *areas, uint32_t count);
void overlap_end_texel(overlap_writer *writer);

/* Face coordinate of the border before texel `index` of a cube of this size. */
static inline double texel_border(uint32_t index, uint32_t size)
{
    return 2.0 * index / size - 1.0;
}

#endif
