/* SPDX-License-Identifier: MIT
 *
 * Meshes made ready for rays. */
#include "bench.h"

#include "machine.h"

#include <stdio.h>

typedef struct scene_work {
    bench_light *light; /* for its context */
    bench_mesh mesh;
    const helio_material *material;
} scene_work;

/* Taking it down again does not count. */
static int build_scene(void *data, double *times)
{
    const scene_work *work = data;
    const helio_scene_desc desc = {.mesh = work->mesh.mesh, .material = work->material};
    helio_scene *scene;
    double start = machine_milliseconds();
    helio_status status = helio_scene_create(work->light->context, &desc, &scene);
    times[0] = machine_milliseconds() - start;
    if (status != HELIO_OK)
        return bench_check(status);
    helio_scene_destroy(scene);
    return EXIT_CODE_OK;
}

static int create(bench *b, const bench_point *point, void *data, bench_job *jobs)
{
    scene_work *work = data;
    work->material = &point->material->material;
    jobs[0] = (bench_job){.run = build_scene, .data = work, .time_count = 1};
    int code = bench_light_at(b, point, &work->light);
    return code == EXIT_CODE_OK ? bench_mesh_at(b, point, &work->mesh) : code;
}

static void fill(const void *data, const bench_job *jobs, bench_result *result)
{
    const scene_work *work = data;
    bench_mesh_describe(&work->mesh, result);
    result->value = bench_time(&jobs[0], 0);
    snprintf(result->note, sizeof result->note, "%.2f M triangles/s", result->triangles / result->value.median / 1e3);
}

static void release(void *data)
{
    scene_work *work = data;
    bench_mesh_release(&work->mesh);
}

int bench_run_scene(bench *b)
{
    static const bench_subject subject = {"Mesh made ready for rays", "ms", sizeof(scene_work), create, fill, release};
    static const bench_axis axes[] = {BENCH_BY_MESH, BENCH_BY_THREADS};
    return bench_curves(b, &subject, axes, sizeof axes / sizeof axes[0]);
}
