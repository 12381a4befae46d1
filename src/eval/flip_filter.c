/* SPDX-License-Identifier: MIT
 * P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild: "FLIP: A Difference
 * Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. */
#include "eval/flip_filter.h"

#include "core/vector.h"

#include <stddef.h>
#include <string.h>

/* ---- kernels ------------------------------------------------------------------------------ */

/* Contrast sensitivities as sums of Gaussians a sqrt(pi / b) exp(-(pi x)^2 / b), x in degrees: table 1. Red-green and
 * achromatic have one. */
static const double ACHROMATIC_B = 0.0047, RED_GREEN_B = 0.0053;
static const double BLUE_YELLOW_A[2] = {34.1, 13.5}, BLUE_YELLOW_B[2] = {0.04, 0.025};
static const double FEATURE_WIDTH = 0.082; /* of edges and points, degrees */

static double gaussian(double x, double deviation)
{
    return exp(-0.5 * (x / deviation) * (x / deviation));
}

/* Weights that sum to 1. Returns what they summed to before. */
static double fill_smooth(flip_kernel *kernel, double deviation, int radius)
{
    double sum = 0;
    kernel->radius = radius;
    for (int x = -radius; x <= radius; x++)
        sum += gaussian(x, deviation);
    for (int x = -radius; x <= radius; x++)
        kernel->weights[x + radius] = (float)(gaussian(x, deviation) / sum);
    return sum;
}

/* First derivative of a Gaussian, but for a factor. */
static double edge_value(double x, double deviation)
{
    return -x * gaussian(x, deviation);
}

/* Second derivative. */
static double point_value(double x, double deviation)
{
    double relative = x / deviation;
    return (relative * relative - 1) * gaussian(x, deviation);
}

/* Weights of which the positive ones sum to 1, the negative ones to -1. */
static void fill_signed(flip_kernel *kernel, double (*value_at)(double x, double deviation), double deviation,
                        int radius)
{
    double positive = 0, negative = 0;
    kernel->radius = radius;
    for (int x = -radius; x <= radius; x++)
        *(value_at(x, deviation) > 0 ? &positive : &negative) += fabs(value_at(x, deviation));
    for (int x = -radius; x <= radius; x++) {
        double value = value_at(x, deviation);
        kernel->weights[x + radius] = (float)(value / (value > 0 ? positive : negative));
    }
}

/* In pixels, of a Gaussian of the contrast sensitivities. */
static double deviation_of(double b, double pixels_per_degree)
{
    return sqrt(b / (2 * PI * PI)) * pixels_per_degree;
}

/* All have the radius of the widest, as they are one filter of three channels. */
static void make_colours(flip_filter *filter, double pixels_per_degree)
{
    int radius = (int)ceil(3 * deviation_of(BLUE_YELLOW_B[0], pixels_per_degree));
    double parts[2];
    fill_smooth(&filter->achromatic, deviation_of(ACHROMATIC_B, pixels_per_degree), radius);
    fill_smooth(&filter->red_green, deviation_of(RED_GREEN_B, pixels_per_degree), radius);
    for (int i = 0; i < 2; i++) {
        double sum = fill_smooth(&filter->blue_yellow[i], deviation_of(BLUE_YELLOW_B[i], pixels_per_degree), radius);
        parts[i] = BLUE_YELLOW_A[i] * sqrt(PI / BLUE_YELLOW_B[i]) * sum * sum;
    }
    for (int i = 0; i < 2; i++)
        filter->blue_yellow_shares[i] = (float)(parts[i] / (parts[0] + parts[1]));
}

static void make_features(flip_filter *filter, double pixels_per_degree)
{
    double deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    int radius = (int)ceil(3 * deviation);
    fill_smooth(&filter->smooth, deviation, radius);
    fill_signed(&filter->edge, edge_value, deviation, radius);
    fill_signed(&filter->point, point_value, deviation, radius);
}

void flip_filter_make(flip_filter *filter, double pixels_per_degree)
{
    memset(filter, 0, sizeof *filter);
    make_colours(filter, pixels_per_degree);
    make_features(filter, pixels_per_degree);
}

/* ---- filtering ---------------------------------------------------------------------------- */

/* Part of a row, FLIP_RADIUS pixels more on either side. */
typedef struct row_window {
    const flip_picture *picture;
    uint32_t row;
    int64_t first; /* column of the first pixel, which may lie outside of the picture */
    uint32_t count;
} row_window;

static int64_t clamp(int64_t value, int64_t least, int64_t greatest)
{
    return value < least ? least : value > greatest ? greatest : value;
}

/* Row y, counted from the window's, at the column of the first pixel that is in the picture. */
static const float *line_of(const row_window *window, int plane, int y, int64_t left)
{
    const flip_picture *picture = window->picture;
    int64_t row = clamp((int64_t)window->row + y, 0, picture->height - 1);
    return picture->planes[plane] + (size_t)row * picture->width + left;
}

/* Sums of pixels times weights: lines[k] has weight k and a pixel for each sum. Those of a block stay in registers. */
static void weigh(const float *const lines[FLIP_TAPS], const flip_kernel *kernel, size_t count, float *restrict out)
{
    enum { BLOCK = 16 };
    int taps = 2 * kernel->radius + 1;
    size_t i = 0;
    for (; i + BLOCK <= count; i += BLOCK) {
        float sums[BLOCK] = {0};
        for (int tap = 0; tap < taps; tap++)
            for (size_t k = 0; k < BLOCK; k++)
                sums[k] += kernel->weights[tap] * lines[tap][i + k];
        memcpy(out + i, sums, sizeof sums);
    }
    for (; i < count; i++) {
        out[i] = 0;
        for (int tap = 0; tap < taps; tap++)
            out[i] += kernel->weights[tap] * lines[tap][i];
    }
}

static void filter_down(const row_window *window, int plane, const flip_kernel *kernel, float *out)
{
    const flip_picture *picture = window->picture;
    const float *lines[FLIP_TAPS];
    int64_t left = clamp(window->first, 0, picture->width - 1);
    int64_t right = clamp(window->first + window->count - 1, 0, picture->width - 1);
    float *inside = out + (left - window->first);
    size_t count = (size_t)(right - left + 1);
    for (int tap = 0; tap < 2 * kernel->radius + 1; tap++)
        lines[tap] = line_of(window, plane, tap - kernel->radius, left);
    weigh(lines, kernel, count, inside);
    for (float *border = out; border < inside; border++)
        *border = *inside;
    for (float *border = inside + count; border < out + window->count; border++)
        *border = inside[count - 1];
}

/* row: [count + 2 FLIP_RADIUS] */
static void filter_across(const float *row, const flip_kernel *kernel, uint32_t count, float *out)
{
    const float *lines[FLIP_TAPS];
    for (int tap = 0; tap < 2 * kernel->radius + 1; tap++)
        lines[tap] = row + FLIP_RADIUS + tap - kernel->radius;
    weigh(lines, kernel, count, out);
}

static void filter(const row_window *window, int plane, const flip_kernel *down, const flip_kernel *across, float *out)
{
    float row[FLIP_WINDOW] = {0};
    filter_down(window, plane, down, row);
    filter_across(row, across, window->count - 2 * FLIP_RADIUS, out);
}

static void see_colours(const flip_filter *f, const row_window *window, uint32_t count, flip_view *view)
{
    float wide[FLIP_CHUNK], narrow[FLIP_CHUNK];
    filter(window, 0, &f->achromatic, &f->achromatic, view->colours[0]);
    filter(window, 1, &f->red_green, &f->red_green, view->colours[1]);
    filter(window, 2, &f->blue_yellow[0], &f->blue_yellow[0], wide);
    filter(window, 2, &f->blue_yellow[1], &f->blue_yellow[1], narrow);
    for (uint32_t i = 0; i < count; i++)
        view->colours[2][i] = f->blue_yellow_shares[0] * wide[i] + f->blue_yellow_shares[1] * narrow[i];
}

/* Of the achromatic channel, which is 116 times the luminance but for a constant that these kernels do not see. */
static void see_features(const flip_filter *f, const row_window *window, const flip_kernel *along, uint32_t count,
                         float *strengths)
{
    float down[FLIP_CHUNK], across[FLIP_CHUNK];
    filter(window, 0, along, &f->smooth, down);
    filter(window, 0, &f->smooth, along, across);
    for (uint32_t i = 0; i < count; i++)
        strengths[i] = sqrtf(down[i] * down[i] + across[i] * across[i]) * (1 / 116.0f);
}

void flip_filter_see(const flip_filter *f, const flip_picture *picture, uint32_t row, uint32_t column, uint32_t count,
                     flip_view *view)
{
    const row_window window = {picture, row, (int64_t)column - FLIP_RADIUS, count + 2 * FLIP_RADIUS};
    see_colours(f, &window, count, view);
    see_features(f, &window, &f->edge, count, view->edges);
    see_features(f, &window, &f->point, count, view->points);
}
