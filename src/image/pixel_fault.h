/* SPDX-License-Identifier: MIT
 * pixel_fault.h - what is wrong with a pixel, by one rule for files and for the environment. */
#ifndef HELIOSTAT_SRC_PIXEL_FAULT_H
#define HELIOSTAT_SRC_PIXEL_FAULT_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

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

/* The pixel made finite and not negative; -0 becomes 0, too. A number's bits grow with its magnitude, and those of
 * infinity and of what is not a number are beyond all others. */
static inline void pixel_clean(const float in[3], float out[3])
{
    const float brightest = PIXEL_BRIGHTEST;
    uint32_t limit, bits[3];
    memcpy(&limit, &brightest, sizeof limit);
    memcpy(bits, in, sizeof bits);
    bool finite =
        ((bits[0] & INT32_MAX) <= limit) & ((bits[1] & INT32_MAX) <= limit) & ((bits[2] & INT32_MAX) <= limit);
    for (int c = 0; c < 3; c++)
        out[c] = finite && in[c] > 0.0f ? in[c] : 0.0f;
}

#endif
