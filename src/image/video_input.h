/* SPDX-License-Identifier: MIT
 * video_input.h - opens files and devices for FFmpeg, and nothing that they refer to. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_INPUT_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_INPUT_H

#include "image/video_log.h"

#include <heliostat/core.h>

#include <stdatomic.h>

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

typedef struct video_input {
    const char *path;
    int descriptor; /* of the file; -1 for devices */
    AVIOContext *io;
    AVFormatContext *format;
    AVStream *stream; /* the one that is read */
    AVCodecContext *codec;
    double deadline;             /* of a device, see video_input_be_patient() */
    const atomic_bool *stopping; /* of a device, see video_reader_heed(); NULL: nobody stops it */
} video_input;

/* Opens the best video stream of the file at path or, with device not NULL, of FFmpeg's device. threads: for decoding.
 * To be closed also after a failure. To be called inside of log. */
helio_status video_input_open(video_input *input, video_log *log, const char *path, const char *device,
                              uint64_t max_pixels, uint32_t threads);
void video_input_close(video_input *input);

/* From now on a device has ten seconds to show a picture, or until it is stopped. */
void video_input_be_patient(video_input *input);
bool video_input_is_late(const video_input *input);

/* HELIO_ERR_DATA where a frame of this size has too many pixels. */
helio_status video_input_check_size(const char *path, int width, int height, uint64_t max_pixels);

/* The display matrix that the file gives to the stream, [9], or NULL. */
const int32_t *video_input_display_matrix(const video_input *input);

#endif
