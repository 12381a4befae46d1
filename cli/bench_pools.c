/* SPDX-License-Identifier: MIT
 *
 * Pools of 6 x 1024 samples, drawn from the tables. */
#include "bench.h"

#include <stdio.h>

enum { POOL_LENGTH = 1024 };

typedef struct pools_work {
    bench_light *light;
    helio_pools *pools;
    uint32_t pass; /* each draws other samples */
} pools_work;

static int draw_pools(void *data, double *times)
{
    pools_work *work = data;
    (void)times;
    return bench_check(helio_pools_draw(work->pools, 0, work->pass++));
}

static int create(bench *b, const bench_point *point, void *data, bench_job *jobs)
{
    pools_work *work = data;
    jobs[0] = (bench_job){.run = draw_pools, .data = work};
    int code = bench_light_at(b, point, &work->light);
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_FACE, .length = POOL_LENGTH};
    return code == EXIT_CODE_OK ? bench_check(helio_pools_create(work->light->tables, &desc, &work->pools)) : code;
}

static void fill(const void *data, const bench_job *jobs, bench_result *result)
{
    const pools_work *work = data;
    result->env_size = work->light->env_size;
    result->strategy = helio_strategy_name(HELIO_STRATEGY_FACE);
    result->value = bench_time(&jobs[0], 0);
    result->samples_per_second = 6 * POOL_LENGTH / result->value.median * 1e3;
    snprintf(result->note, sizeof result->note, "%.1f M samples/s", result->samples_per_second / 1e6);
}

static void release(void *data)
{
    pools_work *work = data;
    helio_pools_destroy(work->pools);
}

int bench_run_pools(bench *b)
{
    static const bench_subject subject = {"Pools, 6 x 1024 samples", "ms", sizeof(pools_work), create, fill, release};
    static const bench_axis axes[] = {BENCH_BY_ISA, BENCH_BY_CUBE, BENCH_BY_THREADS};
    return bench_curves(b, &subject, axes, 3);
}
