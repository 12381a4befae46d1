/* SPDX-License-Identifier: MIT
 * cube_cross.h - a cube unfolded as the layout cross-h, as figures show it. */
#ifndef HELIOSTAT_CLI_CUBE_CROSS_H
#define HELIOSTAT_CLI_CUBE_CROSS_H

#include "face.h"

#include <cairo.h>

/* Four faces wide and three high. */
typedef struct cube_cross {
    double left, top, edge; /* edge: of a face */
} cube_cross;

typedef struct cube_picture {
    const float *cube; /* [6][size][size][3] */
    uint32_t size;
    int pixels; /* along the edge of a face */

    /* The colour, in sRGB, of the mean of the texels that a pixel covers. */
    void (*colour)(const void *data, const double rgb[3], double shown[3]);
    const void *data;
} cube_picture;

/* Texels that are larger than pixels show as squares. */
void cube_cross_draw(cairo_t *cairo, const cube_cross *cross, const cube_picture *picture);

/* The upper left corner of a face. */
void cube_cross_corner(const cube_cross *cross, int face, double *x, double *y);

/* Where a direction of any length is seen. */
void cube_cross_place(const cube_cross *cross, const double direction[3], double *x, double *y);

/* Frames the face and writes into its upper left corner. */
void cube_cross_label(cairo_t *cairo, const cube_cross *cross, int face, double font_size, const char *text);

/* Nothing but faces can be drawn on from here on. */
void cube_cross_clip(cairo_t *cairo, const cube_cross *cross);

#endif
