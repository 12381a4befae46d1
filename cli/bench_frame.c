/* SPDX-License-Identifier: MIT
 *
 * Whole frames: the map changes each time, cube, tables and pools are made anew, the mesh is lit. */
#include "bench_frame.h"

#include "bench_camera.h"
#include "interrupt.h"
#include "machine.h"

#include <stdio.h>

enum { PARTS = 5 };
static const char *const part_names[PARTS] = {"cube_ms", "tables_ms", "pools_ms", "primary_ms", "shade_ms"};

static bool go_on(void *user, float done)
{
    (void)user;
    (void)done;
    return interrupt_signal() == 0;
}

static helio_status render(frame_work *work)
{
    const helio_frame_desc desc = {
        .camera = work->camera, .progress = go_on, .retrace = work->point.scenario == BENCH_TRACED};
    return helio_renderer_render(work->renderer, &desc, &work->info);
}

/* Without shadow rays the maps take turns. With them it is always the same, as the rays depend on it.
 * times: all, then the parts. */
static int run_frame(void *data, double *times)
{
    frame_work *work = data;
    bool takes_turns = work->point.scenario != BENCH_SHADOW;
    const float *rgb = takes_turns && work->frame++ % 2 ? work->other_map.rgb : work->light->map.rgb;
    double start = machine_milliseconds();
    helio_status status = helio_environment_update(work->light->environment, rgb, NULL);
    double updated = machine_milliseconds();
    if (status == HELIO_OK)
        status = render(work);
    times[0] = machine_milliseconds() - start;
    times[1] = updated - start;
    times[2] = work->info.tables_ms;
    times[3] = work->info.pools_ms;
    times[4] = work->info.primary_ms;
    times[5] = work->info.shade_ms;
    return bench_check(status);
}

/* ---- making --------------------------------------------------------------------------- */

static helio_status make_scene(const bench_point *point, frame_work *work)
{
    const helio_scene_desc scene = {.mesh = work->mesh.mesh, .material = &point->material->material};
    helio_status status = helio_scene_create(work->light->context, &scene, &work->scene);
    if (status == HELIO_OK)
        status = bench_camera_find(work->light->context, work->scene, work->mesh.mesh, work->size, &work->camera);
    if (status != HELIO_OK)
        return status;
    const helio_renderer_desc desc = {
        .environment = work->light->environment,
        .scene = work->scene,
        .width = work->size[0],
        .height = work->size[1],
        .spp = point->spp,
        .strategy = point->strategy,
        .no_visibility = point->scenario != BENCH_SHADOW,
        .device = work->device,
    };
    return helio_renderer_create(work->light->context, &desc, &work->renderer);
}

static uint32_t half(uint32_t pixels)
{
    return pixels > 1 ? pixels / 2 : 1;
}

int frame_work_create(bench *b, const bench_point *point, void *data, bench_job *jobs)
{
    frame_work *work = data;
    const uint32_t *size = b->plan->options->size;
    bool is_small = point->scenario == BENCH_SHADOW;
    work->point = *point;
    work->size[0] = is_small ? half(size[0]) : size[0];
    work->size[1] = is_small ? half(size[1]) : size[1];
    jobs[0] = (bench_job){.run = run_frame, .data = work, .time_count = 1 + PARTS};
    int code = bench_light_at(b, point, &work->light);
    if (code == EXIT_CODE_OK)
        code = bench_map_create(b->source, point->map, 90, &work->other_map);
    if (code == EXIT_CODE_OK)
        code = bench_mesh_at(b, point, &work->mesh);
    return code == EXIT_CODE_OK ? bench_check(make_scene(point, work)) : code;
}

void frame_work_release(void *data)
{
    frame_work *work = data;
    helio_renderer_destroy(work->renderer);
    helio_scene_destroy(work->scene);
    bench_mesh_release(&work->mesh);
    bench_map_destroy(&work->other_map);
}

/* ---- results -------------------------------------------------------------------------- */

void frame_work_fill(const frame_work *work, const bench_job *jobs, bench_result *result)
{
    const bench_point *point = &work->point;
    for (int axis = 0; axis < 2; axis++) {
        result->map[axis] = point->map[axis];
        result->size[axis] = work->size[axis];
    }
    result->env_size = point->env_size;
    result->spp = point->spp;
    result->strategy = helio_strategy_name(helio_strategy_resolve(point->strategy));
    result->material = point->material->name;
    result->visibility = point->scenario == BENCH_SHADOW ? "ray" : "none";
    result->camera_rays = point->scenario == BENCH_TRACED ? "traced" : "kept";
    result->coverage = (double)work->info.points / ((double)work->size[0] * work->size[1]);
    bench_mesh_describe(&work->mesh, result);
    for (int i = 0; i < PARTS; i++) {
        result->part_names[i] = part_names[i];
        result->parts[i] = bench_time(&jobs[0], 1 + (uint32_t)i);
    }
}

/* ---- stage ---------------------------------------------------------------------------- */

static void fill_frame(const void *data, const bench_job *jobs, bench_result *result)
{
    const frame_work *work = data;
    frame_work_fill(work, jobs, result);
    result->value = bench_spread_rate(bench_time(&jobs[0], 0), 1e3);
    result->samples_per_second = (double)work->info.samples * result->value.median;
    snprintf(result->note, sizeof result->note, "%.1f M samples/s, %.0f %% covered", result->samples_per_second / 1e6,
             100 * result->coverage);
}

/* The first of the results that the stage has published: what a frame's time goes to. */
static void print_parts(const bench *b, size_t first)
{
    static const char *const labels[PARTS] = {"map into cube", "tables", "pools", "camera rays", "shading"};
    const bench_result *frame = &b->results.items[first];
    bench_result lines[PARTS] = {0};
    for (int i = 0; i < PARTS; i++) {
        lines[i].unit = "ms";
        lines[i].value = frame->parts[i];
        snprintf(lines[i].label, sizeof lines[i].label, "%s", labels[i]);
    }
    if (b->shows_table)
        bench_table_print("Parts of a frame with camera rays kept", lines, PARTS);
}

int bench_run_frame(bench *b)
{
    static const bench_axis axes[] = {BENCH_BY_SCENARIO, BENCH_BY_SPP, BENCH_BY_THREADS};
    const uint32_t *size = b->plan->options->size;
    char title[256];
    snprintf(title, sizeof title, "Frames of %.60s, %ux%u, each with a new map, no shadow rays", b->plan->mesh_name,
             size[0], size[1]);
    const bench_subject subject = {title,      "frames/s",        sizeof(frame_work), frame_work_create,
                                   fill_frame, frame_work_release};
    size_t published = b->results.count;
    int code = bench_curves(b, &subject, axes, sizeof axes / sizeof axes[0]);
    if (code == EXIT_CODE_OK)
        print_parts(b, published);
    return code;
}
