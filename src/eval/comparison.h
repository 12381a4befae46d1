/* SPDX-License-Identifier: MIT
 * comparison.h - what the files that compare pictures share. */
#ifndef HELIOSTAT_SRC_EVAL_COMPARISON_H
#define HELIOSTAT_SRC_EVAL_COMPARISON_H

#include "eval/flip.h"
#include "eval/lab.h"

#include <heliostat/comparison.h>

#include <math.h>

enum { ERROR_MAPS = HELIO_ERROR_MAP_FLIP + 1 };

/* Sums over the pixels of a row, or of the picture. Those of squares go over the three channels too. */
typedef struct comparison_sums {
    uint64_t pixels, skipped, flicker_pixels;
    helio_bad_pixels bad[2]; /* of picture and reference */
    double error_squares, reference_squares, shown_squares, relative, lab, de2000, flip;
    double flicker_references, flicker_squares, flicker_relative;
} comparison_sums;

/* The pair before: [height][width][3] each. */
typedef struct past_pair {
    float *errors; /* picture - reference; NaN where it was not compared */
    float *references;
    bool is_there;
} past_pair;

struct helio_comparison {
    helio_context *context;
    uint32_t width, height;
    bool has_pair; /* the maps hold the errors of one */
    lab_space lab;
    flip_viewer viewer;
    float *maps[ERROR_MAPS];  /* [height][width] each; NULL: left out */
    flip_picture pictures[2]; /* picture and reference; planes are NULL without FLIP */
    past_pair past;           /* NULL without flicker */
    comparison_sums *rows;    /* [height] */
};

/* A pair that is being compared. */
typedef struct measurement {
    helio_comparison *comparison;
    const helio_comparison_pair *pair;
    uint32_t channels[2]; /* of picture and reference */
    comparison_sums sums; /* of the passes that are done */
    double epsilon;       /* of relMSE, or of flicker */
} measurement;

/* Runs body(measurement, row) for all rows, whose sums start from 0, and then adds those to the measurement's. */
void measurement_pass(measurement *work, helio_loop_body body);

/* picture: 0; reference: 1 */
static inline const float *measurement_pixel(const measurement *work, int side, size_t pixel)
{
    const float *pixels = side == 0 ? work->pair->picture : work->pair->reference;
    return pixels + pixel * work->channels[side];
}

/* After the pass that finds out what is compared. */
static inline bool measurement_compares(const measurement *work, size_t pixel)
{
    return !isnan(work->comparison->maps[HELIO_ERROR_MAP_RELATIVE][pixel]);
}

/* x / y where 0 / 0 is 0: a difference of nothing to nothing. */
static inline double measurement_ratio(double x, double y)
{
    return x > 0 ? x / y : 0;
}

/* Adds the flicker since the pair before, and remembers this one. */
void flicker_measure(measurement *work);

#endif
