/* SPDX-License-Identifier: MIT
 *
 * sky_twilight.h - what happens when the sun is lower than the sky model's tables are of use.
 *
 * From 1 degree up the model holds as published. Its curves are steep at 0 degrees, where it is about three times too
 * bright as well; below that it has no data. So from 1 degree down the sky keeps the pattern of a sun that comes to
 * rest at 0.5 degrees, seen from where the sun really is, and its illuminance falls along a smooth curve through
 * published ones; an even blue takes the pattern's place by and by. All curves have continuous derivatives. */
#ifndef HELIOSTAT_SRC_SKY_TWILIGHT_H
#define HELIOSTAT_SRC_SKY_TWILIGHT_H

#include <heliostat/sky.h>

static const double TWILIGHT_BEGINS = 1.0; /* degrees of elevation */

/* The elevation, degrees, at which the model is asked. */
double twilight_model_elevation(double elevation);

/* Illuminance relative to that of the model at this elevation. */
double twilight_brightness(double elevation);

/* Part of the light that comes evenly from the whole sky, 0 ... 1, and its colour, which has a luminance of 1. */
double twilight_even_part(double elevation);
extern const double twilight_colour[3];

#endif
