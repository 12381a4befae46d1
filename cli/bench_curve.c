/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- points and axes ------------------------------------------------------------------ */

static const char *const axis_names[] = {
    [BENCH_BY_ISA] = "instruction set",   [BENCH_BY_THREADS] = "threads",       [BENCH_BY_MAP] = "size of the map",
    [BENCH_BY_CUBE] = "size of the cube", [BENCH_BY_SPP] = "samples per point", [BENCH_BY_STRATEGY] = "strategy",
    [BENCH_BY_MESH] = "size of the mesh", [BENCH_BY_SCENARIO] = "camera rays",
};

bench_point bench_first_point(const bench *b)
{
    const bench_plan *plan = b->plan;
    return (bench_point){
        .isa = plan->isas[0],
        .threads = plan->threads.values[0],
        .map = {plan->map_sizes.values[0][0], plan->map_sizes.values[0][1]},
        .env_size = plan->env_sizes.values[0],
        .spp = plan->spp.values[0],
        .strategy = plan->strategies[0],
        .material = &plan->materials[0],
    };
}

uint32_t bench_axis_count(const bench *b, bench_axis axis)
{
    const bench_plan *plan = b->plan;
    switch (axis) {
    case BENCH_BY_ISA: return plan->isa_count;
    case BENCH_BY_THREADS: return plan->threads.count;
    case BENCH_BY_MAP: return plan->map_sizes.count;
    case BENCH_BY_CUBE: return plan->env_sizes.count;
    case BENCH_BY_SPP: return plan->spp.count;
    case BENCH_BY_STRATEGY: return plan->strategy_count;
    case BENCH_BY_MESH: return 1 + plan->mesh_sizes.count;
    case BENCH_BY_SCENARIO: break; /* kept and traced */
    }
    return 2;
}

void bench_axis_move(const bench *b, bench_axis axis, uint32_t i, bench_point *point, char *label, size_t size)
{
    const bench_plan *plan = b->plan;
    switch (axis) {
    case BENCH_BY_ISA:
        point->isa = plan->isas[i];
        snprintf(label, size, "%s", point->isa);
        break;
    case BENCH_BY_THREADS:
        point->threads = plan->threads.values[i];
        snprintf(label, size, "%u thread%s", point->threads, point->threads == 1 ? "" : "s");
        break;
    case BENCH_BY_MAP:
        point->map[0] = plan->map_sizes.values[i][0];
        point->map[1] = plan->map_sizes.values[i][1];
        snprintf(label, size, "map %ux%u", point->map[0], point->map[1]);
        break;
    case BENCH_BY_CUBE:
        point->env_size = plan->env_sizes.values[i];
        snprintf(label, size, "cube 6x%ux%u", point->env_size, point->env_size);
        break;
    case BENCH_BY_SPP:
        point->spp = plan->spp.values[i];
        snprintf(label, size, "%u spp", point->spp);
        break;
    case BENCH_BY_STRATEGY:
        point->strategy = plan->strategies[i];
        snprintf(label, size, "%s", helio_strategy_name(point->strategy));
        break;
    case BENCH_BY_MESH:
        point->triangles = i > 0 ? plan->mesh_sizes.values[i - 1] : 0;
        snprintf(label, size, "%.28s", i > 0 ? BENCH_MADE_MESH : plan->mesh_name);
        break;
    case BENCH_BY_SCENARIO:
        point->scenario = (bench_scenario)i;
        snprintf(label, size, "%s", i == BENCH_KEPT ? "camera rays kept" : "camera rays traced each frame");
        break;
    }
}

/* ---- curves --------------------------------------------------------------------------- */

/* What is measured at one value of the axis. */
typedef struct stop {
    bench_point point;
    bench_result result;
    void *work;
    bench_job *jobs; /* [BENCH_JOBS] */
} stop;

typedef struct curve {
    uint32_t count;
    stop stops[1 + BENCH_LIST];
    char *works;
    bench_job *jobs; /* [count][BENCH_JOBS] */
} curve;

static int create_stop(bench *b, const bench_subject *subject, bench_axis axis, uint32_t index, stop *s)
{
    const bench_point *point = &s->point;
    char label[sizeof s->result.label];
    bench_axis_move(b, axis, index, &s->point, label, sizeof label);
    s->result = bench_result_begin(b, point->isa, point->threads, subject->unit);
    memcpy(s->result.label, label, sizeof label);
    int code = bench_interrupted();
    return code != EXIT_CODE_OK ? code : subject->create(b, point, s->work, s->jobs);
}

/* Where memory ran out, count is 0. */
static void begin_curve(const bench *b, const bench_subject *subject, const bench_point *point, bench_axis axis,
                        curve *c)
{
    c->count = bench_axis_count(b, axis);
    c->works = calloc(c->count, subject->size);
    c->jobs = calloc(c->count * BENCH_JOBS, sizeof c->jobs[0]);
    if (c->works == NULL || c->jobs == NULL)
        c->count = 0;
    for (uint32_t i = 0; i < c->count; i++)
        c->stops[i] = (stop){.point = *point, .work = c->works + i * subject->size, .jobs = c->jobs + i * BENCH_JOBS};
}

static void end_curve(const bench_subject *subject, curve *c)
{
    for (uint32_t i = 0; i < c->count; i++)
        subject->release(c->stops[i].work);
    free(c->works);
    free(c->jobs);
}

static int publish_curve(bench *b, const bench_subject *subject, const char *title, curve *c)
{
    bench_result results[1 + BENCH_LIST];
    for (uint32_t i = 0; i < c->count; i++) {
        subject->fill(c->stops[i].work, c->stops[i].jobs, &c->stops[i].result);
        results[i] = c->stops[i].result;
    }
    return bench_publish(b, title, results, c->count);
}

int bench_curve(bench *b, const bench_subject *subject, const bench_point *point, bench_axis axis)
{
    curve c;
    char title[LIST_ITEM * 2];
    snprintf(title, sizeof title, "%s, by %s", subject->title, axis_names[axis]);
    begin_curve(b, subject, point, axis, &c);
    int code = c.count > 0 ? EXIT_CODE_OK : message_failure("no memory to measure %s", subject->title);
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < c.count; i++)
        code = create_stop(b, subject, axis, i, &c.stops[i]);
    if (code == EXIT_CODE_OK)
        code = bench_measure(b, title, c.jobs, (size_t)c.count * BENCH_JOBS);
    if (code == EXIT_CODE_OK)
        code = publish_curve(b, subject, title, &c);
    end_curve(subject, &c);
    return code;
}

int bench_curves(bench *b, const bench_subject *subject, const bench_axis *axes, size_t count)
{
    const bench_point first = bench_first_point(b);
    int code = EXIT_CODE_OK;
    for (size_t i = 0; code == EXIT_CODE_OK && i < count; i++)
        if (i == 0 || bench_axis_count(b, axes[i]) > 1)
            code = bench_curve(b, subject, &first, axes[i]);
    return code;
}
