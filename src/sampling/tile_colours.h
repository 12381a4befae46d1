/* SPDX-License-Identifier: MIT
 * tile_colours.h - the light of tiles by colour and direction, which tables by luminance do not know: integrals over
 * the texels, found anew in each frame. */
#ifndef HELIOSTAT_SRC_TILE_COLOURS_H
#define HELIOSTAT_SRC_TILE_COLOURS_H

#include "env/environment.h"

#include <stdalign.h>

struct tiles;

enum {
    COLOUR_TILES = 1536,  /* at most: TILES_MOST */
    COLOUR_COLUMNS = 256, /* texels of a row that are summed together, at most: a tile has no more */
    TEXEL_ROWS = 4,       /* rows that are summed together */
};

/* [count of tiles] each, by colour. */
typedef struct tile_colours {
    /* Integrals of radiance x direction (x, y, z) and of radiance x cosine to the tile's centre. */
    alignas(64) float light[4][3][COLOUR_TILES];
    alignas(64) float hue[3][COLOUR_TILES];     /* the last of these in relation to its luminance ... */
    alignas(64) float brightness[COLOUR_TILES]; /* ... and that luminance; never 0 */
    float per_light;                            /* brightness of all tiles in relation to tiles.light of all */
} tile_colours;

/* Texels of a row of tiles, or of a part of it, or the cells that they are cut into: places that all faces have. */
typedef struct texel_rows {
    uint32_t rows, count; /* at most TEXEL_ROWS, COLOUR_COLUMNS */
    const float *columns; /* [count]: u of the columns' centres */
    float v, width;       /* of the first row's centre; of a row or column */
} texel_rows;

/* The integrals of direction over such texels, along the face's axis and along its right without the factor u, and the
 * v of each row, by which the latter goes along its down. Each number stands for red, green and blue. */
typedef struct texel_moments {
    alignas(64) float along_axis[TEXEL_ROWS][3 * COLOUR_COLUMNS];
    alignas(64) float along_right[TEXEL_ROWS][3 * COLOUR_COLUMNS];
    float v[TEXEL_ROWS];
} texel_moments;

/* Sums of radiance x these over the texels of each column, by colour: [count][3], and what a register reads past them.
 */
typedef struct column_colours {
    alignas(64) float along_axis[3 * COLOUR_COLUMNS + 1];
    alignas(64) float along_right[3 * COLOUR_COLUMNS + 1];
    alignas(64) float along_down[3 * COLOUR_COLUMNS + 1];
} column_colours;

/* The same over columns, with the factor u: red, green, blue and nothing, so that they are a register. */
typedef struct colour_sums {
    double along_axis[4], along_right[4], along_down[4];
} colour_sums;

/* Finds the colours of the frame; t->light must be there. */
void tile_colours_update(struct tiles *t, const helio_environment *environment);

#endif
