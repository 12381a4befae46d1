/* SPDX-License-Identifier: MIT
 * video_reader.h - what a thread that reads video needs besides the public functions. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_READER_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_READER_H

#include <heliostat/video.h>

#include <stdatomic.h>

/* Can this FFmpeg play PNG files of several pictures? */
bool video_reader_plays_png(void);

/* Once *stopping is true, helio_video_next() waits no longer for a device that shows nothing: it fails. */
void video_reader_heed(helio_video_reader *reader, const atomic_bool *stopping);

#endif
