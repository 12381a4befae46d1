/* SPDX-License-Identifier: MIT
 * The histogram of the picture. Its axis is the scale of the colours. */
#include "inspect_drawing.h"

#include <math.h>
#include <stdio.h>

enum { PARTS = 2, MOST_BARS = (MOST_STOPS + LEAST_STOPS) * PARTS }; /* bars for a stop; bars */

typedef struct bar_chart {
    double left, top, width, height;
    int bars;
    double area[MOST_BARS], light[MOST_BARS]; /* parts of all */
    double most;                              /* at the top of the chart */
} bar_chart;

static void sum_bars(const drawing *d, bar_chart *chart)
{
    const inspect_histogram *histogram = &d->found->histogram;
    double sphere = 4 * acos(-1), light = d->found->all_flux > 0 ? d->found->all_flux : 1;
    chart->bars = (int)(d->scale.high - d->scale.low) * PARTS;
    for (int i = 0; i < HISTOGRAM_BINS; i++) {
        double stop = (double)i / STOP_BINS + LOWEST_STOP - d->scale.low;
        int bar = (int)fmin(fmax(floor(stop * PARTS), 0), chart->bars - 1);
        chart->area[bar] += histogram->area[i] / sphere;
        chart->light[bar] += histogram->light[i] / light;
    }
    double most = 0;
    for (int i = 0; i < chart->bars; i++)
        most = fmax(most, fmax(chart->area[i], chart->light[i]));
    chart->most = fmax(ceil(most * 20) / 20, 0.05);
}

static double bar_x(const bar_chart *chart, double bar)
{
    return chart->left + chart->width * bar / chart->bars;
}

static double bar_y(const bar_chart *chart, double part)
{
    return chart->top + chart->height * (1 - part / chart->most);
}

static void draw_levels(const drawing *d, const bar_chart *chart)
{
    double step = chart->most > 0.5 ? 0.2 : chart->most > 0.2 ? 0.1 : chart->most > 0.1 ? 0.05 : 0.02;
    cairo_t *cairo = d->cairo;
    set_font(cairo, 11, false);
    cairo_set_line_width(cairo, 1);
    for (int i = 0; i * step <= chart->most + 1e-9; i++) {
        double y = floor(bar_y(chart, i * step)) + 0.5;
        char text[16];
        snprintf(text, sizeof text, "%.0f %%", 100 * i * step);
        set_grey(cairo, RULE);
        cairo_move_to(cairo, chart->left, y);
        cairo_line_to(cairo, chart->left + chart->width, y);
        cairo_stroke(cairo);
        set_grey(cairo, FAINT);
        draw_text(cairo, chart->left - 6, y + 4, 1, text);
    }
}

static void draw_bars(const drawing *d, const bar_chart *chart)
{
    cairo_t *cairo = d->cairo;
    for (int i = 0; i < chart->bars; i++) {
        double rgb[3];
        colour_scale_colour(&d->scale, d->scale.low + (i + 0.5) / PARTS, rgb);
        cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]);
        double y = bar_y(chart, chart->area[i]), left = bar_x(chart, i), right = bar_x(chart, i + 1);
        cairo_rectangle(cairo, left + 0.5, y, right - left - 1, chart->top + chart->height - y);
        cairo_fill_preserve(cairo);
        set_grey(cairo, FAINT); /* the darkest bars would not be seen otherwise */
        cairo_set_line_width(cairo, 0.5);
        cairo_stroke(cairo);
    }
    for (int i = 0; i < chart->bars; i++) {
        double y = bar_y(chart, chart->light[i]);
        cairo_line_to(cairo, bar_x(chart, i), y);
        cairo_line_to(cairo, bar_x(chart, i + 1), y);
    }
    set_accent(cairo);
    cairo_set_line_width(cairo, 1.5);
    cairo_stroke(cairo);
}

/* As short as can be: labels stand side by side. */
static void format_value(double value, char text[32])
{
    int exponent = (int)floor(log10(value));
    if (value >= 1e9 || value < 1e-3)
        snprintf(text, 32, "%.1fe%d", value / pow(10, exponent), exponent);
    else if (value >= 1e6)
        snprintf(text, 32, "%.3gM", value / 1e6);
    else if (value >= 1e4)
        snprintf(text, 32, "%.3gk", value / 1e3);
    else
        snprintf(text, 32, value >= 1 ? "%.0f" : "%.2g", value);
}

/* The colours' scale, which is the histogram's axis: in stops, and in the map's unit. */
static void draw_scale(const drawing *d, const bar_chart *chart)
{
    enum { BAR = 12, STEPS = 256 };
    cairo_t *cairo = d->cairo;
    double top = chart->top + chart->height + 4;
    for (int i = 0; i < STEPS; i++) {
        double rgb[3], left = chart->left + chart->width * i / STEPS;
        colour_scale_colour(&d->scale, d->scale.low + (i + 0.5) / STEPS * (d->scale.high - d->scale.low), rgb);
        cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]);
        cairo_rectangle(cairo, left, top, fmin(chart->width / STEPS + 1, chart->left + chart->width - left), BAR);
        cairo_fill(cairo);
    }
    int stops = (int)(d->scale.high - d->scale.low), step = stops > 20 ? 4 : stops > 8 ? 2 : 1;
    set_font(cairo, 11, false);
    for (int stop = (int)ceil(d->scale.low / step) * step; stop <= (int)d->scale.high; stop += step) {
        double x = bar_x(chart, (stop - d->scale.low) * PARTS);
        char text[32];
        cairo_set_line_width(cairo, 1);
        set_grey(cairo, FAINT);
        cairo_move_to(cairo, floor(x) + 0.5, top + BAR);
        cairo_line_to(cairo, floor(x) + 0.5, top + BAR + 4);
        cairo_stroke(cairo);
        snprintf(text, sizeof text, stop == 0 ? "0" : "%+d", stop);
        set_grey(cairo, INK);
        draw_text(cairo, x, top + BAR + 17, 0.5, text);
        format_value(exp2(stop), text);
        set_grey(cairo, FAINT);
        draw_text(cairo, x, top + BAR + 32, 0.5, text);
    }
    set_grey(cairo, FAINT);
    draw_text(cairo, chart->left - 30, top + BAR + 17, 1, "stops");
    draw_text(cairo, chart->left - 30, top + BAR + 32, 1, "lum.");
}

void draw_histogram(const drawing *d, double left, double top, double width, double height)
{
    bar_chart chart = {.left = left + 60, .top = top + 38, .width = width - 80, .height = height - 92};
    cairo_t *cairo = d->cairo;
    sum_bars(d, &chart);
    draw_levels(d, &chart);
    draw_bars(d, &chart);
    draw_scale(d, &chart);
    set_font(cairo, 13, false);
    set_grey(cairo, INK);
    double y = top + 16;
    const char *bars = "bars: parts of the sphere", *line = "line: parts of the light, in half stops of luminance";
    draw_text(cairo, left, y, 0, bars);
    set_accent(cairo);
    draw_text(cairo, left + text_width(cairo, bars) + 24, y, 0, line);
}
