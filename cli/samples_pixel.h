/* SPDX-License-Identifier: MIT
 * samples_pixel.h - which pixel samples looks at. */
#ifndef HELIOSTAT_CLI_SAMPLES_PIXEL_H
#define HELIOSTAT_CLI_SAMPLES_PIXEL_H

#include "render_job.h"

/* Does the pixel (*x, *y) of the picture that was rendered last, frame `index`, show the object? Where it does not, and
 * was not asked for, the nearest one that does takes its place. Returns an exit code: EXIT_CODE_FAILED after one
 * sentence on stderr, which proposes that one. */
int samples_pixel_choose(render_job *job, bool is_asked_for, uint64_t index, uint32_t *x, uint32_t *y);

#endif
