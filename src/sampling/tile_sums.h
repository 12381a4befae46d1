/* SPDX-License-Identifier: MIT
 * tile_sums.h - sums over the tiles of a group, over groups, and which of sixteen are true; for kernels. The order is
 * the same for all instruction sets, and so are the bits. */
#ifndef HELIOSTAT_SRC_TILE_SUMS_H
#define HELIOSTAT_SRC_TILE_SUMS_H

#include "sampling/tile_groups.h"

static inline float sum_of_tiles(const float *values)
{
    float eight[8], four[4];
#pragma omp simd
    for (uint32_t i = 0; i < 8; i++)
        eight[i] = values[i] + values[i + 8];
#pragma omp simd
    for (uint32_t i = 0; i < 4; i++)
        four[i] = eight[i] + eight[i + 4];
    return (four[0] + four[2]) + (four[1] + four[3]);
}

static inline float sum_of_groups(const float *values)
{
    float runs[TILE_RUN];
    _Static_assert((int)TILE_RUN == (int)TILE_GROUP && (int)TILE_RUNS == 6, "six sums of sixteen");
#pragma omp simd
    for (uint32_t i = 0; i < TILE_RUN; i++)
        runs[i] =
            ((values[i] + values[i + 16]) + (values[i + 32] + values[i + 48])) + (values[i + 64] + values[i + 80]);
    return sum_of_tiles(runs);
}

/* Which of the groups of a run, or of the tiles of a group, are true, as bits. */
static inline uint32_t bits_of(const int32_t *truths)
{
    uint32_t bits = 0;
#pragma omp simd reduction(| : bits)
    for (uint32_t i = 0; i < TILE_RUN; i++)
        bits |= (truths[i] != 0) << i;
    return bits;
}

#endif
