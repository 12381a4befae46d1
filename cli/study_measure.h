/* SPDX-License-Identifier: MIT
 * study_measure.h - what is rendered and timed at a point of a study. */
#ifndef HELIOSTAT_CLI_STUDY_MEASURE_H
#define HELIOSTAT_CLI_STUDY_MEASURE_H

#include "study_job.h"

/* Renders, times and compares one point, and writes its pictures where they are shown. *is_whole is false where a
 * signal came. */
helio_status study_measure(study_job *job, const study_point *point, study_cell *cell, bool *is_whole);

/* Work of study_measure(), and of the references of a pair, for study_progress. */
double study_measure_work(const study_plan *plan, const study_point *point);

/* What all renderers of a study have in common. */
helio_renderer_desc study_renderer_desc(const study_job *job);
study_turn study_turn_of(const study_plan *plan);

/* For a repetition of the frame that is studied, or, with --seed-mode frame, of another one. */
uint32_t study_seed_of(const study_job *job, uint32_t frame, uint32_t repetition);

#endif
