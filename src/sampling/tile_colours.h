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

/* Sums over the texels of a column in some rows, by colour: of radiance x the integral of direction along the face's
 * axis, along its right without the factor u, and along its down. */
typedef struct column_colours {
    float along_axis[3][COLOUR_COLUMNS], along_right[3][COLOUR_COLUMNS], along_down[3][COLOUR_COLUMNS];
} column_colours;

/* Texels of a tile, or the cells that they are cut into. */
typedef struct texel_rows {
    const float *rgb; /* [rows][count][3], rows `stride` floats apart */
    size_t stride;
    uint32_t rows, count; /* at most TEXEL_ROWS, COLOUR_COLUMNS */
    const float *columns; /* [count]: u of the columns' centres */
    float v, width;       /* of the first row's centre; of a row or column */
} texel_rows;

/* Finds the colours of the frame; t->light must be there. */
void tile_colours_update(struct tiles *t, const helio_environment *environment);

#endif
