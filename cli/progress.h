/* SPDX-License-Identifier: MIT
 * progress.h - the progress bar: one line on stderr, only if that is a terminal. */
#ifndef HELIOSTAT_CLI_PROGRESS_H
#define HELIOSTAT_CLI_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct progress_bar {
    bool visible;
    double started, drawn; /* milliseconds */
    double pixels;         /* of one frame, for the rate of a single one; 0: none is shown */
    uint64_t total;        /* frames; 0 where nobody knows */
    uint64_t passed;       /* frames that are behind us */
    uint64_t rendered;     /* how many of these took time */
} progress_bar;

/* Starts the clock. Nothing is drawn where stderr is no terminal, or if hidden. */
void progress_start(progress_bar *progress, uint64_t total, double pixels, bool hidden);

/* A frame is done: rendered, or there already. */
void progress_pass(progress_bar *progress, bool is_rendered);

/* Shows the part done of the frame, 0..1, at most ten times per second. Fits helio_frame_desc, with user a
 * progress_bar: false asks the renderer to stop, because a signal came. */
bool progress_update(void *user, float done);

/* Clears the line. */
void progress_end(progress_bar *progress);

#endif
