/* SPDX-License-Identifier: MIT
 * samples_json.h - the JSON of samples: one entry for each frame. */
#ifndef HELIOSTAT_CLI_SAMPLES_JSON_H
#define HELIOSTAT_CLI_SAMPLES_JSON_H

#include "samples.h"

#include <jansson.h>

/* The object that holds all; frames are added to it. To be given to json_decref(). */
json_t *samples_json_make(const render_job *job);

/* picture: the radiance that the render has at the pixel. False where there is no memory. */
bool samples_json_add(json_t *object, const samples_findings *found, const float picture[3]);

/* Writes to a file, or to standard output for "-". Returns an exit code. */
int samples_json_write(const char *path, const json_t *object);

#endif
