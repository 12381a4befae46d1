/* SPDX-License-Identifier: MIT
 * bench_frame.h - frames and what they need, for the stages that render. */
#ifndef HELIOSTAT_CLI_BENCH_FRAME_H
#define HELIOSTAT_CLI_BENCH_FRAME_H

#include "bench.h"

typedef struct frame_work {
    bench_point point;
    uint32_t size[2];
    bench_light *light;
    bench_map other_map; /* takes turns with that of the light, without shadow rays */
    bench_mesh mesh;
    helio_scene *scene;
    helio_camera camera;
    helio_device *device; /* that computes; NULL: the CPU does */
    helio_renderer *renderer;
    uint32_t frame;
    uint32_t row;          /* frames that a device makes in a row */
    helio_frame_info info; /* of the latest */
} frame_work;

/* For bench_subject; the size is that of frame_work. The job measures the time of a frame, then those of its parts:
 * cube, tables, pools, camera rays, shading. */
int frame_work_create(bench *b, const bench_point *point, void *work, bench_job *jobs);
void frame_work_release(void *work);

/* Writes the parameters and the parts; value and note are the stage's. */
void frame_work_fill(const frame_work *work, const bench_job *jobs, bench_result *result);

#endif
