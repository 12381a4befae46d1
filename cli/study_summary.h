/* SPDX-License-Identifier: MIT
 * study_summary.h - what the points of a study say together: slopes, errors at equal time, means over environments. */
#ifndef HELIOSTAT_CLI_STUDY_SUMMARY_H
#define HELIOSTAT_CLI_STUDY_SUMMARY_H

#include "study_record.h"

/* ---- curves ---------------------------------------------------------------------------------------------------- */

/* The errors of a strategy, one for each spp: rising times and falling errors, mostly. */
typedef struct study_curve {
    uint32_t count;
    double spp[STUDY_LIST], ms[STUDY_LIST], rmse[STUDY_LIST], relmse[STUDY_LIST], lab[STUDY_LIST];
    double sampling_ms[STUDY_LIST]; /* part of ms that goes to pools and shading */
    double reference_rmse;          /* standard error of the reference */
} study_curve;

/* Points that are done. */
study_curve study_curve_make(const study_record *record, uint32_t environment, uint32_t material, uint32_t strategy);

/* Slope of log rmse over log spp by least squares, -1/2 for independent unbiased samples. The reference's own error is
 * taken out of each square, and points of less than three times that error are left out. NaN with less than two. */
double study_curve_slope(const study_curve *curve);

/* How long pools and shading take with so many samples: fixed + each x spp, both >= 0, by least squares of relative
 * errors, as single times are noisy. What else a frame takes is the same for all strategies, so that at equal time it
 * does not count. False without points. */
typedef struct study_pace {
    double fixed, each; /* ms */
} study_pace;

bool study_curve_pace(const study_curve *curve, study_pace *pace);

/* The error with any number of samples: on straight lines between points in log-log, and up to 64 times beyond the last
 * and before the first one on lines of this slope (relMSE -1, others -1/2: those of independent samples). NaN
 * elsewhere. errors: [count], of the curve. */
double study_curve_at(const study_curve *curve, const double *errors, double slope, double spp);

/* ---- means over environments ----------------------------------------------------------------------------------- */

/* NaN where an environment has no such number. */
typedef struct study_mean {
    double relmse; /* geometric mean */
    double lab;    /* mean */
    double ms;     /* geometric mean, of the whole frame */
    double spp;    /* geometric mean */
    double useful; /* mean share; 0 at equal time */
} study_mean;

study_mean study_mean_at_spp(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp);

/* In each environment with as many samples as fit into the time that the slowest strategy takes for so many. */
study_mean study_mean_at_time(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp);

/* Adds "curves" and "means" to the study's JSON. */
void study_summary_describe(const study_record *record, json_t *object);

#endif
