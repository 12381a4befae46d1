/* SPDX-License-Identifier: MIT
 *
 * A frame: sums of weighted pixels, in an order that depends on the plan alone. */
#include "core/context.h"
#include "env/resampler_plan.h"
#include "image/pixel_fault.h"

#include <string.h>

enum { MAP_QUARTERS = 4 };

typedef struct resampling {
    const resampler *plan;
    const float *map;
    float *cube;
    ptrdiff_t row_step; /* floats from one row of the map to the next */
    /* The pixel where a view finds row 0 of the runs and column 0 of a quarter. */
    const float *origins[MAX_GROUPS][MAP_QUARTERS][GROUP_VIEWS];
} resampling;

/* Red, green, blue and a number that nobody looks at: a vector register on every machine, and the same arithmetic. */
typedef float rgbx __attribute__((vector_size(16)));

/* Sums of this many weighted pixels stay in floats. */
enum { FLOAT_SUM_LIMIT = 64 };

typedef struct view_sums {
    rgbx a, b, c, d;
} view_sums;

/* A place in a list. */
typedef struct overlap_cursor {
    const overlap_run *run;
    const float *weight;
} overlap_cursor;

/* Also reads the number behind the pixel. clamp: negative numbers become 0. */
static inline rgbx load(const float *pixel, bool clamp)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    rgbx loaded;
    memcpy(&loaded, pixel, sizeof loaded);
    return clamp ? (rgbx)((mask)loaded & (mask)(loaded > (rgbx){0})) : loaded;
}

/* Where the first two views find the first pixel of a run, from their origins on; the others find it backwards. */
static inline ptrdiff_t find_offset(const overlap_run *run, ptrdiff_t row_step, ptrdiff_t column_step)
{
    return row_step * run->row + column_step * run->column;
}

/* The views are spelled out so that their sums stay in registers. What a later run needs is fetched ahead: no machine
 * guesses it, as each row of the map is read for a few texels only. (At a change of quarters or tiles that is of no
 * use, and does no harm.) */
static inline void add_run(const float *const origins[GROUP_VIEWS], ptrdiff_t row_step, ptrdiff_t column_step,
                           const overlap_cursor *at, bool clamp, view_sums *sums)
{
    const float *weight = at->weight, *end = weight + at->run->count;
    const float *a = origins[0], *b = origins[1], *c = origins[2], *d = origins[3];
    ptrdiff_t ahead = find_offset(at->run + OVERLAP_AHEAD, row_step, column_step);
    __builtin_prefetch(a + ahead);
    __builtin_prefetch(b + ahead);
    __builtin_prefetch(c - ahead);
    __builtin_prefetch(d - ahead);
    for (ptrdiff_t i = find_offset(at->run, row_step, column_step); weight < end; weight++, i += column_step) {
        rgbx w = {*weight, *weight, *weight, *weight};
        sums->a += load(a + i, clamp) * w;
        sums->b += load(b + i, clamp) * w;
        sums->c += load(c - i, clamp) * w;
        sums->d += load(d - i, clamp) * w;
    }
}

static int64_t find_column(const resampler *plan, const quarter_view *view, int64_t quarter, int64_t column)
{
    int64_t width = (int64_t)plan->width << plan->part_shift;
    int64_t found = view->column_offset + view->column_sign * (quarter * (width / MAP_QUARTERS) + column);
    return (found + 2 * width) % width;
}

/* The same, but pixel by pixel. */
static rgbx sum_by_pixel(const resampling *work, const quarter_view *view, const overlap_cursor *at, rgbx sum)
{
    const resampler *plan = work->plan;
    const overlap_run *run = at->run;
    const float *row = work->map + (view->row_offset + view->row_sign * run->row) * plan->width * 3;
    int64_t column = find_column(plan, view, run->quarter, run->column);
    for (unsigned i = 0; i < run->count; i++, column += view->column_sign) {
        float rgb[3], weight = at->weight[i];
        pixel_clean(row + (column >> plan->part_shift) * 3, rgb);
        sum += (rgbx){rgb[0], rgb[1], rgb[2], 0} * (rgbx){weight, weight, weight, weight};
    }
    return sum;
}

static __attribute__((noinline)) view_sums add_run_by_pixel(const resampling *work, const view_group *group,
                                                            overlap_cursor at, view_sums sums)
{
    return (view_sums){
        sum_by_pixel(work, &group->views[0], &at, sums.a),
        sum_by_pixel(work, &group->views[1], &at, sums.b),
        sum_by_pixel(work, &group->views[2], &at, sums.c),
        sum_by_pixel(work, &group->views[3], &at, sums.d),
    };
}

/* Sums the pixels of a texel in all views, or as many as may be summed in floats. Returns whether that was all. */
static inline bool sum_runs(const resampling *work, const view_group *group, overlap_cursor *at, view_sums *sums)
{
    const float *const(*origins)[GROUP_VIEWS] = work->origins[group - work->plan->groups];
    const float *limit = at->weight + FLOAT_SUM_LIMIT;
    do {
        const overlap_run *run = at->run;
        uint8_t reading = group->readings[run->row];
        if (reading == ROW_AS_IT_IS)
            add_run(origins[run->quarter], work->row_step, 3 * group->column_sign, at, false, sums);
        else if (reading == ROW_CLAMPED)
            add_run(origins[run->quarter], work->row_step, 3 * group->column_sign, at, true, sums);
        else
            *sums = add_run_by_pixel(work, group, *at, *sums);
        at->weight += run->count;
        at->run++;
        if (run->last)
            return true;
    } while (at->weight < limit);
    return false;
}

/* The rest of a texel that has many pixels. */
static __attribute__((noinline)) view_sums sum_more(const resampling *work, const view_group *group, overlap_cursor *at,
                                                    view_sums sums)
{
    typedef double wide __attribute__((vector_size(32)));
    wide a = {0}, b = {0}, c = {0}, d = {0};
    for (bool all = false;;) {
        a += __builtin_convertvector(sums.a, wide);
        b += __builtin_convertvector(sums.b, wide);
        c += __builtin_convertvector(sums.c, wide);
        d += __builtin_convertvector(sums.d, wide);
        if (all)
            break;
        sums = (view_sums){{0}, {0}, {0}, {0}};
        all = sum_runs(work, group, at, &sums);
    }
    return (view_sums){__builtin_convertvector(a, rgbx), __builtin_convertvector(b, rgbx),
                       __builtin_convertvector(c, rgbx), __builtin_convertvector(d, rgbx)};
}

/* Where a view's texels go: a place in the cube, and the step to the next column. */
typedef struct texel_place {
    float *rgb;
    ptrdiff_t step;
} texel_place;

static texel_place find_texel(const resampling *work, const quarter_view *view, int64_t row, int64_t column)
{
    int64_t texel = view->texel + row * view->texel_row_step + column * view->texel_column_step;
    return (texel_place){work->cube + texel * 3, view->texel_column_step * 3};
}

static inline void store(texel_place *place, rgbx sum)
{
    memcpy(place->rgb, &sum, 3 * sizeof(float));
    place->rgb += place->step;
}

/* A tile of a list in four views. Of a face with an odd number of rows or columns the middle ones are in two views each
 * and written twice: by the same thread, always in the same order. */
static void resample_views(const resampling *work, const view_group *group, const overlap_tile *tile)
{
    overlap_cursor at = {group->list->runs + tile->run, group->list->weights + tile->weight};
    for (uint32_t row = tile->first_row; row < tile->end_row; row++) {
        texel_place a = find_texel(work, &group->views[0], row, tile->first_column);
        texel_place b = find_texel(work, &group->views[1], row, tile->first_column);
        texel_place c = find_texel(work, &group->views[2], row, tile->first_column);
        texel_place d = find_texel(work, &group->views[3], row, tile->first_column);
        for (uint32_t column = tile->first_column; column < tile->end_column; column++) {
            view_sums sums = {{0}, {0}, {0}, {0}};
            if (!sum_runs(work, group, &at, &sums))
                sums = sum_more(work, group, &at, sums);
            store(&a, sums.a);
            store(&b, sums.b);
            store(&c, sums.c);
            store(&d, sums.d);
        }
    }
}

static void resample_tile(void *data, size_t index)
{
    const resampling *work = data;
    const resampler *plan = work->plan;
    const overlap_list *list = &plan->lists[index % (size_t)plan->list_count];
    const overlap_tile *tile = &list->tiles[index / (size_t)plan->list_count];
    for (int i = 0; i < plan->group_count; i++)
        if (plan->groups[i].list == list)
            resample_views(work, &plan->groups[i], tile);
}

static void prepare_group(resampling *work, int index, const uint8_t *readings)
{
    const resampler *plan = work->plan;
    const view_group *group = &plan->groups[index];
    for (uint32_t row = 0; row < plan->list_rows; row++) {
        uint8_t reading = plan->part_shift != 0 ? ROW_BY_PIXEL : ROW_AS_IT_IS;
        for (int v = 0; v < GROUP_VIEWS; v++) {
            uint8_t own = readings[group->views[v].row_offset + group->views[v].row_sign * row];
            reading = own > reading ? own : reading;
        }
        group->readings[row] = reading;
    }
    for (int i = 0; i < MAP_QUARTERS * GROUP_VIEWS; i++) {
        const quarter_view *view = &group->views[i % GROUP_VIEWS];
        int64_t column = find_column(plan, view, i / GROUP_VIEWS, 0) >> plan->part_shift;
        work->origins[index][i / GROUP_VIEWS][i % GROUP_VIEWS] =
            work->map + (view->row_offset * plan->width + column) * 3;
    }
}

void resampler_run(helio_context *context, const resampler *plan, const float *map, const uint8_t *readings,
                   float *cube)
{
    resampling work = {.plan = plan, .map = map, .cube = cube, .row_step = 3 * (ptrdiff_t)plan->width};
    for (int i = 0; i < plan->group_count; i++)
        prepare_group(&work, i, readings);
    context_parallel_for(context, (size_t)plan->list_count * plan->lists[0].tile_count, resample_tile, &work);
}
