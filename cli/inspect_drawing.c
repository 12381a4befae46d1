/* SPDX-License-Identifier: MIT */
#include "inspect_drawing.h"

#include "false_colour.h"

#include <math.h>

const double BACKGROUND = 0.09, INK = 0.93, FAINT = 0.62, RULE = 0.3;

/* ---- scale -------------------------------------------------------------------------------- */

static double lit_area(const inspect_histogram *histogram)
{
    double area = 0;
    for (int i = 0; i < HISTOGRAM_BINS; i++)
        area += histogram->area[i];
    return area;
}

/* The stop below which that part of the lit area lies. */
static double find_stop(const inspect_histogram *histogram, double part)
{
    double wanted = part * lit_area(histogram), below = 0;
    int bin = 0;
    while (bin < HISTOGRAM_BINS - 1 && below + histogram->area[bin] <= wanted)
        below += histogram->area[bin++];
    return (double)bin / STOP_BINS + LOWEST_STOP;
}

static double find_greatest(const inspect_histogram *histogram)
{
    int bin = HISTOGRAM_BINS - 1;
    while (bin > 0 && histogram->area[bin] <= 0)
        bin--;
    return (double)bin / STOP_BINS + LOWEST_STOP;
}

/* In whole stops. */
colour_scale colour_scale_choose(const inspect_histogram *histogram)
{
    if (!(lit_area(histogram) > 0))
        return (colour_scale){-LEAST_STOPS / 2.0, LEAST_STOPS / 2.0, LEAST_STOPS / 2.0};
    colour_scale scale = {.low = floor(find_stop(histogram, 0.005)), .high = floor(find_greatest(histogram)) + 1};
    double lacking = LEAST_STOPS - (scale.high - scale.low);
    if (lacking > 0) {
        scale.low -= floor(lacking / 2);
        scale.high += ceil(lacking / 2);
    }
    scale.low = fmax(scale.low, scale.high - MOST_STOPS);
    scale.knee = fmin(fmax(floor(find_stop(histogram, 0.995)) + 1, scale.low + 1), scale.high);
    return scale;
}

void colour_scale_colour(const colour_scale *scale, double stop, double rgb[3])
{
    const double share = 0.7; /* of the colours, at least, for what lies below the knee */
    double even = (scale->knee - scale->low) / (scale->high - scale->low), below = fmax(even, share);
    if (stop < scale->knee || scale->knee >= scale->high)
        false_colour(below * (stop - scale->low) / (scale->knee - scale->low), rgb);
    else
        false_colour(below + (1 - below) * (stop - scale->knee) / (scale->high - scale->knee), rgb);
}

/* ---- text --------------------------------------------------------------------------------- */

void set_grey(cairo_t *cairo, double grey)
{
    cairo_set_source_rgb(cairo, grey, grey, grey);
}

void set_accent(cairo_t *cairo)
{
    cairo_set_source_rgb(cairo, 0.35, 0.95, 1);
}

void set_font(cairo_t *cairo, double size, bool bold)
{
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
}

double text_width(cairo_t *cairo, const char *text)
{
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, text, &extents);
    return extents.x_advance;
}

void draw_text(cairo_t *cairo, double x, double y, double align, const char *text)
{
    cairo_move_to(cairo, x - align * text_width(cairo, text), y);
    cairo_show_text(cairo, text);
}
