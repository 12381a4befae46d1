/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include "interrupt.h"
#include "machine.h"
#include "message.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE_WIDTH = 78, MOST_LOOPS = 1 << 20 };
static const double LEAST_MS = 2; /* of a repetition, so that the clock and the start of threads do not count */
static const uint32_t MADE_TRIANGLES = 200000; /* in place of the dragon */

int bench_check(helio_status status)
{
    return status == HELIO_OK ? EXIT_CODE_OK : message_failure("%s", helio_last_error());
}

int bench_interrupted(void)
{
    return interrupt_signal() != 0 ? EXIT_CODE_SIGNAL + interrupt_signal() : EXIT_CODE_OK;
}

/* One line on stderr, which the next one replaces; without a title it is cleared. */
static void show_progress(const bench *b, const char *title, uint32_t repeat)
{
    char line[LINE_WIDTH + 1] = "";
    if (!b->shows_progress)
        return;
    if (title != NULL)
        snprintf(line, sizeof line, "measuring (part %d of %d), %.45s: %u of %u", b->stage + 1, BENCH_STAGES, title,
                 repeat + 1, b->plan->repeat);
    fprintf(stderr, "\r%-*s%s", LINE_WIDTH, line, title == NULL ? "\r" : "");
    fflush(stderr);
}

/* times: [BENCH_TIMES], ms of one call. */
static int run_job(bench_job *job, double *times)
{
    double start = machine_milliseconds();
    int code = EXIT_CODE_OK;
    for (uint32_t loop = 0; code == EXIT_CODE_OK && loop < job->loops; loop++)
        code = job->run(job->data, times);
    if (job->time_count == 0)
        times[0] = (machine_milliseconds() - start) / job->loops;
    return code != EXIT_CODE_OK ? code : bench_interrupted();
}

/* The first run brings memory and caches into the state of all later ones; it also tells how many loops are enough. */
static int warm_up(bench_job *job)
{
    double times[BENCH_TIMES];
    if (job->run == NULL)
        return EXIT_CODE_OK;
    job->loops = 1;
    int code = run_job(job, times);
    if (code == EXIT_CODE_OK && job->time_count == 0 && times[0] < LEAST_MS)
        job->loops = (uint32_t)fmin(ceil(LEAST_MS / fmax(times[0], 1e-6)), MOST_LOOPS);
    return code;
}

static int repeat_job(bench_job *job)
{
    double times[BENCH_TIMES];
    uint32_t count = job->time_count > 0 ? job->time_count : 1;
    if (job->run == NULL)
        return EXIT_CODE_OK;
    int code = run_job(job, times);
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < count; i++)
        bench_series_add(&job->series[i], times[i]);
    return code;
}

int bench_measure(bench *b, const char *title, bench_job *jobs, size_t count)
{
    const bench_plan *plan = b->plan;
    int code = EXIT_CODE_OK;
    show_progress(b, title, 0);
    for (size_t i = 0; code == EXIT_CODE_OK && i < count; i++)
        code = warm_up(&jobs[i]);
    double end = machine_milliseconds() + plan->job_ms * (double)count;
    for (uint32_t repeat = 0; code == EXIT_CODE_OK && repeat < plan->repeat; repeat++) {
        if (repeat >= plan->least_repeats && machine_milliseconds() > end)
            break;
        show_progress(b, title, repeat);
        for (size_t i = 0; code == EXIT_CODE_OK && i < count; i++)
            code = repeat_job(&jobs[i]);
    }
    show_progress(b, NULL, 0);
    return code;
}

bench_spread bench_time(const bench_job *job, uint32_t index)
{
    return bench_series_spread(&job->series[index]);
}

double bench_time_ratio(const bench_job *jobs)
{
    const bench_series *times = &jobs[0].series[0], *others = &jobs[1].series[0];
    bench_series ratios = {0};
    for (uint32_t i = 0; i < times->count && i < others->count; i++)
        bench_series_add(&ratios, times->values[i] / fmax(others->values[i], 1e-9));
    return bench_series_spread(&ratios).median;
}

int bench_light_at(bench *b, const bench_point *point, bench_light **light)
{
    return bench_light_find(&b->lights, b->source, point->isa, point->threads, point->map, point->env_size, light);
}

/* Read once, with what the library takes for a damaged file. */
static int load_mesh(bench *b)
{
    const bench_plan *plan = b->plan;
    if (plan->mesh[0] == 0)
        return bench_mesh_create(b->context, MADE_TRIANGLES, &b->mesh);
    const helio_mesh_load_desc limits = {.max_memory = (uint64_t)plan->options->max_mesh_memory << 20,
                                         .max_seconds = plan->options->max_mesh_seconds,
                                         .max_pixels = plan->options->max_pixels};
    b->mesh = (bench_mesh){.name = plan->mesh_name, .context = b->context};
    return bench_check(helio_mesh_load(b->context, plan->mesh, &limits, &b->mesh.mesh));
}

int bench_mesh_at(bench *b, const bench_point *point, bench_mesh *mesh)
{
    if (point->triangles > 0)
        return bench_mesh_create(b->context, point->triangles, mesh);
    int code = b->mesh.mesh == NULL ? load_mesh(b) : EXIT_CODE_OK;
    *mesh = (bench_mesh){.name = b->mesh.name, .mesh = b->mesh.mesh};
    return code;
}

size_t bench_cube_bytes(uint32_t env_size)
{
    return (size_t)env_size * env_size * 6 * 3 * sizeof(float);
}

bench_result bench_result_begin(const bench *b, const char *isa, uint32_t threads, const char *unit)
{
    return (bench_result){.stage = bench_stage_name(b->stage), .isa = isa, .threads = threads, .unit = unit};
}

int bench_publish(bench *b, const char *title, const bench_result *results, size_t count)
{
    if (b->shows_table)
        bench_table_print(title, results, count);
    return bench_results_add(&b->results, results, count);
}
