/* SPDX-License-Identifier: MIT
 * flip.h - LDR-FLIP: how much a viewer notices when two pictures alternate. */
#ifndef HELIOSTAT_SRC_EVAL_FLIP_H
#define HELIOSTAT_SRC_EVAL_FLIP_H

#include "eval/flip_filter.h"

typedef struct flip_viewer {
    flip_filter filter;
    float to_xyz[3][3], from_xyz[3][3]; /* linear Rec. 709 to XYZ in parts of white's, and back */
    float greatest;                     /* difference of colours that there is */
} flip_viewer;

void flip_viewer_make(flip_viewer *viewer, double pixels_per_degree);

/* rgb: what a screen shows, linear, 0..1. */
void flip_opponents(const flip_viewer *viewer, const float rgb[3], float opponents[3]);
void flip_lab(const flip_viewer *viewer, const float rgb[3], float lab[3]);

/* errors: [width], each 0..1, of one row of two pictures of one size. Those that are NaN before are not wanted and stay
 * so. */
void flip_compare_row(const flip_viewer *viewer, const flip_picture *picture, const flip_picture *reference,
                      uint32_t row, float *errors);

#endif
