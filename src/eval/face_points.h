/* SPDX-License-Identifier: MIT
 * face_points.h - places on a face with the light that they stand for, on their way to become directions. */
#ifndef HELIOSTAT_SRC_FACE_POINTS_H
#define HELIOSTAT_SRC_FACE_POINTS_H

#include "sampling/gathering.h"

/* Each array: [BLOCK_STRIDE], of which kernels read whole registers. */
typedef struct face_points {
    uint32_t face, count;
    alignas(64) float u[BLOCK_STRIDE];
    alignas(64) float v[BLOCK_STRIDE];
    alignas(64) float area[BLOCK_STRIDE]; /* on the face */
    /* 0: the light lies at (u, v). Else it is spread over a square of this edge, squared and divided by 24: the place
     * moves, and the area changes, so that what is linear in u and v has its exact sum, but for edge^4. */
    alignas(64) float spread[BLOCK_STRIDE];
    alignas(64) float red[BLOCK_STRIDE]; /* radiance */
    alignas(64) float green[BLOCK_STRIDE];
    alignas(64) float blue[BLOCK_STRIDE];
} face_points;

static inline void face_points_add(face_points *points, double u, double v, double area, double spread,
                                   const float *rgb)
{
    uint32_t i = points->count++;
    points->u[i] = (float)u;
    points->v[i] = (float)v;
    points->area[i] = (float)area;
    points->spread[i] = (float)spread;
    points->red[i] = rgb[0];
    points->green[i] = rgb[1];
    points->blue[i] = rgb[2];
}

#endif
