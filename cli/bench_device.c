/* SPDX-License-Identifier: MIT
 *
 * Frames on a graphics processor: a map is sent each time, the picture is left where it is. */
#include "bench_frame.h"

#include "machine.h"

#include <math.h>
#include <stdio.h>

enum { FRAMES_IN_A_ROW = 64, FRAMES_OF_SOFTWARE = 3 };

typedef enum device_time {
    DEVICE_FRAME, /* by the host's clock */
    DEVICE_UPLOAD,
    DEVICE_CUBE,
    DEVICE_TABLES,
    DEVICE_POOLS,
    DEVICE_SHADE,
    DEVICE_BACK,
    DEVICE_TIMES
} device_time;
_Static_assert((int)DEVICE_TIMES == (int)BENCH_TIMES && (int)DEVICE_TIMES == BENCH_PARTS + 1, "all are kept");

static const char *const part_names[BENCH_PARTS] = {"upload_ms", "cube_ms",  "tables_ms",
                                                    "pools_ms",  "shade_ms", "read_back_ms"};
static const char *const part_labels[BENCH_PARTS] = {
    "light to the device", "map into cube", "tables", "pools", "shading", "picture to the host"};

/* ---- one frame -------------------------------------------------------------------------- */

/* The picture comes back in a frame of its own, whose other times do not count. */
static int read_picture(frame_work *work, double *milliseconds)
{
    const helio_frame_desc desc = {.camera = work->camera};
    helio_frame_info info = {0};
    int code = bench_check(helio_renderer_render(work->renderer, &desc, &info));
    *milliseconds = info.read_back_ms;
    return code;
}

/* Several in a row, each of another map, as the next is begun while one is on its way: the time of one is what they
 * take by the host's clock, divided by their number. */
static helio_status render_row(frame_work *work, double *milliseconds)
{
    helio_frame_desc desc = {
        .camera = work->camera, .no_picture = true, .retrace = work->point.scenario == BENCH_TRACED};
    helio_status status = HELIO_OK;
    const double start = machine_milliseconds();
    for (uint32_t i = 0; status == HELIO_OK && i < work->row; i++) {
        const float *rgb = work->frame++ % 2 ? work->other_map.rgb : work->light->map.rgb;
        desc.seed = i;
        status = helio_environment_update(work->light->environment, rgb, NULL);
        if (status == HELIO_OK)
            status = helio_renderer_render(work->renderer, &desc, &work->info);
    }
    *milliseconds = (machine_milliseconds() - start) / work->row;
    return status;
}

static int run_frame(void *data, double *times)
{
    frame_work *work = data;
    helio_status status = render_row(work, &times[DEVICE_FRAME]);
    times[DEVICE_UPLOAD] = work->info.upload_ms;
    times[DEVICE_CUBE] = work->info.cube_ms;
    times[DEVICE_TABLES] = work->info.tables_ms;
    times[DEVICE_POOLS] = work->info.pools_ms;
    times[DEVICE_SHADE] = work->info.shade_ms;
    return status == HELIO_OK ? read_picture(work, &times[DEVICE_BACK]) : bench_check(status);
}

static int create(bench *b, const bench_point *point, void *data, bench_job *jobs)
{
    frame_work *work = data;
    work->device = b->device;
    work->row = helio_device_get_info(b->device).kind == HELIO_DEVICE_SOFTWARE ? FRAMES_OF_SOFTWARE : FRAMES_IN_A_ROW;
    int code = frame_work_create(b, point, work, jobs);
    jobs[0] = (bench_job){.run = run_frame, .data = work, .time_count = DEVICE_TIMES};
    return code;
}

/* ---- results ---------------------------------------------------------------------------- */

/* What is read or written at the least, in bytes: the map; the map and its cube; the cube, solid angles and tables;
 * what is known of the points, and the picture. Cubes of software are the CPU's, and are sent. Of pools nobody can
 * tell: they come from caches. */
static double part_bytes(const frame_work *work, int part)
{
    const double size = work->point.env_size, pixels = (double)work->size[0] * work->size[1];
    const double map = 12.0 * work->point.map[0] * work->point.map[1];
    const double cube = 6 * size * size * 12, points = (double)work->info.points;
    const bool is_software = helio_device_get_info(work->device).kind == HELIO_DEVICE_SOFTWARE;
    switch (1 + part) {
    case DEVICE_UPLOAD: return is_software ? cube : map;
    case DEVICE_CUBE: return is_software ? 0 : map + cube;
    case DEVICE_TABLES: return cube + 4 * size * size + 6 * size * (size + 1) * 4;
    case DEVICE_SHADE: return points * 48 + (pixels - points) * 16 + pixels * 20;
    case DEVICE_BACK: return pixels * 20;
    default: return 0;
    }
}

static void fill(const void *data, const bench_job *jobs, bench_result *result)
{
    const frame_work *work = data;
    frame_work_fill(work, jobs, result);
    result->threads = 0;
    result->isa = NULL;
    result->value = bench_spread_rate(bench_time(&jobs[0], DEVICE_FRAME), 1e3);
    for (int i = 0; i < BENCH_PARTS; i++) {
        result->part_names[i] = part_names[i];
        result->parts[i] = bench_time(&jobs[0], 1 + (uint32_t)i);
    }
    const double shading = fmax(bench_time(&jobs[0], DEVICE_SHADE).median, 1e-6);
    result->samples_per_second = (double)work->info.samples / shading * 1e3;
    snprintf(result->note, sizeof result->note, "shading %.4g ms, %.2f G samples/s", shading,
             result->samples_per_second / 1e9);
}

/* What the time of the first strategy's frame goes to. */
static int publish_parts(bench *b, const bench_result *frame, double copy_rate)
{
    frame_work shape = {.point = bench_first_point(b), .size = {frame->size[0], frame->size[1]}, .device = b->device};
    bench_result lines[BENCH_PARTS];
    shape.info.points = (uint64_t)(frame->coverage * frame->size[0] * frame->size[1]);
    for (int i = 0; i < BENCH_PARTS; i++) {
        const double rate = part_bytes(&shape, i) / fmax(frame->parts[i].median, 1e-6) / 1e6;
        lines[i] = bench_result_begin(b, NULL, 0, "ms");
        lines[i].value = frame->parts[i];
        lines[i].strategy = frame->strategy;
        snprintf(lines[i].label, sizeof lines[i].label, "%s", part_labels[i]);
        if (rate > 0)
            snprintf(lines[i].note, sizeof lines[i].note, "%.1f MB, %.0f %% of the rate of copies",
                     part_bytes(&shape, i) / 1e6, 100 * rate / copy_rate);
    }
    return bench_publish(b, "Parts of a frame of the first strategy", lines, BENCH_PARTS);
}

static int measure_copy(bench *b, double *rate)
{
    const uint64_t bytes = UINT64_C(256) << 20;
    double milliseconds = 0;
    int code = bench_check(helio_device_measure_copy(b->device, bytes, &milliseconds));
    *rate = code == EXIT_CODE_OK ? 2 * (double)bytes / milliseconds / 1e6 : 0;
    bench_result line = bench_result_begin(b, NULL, 0, "GB/s");
    line.value = (bench_spread){*rate, *rate, *rate, 1};
    snprintf(line.label, sizeof line.label, "copies, bytes read and written");
    return code == EXIT_CODE_OK ? bench_publish(b, helio_device_get_info(b->device).name, &line, 1) : code;
}

int bench_run_device(bench *b)
{
    static const bench_axis axes[] = {BENCH_BY_STRATEGY, BENCH_BY_SCENARIO, BENCH_BY_SPP, BENCH_BY_CUBE};
    const uint32_t *size = b->plan->options->size;
    char title[256];
    snprintf(title, sizeof title, "Frames of %.60s, %ux%u, the map sent for each, no shadow rays", b->plan->mesh_name,
             size[0], size[1]);
    const bench_subject subject = {title, "frames/s", sizeof(frame_work), create, fill, frame_work_release};
    double copy_rate = 0;
    int code = measure_copy(b, &copy_rate);
    const size_t published = b->results.count;
    if (code == EXIT_CODE_OK)
        code = bench_curves(b, &subject, axes, sizeof axes / sizeof axes[0]);
    if (code != EXIT_CODE_OK)
        return code;
    const bench_result first = b->results.items[published];
    return publish_parts(b, &first, copy_rate);
}
