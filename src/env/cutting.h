/* SPDX-License-Identifier: MIT
 * cutting.h - cuts a polygon on the sphere along the borders of the cube's texels, and measures the parts.
 *
 * Arcs of great circles are straight lines on the faces of the cube, so that each part is a planar polygon there, whose
 * solid angle is known exactly. */
#ifndef HELIOSTAT_SRC_CUTTING_H
#define HELIOSTAT_SRC_CUTTING_H

#include "env/cube.h"
#include "env/outline.h"

/* The texels of a face that are wanted. */
typedef struct texel_window {
    uint32_t first_row, end_row, first_column, end_column;
} texel_window;

/* A part of the polygon in one texel. */
typedef struct texel_part {
    uint32_t texel; /* (face R + row) R + column */
    float area;     /* sr */
} texel_part;

/* Takes the parts. */
typedef struct cutting {
    uint32_t size; /* R */
    texel_window windows[CUBE_FACES];
    double least;      /* parts up to this area, sr, are roundings and left out */
    texel_part *parts; /* NULL: they are only counted */
    size_t count;      /* so far */
} cutting;

/* Polygons turn to the left on the faces, as pieces of maps that are seen from inside do. */
void cut_outline(const outline *polygon, cutting *result);

#endif
