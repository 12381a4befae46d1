/* SPDX-License-Identifier: MIT
 * video_support.h - clips with known code values, written by FFmpeg without any conversion. */
#ifndef HELIOSTAT_TESTS_VIDEO_SUPPORT_H
#define HELIOSTAT_TESTS_VIDEO_SUPPORT_H

#include "support.h"

#include <heliostat/video.h>

#include <libavcodec/avcodec.h>

typedef struct video_clip {
    const char *muxer; /* FFmpeg's name */
    enum AVCodecID codec;
    enum AVPixelFormat format;
    int width, height, frames;
    enum AVColorRange range;
    enum AVColorPrimaries primaries;
    enum AVColorTransferCharacteristic transfer;
    enum AVColorSpace matrix;
    enum AVChromaLocation location;
    const int32_t *display; /* [9], or NULL */
    int key_distance;       /* frames; 0: the encoder's default */

    /* The code of one sample; x and y count samples of that component. */
    unsigned (*code)(const struct video_clip *clip, int frame, int component, int x, int y);
    const void *user;
} video_clip;

/* Skips the test where this FFmpeg has no such encoder or muxer. */
void write_clip(const char *path, const video_clip *clip);

/* Does it have an encoder of that name? */
bool has_encoder(const char *name);

/* directory/name */
void join(char path[TEST_PATH_SIZE], const char *directory, const char *name);

/* A whole file in memory of malloc(), and back. */
unsigned char *load_bytes(const char *path, size_t *size);
void save_bytes(const char *path, const unsigned char *bytes, size_t size);

#endif
