/* SPDX-License-Identifier: MIT
 * study_settings.h - what numbers of a study depend on, and the scene that they are about. */
#ifndef HELIOSTAT_CLI_STUDY_SETTINGS_H
#define HELIOSTAT_CLI_STUDY_SETTINGS_H

#include "study_job.h"

/* Everything that changes errors or times, but for the lists: numbers of studies with other settings must not stand
 * side by side. NULL where there is no memory. */
json_t *study_settings(const study_job *job);

/* What a reader wants to know besides. */
json_t *study_scene(const study_job *job);

#endif
