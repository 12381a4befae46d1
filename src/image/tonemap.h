/* SPDX-License-Identifier: MIT
 * tonemap.h - from radiance of any size to what a screen shows. */
#ifndef HELIOSTAT_SRC_IMAGE_TONEMAP_H
#define HELIOSTAT_SRC_IMAGE_TONEMAP_H

#include <heliostat/image.h>

/* Does a desc name an exposure and a tone map that there are? name: what they are for. */
helio_status tonemap_check(const helio_picture_write_desc *desc, const char *name);

/* What a screen shows of one pixel, linear, 0..1: exposure and tone map of desc. rgba: linear, premultiplied; shown
 * over black, or straight with desc->alpha. NaN becomes 0. */
void tonemap_linear(const float rgba[4], const helio_picture_write_desc *desc, float rgb[3]);

/* 8-bit sRGB of one pixel. rgba: linear, premultiplied. With desc->alpha, pixel has four entries and its colour is
 * straight; else it has three and shows the pixel over black. NaN becomes 0. */
void tonemap_pixel(const float rgba[4], const helio_picture_write_desc *desc, unsigned char *pixel);

/* The same for helio_picture.shown: four entries in any case, with 255 where there is no alpha. */
static inline void tonemap_shown(const float rgba[4], const helio_picture_write_desc *desc, uint8_t shown[4])
{
    shown[3] = 255;
    tonemap_pixel(rgba, desc, shown);
}

#endif
