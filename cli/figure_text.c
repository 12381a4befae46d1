/* SPDX-License-Identifier: MIT */
#include "figure_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const double BACKGROUND = 0.09, INK = 0.93, FAINT = 0.62, RULE = 0.3;

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

void draw_name(cairo_t *cairo, double x, double y, double width, const char *name)
{
    enum { LARGEST = 17, SMALLEST = 11 };
    char text[256];
    const char *rest = name;
    int size = LARGEST;
    snprintf(text, sizeof text, "%s", name);
    set_font(cairo, size, true);
    while (size > SMALLEST && text_width(cairo, text) > width)
        set_font(cairo, --size, true);
    while (*rest != 0 && text_width(cairo, text) > width) {
        rest++;
        while ((*rest & 0xc0) == 0x80) /* in the middle of a character */
            rest++;
        snprintf(text, sizeof text, "\u2026%s", rest);
    }
    draw_text(cairo, x, y, 0, text);
}

double draw_paragraph(cairo_t *cairo, double x, double y, double width, double line, const char *text)
{
    char row[256] = "";
    while (*text != 0) {
        size_t word = strcspn(text, " "), used = strlen(row);
        char longer[2 * sizeof row];
        snprintf(longer, sizeof longer, "%s%s%.*s", row, used ? " " : "", (int)(word < 128 ? word : 128), text);
        if (used > 0 && text_width(cairo, longer) > width) {
            draw_text(cairo, x, y, 0, row);
            y += line;
            row[0] = 0;
            continue;
        }
        snprintf(row, sizeof row, "%.*s", (int)sizeof row - 1, longer);
        text += word;
        text += strspn(text, " ");
    }
    draw_text(cairo, x, y, 0, row);
    return y + line;
}

double draw_entry(cairo_t *cairo, const text_box *box, double y, const char *label, const char *text)
{
    enum { LINE = 21 };
    set_font(cairo, 13, false);
    set_grey(cairo, FAINT);
    draw_text(cairo, box->left, y, 0, label);
    set_grey(cairo, INK);
    return draw_paragraph(cairo, box->left + box->label_width, y, box->width - box->label_width, LINE, text);
}

void draw_ring(cairo_t *cairo, double x, double y, double radius)
{
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius, 0, 2 * acos(-1));
    cairo_set_line_width(cairo, 4);
    set_grey(cairo, BACKGROUND);
    cairo_stroke_preserve(cairo);
    cairo_set_line_width(cairo, 2);
    set_accent(cairo);
    cairo_stroke(cairo);
}
