/* SPDX-License-Identifier: MIT
 * video_pixels.h - from rendered pictures to the code values that encoders take. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_PIXELS_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_PIXELS_H

#include "image/transfer.h"

#include <heliostat/image.h>

#include <libavutil/frame.h>

typedef struct video_pixels {
    helio_context *context;
    helio_picture_write_desc look; /* exposure and tone map */
    bool hdr;                      /* PQ and BT.2020, else sRGB and Rec. 709 */
    float factor;                  /* of the exposure */
    float rec2020[3][3];           /* BT.2020 = rec2020 x Rec. 709 */
    float matrix[3][3];            /* Y'CbCr = matrix x R'G'B' */
    transfer_encoder *encoder;
    float *lines[2][3]; /* [frame width]: Y', Cb, Cr of two lines */
} video_pixels;

/* width: of the frames. To be ended also after a failure. */
helio_status video_pixels_begin(video_pixels *pixels, helio_context *context, const helio_video_write_desc *desc,
                                int width);
void video_pixels_end(video_pixels *pixels);

/* Fills a frame of one of the formats YUV420P, YUV420P10, GBRP10 and 0RGB32; Y'CbCr in the narrow range, chroma on the
 * left. Where the frame is larger than the picture, the last column and row are repeated. */
void video_pixels_fill(const video_pixels *pixels, const helio_picture *picture, AVFrame *frame);

#endif
