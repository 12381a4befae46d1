/* SPDX-License-Identifier: MIT
 *
 * Compiled once for each instruction set, with HELIO_ISA and HELIO_LANES as the kernels of the library. */
#include "bench_peak.h"

#define JOIN(name, set) name##_##set
#define NAME(name, set) JOIN(name, set)
#define BENCH_FMA NAME(bench_fma, HELIO_ISA)

#if HELIO_LANES > 1
typedef float lanes __attribute__((vector_size(HELIO_LANES * sizeof(float))));
#define LANE(x, i) (x)[i]
#else
typedef float lanes;
#define LANE(x, i) (x)
#endif

bench_fma_loop BENCH_FMA;

/* Values tend to 1, so that none becomes infinite or so small that it takes longer. */
float BENCH_FMA(uint64_t rounds)
{
    lanes chains[BENCH_CHAINS];
    const lanes factor = (lanes){0} + 0.75f, addend = (lanes){0} + 0.25f;
    for (int i = 0; i < BENCH_CHAINS; i++)
        chains[i] = factor + (float)i;
    for (uint64_t round = 0; round < rounds; round++)
#pragma GCC unroll 14
        for (int i = 0; i < BENCH_CHAINS; i++)
            chains[i] = chains[i] * factor + addend;
    float sum = 0.0f;
    for (int i = 0; i < BENCH_CHAINS; i++)
        sum += LANE(chains[i], 0);
    return sum;
}
