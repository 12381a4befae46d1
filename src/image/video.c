/* SPDX-License-Identifier: MIT */
#include "core/file.h"

#include <heliostat/video.h>

bool helio_video_has_extension(const char *path)
{
    static const char *const EXTENSIONS[] = {"mp4", "mov", "mkv", "webm"};
    for (size_t i = 0; path != NULL && i < sizeof EXTENSIONS / sizeof *EXTENSIONS; i++)
        if (file_has_extension(path, EXTENSIONS[i]))
            return true;
    return false;
}
