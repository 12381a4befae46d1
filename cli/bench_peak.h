/* SPDX-License-Identifier: MIT
 * bench_peak.h - what the processor multiplies and adds at most: arithmetic alone, with nothing to wait for. */
#ifndef HELIOSTAT_CLI_BENCH_PEAK_H
#define HELIOSTAT_CLI_BENCH_PEAK_H

#include "bench_team.h"

#include <stdint.h>

/* Independent chains of a round: enough to hide the latency of a multiply-add, and with two constants as many as the
 * least of the instruction sets has registers. */
enum { BENCH_CHAINS = 14 };

/* A register full of multiply-adds for each chain, rounds times. Built once for each instruction set; a name ends in
 * that of its set. Where there is no fused instruction it is a multiplication and an addition. */
typedef float bench_fma_loop(uint64_t rounds);

typedef struct bench_peak {
    bench_team *team; /* the caller's */
    bench_fma_loop *loop;
    uint32_t lanes;
    uint64_t rounds; /* of each thread */
    float sink;      /* makes the result be needed */
} bench_peak;

/* isa: a name of helio_isa_name(). */
bench_peak bench_peak_make(bench_team *team, const char *isa);

/* Floating-point operations of one run, all threads: two for a multiply-add. */
double bench_peak_operations(const bench_peak *peak);

/* data: bench_peak. Fits bench_job. */
int bench_peak_run(void *data, double *times);

#endif
