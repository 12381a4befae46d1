/* SPDX-License-Identifier: MIT
 * srgb.h - the curve that pictures for screens are coded by. */
#ifndef HELIOSTAT_CLI_SRGB_H
#define HELIOSTAT_CLI_SRGB_H

#include <math.h>

/* What lies outside of 0..1 is clipped. */
static inline double srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * fmax(linear, 0) : 1.055 * pow(fmin(linear, 1), 1 / 2.4) - 0.055;
}

/* And back. */
static inline double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

#endif
