/* SPDX-License-Identifier: MIT
 * video_convert.h - decoded frames to linear Rec. 709. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_CONVERT_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_CONVERT_H

#include "image/transfer.h"
#include "image/video_colour.h"

/* How the picture is turned or mirrored for display: column x and row y go to (a x + c y, b x + d y), up to a shift. */
typedef struct video_turn {
    int a, b, c, d; /* each -1, 0 or 1 */
} video_turn;

/* The two chroma samples that a luma sample lies between, and the share of the second. */
typedef struct chroma_pair {
    int first, second;
    float share;
} chroma_pair;

/* Working memory for frames of one size, remade when the size changes. */
typedef struct video_converter {
    helio_context *context;
    transfer_table *table;  /* NULL before the first frame */
    uint32_t width, height; /* of the frames as they are coded */
    float *rgb;             /* [height][width][3], as displayed */
    float *component[3];    /* [width]: one line of codes */
    float *signal[3];       /* [width]: R'G'B' of it */
    float *chroma[2][2];    /* [width]: two neighbouring lines of each chroma component */
    int chroma_line[2];     /* which they are */
    float *blended;         /* [width] */
    chroma_pair *across;    /* [width]: for each column */
} video_converter;

/* Converts the frame into converter->rgb and counts its bad pixels, as in helio_image. */
helio_status video_convert(video_converter *converter, const AVFrame *frame, const video_colour *colour,
                           const video_turn *turn, helio_bad_pixels *bad);

void video_converter_clear(video_converter *converter);

#endif
