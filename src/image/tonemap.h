/* SPDX-License-Identifier: MIT
 * tonemap.h - from radiance of any size to what a screen shows. */
#ifndef HELIOSTAT_SRC_IMAGE_TONEMAP_H
#define HELIOSTAT_SRC_IMAGE_TONEMAP_H

#include <heliostat/image.h>

/* What a screen shows of one pixel, linear, 0..1: exposure and tone map of desc. rgba: linear, premultiplied; shown
 * over black, or straight with desc->alpha. NaN becomes 0. */
void tonemap_linear(const float rgba[4], const helio_picture_write_desc *desc, float rgb[3]);

/* 8-bit sRGB of one pixel. rgba: linear, premultiplied. With desc->alpha, pixel has four entries and its colour is
 * straight; else it has three and shows the pixel over black. NaN becomes 0. */
void tonemap_pixel(const float rgba[4], const helio_picture_write_desc *desc, unsigned char *pixel);

#endif
