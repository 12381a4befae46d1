/* SPDX-License-Identifier: MIT
 * projection.h - square maps of the whole sphere: where a point of the square lies on the sphere.
 *
 * Points of the square are (right, down), both from -1 to 1, its centre 0. Two kinds of layouts: squares that are
 * folded around the sphere, all four corners meeting in -Y, and discs, whose rim is the direction +Z. Both are drawn as
 * who stands inside sees them (and the faces of the cube as from outside). */
#ifndef HELIOSTAT_SRC_PROJECTION_H
#define HELIOSTAT_SRC_PROJECTION_H

#include <heliostat/image.h>

typedef struct direction {
    double x, y, z;
} direction;

typedef struct projection {
    /* Unit vector; of discs for points inside of the disc alone. */
    direction (*find)(double right, double down);
    /* Solid angle, sr, for each unit of area in the square, at that point. */
    double (*density)(double right, double down);
    bool is_disc;
    int up_axis; /* 1 or 2: the upper half of the square has y > 0 or z > 0; the right half always has x > 0 */
} projection;

/* NULL for layouts of other kinds. */
const projection *projection_of(helio_layout layout);

#endif
