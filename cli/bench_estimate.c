/* SPDX-License-Identifier: MIT
 *
 * The estimate at many points without rays, beside multiply-adds alone. The points' normals are spread over the sphere;
 * neighbours differ little, as those of a picture do. */
#include "bench.h"

#include "bench_flops.h"
#include "bench_peak.h"
#include "interrupt.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { POINTS = 2048, PIECE = 32 /* points that a thread takes at a time */ };
_Static_assert(POINTS % PIECE == 0, "pieces are whole");

typedef struct estimate_work {
    const bench_material *material;
    helio_strategy strategy;
    uint32_t spp, calls; /* estimates of a point, each of desc.samples, as pools give no more at once */
    helio_estimate_desc desc;
    bench_light *light;
    helio_pools *pools;
    bench_team *team;
    bench_peak peak;
    atomic_uint next; /* point */
    helio_shading_point points[POINTS];
} estimate_work;

/* ---- points --------------------------------------------------------------------------- */

/* The i-th of many directions that cover the sphere evenly, along a spiral from pole to pole. */
static void spiral(uint32_t i, float direction[3])
{
    const double pi = 3.14159265358979323846;
    double height = 1 - (2 * i + 1.0) / POINTS, radius = sqrt(1 - height * height);
    double azimuth = sqrt(pi * POINTS) * acos(height);
    direction[0] = (float)(radius * cos(azimuth));
    direction[1] = (float)height;
    direction[2] = (float)(radius * sin(azimuth));
}

/* Seen at 45 degrees. */
static void make_point(const helio_material *material, uint32_t i, helio_shading_point *point)
{
    *point = (helio_shading_point){.material = *material, .seed = i * 2654435761u};
    float *n = point->normal;
    spiral(i, n);
    float across = sqrtf(n[0] * n[0] + n[2] * n[2]), half = sqrtf(0.5f);
    const float tangent[3] = {n[2] / across, 0, -n[0] / across};
    for (int axis = 0; axis < 3; axis++)
        point->view[axis] = half * (n[axis] + tangent[axis]);
}

/* ---- work ----------------------------------------------------------------------------- */

static helio_status estimate_piece(const estimate_work *work, uint32_t first)
{
    float radiance[PIECE][3];
    helio_shading_point points[PIECE];
    helio_status status = HELIO_OK;
    memcpy(points, work->points + first, sizeof points);
    for (uint32_t call = 0; status == HELIO_OK && call < work->calls; call++) {
        status = helio_estimate_points(work->pools, PIECE, points, &work->desc, radiance, NULL);
        for (uint32_t i = 0; i < PIECE; i++)
            points[i].seed++;
    }
    return status;
}

static void estimate_pieces(void *data, uint32_t index, uint32_t threads)
{
    estimate_work *work = data;
    (void)index;
    (void)threads;
    for (;;) {
        uint32_t first = atomic_fetch_add_explicit(&work->next, PIECE, memory_order_relaxed);
        if (first >= POINTS || interrupt_signal() != 0 || estimate_piece(work, first) != HELIO_OK)
            return;
    }
}

static int run_estimates(void *data, double *times)
{
    estimate_work *work = data;
    (void)times;
    atomic_store_explicit(&work->next, 0, memory_order_relaxed);
    bench_team_run(work->team, estimate_pieces, work);
    return EXIT_CODE_OK;
}

/* ---- subject -------------------------------------------------------------------------- */

static void divide_samples(estimate_work *work, uint32_t spp)
{
    uint32_t limit = helio_pools_sample_limit(work->pools);
    work->calls = (spp + limit - 1) / limit;
    work->desc.samples = spp / work->calls;
    work->spp = work->desc.samples * work->calls;
}

static int make_pools(const bench_point *point, estimate_work *work)
{
    const helio_pools_desc desc = {.strategy = point->strategy};
    helio_status status = helio_pools_create(work->light->tables, &desc, &work->pools);
    if (status == HELIO_OK)
        status = helio_pools_draw(work->pools, 0, 0);
    if (status != HELIO_OK)
        return bench_check(status);
    divide_samples(work, point->spp);
    return bench_check(estimate_piece(work, 0)); /* other threads could not tell what is wrong */
}

static int create(bench *b, const bench_point *point, void *data, bench_job *jobs)
{
    estimate_work *work = data;
    work->material = point->material;
    work->strategy = point->strategy;
    for (uint32_t i = 0; i < POINTS; i++)
        make_point(&point->material->material, i, &work->points[i]);
    jobs[0] = (bench_job){.run = run_estimates, .data = work};
    jobs[1] = (bench_job){.run = bench_peak_run, .data = &work->peak};
    int code = bench_light_at(b, point, &work->light);
    if (code == EXIT_CODE_OK)
        code = make_pools(point, work);
    if (code == EXIT_CODE_OK)
        code = bench_team_create(point->threads, &work->team);
    if (code == EXIT_CODE_OK)
        work->peak = bench_peak_make(work->team, point->isa);
    return code;
}

static void fill(const void *data, const bench_job *jobs, bench_result *result)
{
    const estimate_work *work = data;
    double samples = (double)POINTS * work->spp;
    result->strategy = helio_strategy_name(helio_strategy_resolve(work->strategy));
    result->material = work->material->name;
    result->spp = work->spp;
    result->env_size = work->light->env_size;
    result->value = bench_spread_rate(bench_time(&jobs[0], 0), samples / 1e3);
    result->samples_per_second = result->value.median * 1e6;
    result->flops_per_sample = bench_flops_per_sample(work->strategy, work->material->material.kind);
    result->share_of_fma_peak =
        result->flops_per_sample * samples / bench_peak_operations(&work->peak) / bench_time_ratio(jobs);
    snprintf(result->note, sizeof result->note, "%4.1f %% of the peak, at %.0f operations a sample",
             100 * result->share_of_fma_peak, result->flops_per_sample);
}

static void release(void *data)
{
    estimate_work *work = data;
    bench_team_destroy(work->team);
    helio_pools_destroy(work->pools);
}

/* All strategies, for each material and instruction set. */
static int run_matrix(bench *b)
{
    bench_point point = bench_first_point(b);
    int code = EXIT_CODE_OK;
    for (uint32_t m = 0; m < b->plan->material_count; m++)
        for (uint32_t i = 0; code == EXIT_CODE_OK && i < b->plan->isa_count; i++) {
            char title[LIST_ITEM + 48];
            point.material = &b->plan->materials[m];
            point.isa = b->plan->isas[i];
            snprintf(title, sizeof title, "Estimate, %s, %s", point.material->name, point.isa);
            const bench_subject subject = {title, "M samples/s", sizeof(estimate_work), create, fill, release};
            code = bench_curve(b, &subject, &point, BENCH_BY_STRATEGY);
        }
    return code;
}

int bench_run_estimate(bench *b)
{
    static const bench_subject subject = {"Estimate", "M samples/s", sizeof(estimate_work), create, fill, release};
    static const bench_axis axes[] = {BENCH_BY_SPP, BENCH_BY_THREADS};
    int code = run_matrix(b);
    for (size_t i = 0; code == EXIT_CODE_OK && i < sizeof axes / sizeof axes[0]; i++) {
        const bench_point first = bench_first_point(b);
        if (bench_axis_count(b, axes[i]) > 1)
            code = bench_curve(b, &subject, &first, axes[i]);
    }
    return code;
}
