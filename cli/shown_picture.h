/* SPDX-License-Identifier: MIT
 * shown_picture.h - a rendered picture as it is shown in a smaller one. */
#ifndef HELIOSTAT_CLI_SHOWN_PICTURE_H
#define HELIOSTAT_CLI_SHOWN_PICTURE_H

#include <heliostat/image.h>

typedef struct shown_picture {
    const float *pixels; /* [height][width][channels], linear, premultiplied */
    uint32_t width, height, channels;
    float exposure; /* stops */
    helio_tonemap tonemap;
} shown_picture;

/* Each pixel becomes the mean of those that it covers, as they are shown. Neither side may grow. rgb:
 * [height][width][3], linear. */
void shown_picture_shrink(const shown_picture *picture, uint32_t width, uint32_t height, float *rgb);

#endif
