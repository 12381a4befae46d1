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

/* What a line says: at a narrow terminal the bar goes first, then what is least needed, which comes last. */
typedef struct progress_line {
    char head[64], left[32], speed[48], past[32];
} progress_line;

/* Hours, minutes and seconds. */
void progress_format_time(double milliseconds, char text[16]);

/* Starts the clock. Nothing is drawn where stderr is no terminal, or if hidden. */
void progress_start(progress_bar *progress, uint64_t total, double pixels, bool hidden);

/* A frame is done: rendered, or there already. */
void progress_pass(progress_bar *progress, bool is_rendered);

/* Shows the part done of the frame, 0..1, at most ten times per second. Fits helio_frame_desc, with user a
 * progress_bar: false asks the renderer to stop, because a signal came. */
bool progress_update(void *user, float done);

/* Is it time to show something, a tenth of a second after the last time? Never, if nothing is shown at all. */
bool progress_is_due(const progress_bar *progress);

/* Shows a line of the caller's. done: 0..1; less than 0: there is no bar. */
void progress_show(progress_bar *progress, const progress_line *line, double done);

/* Clears the line. */
void progress_end(progress_bar *progress);

#endif
