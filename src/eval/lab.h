/* SPDX-License-Identifier: MIT
 * lab.h - CIE 1976 L*a*b* and differences in it, by lcms2. */
#ifndef HELIOSTAT_SRC_EVAL_LAB_H
#define HELIOSTAT_SRC_EVAL_LAB_H

#include "image/colour.h"

typedef struct lab_colour {
    double lightness, a, b; /* lightness: 0..100 for what a screen shows */
} lab_colour;

typedef struct lab_space {
    colour_matrix to_xyz; /* of linear Rec. 709 */
    double white[3];      /* XYZ of (1, 1, 1): D65 with Y = 1 */
} lab_space;

void lab_space_make(lab_space *space);

/* rgb: linear Rec. 709, 0..1. No adaptation of white: that of the space is that of Rec. 709. */
lab_colour lab_from_rec709(const lab_space *space, const float rgb[3]);

/* Delta E*ab: the distance. */
double lab_difference(const lab_colour *a, const lab_colour *b);

/* CIEDE2000 with the parametric factors kL = kC = kH = 1. */
double lab_difference_2000(const lab_colour *a, const lab_colour *b);

#endif
