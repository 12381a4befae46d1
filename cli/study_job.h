/* SPDX-License-Identifier: MIT
 * study_job.h - the objects that a study works with, and the measuring of its points. */
#ifndef HELIOSTAT_CLI_STUDY_JOB_H
#define HELIOSTAT_CLI_STUDY_JOB_H

#include "frame_warnings.h"
#include "study_light.h"
#include "study_picture.h"
#include "study_progress.h"
#include "study_record.h"
#include "study_truth.h"

typedef struct study_job {
    const study_plan *plan;
    study_record record;
    frame_warnings warnings;
    study_progress progress;
    helio_context *context;
    helio_mesh *mesh;
    uint64_t mesh_digest;
    helio_camera camera;
    helio_environment *environment;
    helio_comparison *full;  /* with Lab and FLIP, which take longer than many frames */
    helio_comparison *plain; /* without them, with flicker */

    /* Of the environment and material that are at work: */
    study_light light;
    helio_scene *scene;
    study_truth *truths; /* one for each frame of the light */
    study_window window;
    float exposure;
} study_job;

/* Opens what does not depend on the environment. Exit codes come with one sentence on stderr. Close it in any case. */
int study_job_open(study_job *job, const study_plan *plan);
void study_job_close(study_job *job);

/* Measures all points that the record does not have yet, and writes the record after each. */
int study_job_run(study_job *job);

/* Names of files in the study's folder. what: "picture" or "error"; the strategy does not count for references. */
enum { STUDY_PATH = 2 * STUDY_NAME };
void study_job_path(const study_plan *plan, const char *name, char path[STUDY_PATH]);
void study_job_picture_path(const study_plan *plan, const study_point *point, const char *what, char path[STUDY_PATH]);

/* Makes a folder of this name in the study's, if there is none yet. Returns an exit code; one sentence on stderr tells
 * of a failure. */
int study_job_folder(const study_plan *plan, const char *name);

/* The part of names that tells environment and material. */
void study_job_pair_name(const study_plan *plan, uint32_t environment, uint32_t material, char name[160]);

/* Can pictures be made in this build? */
bool study_job_has_pictures(void);

/* The error that pictures of errors show, and the one that gets the last colour. */
helio_error_map study_job_error_map(double *range);

#endif
