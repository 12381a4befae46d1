/* SPDX-License-Identifier: MIT */
#include "bench_peak.h"

#include "message.h"

#include <string.h>

bench_fma_loop bench_fma_scalar;
#ifdef HELIO_KERNELS_X86
bench_fma_loop bench_fma_sse2, bench_fma_avx2, bench_fma_avx512;
#else
bench_fma_loop bench_fma_simd;
#endif

static const struct {
    const char *isa;
    bench_fma_loop *loop;
    uint32_t lanes;
} loops[] = {
    {"scalar", bench_fma_scalar, 1},
#ifdef HELIO_KERNELS_X86
    {"sse2", bench_fma_sse2, 4},
    {"avx2", bench_fma_avx2, 8},
    {"avx512", bench_fma_avx512, 16},
#else
    {"simd", bench_fma_simd, 4},
#endif
};

bench_peak bench_peak_make(bench_team *team, const char *isa)
{
    bench_peak peak = {.team = team, .loop = loops[0].loop, .lanes = loops[0].lanes, .rounds = 200000};
    for (size_t i = 0; i < sizeof loops / sizeof loops[0]; i++)
        if (strcmp(loops[i].isa, isa) == 0) {
            peak.loop = loops[i].loop;
            peak.lanes = loops[i].lanes;
        }
    return peak;
}

double bench_peak_operations(const bench_peak *peak)
{
    return 2.0 * BENCH_CHAINS * peak->lanes * (double)peak->rounds * bench_team_threads(peak->team);
}

static void run_loop(void *data, uint32_t index, uint32_t threads)
{
    bench_peak *peak = data;
    float sum = peak->loop(peak->rounds);
    (void)threads;
    if (index == 0)
        peak->sink = sum;
}

int bench_peak_run(void *data, double *times)
{
    bench_peak *peak = data;
    (void)times;
    bench_team_run(peak->team, run_loop, peak);
    return EXIT_CODE_OK;
}
