/* SPDX-License-Identifier: MIT
 * pixel_fault.h - what is wrong with a pixel, by one rule for files and for the environment. */
#ifndef HELIOSTAT_SRC_PIXEL_FAULT_H
#define HELIOSTAT_SRC_PIXEL_FAULT_H

#include <math.h>

/* The worst first, see helio_bad_pixels. */
typedef enum pixel_fault {
    PIXEL_NAN,
    PIXEL_INFINITE,
    PIXEL_NEGATIVE,
    PIXEL_GOOD,
} pixel_fault;

/* No light is brighter, and sums of such numbers would not fit a float. */
#define PIXEL_BRIGHTEST 1e30f

static inline pixel_fault pixel_fault_of(const float rgb[3])
{
    if (isnan(rgb[0]) || isnan(rgb[1]) || isnan(rgb[2]))
        return PIXEL_NAN;
    if (fabsf(rgb[0]) > PIXEL_BRIGHTEST || fabsf(rgb[1]) > PIXEL_BRIGHTEST || fabsf(rgb[2]) > PIXEL_BRIGHTEST)
        return PIXEL_INFINITE;
    return rgb[0] < 0.0f || rgb[1] < 0.0f || rgb[2] < 0.0f ? PIXEL_NEGATIVE : PIXEL_GOOD;
}

#endif
