/* SPDX-License-Identifier: MIT
 * frame_warnings.h - what is odd about frames: told for the first ones, and then in one sentence for all others. */
#ifndef HELIOSTAT_CLI_FRAME_WARNINGS_H
#define HELIOSTAT_CLI_FRAME_WARNINGS_H

#include "stats.h"

#include <heliostat/source.h>

#include <stdatomic.h>

typedef struct frame_warnings {
    uint64_t bad_frames, bad_pixels;     /* NaN, infinite or negative */
    uint64_t gamut_frames, gamut_pixels; /* of colours that Rec. 709 cannot hold */
    uint64_t size_changes;
    uint32_t width, height;   /* of the frame before */
    atomic_uint_fast64_t log; /* warnings of the library, from any thread */
    bool tells_all;
} frame_warnings;

/* Compares the frame with the one before. label: what messages call it. */
void frame_warnings_size(frame_warnings *warnings, const char *label, const helio_source_frame *frame);
void frame_warnings_bad_pixels(frame_warnings *warnings, const char *label, const stats_frame *frame);

/* A warning from the library's log. */
void frame_warnings_log(frame_warnings *warnings, const char *message);

/* Tells how many were not told. */
void frame_warnings_end(const frame_warnings *warnings);

#endif
