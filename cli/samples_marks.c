/* SPDX-License-Identifier: MIT */
#include "samples_drawing.h"

#include <math.h>

static const double RED[3] = {0.95, 0.13, 0.16}, GREEN[3] = {0.16, 0.86, 0.32}, YELLOW[3] = {1, 0.84, 0.1};
static const double BLUE[3] = {0.16, 0.42, 1}, VIOLET[3] = {0.85, 0.45, 1};

static const double POOLED_RADIUS = 1.1;

static void set_colour(cairo_t *cairo, const double rgb[3])
{
    cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]);
}

/* Filled, or as a ring; with a dark seam. */
static void paint_shape(cairo_t *cairo, const double rgb[3], double size, bool is_hollow)
{
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.85);
    cairo_set_line_width(cairo, (is_hollow ? 3.4 : 1.8) * size);
    cairo_stroke_preserve(cairo);
    set_colour(cairo, rgb);
    cairo_set_line_width(cairo, 1.6 * size);
    if (is_hollow)
        cairo_stroke(cairo);
    else
        cairo_fill(cairo);
}

static void draw_disc(cairo_t *cairo, double x, double y, double radius, const double rgb[3], double size,
                      bool is_hollow)
{
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius * size, 0, 2 * acos(-1));
    cairo_close_path(cairo);
    paint_shape(cairo, rgb, size, is_hollow);
}

static void draw_diamond(cairo_t *cairo, double x, double y, const double rgb[3], double size, bool is_hollow)
{
    double radius = 4.6 * size;
    cairo_new_path(cairo);
    cairo_move_to(cairo, x, y - radius);
    cairo_line_to(cairo, x + radius, y);
    cairo_line_to(cairo, x, y + radius);
    cairo_line_to(cairo, x - radius, y);
    cairo_close_path(cairo);
    paint_shape(cairo, rgb, size, is_hollow);
}

static void draw_normal(cairo_t *cairo, double x, double y, double size)
{
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, 6 * size, 0, 2 * acos(-1));
    set_colour(cairo, BLUE);
    cairo_fill_preserve(cairo);
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.85);
    cairo_set_line_width(cairo, 4 * size);
    cairo_stroke_preserve(cairo);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_set_line_width(cairo, 2 * size);
    cairo_stroke(cairo);
}

void samples_add_dot(cairo_t *cairo, double x, double y)
{
    cairo_move_to(cairo, x, y);
    cairo_line_to(cairo, x, y);
}

void samples_stroke_dots(cairo_t *cairo, double size)
{
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(cairo, 2 * POOLED_RADIUS * size);
    set_colour(cairo, RED);
    cairo_stroke(cairo);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
}

/* Bright on a dark seam, to be seen on anything. */
void samples_stroke_horizon(cairo_t *cairo, double size, bool is_dashed)
{
    const double dashes[] = {5 * size, 4 * size};
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.6);
    cairo_set_line_width(cairo, 3 * size);
    cairo_set_dash(cairo, dashes, is_dashed ? 2 : 0, 0);
    cairo_stroke_preserve(cairo);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_set_line_width(cairo, 1.3 * size);
    cairo_stroke(cairo);
    cairo_set_dash(cairo, NULL, 0, 0);
}

static void draw_horizon_sample(cairo_t *cairo, double x, double y, double size, bool is_dashed)
{
    cairo_new_path(cairo);
    cairo_move_to(cairo, x - 9 * size, y);
    cairo_line_to(cairo, x + 9 * size, y);
    samples_stroke_horizon(cairo, size, is_dashed);
}

void samples_draw_mark(cairo_t *cairo, samples_mark mark, double x, double y, double size)
{
    const double radius = 3.6;
    switch (mark) {
    case MARK_POOLED:
        cairo_new_path(cairo);
        samples_add_dot(cairo, x, y);
        samples_stroke_dots(cairo, size);
        break;
    case MARK_USED: draw_disc(cairo, x, y, radius, GREEN, size, false); break;
    case MARK_SHADOWED: draw_disc(cairo, x, y, radius, GREEN, size, true); break;
    case MARK_USELESS: draw_disc(cairo, x, y, radius, YELLOW, size, false); break;
    case MARK_SURFACE_USED: draw_diamond(cairo, x, y, VIOLET, size, false); break;
    case MARK_SURFACE_SHADOWED: draw_diamond(cairo, x, y, VIOLET, size, true); break;
    case MARK_SURFACE_USELESS: draw_diamond(cairo, x, y, YELLOW, size, false); break;
    case MARK_NORMAL: draw_normal(cairo, x, y, size); break;
    case MARK_HORIZON: draw_horizon_sample(cairo, x, y, size, false); break;
    case MARK_FLAT_HORIZON: draw_horizon_sample(cairo, x, y, size, true); break;
    case MARK_COUNT: break;
    }
}

void samples_set_mark_colour(cairo_t *cairo, samples_mark mark)
{
    switch (mark) {
    case MARK_POOLED: set_colour(cairo, RED); break;
    case MARK_USED:
    case MARK_SHADOWED: set_colour(cairo, GREEN); break;
    case MARK_USELESS:
    case MARK_SURFACE_USELESS: set_colour(cairo, YELLOW); break;
    case MARK_SURFACE_USED:
    case MARK_SURFACE_SHADOWED: set_colour(cairo, VIOLET); break;
    case MARK_NORMAL: set_colour(cairo, BLUE); break;
    default: set_grey(cairo, INK); break;
    }
}
