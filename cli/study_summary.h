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
    double flicker[STUDY_LIST];     /* NaN where it was not measured */
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

/* ---- scores ---------------------------------------------------------------------------------------------------- */

/* What strategies are compared at: the same number of samples, or the time that the slowest of them takes for it, or
 * from 0 on that of the strategy with this number in the plan. */
enum { STUDY_EQUAL_SAMPLES = -1, STUDY_TIME_OF_SLOWEST = -2 };

/* The time of face, the paper's strategy; without it that of the first one. */
int study_terms_of_paper(const study_plan *plan);

/* What a strategy comes to. NaN where there is no such number. */
typedef struct study_score {
    double relmse, lab, ms; /* ms: of the whole frame */
    double spp;             /* how many samples those terms let it have */
    double flicker;
    double useful, flicker_ratio; /* useful: share; both only at equal samples */
} study_score;

study_score study_score_of(const study_record *record, const study_point *point, int terms);

/* Means over all environments: geometric ones but for lab, useful and flicker_ratio. */
study_score study_score_mean(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp, int terms);

/* ---- ratios ---------------------------------------------------------------------------------------------------- */

/* What strategies are held against: the better of face and face+brdf in each environment, and light+brdf, which is what
 * most renderers do. */
enum { STUDY_BASELINES = 2, STUDY_BASELINE_NAME = 64 };

/* "face or face+brdf", as far as they are in the plan, without options of their own. False: none is. */
bool study_baseline_name(const study_plan *plan, int baseline, char name[STUDY_BASELINE_NAME]);

/* What is compared. */
typedef enum study_error { STUDY_RELMSE, STUDY_FLICKER } study_error;

/* "relMSE", "flicker" */
const char *study_error_name(study_error error);

/* A strategy's error as a part of the baseline's. */
typedef struct study_ratio {
    double mean;          /* geometric, over all environments; NaN where one has no such number */
    double worst;         /* the greatest that there is; NaN: there is none */
    uint32_t environment; /* that has it */
} study_ratio;

/* Of all environments, whichever the point names. */
study_ratio study_ratio_mean(const study_record *record, study_error error, int baseline, const study_point *point,
                             int terms);

/* ---- JSON ------------------------------------------------------------------------------------------------------ */

/* Adds "curves", "means" and "ratios" to the study's JSON. */
void study_summary_describe(const study_record *record, json_t *object);

#endif
