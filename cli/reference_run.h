/* SPDX-License-Identifier: MIT
 * reference_run.h - the reference of one frame, from the first piece to the file. */
#ifndef HELIOSTAT_CLI_REFERENCE_RUN_H
#define HELIOSTAT_CLI_REFERENCE_RUN_H

#include "reference_plan.h"
#include "render_job.h"

typedef struct reference_run {
    const reference_plan *plan;
    render_job *job;
    char out[SINK_PATH_SIZE], checkpoint[SINK_PATH_SIZE];
    helio_reference *reference;
    helio_reference_info info; /* of the latest piece */
    double error;              /* helio_reference_error() after it */
    uint64_t resumed;          /* pieces that an earlier run had done */
    uint64_t samples;          /* of this run */
    double started;            /* milliseconds */
    double saved, save_cost;   /* when the latest checkpoint was begun, and how long it took */
    bool is_saved;             /* nothing has come since then */
    bool has_warned;           /* that no checkpoint can be written */
    double seconds;            /* that this run took */
} reference_run;

/* Computes what the job is lit by now and writes it. exposure: of a PNG. index: of the frame. Returns an exit code,
 * after one sentence on stderr if it is not EXIT_CODE_OK; run tells what came of it. */
int reference_run_frame(reference_run *run, uint64_t index, const char *out, float exposure);

#endif
