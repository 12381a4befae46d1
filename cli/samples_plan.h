/* SPDX-License-Identifier: MIT
 * samples_plan.h - the options of samples, checked and turned into those of a scene and its figures. */
#ifndef HELIOSTAT_CLI_SAMPLES_PLAN_H
#define HELIOSTAT_CLI_SAMPLES_PLAN_H

#include "numbered_path.h"
#include "render_job.h"

typedef struct samples_plan {
    cli_options options; /* as render would be given them; the job's plan refers to them */
    bool has_pixel;
    uint32_t x, y;
    bool draws_frames;   /* a figure for each frame, or one for the only one, to the out of the job's plan */
    numbered_path names; /* of these, where they are numbered */
    const char *sheet, *json;
} samples_plan;

/* Reads and writes no file. Makes the job's plan as well. Returns an exit code; one sentence on stderr tells what is
 * wrong. */
int samples_plan_make(samples_plan *plan, const cli_options *options, render_job *job);

/* What can only be told once the job's source is open. */
int samples_plan_settle(samples_plan *plan, render_job *job);

#endif
