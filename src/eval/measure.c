/* SPDX-License-Identifier: MIT
 * A pair is compared in passes over its rows. Each row has sums of its own, which are added in their order: so the
 * number of threads changes no bit. docs/comparison.md has the formulas. */
#include "eval/comparison.h"

#include "core/context.h"
#include "core/error.h"
#include "image/pixel_fault.h"

#include <string.h>

/* ---- passes ------------------------------------------------------------------------------- */

static void add_bad(helio_bad_pixels *sum, const helio_bad_pixels *part)
{
    sum->nan += part->nan;
    sum->infinite += part->infinite;
    sum->negative += part->negative;
}

static void add_sums(comparison_sums *sum, const comparison_sums *part)
{
    sum->pixels += part->pixels;
    sum->skipped += part->skipped;
    sum->flicker_pixels += part->flicker_pixels;
    for (int side = 0; side < 2; side++)
        add_bad(&sum->bad[side], &part->bad[side]);
    sum->error_squares += part->error_squares;
    sum->reference_squares += part->reference_squares;
    sum->shown_squares += part->shown_squares;
    sum->relative += part->relative;
    sum->lab += part->lab;
    sum->de2000 += part->de2000;
    sum->flip += part->flip;
    sum->flicker_references += part->flicker_references;
    sum->flicker_squares += part->flicker_squares;
    sum->flicker_relative += part->flicker_relative;
}

void measurement_pass(measurement *work, helio_loop_body body)
{
    const helio_comparison *comparison = work->comparison;
    memset(comparison->rows, 0, comparison->height * sizeof *comparison->rows);
    context_parallel_for(comparison->context, comparison->height, body, work);
    for (uint32_t row = 0; row < comparison->height; row++)
        add_sums(&work->sums, &comparison->rows[row]);
}

/* ---- what is compared --------------------------------------------------------------------- */

static void count_fault(helio_bad_pixels *bad, pixel_fault fault)
{
    bad->nan += fault == PIXEL_NAN;
    bad->infinite += fault == PIXEL_INFINITE;
    bad->negative += fault == PIXEL_NEGATIVE;
}

static bool is_finite(pixel_fault fault)
{
    return fault == PIXEL_GOOD || fault == PIXEL_NEGATIVE;
}

/* Does the pixel count? */
static bool judge(const measurement *work, size_t pixel, comparison_sums *sums)
{
    const float *mask = work->pair->mask;
    if (mask != NULL && !(mask[pixel] >= 0.5f))
        return false;
    bool is_compared = true;
    for (int side = 0; side < 2; side++) {
        pixel_fault fault = pixel_fault_of(measurement_pixel(work, side, pixel));
        count_fault(&sums->bad[side], fault);
        is_compared = is_compared && is_finite(fault);
    }
    sums->pixels += is_compared;
    sums->skipped += !is_compared;
    return is_compared;
}

/* ---- radiance, and what a screen shows of it ---------------------------------------------- */

static double square(double x)
{
    return x * x;
}

static void compare_radiance(const measurement *work, size_t pixel, comparison_sums *sums)
{
    const float *a = measurement_pixel(work, 0, pixel), *b = measurement_pixel(work, 1, pixel);
    for (int c = 0; c < 3; c++) {
        sums->error_squares += square((double)a[c] - (double)b[c]);
        sums->reference_squares += square((double)b[c]);
    }
}

static bool is_same_colour(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static void compare_shown(const measurement *work, size_t pixel, const float a[3], const float b[3],
                          comparison_sums *sums)
{
    float *const *maps = work->comparison->maps;
    const lab_space *space = &work->comparison->lab;
    double difference = 0, difference_2000 = 0;
    if (!is_same_colour(a, b)) {
        for (int c = 0; c < 3; c++)
            sums->shown_squares += square((double)srgb_encode(a[c]) - (double)srgb_encode(b[c]));
        if (maps[HELIO_ERROR_MAP_LAB] != NULL) {
            lab_colour seen = lab_from_rec709(space, a), wanted = lab_from_rec709(space, b);
            difference = lab_difference(&seen, &wanted);
            difference_2000 = lab_difference_2000(&seen, &wanted);
        }
    }
    if (maps[HELIO_ERROR_MAP_LAB] == NULL)
        return;
    maps[HELIO_ERROR_MAP_LAB][pixel] = (float)difference;
    maps[HELIO_ERROR_MAP_DE2000][pixel] = (float)difference_2000;
    sums->lab += difference;
    sums->de2000 += difference_2000;
}

/* FLIP's viewer sees the whole pictures. */
static void keep_opponents(const helio_comparison *comparison, size_t pixel, float shown[2][3])
{
    for (int side = 0; side < 2; side++) {
        float opponents[3];
        flip_opponents(&comparison->viewer, shown[side], opponents);
        for (int c = 0; c < 3; c++)
            comparison->pictures[side].planes[c][pixel] = opponents[c];
    }
}

/* NaN in the maps of what later passes fill tells them what to leave out. */
static void mark(const helio_comparison *comparison, size_t pixel, float value)
{
    for (int i = 0; i < ERROR_MAPS; i++)
        if (comparison->maps[i] != NULL)
            comparison->maps[i][pixel] = value;
}

static void compare_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    comparison_sums *sums = &comparison->rows[row];
    bool has_flip = comparison->pictures[0].planes[0] != NULL;
    for (size_t i = row * comparison->width; i < (row + 1) * comparison->width; i++) {
        float shown[2][3];
        bool is_compared = judge(work, i, sums);
        for (int side = 0; side < 2 && (is_compared || has_flip); side++)
            helio_tonemap_apply(work->pair->tonemap, work->pair->exposure, measurement_pixel(work, side, i),
                                shown[side]);
        if (has_flip)
            keep_opponents(comparison, i, shown);
        mark(comparison, i, is_compared ? 0 : NAN);
        if (is_compared) {
            compare_radiance(work, i, sums);
            compare_shown(work, i, shown[0], shown[1], sums);
        }
    }
}

/* ---- relative errors, once the reference's mean square is known --------------------------- */

static void relate_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    float *errors = comparison->maps[HELIO_ERROR_MAP_RELATIVE];
    for (size_t i = row * comparison->width; i < (row + 1) * comparison->width; i++) {
        const float *a = measurement_pixel(work, 0, i), *b = measurement_pixel(work, 1, i);
        double sum = 0;
        if (!measurement_compares(work, i))
            continue;
        for (int c = 0; c < 3; c++)
            sum += measurement_ratio(square((double)a[c] - (double)b[c]), square((double)b[c]) + work->epsilon);
        comparison->rows[row].relative += sum;
        errors[i] = (float)(sum / 3);
    }
}

/* ---- FLIP --------------------------------------------------------------------------------- */

static void flip_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    size_t first = row * comparison->width;
    float *errors = comparison->maps[HELIO_ERROR_MAP_FLIP] + first;
    flip_compare_row(&comparison->viewer, &comparison->pictures[0], &comparison->pictures[1], (uint32_t)row, errors);
    for (uint32_t i = 0; i < comparison->width; i++)
        if (measurement_compares(work, first + i))
            comparison->rows[row].flip += (double)errors[i];
}

/* ---- all of it ---------------------------------------------------------------------------- */

static helio_status check_pair(const helio_comparison_pair *pair)
{
    const uint32_t channels[2] = {pair->picture_channels, pair->reference_channels};
    helio_tonemap tonemap;
    if (pair->picture == NULL || pair->reference == NULL)
        return fail(HELIO_ERR_ARGUMENT, "a comparison needs a picture and a reference");
    for (int side = 0; side < 2; side++)
        if (channels[side] != 0 && channels[side] != 3 && channels[side] != 4)
            return fail(HELIO_ERR_ARGUMENT, "a %s of %u channels cannot be compared; give 3 or 4",
                        side == 0 ? "picture" : "reference", channels[side]);
    if (!(pair->exposure >= -100 && pair->exposure <= 100))
        return fail(HELIO_ERR_ARGUMENT, "an exposure of %g stops was given; use -100 to 100", (double)pair->exposure);
    return helio_tonemap_parse(helio_tonemap_name(pair->tonemap), &tonemap);
}

static double mean(double sum, uint64_t count)
{
    return count > 0 ? sum / (double)count : (double)NAN;
}

static helio_comparison_info make_info(const measurement *work)
{
    const comparison_sums *sums = &work->sums;
    float *const *maps = work->comparison->maps;
    bool has_lab = maps[HELIO_ERROR_MAP_LAB] != NULL, has_flip = maps[HELIO_ERROR_MAP_FLIP] != NULL;
    return (helio_comparison_info){
        .pixels = sums->pixels,
        .skipped = sums->skipped,
        .picture_bad = sums->bad[0],
        .reference_bad = sums->bad[1],
        .rmse = sqrt(mean(sums->error_squares, 3 * sums->pixels)),
        .relmse = mean(sums->relative, 3 * sums->pixels),
        .psnr = -10 * log10(mean(sums->shown_squares, 3 * sums->pixels)),
        .lab_mean = has_lab ? mean(sums->lab, sums->pixels) : (double)NAN,
        .de2000_mean = has_lab ? mean(sums->de2000, sums->pixels) : (double)NAN,
        .flip = has_flip ? mean(sums->flip, sums->pixels) : (double)NAN,
        .flicker = mean(sums->flicker_relative, 3 * sums->flicker_pixels),
        .flicker_rmse = sqrt(mean(sums->flicker_squares, 3 * sums->flicker_pixels)),
        .flicker_pixels = sums->flicker_pixels,
    };
}

helio_status helio_comparison_measure(helio_comparison *comparison, const helio_comparison_pair *pair,
                                      helio_comparison_info *info)
{
    if (comparison == NULL || pair == NULL || info == NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_comparison_measure needs a comparison, a pair and a place for the result");
    HELIO_TRY(check_pair(pair));
    measurement work = {.comparison = comparison,
                        .pair = pair,
                        .channels = {pair->picture_channels != 0 ? pair->picture_channels : 3,
                                     pair->reference_channels != 0 ? pair->reference_channels : 3}};
    measurement_pass(&work, compare_row);
    work.epsilon = 0.01 * mean(work.sums.reference_squares, 3 * work.sums.pixels);
    measurement_pass(&work, relate_row);
    if (comparison->maps[HELIO_ERROR_MAP_FLIP] != NULL)
        measurement_pass(&work, flip_row);
    if (comparison->past.errors != NULL)
        flicker_measure(&work);
    comparison->has_pair = true;
    *info = make_info(&work);
    return HELIO_OK;
}
