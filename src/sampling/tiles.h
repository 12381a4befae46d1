/* SPDX-License-Identifier: MIT
 * tiles.h - squares of texels, and their light as integers: coarse enough to be weighed for hundreds of pools in every
 * frame, with the tables' texels inside.
 *
 * A face has T x T tiles, T = min(16, R), with borders after floor(k R / T) rows and columns. All tiles are in one
 * order, along a Hilbert curve over each face, so that neighbours in the order are neighbours on the sphere: strata of
 * samples are then compact. */
#ifndef HELIOSTAT_SRC_TILES_H
#define HELIOSTAT_SRC_TILES_H

#include "sampling/tables.h"
#include "sampling/tile_colours.h"
#include "sampling/tile_groups.h"

#include <stdalign.h>

enum {
    TILES_PER_EDGE = 16,
    TILES_MOST = CUBE_FACES * TILES_PER_EDGE * TILES_PER_EDGE,
};

typedef struct tiles {
    helio_context *context;
    uint32_t size;                       /* R */
    uint32_t per_edge;                   /* T */
    uint32_t count;                      /* 6 T^2 */
    uint32_t stride;                     /* 1 + most rows of a tile */
    float radius;                        /* largest angle between the centre of a tile and a direction in it */
    float edge;                          /* its sine, rounded up */
    uint32_t starts[TILES_PER_EDGE + 1]; /* first row, or column, of the tiles of an edge; R at the end */
    uint8_t *of_line;                    /* [R]: which of the T tiles holds a row, or column */
    uint16_t positions[TILES_MOST];      /* [6][T][T]: in the order */
    uint16_t grid[TILES_MOST];           /* [count]: (face x T + row) x T + column of the tile at a position */
    alignas(64) float x[TILES_MOST];     /* [count]: direction to the centre of the tile at a position */
    alignas(64) float y[TILES_MOST];
    alignas(64) float z[TILES_MOST];
    alignas(64) float angle[TILES_MOST];  /* [count]: solid angle of each, sr */
    alignas(64) float light[TILES_MOST];  /* [count]: the tables' weight, in proportion; 2^-60 to 1, or 0 */
    row_sum totals[TILES_MOST];           /* [count]: the same exactly */
    alignas(64) float spread[TILES_MOST]; /* [count]: angle that the light of a tile takes: its radius, or the part of
                                             it that even light would need; small where there is a sun */
    alignas(64) float peak[TILES_MOST];   /* [count]: mean of the light per sr, each part by the light itself, supposed
                                             that it is spread across the tile as it is along it */
    tile_colours colours;
    tile_groups groups;
    uint32_t *sums;           /* [count][stride]: prefix sums over the rows of a tile */
    float *segment_densities; /* [6][R][T]: what a unit of weight in this row of a tile adds to the density given the
                                 tile, as row_densities of the tables do */
} tiles;

/* A sample: one of a tile's list. */
typedef struct tile_draw {
    uint32_t element;  /* in all lists */
    uint32_t position; /* of the tile */
} tile_draw;

helio_status tiles_create(helio_context *context, uint32_t size, tiles **out);
void tiles_destroy(tiles *t);

/* Sums up the tables' current weights. No memory is taken. */
void tiles_update(tiles *t, const helio_tables *tables);

/* The sine of an angle below 90 degrees, rounded up to a 256th, so that it is the same with every libm; 2 for larger
 * angles. */
float tiles_sine(float angle);

/* of_line[], in a form for registers: the quotient is at least 1/2 of 1/R from whole numbers, far more than what
 * rounding does. per_texel: 1 / R. */
static inline uint32_t tiles_of_line(uint32_t per_edge, float per_texel, uint32_t line)
{
    return (uint32_t)(int32_t)(((float)(int32_t)((line + 1) * per_edge) - 0.5f) * per_texel);
}

/* Where the tile that holds a texel comes in the order. */
static inline uint32_t tiles_position(const tiles *t, uint32_t face, uint32_t row, uint32_t column)
{
    return t->positions[(face * t->per_edge + t->of_line[row]) * t->per_edge + t->of_line[column]];
}

/* The part of a row that is in one tile, among all. line: the row, counted through all faces. */
static inline uint32_t tiles_segment(const tiles *t, uint32_t line, uint32_t column)
{
    return line * t->per_edge + t->of_line[column];
}

/* face_place_density()'s unit for the density given the tile: the probabilities of its row in the tile and of its texel
 * in that part of the row, from the stored integers. */
static inline float tiles_unit_density(const tiles *t, const face_place *at)
{
    return t->segment_densities[tiles_segment(t, at->face * t->size + at->row, at->column)];
}

#endif
