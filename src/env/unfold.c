/* SPDX-License-Identifier: MIT
 *
 * The way back from the cube to a map, by the same overlaps: a pixel is the average of the texels over what they cover
 * of it. */
#include "core/context.h"
#include "core/error.h"
#include "env/environment.h"
#include "env/resampler_plan.h"

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

/* Adds a row of a run to the pixels under it. */
static void add_row(const band_sums *band, const quarter_view *view, const overlap_run *run, int64_t row,
                    const float *weights, const float *rgb, double solid_angle)
{
    const resampler *plan = band->work->plan;
    int64_t column = quarter_view_column(plan, view, run->quarter, run->column);
    pixel_sum *sums = band->sums + (size_t)(row - band->first_row) * plan->width;
    for (unsigned i = 0; i < run->count; i++, column += view->column_sign) {
        pixel_sum *sum = &sums[column >> plan->part_shift];
        double weight = (double)weights[i] * solid_angle;
        for (int c = 0; c < 3; c++)
            sum->rgb[c] += weight * (double)rgb[c];
        sum->weight += weight;
    }
}

/* Takes what a texel has in the band. Returns where the texel's overlaps end. */
static overlap_cursor add_texel(const band_sums *band, const quarter_view *view, overlap_cursor at, const float *rgb,
                                double solid_angle)
{
    for (bool last = false; !last; at.run++) {
        last = at.run->last;
        for (int64_t i = 0; i <= at.run->more_rows; i++, at.weight += at.run->count) {
            int64_t row = view->row_offset + view->row_sign * (at.run->row + i);
            if (row >= band->first_row && row < band->end_row)
                add_row(band, view, at.run, row, at.weight, rgb, solid_angle);
        }
    }
    return at;
}

/* Of a face with an odd number of rows or columns the middle ones are in two views: one of them does. */
static bool is_in_other_view(uint32_t size, const quarter_view *view, uint32_t row, uint32_t column)
{
    return (view->texel_row_step < 0 && 2 * row + 1 == size) || (view->texel_column_step < 0 && 2 * column + 1 == size);
}

static void add_tile(const band_sums *band, const view_group *group, const quarter_view *view, const overlap_tile *tile)
{
    const helio_environment *environment = band->work->environment;
    overlap_cursor at = {group->list->runs + tile->run, group->list->weights + tile->weight};
    for (uint32_t row = tile->first_row; row < tile->end_row; row++)
        for (uint32_t column = tile->first_column; column < tile->end_column; column++) {
            int64_t texel = view->texel + row * view->texel_row_step + column * view->texel_column_step;
            double solid_angle = is_in_other_view(environment->size, view, row, column)
                                     ? 0.0
                                     : (double)environment->solid_angle[(size_t)row * environment->size + column];
            at = add_texel(band, view, at, environment->cube + texel * 3, solid_angle);
        }
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
                    add_tile(&band, group, &group->views[v], &group->list->tiles[t]);
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
