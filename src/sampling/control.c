/* SPDX-License-Identifier: MIT */
#include "sampling/control.h"

#include "core/context.h"
#include "sampling/kernels.h"

#include <string.h>

enum { LEAST_CELLS = 32 }; /* along an edge of a face, see add_texels() */

helio_status control_create(helio_context *context, const normal_bins *bins, light_control **out)
{
    light_control *c = context_allocate(context, 1, sizeof *c);
    if (c == NULL)
        return HELIO_ERR_MEMORY;
    c->context = context;
    c->bins = bins->count;
    c->chunks = bins->pool_length / CONTROL_CHUNK;
    c->known = context_allocate(context, c->bins, sizeof *c->known);
    c->sums = context_allocate(context, c->bins, (c->chunks + (size_t)1) * sizeof *c->sums);
    if (c->known == NULL || c->sums == NULL) {
        control_destroy(c);
        return HELIO_ERR_MEMORY;
    }
    *out = c;
    return HELIO_OK;
}

void control_destroy(light_control *c)
{
    if (c == NULL)
        return;
    context_release(c->context, c->sums);
    context_release(c->context, c->known);
    context_release(c->context, c);
}

/* ---- light of the tiles ---- */

typedef struct control_work {
    light_control *control;
    const normal_bins *bins;
    const helio_environment *environment;
    const kernel_set *kernels;
} control_work;

/* Texels of cubes with few of them are cut into split x split cells. */
typedef struct tile_cells {
    uint32_t split, first_column, count; /* columns of cells */
    float width;
    float u[CONTROL_COLUMNS]; /* [count] */
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

/* As one row; see add_texels() for why. */
static void add_cut_row(const control_work *work, const tile_cells *cells, texel_rows texels, uint32_t row,
                        control_columns *sums)
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

static void add_rows(const control_work *work, const tile_cells *cells, uint32_t face, uint32_t first, uint32_t end,
                     control_columns *sums)
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

static vec3 sum_columns(const tile_cells *cells, const control_columns *sums, uint32_t face, int c)
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

static void light_tile(void *data, size_t index)
{
    const control_work *work = data;
    const tiles *t = work->bins->tiles;
    const uint32_t grid = (uint32_t)index, column = grid % t->per_edge, row = grid / t->per_edge % t->per_edge;
    const uint32_t face = grid / (t->per_edge * t->per_edge), position = t->positions[grid];
    float(*light)[TILES_MOST] = work->control->light.of;
    control_columns sums;
    tile_cells cells;
    lay_columns(t, column, &cells);
    for (int c = 0; c < 3; c++) {
        memset(sums.along_axis[c], 0, cells.count * sizeof(float));
        memset(sums.along_right[c], 0, cells.count * sizeof(float));
        memset(sums.along_down[c], 0, cells.count * sizeof(float));
    }
    add_rows(work, &cells, face, t->starts[row], t->starts[row + 1], &sums);
    for (int c = 0; c < 3; c++) {
        const vec3 moment = sum_columns(&cells, &sums, face, c);
        light[c][position] = moment.x;
        light[3 + c][position] = moment.y;
        light[6 + c][position] = moment.z;
        light[9 + c][position] = dot(moment, (vec3){t->x[position], t->y[position], t->z[position]});
    }
}

/* ---- light of the bins ---- */

static void know_bin(void *data, size_t bin)
{
    const control_work *work = data;
    light_control *c = work->control;
    work->kernels->know_bin(work->bins->tiles, &c->light, &work->bins->bins[bin], &c->known[bin]);
}

void control_update(light_control *c, const normal_bins *bins, const helio_environment *environment)
{
    control_work work = {c, bins, environment, kernels_of(context_isa(c->context))};
    context_parallel_for(c->context, bins->tiles->count, light_tile, &work);
    context_parallel_for(c->context, bins->count, know_bin, &work);
}

/* ---- samples ---- */

static void sum_pool(void *data, size_t bin)
{
    const light_control *c = data;
    control_matrix *sums = c->sums + bin * (c->chunks + 1);
    for (uint32_t chunk = 0; chunk < c->chunks; chunk++)
        for (int row = 0; row < 4; row++)
            for (int i = 0; i < 4; i++)
                sums[chunk + 1].rows[row][i] += sums[chunk].rows[row][i];
}

void control_sum_pools(light_control *c)
{
    context_parallel_for(c->context, c->bins, sum_pool, c);
}

/* Sums of light next to the greatest of floats are infinite, and say nothing. */
static float finite_or_nothing(float x)
{
    return x - x == 0.0f ? x : 0.0f;
}

vec3 control_difference(const light_control *c, uint32_t bin, uint32_t first, uint32_t count, vec3 normal)
{
    const uint32_t chunks = count / CONTROL_CHUNK;
    if (chunks == 0)
        return (vec3){0, 0, 0};
    const control_matrix *start = c->sums + (size_t)bin * (c->chunks + 1) + first / CONTROL_CHUNK,
                         *end = start + chunks;
    const control_matrix *known = &c->known[bin];
    const float factor = 1.0f / (float)(chunks * CONTROL_CHUNK), n[4] = {normal.x, normal.y, normal.z, 1.0f};
    float sum[4] = {0};
    for (int row = 0; row < 4; row++)
        for (int i = 0; i < 4; i++)
            sum[i] += n[row] * (known->rows[row][i] - factor * (end->rows[row][i] - start->rows[row][i]));
    return (vec3){finite_or_nothing(sum[0]), finite_or_nothing(sum[1]), finite_or_nothing(sum[2])};
}
