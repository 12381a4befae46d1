/* SPDX-License-Identifier: MIT
 * outline.h - the outline of a piece of a square map as a polygon on the sphere.
 *
 * The straight edges of the piece are curves there. They become chains of arcs of great circles, with more points where
 * they bend more. Neighbours have the very same points on the edge between them, so that the pieces of a map fill the
 * sphere without gaps and overlaps. What lies outside of a disc shrinks to its rim, which is one direction. */
#ifndef HELIOSTAT_SRC_OUTLINE_H
#define HELIOSTAT_SRC_OUTLINE_H

#include "env/projection.h"

/* Pieces must not be larger than 2 / OUTLINE_LEAST_PIECES each way; see OUTLINE_DEPTH in outline.c for the points. */
enum { OUTLINE_LEAST_PIECES = 64, OUTLINE_EDGE_POINTS = 64, OUTLINE_POINTS = 4 * OUTLINE_EDGE_POINTS };

typedef struct outline {
    int count; /* 0: the piece has no part of the sphere */
    direction points[OUTLINE_POINTS];
} outline;

/* The piece between these coordinates. */
void outline_trace(const projection *map, const double right[2], const double down[2], outline *result);

#endif
