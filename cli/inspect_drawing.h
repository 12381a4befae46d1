/* SPDX-License-Identifier: MIT
 * inspect_drawing.h - what the parts of the picture that inspect draws have in common. */
#ifndef HELIOSTAT_CLI_INSPECT_DRAWING_H
#define HELIOSTAT_CLI_INSPECT_DRAWING_H

#include "figure_text.h"
#include "inspect.h"

/* In pixels, or points. */
enum { FACE_EDGE = 288, MARGIN = 24, WIDTH = 4 * FACE_EDGE + 2 * MARGIN, HEIGHT = 3 * FACE_EDGE + 2 * MARGIN };

enum { LEAST_STOPS = 4, MOST_STOPS = 32 }; /* that the colours stand for */

/* Luminances as powers of two. From low to knee they get most of the colours, as most of the map is there; what lies
 * from there to high is lights. */
typedef struct colour_scale {
    double low, knee, high;
} colour_scale;

typedef struct drawing {
    cairo_t *cairo;
    const inspect_findings *found;
    const float *cube;
    colour_scale scale;
} drawing;

colour_scale colour_scale_choose(const inspect_histogram *histogram);

/* The colour, as false_colour(), of a luminance that is given as a power of two. */
void colour_scale_colour(const colour_scale *scale, double stop, double rgb[3]);

/* Both begin at the upper left corner. */
void draw_findings(const drawing *d, double left, double top, double width);
void draw_histogram(const drawing *d, double left, double top, double width, double height);

#endif
