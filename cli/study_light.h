/* SPDX-License-Identifier: MIT
 * study_light.h - an environment of a study in memory: one map, or the frames of a short sequence. */
#ifndef HELIOSTAT_CLI_STUDY_LIGHT_H
#define HELIOSTAT_CLI_STUDY_LIGHT_H

#include <heliostat/heliostat.h>

typedef struct study_light {
    helio_source *source;
    helio_source_frame *frames; /* with pixels and skies of our own */
    helio_sky_desc *skies;      /* what frames of skies point to */
    uint32_t stored;            /* frames that are in memory */
    uint32_t count;             /* frames that can be applied */
    bool turns;                 /* all of them are the one that is stored, turned */
    bool is_out_of_memory;      /* why a function below failed, where helio_last_error() does not tell */
    uint64_t digest;            /* of all that is stored */
} study_light;

typedef struct study_turn {
    double rotate, step; /* degrees: of the frame that is studied, and from one to the next where the map does not move
                            by itself */
    bool flip;
    float intensity;
} study_turn;

/* Reads up to so many frames. There may be none: then count is 0. Release it in any case. */
helio_status study_light_open(helio_context *context, const char *specification, const helio_source_desc *desc,
                              uint32_t frames, study_light *light);
void study_light_release(study_light *light);

/* Makes frame `index` the environment's: all that is to be done with a map that is in memory. info may be NULL. */
helio_status study_light_apply(const study_light *light, uint32_t index, const study_turn *turn,
                               helio_environment *environment, helio_environment_info *info);

#endif
