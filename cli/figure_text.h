/* SPDX-License-Identifier: MIT
 * figure_text.h - the greys, the words and the marks of all figures. */
#ifndef HELIOSTAT_CLI_FIGURE_TEXT_H
#define HELIOSTAT_CLI_FIGURE_TEXT_H

#include <cairo.h>
#include <stdbool.h>

extern const double BACKGROUND, INK, FAINT, RULE; /* greys */
void set_grey(cairo_t *cairo, double grey);
void set_accent(cairo_t *cairo);
void set_font(cairo_t *cairo, double size, bool bold);
double text_width(cairo_t *cairo, const char *text);

/* align: 0 begins at x, 0.5 is centred there, 1 ends there. */
void draw_text(cairo_t *cairo, double x, double y, double align, const char *text);

/* In bold; smaller if it is wide, and then its start is cut off, as the end of a name tells more. */
void draw_name(cairo_t *cairo, double x, double y, double width, const char *name);

/* Breaks lines at blanks. Returns the y of the next line. */
double draw_paragraph(cairo_t *cairo, double x, double y, double width, double line, const char *text);

typedef struct text_box {
    double left, width, label_width;
} text_box;

/* A faint label, and beside it a text that may take several lines. Returns the y of the next line. */
double draw_entry(cairo_t *cairo, const text_box *box, double y, const char *label, const char *text);

/* In the accent's colour, to be seen on anything. */
void draw_ring(cairo_t *cairo, double x, double y, double radius);

#endif
