/* SPDX-License-Identifier: MIT */
#include "sampling/tile_colours.h"

#include "core/context.h"
#include "sampling/kernels.h"

#include <string.h>

_Static_assert((int)COLOUR_TILES == (int)TILES_MOST, "a colour for each tile");

enum {
    LEAST_CELLS = 32, /* along an edge of a face, see find_moments() */
    BAND_COLUMNS =
        256 /* texels of a row of a band, unless a tile has more: sums and moments stay in the nearest cache */
};

typedef struct colour_work {
    tiles *tiles;
    const helio_environment *environment;
    const kernel_set *kernels;
    uint32_t bands, tiles_of_band; /* in a row of tiles; side by side */
} colour_work;

/* Tiles side by side in a row of tiles, of every face: what directions are integrated to is the same on all of them.
 * Texels of cubes with few of them are cut into split x split cells. */
typedef struct tile_band {
    uint32_t row, first, end;                     /* of tiles: the row, the columns */
    uint32_t first_column, columns, split, count; /* of texels; and columns of cells */
    float width;                                  /* of a cell */
    float u[COLOUR_COLUMNS];                      /* [count] */
    column_colours sums[CUBE_FACES];
} tile_band;

static void lay_band(const colour_work *work, uint32_t index, tile_band *band)
{
    const tiles *t = work->tiles;
    band->row = index / work->bands;
    band->first = index % work->bands * work->tiles_of_band;
    band->end = band->first + work->tiles_of_band < t->per_edge ? band->first + work->tiles_of_band : t->per_edge;
    band->first_column = t->starts[band->first];
    band->columns = t->starts[band->end] - band->first_column;
    band->split = (LEAST_CELLS + t->size - 1) / t->size;
    band->count = band->columns * band->split;
    band->width = 2.0f / (float)(t->size * band->split);
    for (uint32_t i = 0; i < band->count; i++)
        band->u[i] = ((float)(band->first_column * band->split + i) + 0.5f) * band->width - 1.0f;
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        for (uint32_t i = 0; i <= 3 * band->count; i++)
            band->sums[face].along_axis[i] = band->sums[face].along_right[i] = band->sums[face].along_down[i] = 0.0f;
}

/* The texels of a row of a face, each as often as it is cut. */
static void cut_texels(const tile_band *band, const float *rgb, float *copies)
{
    for (uint32_t i = 0; i < band->count; i++)
        memcpy(copies + 3 * (size_t)i, rgb + 3 * (size_t)(i / band->split), 3 * sizeof(float));
}

/* rows: of cells, of one row of texels where these are cut. */
static void add_rows_of_band(const colour_work *work, uint32_t row, uint32_t rows, tile_band *band)
{
    const texel_rows texels = {.rows = rows,
                               .count = band->count,
                               .columns = band->u,
                               .v = ((float)row + 0.5f) * band->width - 1.0f,
                               .width = band->width};
    texel_moments moments;
    float copies[3 * COLOUR_COLUMNS];
    work->kernels->find_moments(&texels, &moments);
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        const float *rgb = environment_texel(work->environment, face, row / band->split, band->first_column);
        if (band->split > 1)
            cut_texels(band, rgb, copies);
        work->kernels->add_texels(&texels, band->split > 1 ? copies : rgb, (size_t)3 * work->environment->size,
                                  &moments, &band->sums[face]);
    }
}

static vec3 moment_of(const colour_sums *sums, const cube_face *face, int c)
{
    const vec3 along_axis = scale(face->axis, (float)sums->along_axis[c]);
    return add_scaled(add_scaled(along_axis, face->right, (float)sums->along_right[c]), face->down,
                      (float)sums->along_down[c]);
}

static void colour_tile(const colour_work *work, const tile_band *band, uint32_t face, uint32_t column)
{
    tiles *t = work->tiles;
    const uint32_t position = t->positions[(face * t->per_edge + band->row) * t->per_edge + column];
    const uint32_t first = (t->starts[column] - band->first_column) * band->split;
    const uint32_t end = (t->starts[column + 1] - band->first_column) * band->split;
    const colour_sums sums = work->kernels->sum_columns(&band->sums[face], band->u, first, end);
    float(*light)[3][TILES_MOST] = t->colours.light;
    for (int c = 0; c < 3; c++) {
        const vec3 moment = moment_of(&sums, &cube_faces[face], c);
        light[0][c][position] = moment.x;
        light[1][c][position] = moment.y;
        light[2][c][position] = moment.z;
        light[3][c][position] = dot(moment, (vec3){t->x[position], t->y[position], t->z[position]});
    }
}

static void colour_band(void *data, size_t index)
{
    const colour_work *work = data;
    const tiles *t = work->tiles;
    tile_band band;
    lay_band(work, (uint32_t)index, &band);
    const uint32_t end = t->starts[band.row + 1] * band.split, most = band.split > 1 ? 1 : TEXEL_ROWS;
    for (uint32_t row = t->starts[band.row] * band.split; row < end; row += most)
        add_rows_of_band(work, row, end - row < most ? end - row : most, &band);
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        for (uint32_t column = band.first; column < band.end; column++)
            colour_tile(work, &band, face, column);
}

static void find_hues(tiles *t)
{
    tile_colours *colours = &t->colours;
    double brightness = 0.0, light = 0.0;
    for (uint32_t i = 0; i < t->count; i++) {
        const float rgb[3] = {colours->light[3][0][i], colours->light[3][1][i], colours->light[3][2][i]};
        const float value = luminance(rgb);
        colours->brightness[i] = value > 0.0f ? value : 1.0f;
        for (int c = 0; c < 3; c++)
            colours->hue[c][i] = rgb[c] / colours->brightness[i];
        brightness += (double)value;
        light += (double)t->light[i];
    }
    colours->per_light = light > 0.0 ? (float)(brightness / light) : 0.0f;
}

void tile_colours_update(struct tiles *t, const helio_environment *environment)
{
    colour_work work = {.tiles = t, .environment = environment, .kernels = kernels_of(context_isa(t->context))};
    const uint32_t widest = (t->size + t->per_edge - 1) / t->per_edge;
    work.tiles_of_band = widest < BAND_COLUMNS ? BAND_COLUMNS / widest : 1;
    work.bands = (t->per_edge + work.tiles_of_band - 1) / work.tiles_of_band;
    context_parallel_for(t->context, (size_t)t->per_edge * work.bands, colour_band, &work);
    find_hues(t);
}
