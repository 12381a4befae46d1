/* SPDX-License-Identifier: MIT */
#include "canvas.h"

#include <cairo.h>
#include <math.h>

static void set_colour(cairo_t *cairo, uint32_t colour)
{
    cairo_set_source_rgb(cairo, (colour >> 16) / 255.0, (colour >> 8 & 255) / 255.0, (colour & 255) / 255.0);
}

static void draw_line(canvas *on, const canvas_stroke *stroke, const double (*points)[2], size_t count)
{
    cairo_t *cairo = on->data;
    cairo_new_path(cairo);
    for (size_t i = 0; i < count; i++)
        cairo_line_to(cairo, points[i][0], points[i][1]);
    set_colour(cairo, stroke->colour);
    cairo_set_line_width(cairo, stroke->width);
    cairo_set_dash(cairo, &stroke->dash, stroke->dash > 0 ? 1 : 0, 0);
    cairo_stroke(cairo);
}

static void draw_dot(canvas *on, uint32_t colour, double x, double y, double radius)
{
    cairo_t *cairo = on->data;
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius, 0, 2 * acos(-1));
    set_colour(cairo, colour);
    cairo_fill(cairo);
}

static void draw_text(canvas *on, const canvas_text *style, double x, double y, const char *text)
{
    static const double parts[] = {[CANVAS_START] = 0, [CANVAS_MIDDLE] = 0.5, [CANVAS_END] = 1};
    cairo_t *cairo = on->data;
    cairo_text_extents_t extents;
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           style->bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, style->size);
    cairo_text_extents(cairo, text, &extents);
    cairo_save(cairo);
    cairo_translate(cairo, x, y);
    if (style->upwards)
        cairo_rotate(cairo, -acos(-1) / 2);
    cairo_move_to(cairo, -parts[style->align] * extents.x_advance, 0);
    set_colour(cairo, style->colour);
    cairo_show_text(cairo, text);
    cairo_restore(cairo);
}

canvas canvas_on_cairo(void *cairo)
{
    return (canvas){draw_line, draw_dot, draw_text, cairo};
}
