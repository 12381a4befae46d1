/* SPDX-License-Identifier: MIT
 * study_record.h - what a study has found so far, in memory and in its folder's study.json, from which it resumes. */
#ifndef HELIOSTAT_CLI_STUDY_RECORD_H
#define HELIOSTAT_CLI_STUDY_RECORD_H

#include "study_plan.h"

#include <jansson.h>

/* What was measured at one point. NaN: there is none. */
typedef struct study_cell {
    bool is_done;
    double relmse, rmse;                                       /* means over the repetitions; rmse of squares */
    double lab_mean, de2000_mean, psnr, flip;                  /* of the first one */
    double flicker, flicker_rmse, sequence_relmse;             /* means over the sequence */
    double flicker_ratio;                                      /* flicker / sequence_relmse */
    double total_ms, low_ms, high_ms;                          /* of the whole frame: median and quartiles */
    double cube_ms, tables_ms, pools_ms, primary_ms, shade_ms; /* medians of its parts */
    double samples, useful_share, rays, passes;
    double reference_rmse; /* standard error of the reference, as an RMSE */
    double exposure;       /* stops */
} study_cell;

/* One of the numbers of a cell. */
typedef struct study_number {
    const char *name, *meaning;
    size_t offset; /* in study_cell */
} study_number;

enum { STUDY_NUMBERS = 23 };
extern const study_number study_numbers[STUDY_NUMBERS];
double study_number_of(const study_cell *cell, const study_number *number);

enum { STUDY_DIGEST = 24 };

typedef struct study_record {
    const study_plan *plan;
    study_cell *cells;             /* [study_plan_count()] */
    json_t *settings;              /* what makes cells comparable: those of another run must be the same */
    json_t *scene;                 /* what is lit and seen, in words */
    char (*digests)[STUDY_DIGEST]; /* [environment_count]; "": not read yet */
} study_record;

/* Release it in any case. All exit codes come with one sentence on stderr. */
int study_record_open(study_record *record, const study_plan *plan, json_t *settings, json_t *scene);
void study_record_release(study_record *record);

/* Takes over what a file has. EXIT_CODE_FAILED where it comes from another study. */
int study_record_load(study_record *record, const char *path);

/* Complete, or not there at all. */
int study_record_write(const study_record *record, const char *path);

/* Keeps a cell, with as many digits as files have. */
void study_record_keep(study_record *record, size_t index, const study_cell *cell);

/* Tells of which data an environment is. Forgets the cells that were made with other data, and returns whether it was
 * other data. */
bool study_record_note_digest(study_record *record, uint32_t environment, uint64_t digest);

#endif
