/* SPDX-License-Identifier: MIT
 * How much the error changes from one pair to the next: half of the mean square of the difference, which is the Allan
 * variance of the error. */
#include "eval/comparison.h"

static bool is_in_both(const measurement *work, size_t pixel)
{
    return measurement_compares(work, pixel) && !isnan(work->comparison->past.errors[3 * pixel]);
}

/* (b^2 + b'^2) / 2 */
static double reference_square(double now, double before)
{
    return (now * now + before * before) / 2;
}

static void refer_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    comparison_sums *sums = &comparison->rows[row];
    for (size_t i = row * comparison->width; i < (row + 1) * comparison->width; i++) {
        const float *now = measurement_pixel(work, 1, i), *before = comparison->past.references + 3 * i;
        if (!is_in_both(work, i))
            continue;
        sums->flicker_pixels++;
        for (int c = 0; c < 3; c++)
            sums->flicker_references += reference_square((double)now[c], (double)before[c]);
    }
}

static void add_change(const measurement *work, size_t pixel, comparison_sums *sums)
{
    const past_pair *past = &work->comparison->past;
    const float *a = measurement_pixel(work, 0, pixel), *b = measurement_pixel(work, 1, pixel);
    for (size_t c = 0; c < 3; c++) {
        double change = (double)(a[c] - b[c]) - (double)past->errors[3 * pixel + c];
        double reference = reference_square((double)b[c], (double)past->references[3 * pixel + c]);
        sums->flicker_squares += change * change;
        sums->flicker_relative += measurement_ratio(change * change / 2, reference + work->epsilon);
    }
}

static void change_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    for (size_t i = row * comparison->width; i < (row + 1) * comparison->width; i++)
        if (is_in_both(work, i))
            add_change(work, i, &comparison->rows[row]);
}

static void remember_row(void *data, size_t row)
{
    const measurement *work = data;
    const helio_comparison *comparison = work->comparison;
    for (size_t i = row * comparison->width; i < (row + 1) * comparison->width; i++) {
        const float *a = measurement_pixel(work, 0, i), *b = measurement_pixel(work, 1, i);
        bool is_compared = measurement_compares(work, i);
        for (size_t c = 0; c < 3; c++) {
            comparison->past.errors[3 * i + c] = is_compared ? a[c] - b[c] : NAN;
            comparison->past.references[3 * i + c] = b[c];
        }
    }
}

void flicker_measure(measurement *work)
{
    past_pair *past = &work->comparison->past;
    if (past->is_there) {
        measurement_pass(work, refer_row);
        if (work->sums.flicker_pixels > 0)
            work->epsilon = 0.01 * work->sums.flicker_references / (3 * (double)work->sums.flicker_pixels);
        measurement_pass(work, change_row);
    }
    measurement_pass(work, remember_row);
    past->is_there = true;
}
