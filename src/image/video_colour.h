/* SPDX-License-Identifier: MIT
 * video_colour.h - from the tags of a frame to the numbers that make linear Rec. 709 of its code values. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_COLOUR_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_COLOUR_H

#include "image/colour.h"

#include <heliostat/video.h>

#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>

typedef struct video_colour {
    helio_transfer transfer;
    float signal[3][4]; /* R'G'B' = signal x (code, code, code, 1); codes of Y', Cb, Cr or of R', G', B' */
    float rec709[3][3]; /* Rec. 709 = rec709 x linear RGB */
    bool is_rgb;        /* or grey: signal is diagonal but for its last column */
    bool is_rec709;     /* rec709 is 1 */
} video_colour;

/* What a frame says of itself, as its decoder or its container's header has it. */
typedef struct video_tags {
    enum AVPixelFormat format;
    int width, height;
    enum AVColorRange range;
    enum AVColorPrimaries primaries;
    enum AVColorTransferCharacteristic transfer;
    enum AVColorSpace matrix;
} video_tags;

/* The curve of these tags, never AUTO. wanted: what the caller asks for, or AUTO. */
helio_transfer video_colour_transfer(const video_tags *tags, helio_transfer wanted);

/* HELIO_ERR_UNSUPPORTED, with path in the sentence, where the tags name something that this library does not know. */
helio_status video_colour_resolve(const char *path, const video_tags *tags, helio_transfer wanted,
                                  video_colour *colour);

/* Y'CbCr = matrix x R'G'B', with Y' in 0..1, Cb and Cr in -0.5..0.5. space: BT709 or BT2020_NCL. */
void video_colour_matrix(enum AVColorSpace space, colour_matrix *matrix);

/* BT.2020 = matrix x Rec. 709. */
void video_colour_rec709_to_bt2020(colour_matrix *matrix);

#endif
