/* SPDX-License-Identifier: MIT
 * study_progress.h - how much of a study is done, by the work that its parts take. */
#ifndef HELIOSTAT_CLI_STUDY_PROGRESS_H
#define HELIOSTAT_CLI_STUDY_PROGRESS_H

#include "progress.h"
#include "study_plan.h"

typedef struct study_progress {
    progress_bar bar;
    double total, done; /* work */
    double part;        /* of the frame that is being rendered */
} study_progress;

/* Work of a frame, in samples that take as long as those of a BRDF. */
double study_progress_frame(helio_strategy strategy, uint32_t spp);

/* Begins a frame of so much work, and ends it. */
void study_progress_begin(study_progress *progress, double work);
void study_progress_end(study_progress *progress);

/* Fits helio_frame_desc, with user a study_progress. */
bool study_progress_update(void *user, float done);

#endif
