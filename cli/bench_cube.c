/* SPDX-License-Identifier: MIT
 *
 * The map of a new frame into the cube, and the cube into tables: each beside memcpy of what it reads. */
#include "bench.h"

#include "bench_memcpy.h"

#include <stdio.h>

typedef struct light_work {
    bench_light *light;
    bench_team *team;
    bench_memcpy copy;
} light_work;

static int create(bench *b, const bench_point *point, size_t bytes, light_work *work, bench_job *jobs)
{
    jobs[0].data = work;
    jobs[1] = (bench_job){.run = bench_memcpy_run, .data = &work->copy};
    int code = bench_light_at(b, point, &work->light);
    if (code == EXIT_CODE_OK)
        code = bench_team_create(point->threads, &work->team);
    if (code == EXIT_CODE_OK)
        code = bench_memcpy_create(work->team, bytes, &work->copy);
    return code;
}

static void fill(const light_work *work, const bench_job *jobs, const char *what, bench_result *result)
{
    result->map[0] = work->light->map.width;
    result->map[1] = work->light->map.height;
    result->env_size = work->light->env_size;
    result->value = bench_time(&jobs[0], 0);
    result->ratio_to_memcpy = bench_time_ratio(jobs);
    snprintf(result->note, sizeof result->note, "%.2f x memcpy of the %s", result->ratio_to_memcpy, what);
}

static void release(void *data)
{
    light_work *work = data;
    bench_memcpy_destroy(&work->copy);
    bench_team_destroy(work->team);
}

/* ---- cube ----------------------------------------------------------------------------- */

static int update_cube(void *data, double *times)
{
    light_work *work = data;
    (void)times;
    return bench_check(helio_environment_update(work->light->environment, work->light->map.rgb, NULL));
}

static int create_cube(bench *b, const bench_point *point, void *work, bench_job *jobs)
{
    jobs[0].run = update_cube;
    return create(b, point, (size_t)point->map[0] * point->map[1] * 3 * sizeof(float), work, jobs);
}

static void fill_cube(const void *work, const bench_job *jobs, bench_result *result)
{
    fill(work, jobs, "map", result);
}

int bench_run_cube(bench *b)
{
    static const bench_subject subject = {"Map into cube", "ms", sizeof(light_work), create_cube, fill_cube, release};
    static const bench_axis axes[] = {BENCH_BY_MAP, BENCH_BY_CUBE, BENCH_BY_THREADS};
    return bench_curves(b, &subject, axes, sizeof axes / sizeof axes[0]);
}

/* ---- tables --------------------------------------------------------------------------- */

static int update_tables(void *data, double *times)
{
    light_work *work = data;
    (void)times;
    return bench_check(helio_tables_update(work->light->tables));
}

static int create_tables(bench *b, const bench_point *point, void *work, bench_job *jobs)
{
    jobs[0].run = update_tables;
    return create(b, point, bench_cube_bytes(point->env_size), work, jobs);
}

static void fill_tables(const void *work, const bench_job *jobs, bench_result *result)
{
    fill(work, jobs, "cube", result);
}

int bench_run_tables(bench *b)
{
    static const bench_subject subject = {"Tables", "ms", sizeof(light_work), create_tables, fill_tables, release};
    static const bench_axis axes[] = {BENCH_BY_ISA, BENCH_BY_CUBE, BENCH_BY_THREADS};
    return bench_curves(b, &subject, axes, sizeof axes / sizeof axes[0]);
}
