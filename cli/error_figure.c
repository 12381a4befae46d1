/* SPDX-License-Identifier: MIT */
#include "error_figure.h"

#include "false_colour.h"
#include "figure.h"
#include "figure_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    MARGIN = 20,
    SMALLEST = 480, /* edges of the map as it is drawn, pixels: small pictures are drawn in larger squares */
    LARGEST = 4096,
    BAR_HEIGHT = 14,
    LEGEND_HEIGHT = 132,
    INTERVALS = 5 /* of the scale */
};

/* ---- range --------------------------------------------------------------------------------- */

static size_t count_above(const float *errors, size_t pixels, double bound)
{
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++)
        count += (double)errors[i] > bound;
    return count;
}

/* 1, 2 or 5 times a power of ten. */
double error_figure_range(helio_error_map map, const float *errors, size_t pixels)
{
    static const double digits[] = {1, 2, 5};
    size_t wrong = count_above(errors, pixels, 0), compared = 0;
    for (size_t i = 0; i < pixels; i++)
        compared += !isnan(errors[i]);
    if (map == HELIO_ERROR_MAP_FLIP || wrong == 0)
        return 1;
    for (int power = -9; power < 9; power++)
        for (int i = 0; i < 3; i++)
            if (count_above(errors, pixels, digits[i] * pow(10, power)) <= compared / 200)
                return digits[i] * pow(10, power);
    return 1e9;
}

/* ---- the map ------------------------------------------------------------------------------- */

typedef struct map_shape {
    uint32_t width, height; /* as it is drawn */
} map_shape;

static map_shape choose_shape(const error_figure *subject)
{
    uint32_t edge = subject->width > subject->height ? subject->width : subject->height;
    if (edge > LARGEST)
        return (map_shape){(uint32_t)fmax((double)subject->width * LARGEST / edge, 1),
                           (uint32_t)fmax((double)subject->height * LARGEST / edge, 1)};
    uint32_t zoom = edge < SMALLEST ? (SMALLEST + edge - 1) / edge : 1;
    return (map_shape){subject->width * zoom, subject->height * zoom};
}

static uint32_t edge_of(uint32_t index, uint32_t pixels, uint32_t drawn)
{
    return (uint32_t)((uint64_t)index * pixels / drawn);
}

/* The mean of the errors that a drawn pixel covers, at least one; NaN where none of them was compared. */
static double covered(const error_figure *subject, const map_shape *shape, uint32_t row, uint32_t column)
{
    uint32_t top = edge_of(row, subject->height, shape->height),
             bottom = edge_of(row + 1, subject->height, shape->height);
    uint32_t left = edge_of(column, subject->width, shape->width);
    uint32_t right = edge_of(column + 1, subject->width, shape->width), count = 0;
    double sum = 0;
    for (uint32_t y = top; y < bottom || y == top; y++)
        for (uint32_t x = left; x < right || x == left; x++) {
            float error = subject->errors[(size_t)y * subject->width + x];
            if (isnan(error))
                continue;
            sum += (double)error;
            count++;
        }
    return count > 0 ? sum / count : (double)NAN;
}

static uint32_t pack(const double rgb[3])
{
    return (uint32_t)(rgb[0] * 255 + 0.5) << 16 | (uint32_t)(rgb[1] * 255 + 0.5) << 8 | (uint32_t)(rgb[2] * 255 + 0.5);
}

static uint32_t colour_of(double error, double range)
{
    double rgb[3] = {RULE, RULE, RULE};
    if (!isnan(error))
        false_colour(error / range, rgb);
    return pack(rgb);
}

static void draw_map(cairo_t *cairo, const error_figure *subject, const map_shape *shape)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)shape->width, (int)shape->height);
    unsigned char *data = cairo_image_surface_get_data(surface);
    size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    for (uint32_t row = 0; data != NULL && row < shape->height; row++)
        for (uint32_t column = 0; column < shape->width; column++) {
            uint32_t pixel = colour_of(covered(subject, shape, row, column), subject->range);
            memcpy(data + row * stride + 4 * (size_t)column, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
    cairo_set_source_surface(cairo, surface, MARGIN, MARGIN);
    cairo_paint(cairo);
    cairo_surface_destroy(surface);
}

/* ---- the legend ---------------------------------------------------------------------------- */

static const char *quantity_of(helio_error_map map)
{
    static const char *const quantities[] = {
        [HELIO_ERROR_MAP_LAB] = "\u0394E*ab, CIE 1976 L*a*b*",
        [HELIO_ERROR_MAP_DE2000] = "\u0394E00, CIEDE2000",
        [HELIO_ERROR_MAP_RELATIVE] = "(a \u2212 b)\u00b2 / (b\u00b2 + \u03b5), relative squared error of radiance",
        [HELIO_ERROR_MAP_FLIP] = "FLIP, 0 to 1",
    };
    return quantities[map];
}

static double mean_of(const error_figure *subject)
{
    const helio_comparison_info *info = subject->info;
    const double means[] = {
        [HELIO_ERROR_MAP_LAB] = info->lab_mean,
        [HELIO_ERROR_MAP_DE2000] = info->de2000_mean,
        [HELIO_ERROR_MAP_RELATIVE] = info->relmse,
        [HELIO_ERROR_MAP_FLIP] = info->flip,
    };
    return means[subject->map];
}

static void draw_scale(cairo_t *cairo, const error_figure *subject, double left, double top, double width)
{
    bool is_exceeded = count_above(subject->errors, (size_t)subject->width * subject->height, subject->range) > 0;
    for (int x = 0; x < (int)width; x++) {
        double rgb[3];
        false_colour((x + 0.5) / width, rgb);
        cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]);
        cairo_rectangle(cairo, left + x, top, 1, BAR_HEIGHT);
        cairo_fill(cairo);
    }
    set_font(cairo, 11, false);
    for (int i = 0; i <= INTERVALS; i++) {
        char text[32];
        double x = left + width * i / INTERVALS;
        snprintf(text, sizeof text, "%s%g", i == INTERVALS && is_exceeded ? "\u2265 " : "",
                 subject->range * i / INTERVALS);
        set_grey(cairo, FAINT);
        cairo_rectangle(cairo, fmin(x, left + width - 1), top + BAR_HEIGHT, 1, 4);
        cairo_fill(cairo);
        draw_text(cairo, x, top + BAR_HEIGHT + 16, i == 0 ? 0 : i == INTERVALS ? 1 : 0.5, text);
    }
}

static void draw_words(cairo_t *cairo, const error_figure *subject, double left, double top, double width)
{
    const helio_comparison_info *info = subject->info;
    char text[512];
    snprintf(text, sizeof text, "%s: mean %.4g", quantity_of(subject->map), mean_of(subject));
    set_font(cairo, 13, true);
    set_grey(cairo, INK);
    top = draw_paragraph(cairo, left, top, width, 17, text);
    snprintf(text, sizeof text, "over %" PRIu64 " pixels", info->pixels);
    if (info->skipped > 0)
        snprintf(text + strlen(text), sizeof text - strlen(text), ", %" PRIu64 " left out as NaN or infinite",
                 info->skipped);
    if (subject->map != HELIO_ERROR_MAP_RELATIVE)
        snprintf(text + strlen(text), sizeof text - strlen(text), "; shown at %+.2f stops, white D65",
                 subject->exposure);
    set_font(cairo, 11, false);
    set_grey(cairo, FAINT);
    top = draw_paragraph(cairo, left, top, width, 14, text);
    snprintf(text, sizeof text, "%.200s against %.200s", subject->picture, subject->reference);
    draw_paragraph(cairo, left, top, width, 14, text);
}

static void draw_all(cairo_t *cairo, const void *data)
{
    const error_figure *subject = data;
    map_shape shape = choose_shape(subject);
    double width = fmax(shape.width, SMALLEST), top = MARGIN + shape.height + 12;
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    draw_map(cairo, subject, &shape);
    draw_scale(cairo, subject, MARGIN, top, width);
    draw_words(cairo, subject, MARGIN, top + BAR_HEIGHT + 40, width);
}

int error_figure_write(const char *path, const error_figure *subject)
{
    map_shape shape = choose_shape(subject);
    const figure drawn = {.width = (int)fmax(shape.width, SMALLEST) + 2 * MARGIN,
                          .height = (int)shape.height + 2 * MARGIN + LEGEND_HEIGHT - MARGIN,
                          .draw = draw_all,
                          .data = subject};
    return figure_write("out", path, &drawn);
}
