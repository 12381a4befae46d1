/* SPDX-License-Identifier: MIT
 *
 * Rays apart from what else a frame does. */
#include "bench_frame.h"

#include <stdio.h>

static void fill_camera_rays(const void *data, const bench_job *jobs, bench_result *result)
{
    const frame_work *work = data;
    frame_work_fill(work, jobs, result);
    result->stage = "camera_rays";
    result->value = bench_spread_rate(bench_time(&jobs[0], 4), (double)work->info.camera_rays / 1e3);
    snprintf(result->note, sizeof result->note, "%u triangles, %.0f %% covered", result->triangles,
             100 * result->coverage);
}

static void fill_shadow_rays(const void *data, const bench_job *jobs, bench_result *result)
{
    const frame_work *work = data;
    frame_work_fill(work, jobs, result);
    result->stage = "shadow_rays";
    result->value = bench_spread_rate(bench_time(&jobs[0], 5), (double)work->info.rays / 1e3);
    result->samples_per_second = (double)work->info.samples / bench_time(&jobs[0], 5).median * 1e3;
    snprintf(result->note, sizeof result->note, "%u triangles, %.1f M samples/s", result->triangles,
             result->samples_per_second / 1e6);
}

int bench_run_rays(bench *b)
{
    static const bench_subject camera = {"Camera rays",     "M rays/s",       sizeof(frame_work),
                                         frame_work_create, fill_camera_rays, frame_work_release};
    static const bench_subject shadow = {"Shadow rays with their shading",
                                         "M rays/s",
                                         sizeof(frame_work),
                                         frame_work_create,
                                         fill_shadow_rays,
                                         frame_work_release};
    bench_point point = bench_first_point(b);
    point.scenario = BENCH_TRACED;
    point.spp = 1;
    int code = bench_curve(b, &camera, &point, BENCH_BY_MESH);
    point = bench_first_point(b);
    point.scenario = BENCH_SHADOW;
    return code == EXIT_CODE_OK ? bench_curve(b, &shadow, &point, BENCH_BY_MESH) : code;
}
