/* SPDX-License-Identifier: MIT
 * progress.h - how far the work is: on a terminal a bar in one line of stderr; elsewhere, as in logs, a line now and
 * then. */
#ifndef HELIOSTAT_CLI_PROGRESS_H
#define HELIOSTAT_CLI_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct progress_bar {
    bool visible;          /* as a bar */
    bool is_logged;        /* by a line now and then */
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

/* Starts the clock. Nothing is shown if hidden. */
void progress_start(progress_bar *progress, uint64_t total, double pixels, bool hidden);

/* A frame is done: rendered, or there already. */
void progress_pass(progress_bar *progress, bool is_rendered);

/* Shows the part done of the frame, 0..1, whenever that is due. Fits helio_frame_desc, with user a
 * progress_bar: false asks the renderer to stop, because a signal came. */
bool progress_update(void *user, float done);

/* Is it time to show something? Never, if nothing is shown at all. On a terminal it is a tenth of a second after the
 * last time; elsewhere half a minute after it, or later: a tenth of the time that has passed. */
bool progress_is_due(const progress_bar *progress);

/* Shows a line of the caller's. done: 0..1; less than 0: there is no bar. */
void progress_show(progress_bar *progress, const progress_line *line, double done);

/* Clears the line of a bar. */
void progress_end(progress_bar *progress);

#endif
