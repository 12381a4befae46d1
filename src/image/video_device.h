/* SPDX-License-Identifier: MIT
 * video_device.h - FFmpeg's devices, found when one is asked for. */
#ifndef HELIOSTAT_SRC_VIDEO_DEVICE_H
#define HELIOSTAT_SRC_VIDEO_DEVICE_H

#include <heliostat/core.h>

#include <libavformat/avformat.h>

/* The device of this name that gives pictures, such as v4l2 or lavfi. Loads the library of the devices, which alone
 * brings some eighty others, at the first call: programs that use none should not wait for them at each start. */
helio_status video_device_find(const char *name, const AVInputFormat **device);

#endif
