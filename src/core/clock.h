/* SPDX-License-Identifier: MIT
 * clock.h - the time that passes, whatever becomes of the time of day. */
#ifndef HELIOSTAT_SRC_CLOCK_H
#define HELIOSTAT_SRC_CLOCK_H

#include <time.h>

/* Seconds since some moment before the program began. */
static inline double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
