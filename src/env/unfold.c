/* SPDX-License-Identifier: MIT
 *
 * The way back from the cube to a map, by the same overlaps: a pixel is the average of the texels over what they cover
 * of it. */
#include "core/context.h"
#include "core/error.h"
#include "env/environment.h"
#include "env/resampler_plan.h"

#include <string.h>

/* Bands of rows are summed at the same time, some at once, so that the sums do not take memory for a whole large map.
 */
enum { BANDS_AT_ONCE = 16, PIXELS_AT_ONCE = 1 << 21 };

/* Weighted sums and the weights' own. */
typedef struct pixel_sum {
    double rgb[3], weight;
} pixel_sum;

typedef struct unfolding {
    const helio_environment *environment;
    const resampler *plan;
    uint32_t first_row, band_rows; /* of the bands summed now */
    pixel_sum *sums;               /* [BANDS_AT_ONCE][band_rows][width] */
    float *rgb;
} unfolding;

/* Rows of the map, some of which have sums. */
typedef struct band_sums {
    const unfolding *work;
    uint32_t first_row, end_row;
    pixel_sum *sums;
} band_sums;

/* A window of a view's, and a texel on its way to the pixels there. */
typedef struct texel_light {
    const quarter_view *view;
    const overlap_window *window;
    float rgb[3];
    double solid_angle;
} texel_light;

/* Adds a row of a part to the pixels under it. column: of the list. */
static void add_row(const band_sums *band, const texel_light *light, const overlap_cursor *at, int64_t row,
                    int64_t column)
{
    const resampler *plan = band->work->plan;
    pixel_sum *sums = band->sums + (size_t)(row - band->first_row) * plan->width;
    column = quarter_view_column(plan, light->view, light->window->quarter, column);
    for (unsigned i = 0; i < at->batch->columns; i++, column += light->view->column_sign) {
        pixel_sum *sum = &sums[column >> plan->part_shift];
        double weight = (double)at->weight[i] * light->solid_angle;
        for (int c = 0; c < 3; c++)
            sum->rgb[c] += weight * (double)light->rgb[c];
        sum->weight += weight;
    }
}

/* Adds what a part has in the band. */
static void add_part(const band_sums *band, const texel_light *light, overlap_cursor *at)
{
    const overlap_window *window = light->window;
    const int64_t first_row = window->row + at->part->pixel / window->pitch;
    const int64_t column = window->column + at->part->pixel % window->pitch;
    for (int64_t i = 0; i < at->batch->rows; i++, at->weight += at->batch->columns) {
        int64_t row = light->view->row_offset + light->view->row_sign * (first_row + i);
        if (row >= band->first_row && row < band->end_row)
            add_row(band, light, at, row, column);
    }
}

static void find_light(const helio_environment *environment, const resampler *plan, uint32_t row, uint32_t column,
                       texel_light *light)
{
    const quarter_view *view = light->view;
    int64_t texel = view->texel + row * view->texel_row_step + column * view->texel_column_step;
    memcpy(light->rgb, environment->cube + texel * 3, sizeof light->rgb);
    light->solid_angle = quarter_view_has_row(plan, view, row) && quarter_view_has_column(plan, view, column)
                             ? (double)environment->solid_angle[(size_t)row * environment->size + column]
                             : 0.0;
}

/* Takes what the texels of a tile have in the band in one of its windows. */
static void add_window(const band_sums *band, const overlap_list *list, const overlap_tile *tile, texel_light *light)
{
    overlap_cursor at = overlap_cursor_at(list, light->window);
    for (uint32_t row = tile->first_row; row < tile->end_row; at.batch++) {
        for (uint32_t i = 0; i < at.batch->count; i++, at.part++) {
            find_light(band->work->environment, band->work->plan, row, tile->first_column + at.part->texel, light);
            add_part(band, light, &at);
        }
        row += at.batch->last;
    }
}

static void add_tile(const band_sums *band, const overlap_list *list, const quarter_view *view,
                     const overlap_tile *tile)
{
    for (uint32_t i = 0; i < tile->window_count; i++)
        add_window(band, list, tile, &(texel_light){.view = view, .window = &list->windows[tile->window + i]});
}

static bool sees_band(const quarter_view *view, const overlap_tile *tile, const band_sums *band)
{
    int64_t a = view->row_offset + view->row_sign * tile->least_map_row;
    int64_t b = view->row_offset + view->row_sign * tile->greatest_map_row;
    return (a < b ? a : b) < band->end_row && (a < b ? b : a) >= band->first_row;
}

static void write_averages(const band_sums *band)
{
    size_t width = band->work->plan->width, count = (band->end_row - band->first_row) * width;
    float *rgb = band->work->rgb + band->first_row * width * 3;
    for (size_t i = 0; i < count; i++) {
        const pixel_sum *sum = &band->sums[i];
        for (int c = 0; c < 3; c++)
            rgb[i * 3 + (size_t)c] = sum->weight > 0.0 ? (float)(sum->rgb[c] / sum->weight) : 0.0f;
    }
}

static void unfold_band(void *data, size_t index)
{
    const unfolding *work = data;
    const resampler *plan = work->plan;
    band_sums band = {.work = work, .first_row = work->first_row + (uint32_t)index * work->band_rows};
    if (band.first_row >= plan->height)
        return;
    band.end_row = plan->height - band.first_row < work->band_rows ? plan->height : band.first_row + work->band_rows;
    band.sums = work->sums + index * work->band_rows * plan->width;
    size_t pixels = (size_t)(band.end_row - band.first_row) * plan->width;
    for (size_t i = 0; i < pixels; i++)
        band.sums[i] = (pixel_sum){{0}, 0};
    for (int g = 0; g < plan->group_count; g++) {
        const view_group *group = &plan->groups[g];
        for (int v = 0; v < GROUP_VIEWS; v++)
            for (size_t t = 0; t < group->list->tile_count; t++)
                if (sees_band(&group->views[v], &group->list->tiles[t], &band))
                    add_tile(&band, group->list, &group->views[v], &group->list->tiles[t]);
    }
    write_averages(&band);
}

static helio_status unfold(unfolding *work)
{
    const resampler *plan = work->plan;
    helio_context *context = work->environment->context;
    uint32_t rows = PIXELS_AT_ONCE / BANDS_AT_ONCE / plan->width, even = (plan->height - 1) / BANDS_AT_ONCE + 1;
    work->band_rows = rows == 0 ? 1 : rows < even ? rows : even;
    work->sums = context_allocate(context, (size_t)BANDS_AT_ONCE * work->band_rows * plan->width, sizeof *work->sums);
    if (work->sums == NULL)
        return HELIO_ERR_MEMORY;
    for (; work->first_row < plan->height; work->first_row += BANDS_AT_ONCE * work->band_rows)
        context_parallel_for(context, BANDS_AT_ONCE, unfold_band, work);
    context_release(context, work->sums);
    return HELIO_OK;
}

helio_status helio_environment_unfold(const helio_environment *environment, helio_layout layout, uint32_t width,
                                      uint32_t height, float *rgb)
{
    if (environment == NULL || rgb == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_environment_unfold needs an environment and a place for the map");
    HELIO_TRY(environment_resolve_map(width, height, &layout));
    environment_settle(environment);
    resampler *plan;
    helio_status status = resampler_create(environment->context, layout, width, height, environment->size, &plan);
    if (status == HELIO_OK) {
        status = unfold(&(unfolding){.environment = environment, .plan = plan, .rgb = rgb});
        resampler_destroy(environment->context, plan);
    }
    return status == HELIO_ERR_MEMORY
               ? fail(HELIO_ERR_MEMORY, "no memory to unfold the cube to a %s map of %ux%u pixels",
                      helio_layout_name(layout), width, height)
               : status;
}
