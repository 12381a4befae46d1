/* SPDX-License-Identifier: MIT */
#include "bench_series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void bench_series_add(bench_series *series, double value)
{
    if (series->count < BENCH_REPEATS)
        series->values[series->count++] = value;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Between two values by their distance. */
static double quantile(const double *sorted, uint32_t count, double part)
{
    double position = part * (count - 1), below = floor(position), fraction = position - below;
    uint32_t i = (uint32_t)below;
    return fraction > 0 ? sorted[i] + fraction * (sorted[i + 1] - sorted[i]) : sorted[i];
}

bench_spread bench_series_spread(const bench_series *series)
{
    double sorted[BENCH_REPEATS];
    uint32_t count = series->count;
    if (count == 0)
        return (bench_spread){0};
    memcpy(sorted, series->values, count * sizeof sorted[0]);
    qsort(sorted, count, sizeof sorted[0], compare);
    return (bench_spread){quantile(sorted, count, 0.5), quantile(sorted, count, 0.25), quantile(sorted, count, 0.75),
                          count};
}

bench_spread bench_spread_rate(bench_spread times, double work)
{
    const double least = 1e-9; /* a clock may stand still */
    return (bench_spread){work / fmax(times.median, least), work / fmax(times.high, least),
                          work / fmax(times.low, least), times.repeats};
}
