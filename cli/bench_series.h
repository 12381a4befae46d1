/* SPDX-License-Identifier: MIT
 * bench_series.h - what was measured again and again, and what is told of it. */
#ifndef HELIOSTAT_CLI_BENCH_SERIES_H
#define HELIOSTAT_CLI_BENCH_SERIES_H

#include <stdint.h>

enum { BENCH_REPEATS = 101 }; /* most repetitions */

typedef struct bench_series {
    uint32_t count;
    double values[BENCH_REPEATS];
} bench_series;

/* The median and, as its spread, the quartiles between which half of the values lie. */
typedef struct bench_spread {
    double median, low, high;
    uint32_t repeats;
} bench_spread;

void bench_series_add(bench_series *series, double value);
bench_spread bench_series_spread(const bench_series *series);

/* work / time, with the quartiles in their order again. */
bench_spread bench_spread_rate(bench_spread times, double work);

#endif
