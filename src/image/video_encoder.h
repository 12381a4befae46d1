/* SPDX-License-Identifier: MIT
 * video_encoder.h - which containers and codecs can be written, and with what settings. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_ENCODER_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_ENCODER_H

#include "image/video_log.h"

#include <heliostat/video.h>

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

/* An encoder of this FFmpeg, and what it takes. */
typedef struct video_encoder {
    const AVCodec *library;
    enum AVPixelFormat format;
    const char *muxer;
    int width, height; /* of the frames: even where the codec wants it */
} video_encoder;

/* Defaults filled in and everything checked. given may be NULL; its size is not looked at. */
helio_status video_encoder_resolve(const char *path, const helio_video_write_desc *given, helio_video_write_desc *desc);

/* Finds the encoder for a path and a resolved desc. */
helio_status video_encoder_find(const char *path, const helio_video_write_desc *desc, video_encoder *encoder);

/* The rate as a fraction; those of 1000/1001 are recognised. */
AVRational video_encoder_rate(double fps);

/* Opens the encoder. codec is to be freed also after a failure. To be called inside of log. */
helio_status video_encoder_open(const video_encoder *encoder, const char *path, const helio_video_write_desc *desc,
                                uint32_t threads, bool global_header, video_log *log, AVCodecContext **codec);

/* Gives the stream what its codec has, with the metadata of HDR10. */
helio_status video_encoder_describe(const helio_video_write_desc *desc, const AVCodecContext *codec, AVStream *stream);

#endif
