/* SPDX-License-Identifier: MIT
 *
 * What the machine can do at most: memory by memcpy, arithmetic by multiply-adds. */
#include "bench.h"

#include "bench_memcpy.h"
#include "bench_peak.h"

#include <stdio.h>

/* Of one number of threads: memcpy first, then each instruction set. */
typedef struct machine_limits {
    bench_team *team;
    bench_memcpy copy;
    bench_peak peaks[BENCH_LIST];
    bench_job jobs[1 + BENCH_LIST];
} machine_limits;

static void fill_copy(const bench *b, const machine_limits *limits, bench_result *result)
{
    const bench_job *job = &limits->jobs[0];
    *result = bench_result_begin(b, NULL, bench_team_threads(limits->team), "GB/s");
    result->env_size = b->plan->env_sizes.values[0];
    result->value = bench_spread_rate(bench_time(job, 0), (double)limits->copy.bytes / 1e6);
    result->stage = "memcpy";
    snprintf(result->label, sizeof result->label, "%u thread%s", result->threads, result->threads == 1 ? "" : "s");
    snprintf(result->note, sizeof result->note, "%.1f MB in %.3g ms", (double)limits->copy.bytes / 1e6,
             bench_time(job, 0).median);
}

static void fill_peak(const bench *b, const machine_limits *limits, uint32_t i, bench_result *result)
{
    *result = bench_result_begin(b, b->plan->isas[i], bench_team_threads(limits->team), "GFLOPS");
    result->value =
        bench_spread_rate(bench_time(&limits->jobs[1 + i], 0), bench_peak_operations(&limits->peaks[i]) / 1e6);
    result->stage = "fma";
    snprintf(result->label, sizeof result->label, "%s, %u thread%s", result->isa, result->threads,
             result->threads == 1 ? "" : "s");
}

/* copies: [1], peaks: [isa_count]. */
static int measure_threads(bench *b, uint32_t threads, bench_result *copy, bench_result *peaks)
{
    const bench_plan *plan = b->plan;
    uint32_t cube = plan->env_sizes.values[0];
    machine_limits limits = {0};
    int code = bench_team_create(threads, &limits.team);
    if (code == EXIT_CODE_OK)
        code = bench_memcpy_create(limits.team, bench_cube_bytes(cube), &limits.copy);
    limits.jobs[0] = (bench_job){.run = bench_memcpy_run, .data = &limits.copy};
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < plan->isa_count; i++) {
        limits.peaks[i] = bench_peak_make(limits.team, plan->isas[i]);
        limits.jobs[1 + i] = (bench_job){.run = bench_peak_run, .data = &limits.peaks[i]};
    }
    if (code == EXIT_CODE_OK)
        code = bench_measure(b, "memcpy and multiply-adds", limits.jobs, 1 + plan->isa_count);
    if (code == EXIT_CODE_OK) {
        fill_copy(b, &limits, copy);
        for (uint32_t i = 0; i < plan->isa_count; i++)
            fill_peak(b, &limits, i, &peaks[i]);
    }
    bench_memcpy_destroy(&limits.copy);
    bench_team_destroy(limits.team);
    return code;
}

int bench_run_machine(bench *b)
{
    const bench_plan *plan = b->plan;
    bench_result copies[BENCH_LIST] = {0}, peaks[BENCH_LIST * BENCH_LIST] = {0};
    int code = EXIT_CODE_OK;
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < plan->threads.count; i++)
        code = measure_threads(b, plan->threads.values[i], &copies[i], &peaks[i * plan->isa_count]);
    if (code != EXIT_CODE_OK)
        return code;
    b->memcpy_gb_per_s = copies[0].value.median;
    b->fma_peak_gflops = peaks[0].value.median;
    code = bench_publish(b, "memcpy, split over the threads: bytes copied", copies, plan->threads.count);
    if (code == EXIT_CODE_OK)
        code = bench_publish(b, "Multiply-adds in registers: the arithmetic peak", peaks,
                             (size_t)plan->threads.count * plan->isa_count);
    return code;
}
