/* SPDX-License-Identifier: MIT */
#include "sampling/tile_colours.h"

#include "core/context.h"
#include "sampling/kernels.h"

#include <string.h>

_Static_assert((int)COLOUR_TILES == (int)TILES_MOST, "a colour for each tile");

enum { LEAST_CELLS = 32 }; /* along an edge of a face, see add_texels() */

typedef struct colour_work {
    tiles *tiles;
    const helio_environment *environment;
    const kernel_set *kernels;
} colour_work;

/* Texels of cubes with few of them are cut into split x split cells. */
typedef struct tile_cells {
    uint32_t split, first_column, count; /* columns of cells */
    float width;
    float u[COLOUR_COLUMNS]; /* [count] */
} tile_cells;

static void lay_columns(const tiles *t, uint32_t column, tile_cells *cells)
{
    cells->split = (LEAST_CELLS + t->size - 1) / t->size;
    cells->first_column = t->starts[column];
    cells->count = (t->starts[column + 1] - t->starts[column]) * cells->split;
    cells->width = 2.0f / (float)(t->size * cells->split);
    for (uint32_t i = 0; i < cells->count; i++)
        cells->u[i] = ((float)(cells->first_column * cells->split + i) + 0.5f) * cells->width - 1.0f;
}

static void clear_columns(uint32_t count, column_colours *sums)
{
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < count; i++)
            sums->along_axis[c][i] = sums->along_right[c][i] = sums->along_down[c][i] = 0.0f;
}

/* As one row; see add_texels() for why. */
static void add_cut_row(const colour_work *work, const tile_cells *cells, texel_rows texels, uint32_t row,
                        column_colours *sums)
{
    float copies[3 * LEAST_CELLS * 2];
    for (uint32_t i = 0; i < cells->count; i++)
        memcpy(copies + 3 * (size_t)i, texels.rgb + 3 * (size_t)(i / cells->split), 3 * sizeof(float));
    texels.rgb = copies;
    texels.rows = 1;
    for (uint32_t i = 0; i < cells->split; i++) {
        texels.v = ((float)(row * cells->split + i) + 0.5f) * cells->width - 1.0f;
        work->kernels->add_texels(&texels, sums);
    }
}

static void add_rows(const colour_work *work, const tile_cells *cells, uint32_t face, uint32_t first, uint32_t end,
                     column_colours *sums)
{
    texel_rows texels = {.stride = (size_t)3 * work->environment->size,
                         .count = cells->count,
                         .columns = cells->u,
                         .width = cells->width};
    for (uint32_t row = first; row < end; row += texels.rows) {
        texels.rgb = environment_texel(work->environment, face, row, cells->first_column);
        texels.rows = cells->split > 1 ? 1 : end - row < TEXEL_ROWS ? end - row : TEXEL_ROWS;
        texels.v = ((float)row + 0.5f) * cells->width - 1.0f;
        if (cells->split > 1)
            add_cut_row(work, cells, texels, row, sums);
        else
            work->kernels->add_texels(&texels, sums);
    }
}

static vec3 sum_columns(const tile_cells *cells, const column_colours *sums, uint32_t face, int c)
{
    const cube_face *f = &cube_faces[face];
    double axis = 0, right = 0, down = 0;
    for (uint32_t i = 0; i < cells->count; i++) {
        axis += (double)sums->along_axis[c][i];
        right += (double)(sums->along_right[c][i] * cells->u[i]);
        down += (double)sums->along_down[c][i];
    }
    return add_scaled(add_scaled(scale(f->axis, (float)axis), f->right, (float)right), f->down, (float)down);
}

static void colour_tile(void *data, size_t index)
{
    const colour_work *work = data;
    tiles *t = work->tiles;
    const uint32_t grid = (uint32_t)index, column = grid % t->per_edge, row = grid / t->per_edge % t->per_edge;
    const uint32_t face = grid / (t->per_edge * t->per_edge), position = t->positions[grid];
    float(*light)[3][TILES_MOST] = t->colours.light;
    column_colours sums;
    tile_cells cells;
    lay_columns(t, column, &cells);
    clear_columns(cells.count, &sums);
    add_rows(work, &cells, face, t->starts[row], t->starts[row + 1], &sums);
    for (int c = 0; c < 3; c++) {
        const vec3 moment = sum_columns(&cells, &sums, face, c);
        light[0][c][position] = moment.x;
        light[1][c][position] = moment.y;
        light[2][c][position] = moment.z;
        light[3][c][position] = dot(moment, (vec3){t->x[position], t->y[position], t->z[position]});
    }
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
    colour_work work = {t, environment, kernels_of(context_isa(t->context))};
    context_parallel_for(t->context, t->count, colour_tile, &work);
    find_hues(t);
}
