/* SPDX-License-Identifier: MIT
 *
 * A frame: sums of weighted pixels, in an order that depends on the plan alone. */
#include "env/resampling.h"
#include "image/pixel_fault.h"
#include "sampling/kernels.h"

#include <string.h>

/* Red, green, blue and a number that nobody looks at: a vector register on every machine, and the same arithmetic. */
typedef float rgbx __attribute__((vector_size(16)));
typedef uint32_t rgbx_bits __attribute__((vector_size(16)));

/* Sums of this many weighted pixels stay in floats. */
enum { FLOAT_SUM_LIMIT = 64 };

typedef struct view_sums {
    rgbx a, b, c, d;
} view_sums;

/* How pixels are read: known to the compiler, which makes loops for each. */
typedef struct reading {
    bool half, clamp;
    bool careful;         /* some rows are to be read pixel by pixel */
    uint32_t pixel_bytes; /* 0: not known to the compiler */
} reading;

/* ---- pixels ---- */

/* Also reads the number behind the pixel. Numbers are finite; without clamp not negative, but -0 may come either way.
 */
static inline rgbx load(const unsigned char *pixel, reading how)
{
    if (!how.half) {
        rgbx loaded;
        memcpy(&loaded, pixel, sizeof loaded);
        return how.clamp ? (rgbx)((rgbx_bits)loaded & (rgbx_bits)(loaded > (rgbx){0})) : loaded;
    }
    typedef uint16_t halves __attribute__((vector_size(8)));
    halves numbers;
    memcpy(&numbers, pixel, sizeof numbers);
    const rgbx_bits wide = __builtin_convertvector(numbers, rgbx_bits);
    const rgbx_bits least_normal = (rgbx_bits){113, 113, 113, 113} << 23,
                    rebias = (rgbx_bits){112, 112, 112, 112} << 23;
    rgbx_bits bits = (wide & 0x7fff) << 13, small = (rgbx_bits)((wide & 0x7c00) == 0);
    rgbx normal = (rgbx)(bits + rebias), subnormal = (rgbx)(bits + least_normal) - (rgbx)least_normal;
    bits = ((rgbx_bits)subnormal & small) | ((rgbx_bits)normal & ~small);
    return (rgbx)(how.clamp ? bits & (rgbx_bits)((wide & 0x8000) == 0) : bits);
}

static rgbx sum_by_pixel(const struct resampling *work, const quarter_view *view, const overlap_cursor *at, rgbx sum)
{
    const resampler *plan = work->plan;
    const overlap_run *run = at->run;
    const float *weight = at->weight;
    for (int64_t i = 0; i <= run->more_rows; i++) {
        int64_t row = view->row_offset + view->row_sign * (run->row + i);
        int64_t column = quarter_view_column(plan, view, run->quarter, run->column);
        for (unsigned k = 0; k < run->count; k++, weight++, column += view->column_sign) {
            float rgb[3];
            map_pixels_read(&work->pixels, row, column >> plan->part_shift, rgb);
            pixel_clean(rgb, rgb);
            sum += (rgbx){rgb[0], rgb[1], rgb[2], 0} * (rgbx){*weight, *weight, *weight, *weight};
        }
    }
    return sum;
}

/* The same sums, but pixel by pixel, and whatever is in them. */
static __attribute__((noinline)) view_sums add_run_by_pixel(const struct resampling *work, const view_group *group,
                                                            overlap_cursor at, view_sums sums)
{
    return (view_sums){
        sum_by_pixel(work, &group->views[0], &at, sums.a),
        sum_by_pixel(work, &group->views[1], &at, sums.b),
        sum_by_pixel(work, &group->views[2], &at, sums.c),
        sum_by_pixel(work, &group->views[3], &at, sums.d),
    };
}

/* ---- texels ---- */

static bool is_by_pixel(const view_group *group, const overlap_run *run)
{
    for (unsigned i = 0; i <= run->more_rows; i++)
        if (group->readings[run->row + i] == ROW_BY_PIXEL)
            return true;
    return false;
}

static inline __attribute__((always_inline)) void add_pixel(const unsigned char *a, const unsigned char *b,
                                                            const unsigned char *c, const unsigned char *d,
                                                            float weight, reading how, view_sums *sums)
{
    rgbx w = {weight, weight, weight, weight};
    sums->a += load(a, how) * w;
    sums->b += load(b, how) * w;
    sums->c += load(c, how) * w;
    sums->d += load(d, how) * w;
}

/* Sums the pixels of a texel in all views, or as many as may be summed in floats. Returns whether that was all. The
 * views are spelled out so that their sums stay in registers. What a later run needs is fetched ahead: no machine
 * guesses it, as each row of the map is read for a few texels only. (At a change of quarters or tiles that is of no
 * use, and does no harm.) */
static inline __attribute__((always_inline)) bool sum_runs(const struct resampling *work, const view_group *group,
                                                           reading how, overlap_cursor *cursor, view_sums *sums)
{
    const unsigned char *const(*origins)[GROUP_VIEWS] = work->origins[group - work->plan->groups];
    const ptrdiff_t row_bytes = work->pixels.row_bytes;
    const ptrdiff_t pixel_bytes = how.pixel_bytes != 0 ? how.pixel_bytes : work->pixels.pixel_bytes;
    const overlap_run *run = cursor->run;
    const float *weight = cursor->weight, *limit = weight + FLOAT_SUM_LIMIT;
    bool last;
    do {
        if (how.careful && is_by_pixel(group, run)) {
            *sums = add_run_by_pixel(work, group, (overlap_cursor){run, weight}, *sums);
            weight += run->count * (run->more_rows + 1);
        } else {
            const unsigned char *const *origin = origins[run->quarter];
            const unsigned char *a = origin[0], *b = origin[1], *c = origin[2], *d = origin[3];
            const overlap_run *later = run + OVERLAP_AHEAD;
            ptrdiff_t row = row_bytes * (later->row + later->more_rows),
                      column = pixel_bytes * (ptrdiff_t)later->column;
            __builtin_prefetch(a + (row + column));
            __builtin_prefetch(b + (row - column));
            __builtin_prefetch(c - (row - column));
            __builtin_prefetch(d - (row + column));
            row = row_bytes * run->row, column = pixel_bytes * (ptrdiff_t)run->column;
            for (unsigned rows = run->more_rows + 1u; rows > 0; rows--, row += row_bytes) {
                const float *end = weight + run->count;
                ptrdiff_t i = row + column, k = row - column;
                do {
                    add_pixel(a + i, b + k, c - k, d - i, *weight, how, sums);
                    i += pixel_bytes;
                    k -= pixel_bytes;
                } while (++weight < end);
            }
        }
        last = run->last;
        run++;
    } while (!last && weight < limit);
    *cursor = (overlap_cursor){run, weight};
    return last;
}

/* The rest of a texel that has many pixels. */
static __attribute__((noinline)) view_sums sum_more(const struct resampling *work, const view_group *group, reading how,
                                                    overlap_cursor *at, view_sums sums)
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
        all = sum_runs(work, group, how, at, &sums);
    }
    return (view_sums){__builtin_convertvector(a, rgbx), __builtin_convertvector(b, rgbx),
                       __builtin_convertvector(c, rgbx), __builtin_convertvector(d, rgbx)};
}

/* Where a view's texels go: a place in the cube, and the step to the next column. */
typedef struct texel_place {
    float *rgb;
    ptrdiff_t step;
} texel_place;

static texel_place find_texel(const struct resampling *work, const quarter_view *view, int64_t row, int64_t column)
{
    int64_t texel = view->texel + row * view->texel_row_step + column * view->texel_column_step;
    return (texel_place){work->cube + texel * 3, view->texel_column_step * 3};
}

static inline void store(texel_place *place, rgbx sum)
{
    memcpy(place->rgb, &sum, 2 * sizeof(float));
    place->rgb[2] = sum[2];
    place->rgb += place->step;
}

/* A tile of a list in four views. Of a face with an odd number of rows or columns the middle ones are in two views each
 * and written twice: by the same thread, always in the same order. */
static inline __attribute__((always_inline)) void resample_views(const struct resampling *work, const view_group *group,
                                                                 reading how, const overlap_tile *tile)
{
    overlap_cursor at = {group->list->runs + tile->run, group->list->weights + tile->weight};
    for (uint32_t row = tile->first_row; row < tile->end_row; row++) {
        texel_place a = find_texel(work, &group->views[0], row, tile->first_column);
        texel_place b = find_texel(work, &group->views[1], row, tile->first_column);
        texel_place c = find_texel(work, &group->views[2], row, tile->first_column);
        texel_place d = find_texel(work, &group->views[3], row, tile->first_column);
        for (uint32_t column = tile->first_column; column < tile->end_column; column++) {
            view_sums sums = {{0}, {0}, {0}, {0}};
            if (!sum_runs(work, group, how, &at, &sums))
                sums = sum_more(work, group, how, &at, sums);
            store(&a, sums.a);
            store(&b, sums.b);
            store(&c, sums.c);
            store(&d, sums.d);
        }
    }
}

static bool has_plain_rows(const view_group *group, const overlap_tile *tile)
{
    for (unsigned row = tile->least_map_row; row <= tile->greatest_map_row; row++)
        if (group->readings[row] != ROW_AS_IT_IS)
            return false;
    return true;
}

void KERNEL(resample)(const struct resampling *work, const view_group *group, const overlap_tile *tile)
{
    const reading plain = {.pixel_bytes = 3 * sizeof(float)};
    if (work->pixels.half)
        resample_views(work, group, (reading){.half = true, .clamp = true, .careful = true}, tile);
    else if (work->pixels.pixel_bytes == plain.pixel_bytes && has_plain_rows(group, tile))
        resample_views(work, group, plain, tile);
    else
        resample_views(work, group, (reading){.clamp = true, .careful = true}, tile);
}
