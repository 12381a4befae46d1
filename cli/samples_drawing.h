/* SPDX-License-Identifier: MIT
 * samples_drawing.h - the parts of the figures of samples. */
#ifndef HELIOSTAT_CLI_SAMPLES_DRAWING_H
#define HELIOSTAT_CLI_SAMPLES_DRAWING_H

#include "cube_cross.h"
#include "figure_text.h"
#include "samples.h"

/* In pixels, or points. */
enum { SAMPLES_MARGIN = 24 };

typedef struct samples_drawing {
    cairo_t *cairo;
    const samples_view *view;
    cube_cross cross;
    double size; /* of marks: 1 in a figure of one frame */
    int detail;  /* pixels along the edge of a point, for pictures in files that can be magnified */
} samples_drawing;

/* How many pixels a figure has for a point, by the end of its path. */
int samples_detail(const char *path);

/* The map as the render shows it, darkened below the point's horizon; upon it the pools, then the counts of each face
 * in the corners of the cross, then the point's own samples and its normal. */
void samples_draw_map(const samples_drawing *d);
void samples_draw_pools(const samples_drawing *d);
void samples_draw_face_labels(const samples_drawing *d, double font_size);
void samples_draw_samples(const samples_drawing *d);

/* What the marks look like that stand for samples. */
typedef enum samples_mark {
    MARK_POOLED,
    MARK_USED,
    MARK_SHADOWED,
    MARK_USELESS,
    MARK_SURFACE_USED,
    MARK_SURFACE_SHADOWED,
    MARK_SURFACE_USELESS,
    MARK_NORMAL,
    MARK_HORIZON,
    MARK_FLAT_HORIZON, /* of the flat surface */
    MARK_COUNT
} samples_mark;

void samples_draw_mark(cairo_t *cairo, samples_mark mark, double x, double y, double size);
void samples_set_mark_colour(cairo_t *cairo, samples_mark mark);

/* Pooled samples are thousands: they are added to a path, and stroked together. */
void samples_add_dot(cairo_t *cairo, double x, double y);
void samples_stroke_dots(cairo_t *cairo, double size);

/* Strokes the path, which stays. */
void samples_stroke_horizon(cairo_t *cairo, double size, bool is_dashed);

/* Is the horizon of the flat surface one of its own, more than a hair beside that of the normal? */
bool samples_has_flat_horizon(const samples_findings *found);

/* The render, as large as fits in the box, at its upper left; the pixel is marked. */
void samples_draw_render(const samples_drawing *d, double left, double top, double width, double height);

/* What each mark means, with counts. Returns the y below. title_width: of the longest text. */
double samples_draw_legend(const samples_drawing *d, double left, double top, double width);

/* The legend of several frames: marks without counts, side by side from the left. */
void samples_draw_key(cairo_t *cairo, const samples_findings *found, double left, double y);

/* What was asked for, and the table of counts. */
void samples_draw_title(const samples_drawing *d, double left, double top, double width);
void samples_draw_table(const samples_drawing *d, double left, double top, double width);

/* The counts as bars, one for each technique. */
void samples_draw_bars(const samples_drawing *d, double left, double bottom, double width);

#endif
