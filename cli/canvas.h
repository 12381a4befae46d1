/* SPDX-License-Identifier: MIT
 * canvas.h - what line drawings are made on: SVG within a page, or cairo for PDF. Units are pixels or points, x to the
 * right, y down; colours 0xRRGGBB. */
#ifndef HELIOSTAT_CLI_CANVAS_H
#define HELIOSTAT_CLI_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct canvas canvas;

typedef struct canvas_stroke {
    uint32_t colour;
    double width;
    double dash; /* length of dashes and gaps; 0: none */
} canvas_stroke;

typedef enum canvas_align { CANVAS_START, CANVAS_MIDDLE, CANVAS_END } canvas_align;

typedef struct canvas_text {
    uint32_t colour;
    double size;
    bool bold;
    canvas_align align;
    bool upwards; /* turned, to be read from the right */
} canvas_text;

struct canvas {
    void (*line)(canvas *on, const canvas_stroke *stroke, const double (*points)[2], size_t count);
    void (*dot)(canvas *on, uint32_t colour, double x, double y, double radius);
    void (*text)(canvas *on, const canvas_text *style, double x, double y, const char *text);
    void *data; /* FILE of an SVG, cairo_t */
};

/* Draws with SVG elements. stream: a FILE, between <svg> and </svg>. */
canvas canvas_on_svg(void *stream);

/* cairo: a cairo_t. Not in builds without cairo. */
canvas canvas_on_cairo(void *cairo);

/* Text with <, >, & and quotes as XML has them, and without control characters. stream: a FILE. */
void canvas_write_escaped(void *stream, const char *text);

#endif
