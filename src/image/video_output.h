/* SPDX-License-Identifier: MIT
 * video_output.h - a file for FFmpeg to write that appears under its name only when it is complete. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_OUTPUT_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_OUTPUT_H

#include "core/file.h"

#include <libavformat/avformat.h>

typedef struct video_output {
    file_writer file;
    AVFormatContext *format;
} video_output;

/* path: kept, to stay as long as the output. muxer: a name of FFmpeg's. To be closed also after a failure. */
helio_status video_output_open(video_output *output, const char *path, const char *muxer);

/* With commit: gives the file its name. Without: removes it. */
helio_status video_output_close(video_output *output, bool commit);

#endif
