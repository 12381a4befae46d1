/* SPDX-License-Identifier: MIT
 * video_samples.h - code values out of frames of any pixel format. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_SAMPLES_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_SAMPLES_H

#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>

/* Reads count code values of one component from the left of a line, both counted in samples of that component, as they
 * are: 0 ... 2^depth - 1, or the numbers of a float format. Pictures with a palette have the components R, G and B. */
void video_samples_read(const AVFrame *frame, const AVPixFmtDescriptor *format, int component, int line, int count,
                        float *samples);

#endif
