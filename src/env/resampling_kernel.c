/* SPDX-License-Identifier: MIT
 *
 * A frame: the pixels that a tile sees are brought together, then sums of them, weighted, in an order that depends on
 * the plan alone. */
#include "core/context.h"
#include "env/resampling.h"
#include "image/pixel_fault.h"
#include "sampling/kernels.h"

#include <string.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

/* ---- pixels ---- */

/* Red, green, blue and a number that nobody looks at. */
typedef float rgbx __attribute__((vector_size(16)));
typedef uint32_t rgbx_bits __attribute__((vector_size(16)));

/* Bits 31 are set where a number is not from 0 to the brightest: its bits are beyond those of the limit, so that the
 * sum overflows into the sign, or it has the sign already, as -0 has. */
static inline rgbx load_floats(const unsigned char *pixel, rgbx_bits *suspicions)
{
    const float brightest = PIXEL_BRIGHTEST;
    rgbx_bits bits;
    uint32_t limit;
    memcpy(&limit, &brightest, sizeof limit);
    memcpy(&bits, pixel, sizeof bits);
    *suspicions |= bits | (bits + (INT32_MAX - limit));
    return (rgbx)bits;
}

/* IEEE binary16, whose finite numbers are all below the limit; exact. */
static inline rgbx load_halves(const unsigned char *pixel, rgbx_bits *suspicions)
{
    typedef uint16_t halves __attribute__((vector_size(8)));
    halves numbers;
    memcpy(&numbers, pixel, sizeof numbers);
    const rgbx_bits wide = __builtin_convertvector(numbers, rgbx_bits);
    const rgbx_bits least_normal = (rgbx_bits){113, 113, 113, 113} << 23,
                    rebias = (rgbx_bits){112, 112, 112, 112} << 23;
    rgbx_bits bits = (wide & 0x7fff) << 13, small = (rgbx_bits)((wide & 0x7c00) == 0);
    rgbx normal = (rgbx)(bits + rebias), subnormal = (rgbx)(bits + least_normal) - (rgbx)least_normal;
    *suspicions |= (wide | (wide + 0x0400)) << 16;
    return (rgbx)(((rgbx_bits)subnormal & small) | ((rgbx_bits)normal & ~small));
}

/* A shared exponent, with which all is light; exact. */
static inline rgbx load_word(const unsigned char *pixel)
{
    typedef int32_t rgbx_integers __attribute__((vector_size(16)));
    uint32_t word;
    memcpy(&word, pixel, sizeof word);
    const rgbx_bits bits = (rgbx_bits){word, word >> 9, word >> 18, 0} & 511;
    const rgbx_bits exponent = (rgbx_bits){word, word, word, word} >> 27;
    const rgbx unit = (rgbx)((exponent + (127 - 24)) << 23);
    return __builtin_convertvector((rgbx_integers)bits, rgbx) * unit;
}

static inline __attribute__((always_inline)) rgbx load_pixel(const unsigned char *pixel, map_numbers numbers,
                                                             rgbx_bits *suspicions)
{
    return numbers == MAP_FLOATS   ? load_floats(pixel, suspicions)
           : numbers == MAP_HALVES ? load_halves(pixel, suspicions)
                                   : load_word(pixel);
}

/* A span of a window as a view sees it. */
typedef struct seen_span {
    const unsigned char *first; /* pixel */
    ptrdiff_t step;             /* to the next one, bytes */
    unsigned count;
} seen_span;

/* Copies pixels that are probably all light. Returns false if they are not. Reads a number more than there are. to: the
 * first pixel's place in a view; others follow at the distance of pixels of all views. */
static inline __attribute__((always_inline)) bool copy_light(const seen_span *span, map_numbers numbers, float *to)
{
    rgbx_bits suspicions = {0};
    const unsigned char *from = span->first;
#pragma GCC unroll 4
    for (unsigned i = 0; i < span->count; i++, from += span->step, to += GROUP_VIEWS * 4) {
        rgbx pixel = load_pixel(from, numbers, &suspicions);
        memcpy(to, &pixel, sizeof pixel);
    }
    return (suspicions[0] | suspicions[1] | suspicions[2]) >> 31 == 0;
}

/* numbers is a constant where this is expanded. */
static inline bool copy_light_of(map_numbers numbers, const seen_span *span, float *to)
{
    switch (numbers) {
    case MAP_FLOATS: return copy_light(span, MAP_FLOATS, to);
    case MAP_HALVES: return copy_light(span, MAP_HALVES, to);
    default: return copy_light(span, MAP_WORDS, to);
    }
}

/* Copies any pixels, or parts of them, cleaned. Returns whether some were no light. */
static __attribute__((noinline)) bool copy_any(const struct resampling *work, const quarter_view *view,
                                               const overlap_window *window, const overlap_span *span, float *to)
{
    const resampler *plan = work->plan;
    const int64_t row = view->row_offset + view->row_sign * ((int64_t)window->row + span->row);
    bool faults = false;
    for (int64_t i = 0; i < span->count; i++, to += GROUP_VIEWS * 4) {
        int64_t column = quarter_view_column(plan, view, window->quarter, (int64_t)window->column + span->column + i);
        map_pixels_read(&work->pixels, row, column >> plan->part_shift, to);
        faults |= pixel_fault_of(to) != PIXEL_GOOD;
        pixel_clean(to, to);
    }
    return faults;
}

static inline seen_span see_span(const struct resampling *work, const view_group *group, int v,
                                 const overlap_window *window, const overlap_span *span)
{
    const quarter_view *view = &group->views[v];
    const ptrdiff_t row_step = work->pixels.row_bytes * view->row_sign;
    const ptrdiff_t step = work->pixels.pixel_bytes * view->column_sign;
    const unsigned char *origin = work->origins[group - work->plan->groups][window->quarter][v];
    return (seen_span){origin + row_step * ((ptrdiff_t)window->row + span->row) +
                           step * ((ptrdiff_t)window->column + span->column),
                       step, span->count};
}

/* Sends for the pixels of a span: no machine guesses them, as each row of the map is read for a few texels only. */
static inline void fetch_span(const seen_span *seen)
{
    const ptrdiff_t length = seen->step * (ptrdiff_t)(seen->count - 1);
    const unsigned char *from = length > 0 ? seen->first : seen->first + length;
    const unsigned char *last = length > 0 ? seen->first + length : seen->first;
    for (; from < last; from += CONTEXT_ALIGNMENT)
        __builtin_prefetch(from);
    __builtin_prefetch(last);
}

/* Copies a span for a view. Returns whether some pixels were no light. */
static inline bool copy_span(const struct resampling *work, const view_group *group, int v,
                             const overlap_window *window, const overlap_span *span, float *to)
{
    const seen_span seen = see_span(work, group, v, window, span);
    const unsigned char *end = seen.first + seen.step * (ptrdiff_t)(seen.count - 1);
    if (seen.first != work->last_pixel && end != work->last_pixel && copy_light_of(work->pixels.numbers, &seen, to))
        return false;
    return copy_any(work, &group->views[v], window, span, to);
}

static bool copy_window(const struct resampling *work, const view_group *group, const overlap_window *window,
                        struct resampling_space *space)
{
    enum { AHEAD = 2 };
    const overlap_span *span = group->list->spans + window->span, *end = span + window->span_count;
    const bool whole = work->plan->part_shift == 0; /* pixels, and no parts of them */
    bool faults = false;
    for (; span < end; span++) {
        float *to = space->pixels[(unsigned)span->row * window->pitch + span->column];
        for (int v = 0; v < GROUP_VIEWS; v++, to += 4) {
            if (whole && span + AHEAD < end) {
                seen_span ahead = see_span(work, group, v, window, span + AHEAD);
                fetch_span(&ahead);
            }
            faults |= whole ? copy_span(work, group, v, window, span, to)
                            : copy_any(work, &group->views[v], window, span, to);
        }
    }
    return faults;
}

/* ---- sums ---- */

/* The numbers of a pixel in all views, in as many registers as they take. */
enum { NUMBERS = GROUP_VIEWS * 4, REGISTERS = NUMBERS / HELIO_LANES };
typedef float lanes __attribute__((vector_size(sizeof(float) * HELIO_LANES)));
typedef struct view_sums {
    lanes part[REGISTERS];
} view_sums;

/* columns: 0 where the compiler does not know. */
static inline __attribute__((always_inline)) view_sums sum_part(const float *pixel, const float *weight, unsigned rows,
                                                                unsigned columns, unsigned known_columns,
                                                                ptrdiff_t pitch)
{
    const unsigned count = known_columns != 0 ? known_columns : columns;
    view_sums sums = {0};
    for (; rows > 0; rows--, pixel += pitch * NUMBERS, weight += count) {
        for (unsigned k = 0; k < count; k++) {
            for (int i = 0; i < REGISTERS; i++) {
                lanes numbers;
                memcpy(&numbers, __builtin_assume_aligned(pixel + k * NUMBERS + i * HELIO_LANES, sizeof numbers),
                       sizeof numbers);
                sums.part[i] += numbers * weight[k];
            }
        }
    }
    return sums;
}

static inline void put_sums(const view_sums *sums, bool adds, float *texel)
{
    view_sums before = {0};
    texel = __builtin_assume_aligned(texel, sizeof *sums);
    if (adds)
        memcpy(&before, texel, sizeof before);
    for (int i = 0; i < REGISTERS; i++)
        before.part[i] += sums->part[i];
    memcpy(texel, &before, sizeof before);
}

static inline void put_deep_sums(const view_sums *sums, bool adds, double *texel)
{
    for (int i = 0; i < NUMBERS; i++)
        texel[i] = (adds ? texel[i] : 0.0) + (double)sums->part[i / HELIO_LANES][i % HELIO_LANES];
}

static inline __attribute__((always_inline)) void sum_batch(struct resampling_space *space, ptrdiff_t pitch, bool deep,
                                                            unsigned known_columns, overlap_cursor *cursor)
{
    const overlap_batch *batch = cursor->batch;
    const overlap_part *part = cursor->part, *end = part + batch->count;
    const float *weight = cursor->weight;
    const unsigned rows = batch->rows, columns = batch->columns, weights = rows * columns;
    const bool adds = batch->adds;
    for (; part < end; part++, weight += weights) {
        view_sums sums = sum_part(space->pixels[part->pixel], weight, rows, columns, known_columns, pitch);
        if (deep)
            put_deep_sums(&sums, adds, space->deep_texels[part->texel]);
        else
            put_sums(&sums, adds, space->texels[part->texel]);
    }
    cursor->part = part;
    cursor->weight = weight;
}

/* Sums a row of texels. */
static void sum_texels(struct resampling_space *space, ptrdiff_t pitch, bool deep, overlap_cursor *at)
{
    for (bool last = false; !last; at->batch++) {
        last = at->batch->last;
        if (deep)
            sum_batch(space, pitch, true, 0, at);
        else if (at->batch->columns == 1)
            sum_batch(space, pitch, false, 1, at);
        else if (at->batch->columns == 2)
            sum_batch(space, pitch, false, 2, at);
        else if (at->batch->columns == 3)
            sum_batch(space, pitch, false, 3, at);
        else
            sum_batch(space, pitch, false, 0, at);
    }
}

/* ---- texels ---- */

static void narrow(struct resampling_space *space, uint32_t count)
{
    for (uint32_t texel = 0; texel < count; texel++)
        for (int i = 0; i < NUMBERS; i++)
            space->texels[texel][i] = (float)space->deep_texels[texel][i];
}

/* Writes the texels of a view from the left to the right: each overwrites the number that the one before had too many;
 * the last has none, as the texel behind it may be another thread's. */
static inline void write_texels(const float *from, ptrdiff_t step, uint32_t count, float *to)
{
    for (uint32_t i = 1; i < count; i++, from += step, to += 3)
        memcpy(to, from, sizeof(rgbx));
    memcpy(to, from, 3 * sizeof *to);
}

/* Where a view has texels of a tile's row in the cube: those from the tile's first column on, but not the last where
 * that is another view's. */
typedef struct texel_place {
    float *rgb; /* of the leftmost */
    uint32_t count;
    bool onwards; /* the leftmost is the tile's first */
} texel_place;

static texel_place find_texels(const struct resampling *work, const quarter_view *view, const overlap_tile *tile,
                               uint32_t row)
{
    texel_place place = {.onwards = view->texel_column_step > 0};
    uint32_t end = tile->end_column - !quarter_view_has_column(work->plan, view, tile->end_column - 1);
    if (quarter_view_has_row(work->plan, view, row))
        place.count = end - tile->first_column;
    int64_t leftmost = place.onwards ? tile->first_column : (int64_t)end - 1;
    place.rgb = work->cube + 3 * (view->texel + row * view->texel_row_step + leftmost * view->texel_column_step);
    return place;
}

/* Sends for the places of texels. */
static inline void fetch_texels(const texel_place *place)
{
    for (uint32_t i = 0; i < 3 * place->count; i += CONTEXT_ALIGNMENT / sizeof(float))
        __builtin_prefetch(place->rgb + i, 1);
}

/* The same past the caches, where these are whole lines of them. Returns false if nothing was written. */
static inline bool stream_texels(const float *from, ptrdiff_t step, uint32_t count, float *to)
{
#ifdef __SSE2__
    if ((uintptr_t)to % CONTEXT_ALIGNMENT != 0 || count * 3 * sizeof *to % CONTEXT_ALIGNMENT != 0)
        return false;
    for (uint32_t i = 0; i < count; i += 4, from += 4 * step, to += 12) {
        const __m128 a = _mm_load_ps(from), b = _mm_load_ps(from + step);
        const __m128 c = _mm_load_ps(from + 2 * step), d = _mm_load_ps(from + 3 * step);
        const __m128 a2b0 = _mm_shuffle_ps(a, b, _MM_SHUFFLE(0, 0, 2, 2));
        const __m128 c2d0 = _mm_shuffle_ps(c, d, _MM_SHUFFLE(0, 0, 2, 2));
        _mm_stream_ps(to, _mm_shuffle_ps(a, a2b0, _MM_SHUFFLE(2, 0, 1, 0)));
        _mm_stream_ps(to + 4, _mm_shuffle_ps(b, c, _MM_SHUFFLE(1, 0, 2, 1)));
        _mm_stream_ps(to + 8, _mm_shuffle_ps(c2d0, d, _MM_SHUFFLE(2, 1, 2, 0)));
    }
    return true;
#else
    (void)from, (void)step, (void)count, (void)to;
    return false;
#endif
}

/* What was streamed is for other threads to see. */
static void end_streams(const struct resampling *work)
{
    (void)work;
#ifdef __SSE2__
    if (work->streams)
        _mm_sfence();
#endif
}

static void write_row(const struct resampling *work, const view_group *group, const overlap_tile *tile, uint32_t row,
                      const struct resampling_space *space)
{
    for (int v = 0; v < GROUP_VIEWS; v++) {
        const texel_place place = find_texels(work, &group->views[v], tile, row);
        if (place.count == 0)
            continue;
        const float *from = space->texels[place.onwards ? 0 : place.count - 1] + 4 * v;
        const ptrdiff_t step = place.onwards ? NUMBERS : -NUMBERS;
        if (work->streams && stream_texels(from, step, place.count, place.rgb))
            continue;
        if (row + 1 < tile->end_row) {
            const texel_place next = find_texels(work, &group->views[v], tile, row + 1);
            fetch_texels(&next);
        }
        write_texels(from, step, place.count, place.rgb);
    }
}

bool KERNEL(resample)(const struct resampling *work, const view_group *group, const overlap_tile *tile,
                      struct resampling_space *space)
{
    const overlap_window *window = group->list->windows + tile->window, *end = window + tile->window_count;
    bool faults = false;
    for (; window < end; window++) {
        overlap_cursor at = overlap_cursor_at(group->list, window);
        faults |= copy_window(work, group, window, space);
        for (uint32_t row = tile->first_row; row < tile->end_row; row++) {
            sum_texels(space, window->pitch, tile->deep, &at);
            if (window + 1 < end)
                continue;
            if (tile->deep)
                narrow(space, tile->end_column - tile->first_column);
            write_row(work, group, tile, row, space);
        }
    }
    end_streams(work);
    return faults;
}
