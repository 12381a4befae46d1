/* SPDX-License-Identifier: MIT
 * frame_error.h - the error of rendered frames against the pictures that --reference names. */
#ifndef HELIOSTAT_CLI_FRAME_ERROR_H
#define HELIOSTAT_CLI_FRAME_ERROR_H

#include "numbered_path.h"
#include "picture_file.h"
#include "stats.h"

#include <heliostat/heliostat.h>

enum { FRAME_ERROR_PATH = 4096 };

/* Start from {0}: then there is no reference, and nothing below does anything. */
typedef struct frame_error {
    helio_context *context;
    const char *path;    /* of the picture, or the pattern of names; NULL: there is none */
    numbered_path names; /* where has_numbers */
    bool has_numbers;
    uint32_t size[2]; /* width, height of all frames */
    helio_comparison *comparison;
    helio_image *reference; /* of the frame that comes next */
    double relmse, lab;     /* sums over the frames that were measured */
    uint64_t frames;        /* how many these are */
    bool is_told;           /* that a reference is no radiance */
} frame_error;

/* path: of a picture for all frames, or with %04d for the frame's number; it stays the caller's. One picture is read
 * here. Returns an exit code; one sentence on stderr tells what is wrong. Close it in any case. */
int frame_error_open(frame_error *error, helio_context *context, const char *path, const uint32_t size[2]);
void frame_error_close(frame_error *error);

/* The picture that a frame is compared with; "" without one. False if it does not fit. */
bool frame_error_name(const frame_error *error, uint64_t index, char name[FRAME_ERROR_PATH]);

/* Reads it, before the frame is rendered. Returns an exit code, as above. */
int frame_error_prepare(frame_error *error, uint64_t index, stats_frame *stats);

/* Compares the frame: exposure and tone map are those of PNG. Numbers that there are not, as Lab without lcms2, are NaN
 * in the stats. Returns an exit code, as above. */
int frame_error_measure(frame_error *error, const helio_picture *picture, float exposure, helio_tonemap tonemap,
                        stats_frame *stats);

/* Tells the mean over the frames. */
void frame_error_tell(const frame_error *error);

#endif
