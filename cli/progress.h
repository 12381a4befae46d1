/* SPDX-License-Identifier: MIT
 * progress.h - the progress bar: one line on stderr, only if that is a terminal. */
#ifndef HELIOSTAT_CLI_PROGRESS_H
#define HELIOSTAT_CLI_PROGRESS_H

#include <stdbool.h>

typedef struct progress_bar {
    bool visible;
    double started, drawn; /* milliseconds */
    double pixels;         /* of the whole work, for the rate */
} progress_bar;

/* Starts the clock. Nothing is drawn where stderr is no terminal, or if hidden. */
void progress_start(progress_bar *progress, double pixels, bool hidden);

/* Shows the part done, 0..1, at most ten times per second. Fits helio_frame_desc, with user a progress_bar: false asks
 * the renderer to stop, because a signal came. */
bool progress_update(void *user, float done);

/* Clears the line. */
void progress_end(progress_bar *progress);

#endif
