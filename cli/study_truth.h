/* SPDX-License-Identifier: MIT
 * study_truth.h - the reference that the pictures of a study are compared with. */
#ifndef HELIOSTAT_CLI_STUDY_TRUTH_H
#define HELIOSTAT_CLI_STUDY_TRUTH_H

#include "study_progress.h"

#include <heliostat/heliostat.h>

typedef struct study_truth {
    uint32_t width, height;
    float *rgb;    /* [height][width][3] */
    float *object; /* [height][width], its coverage */
    float *error;  /* [height][width][3], standard error of rgb */
    double rmse;   /* that of the object's pixels, as one number */
} study_truth;

typedef struct study_truth_desc {
    helio_renderer_desc renderer; /* of what is compared; spp and strategy do not count */
    helio_camera camera;
    bool is_quadrature; /* the light of all texels, without noise and without shadows */
    uint32_t spp;       /* else so many samples per shading point, as study counts them */
    uint32_t seed;
    study_progress *progress;
} study_truth_desc;

/* Makes it with the light that the environment has. *is_whole is false where a signal came. Release it in any case. */
helio_status study_truth_make(helio_context *context, const study_truth_desc *desc, study_truth *truth, bool *is_whole);
double study_truth_work(const study_truth_desc *desc); /* for study_progress */
void study_truth_release(study_truth *truth);

/* From and to OpenEXR, float by float. false: there is no such file of this size. */
bool study_truth_read(helio_context *context, const char *path, const uint32_t size[2], study_truth *truth);
helio_status study_truth_write(helio_context *context, const char *path, const study_truth *truth);

#endif
