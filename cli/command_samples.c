/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "interrupt.h"
#include "message.h"
#include "output_file.h"
#include "samples.h"
#include "samples_json.h"
#include "samples_pixel.h"
#include "samples_plan.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct samples_run {
    samples_plan plan;
    render_job job;
    samples_findings found;
    samples_sheet *sheet;
    json_t *json;
    uint64_t frames;  /* that came */
    uint64_t written; /* figures */
} samples_run;

static int fail_with_library(void)
{
    return message_failure("%s", helio_last_error());
}

static int fail_without_memory(void)
{
    return message_failure("there is no memory for the samples of the pixel");
}

/* ---- opening ------------------------------------------------------------------------------ */

static int make_parts(samples_run *run)
{
    const samples_plan *plan = &run->plan;
    if (!samples_make(&run->found, &run->job))
        return fail_without_memory();
    run->found.x = plan->x;
    run->found.y = plan->y;
    if (plan->sheet != NULL)
        run->sheet = samples_sheet_make(plan->sheet, run->job.source_info.frame_count);
    if (plan->json != NULL)
        run->json = samples_json_make(&run->job);
    bool is_whole = (plan->sheet == NULL || run->sheet != NULL) && (plan->json == NULL || run->json != NULL);
    return is_whole ? EXIT_CODE_OK : fail_without_memory();
}

static int open_run(samples_run *run, const cli_options *options)
{
    int code = samples_plan_make(&run->plan, options, &run->job);
    if (code == EXIT_CODE_OK)
        code = render_job_open_source(&run->job);
    if (code == EXIT_CODE_OK)
        code = samples_plan_settle(&run->plan, &run->job);
    if (code == EXIT_CODE_OK)
        code = render_job_open_scene(&run->job);
    return code == EXIT_CODE_OK ? make_parts(run) : code;
}

static void close_run(samples_run *run)
{
    json_decref(run->json);
    samples_sheet_release(run->sheet);
    samples_release(&run->found);
    render_job_close(&run->job);
}

/* ---- each frame --------------------------------------------------------------------------- */

static void note_frame(samples_run *run, const helio_source_frame *frame, const helio_environment_info *light)
{
    samples_findings *found = &run->found;
    double exposure = run->plan.options.exposure;
    found->index = frame->index;
    frame_label_make(frame, found->label);
    found->exposure = isnan(exposure) ? light->auto_exposure : (float)exposure;
    memcpy(found->flux, light->flux, sizeof found->flux);
}

static samples_view view_of(const samples_run *run)
{
    const render_job *job = &run->job;
    const helio_picture picture = helio_renderer_picture(job->renderer);
    return (samples_view){
        .found = &run->found,
        .plan = &job->plan,
        .cube = helio_environment_cube(job->environment),
        .cube_size = helio_environment_cube_size(job->environment),
        .picture = {.pixels = picture.rgba,
                    .width = picture.width,
                    .height = picture.height,
                    .channels = 4,
                    .exposure = run->found.exposure,
                    .tonemap = job->plan.tonemap},
    };
}

static int draw_frame(samples_run *run, const samples_view *view)
{
    char name[SINK_PATH_SIZE];
    const char *const inputs[] = {run->job.plan.mesh, NULL};
    const char *path = run->job.plan.out;
    int code = EXIT_CODE_OK;
    if (run->job.plan.sink == SINK_NUMBERED) {
        path = name;
        if (!numbered_path_format(&run->plan.names, run->found.index, name, sizeof name))
            return message_failure("--out %s makes names that are too long", run->job.plan.out);
        code = output_file_check("out", name, run->job.source, inputs);
    }
    if (code == EXIT_CODE_OK)
        code = samples_draw(path, view);
    run->written += code == EXIT_CODE_OK;
    return code;
}

static bool prints_text(const samples_run *run)
{
    return !run->plan.options.quiet && (run->plan.json == NULL || strcmp(run->plan.json, "-") != 0);
}

static int tell_frame(samples_run *run)
{
    const samples_view view = view_of(run);
    size_t pixel = (size_t)run->found.y * view.picture.width + run->found.x;
    int code = run->plan.draws_frames ? draw_frame(run, &view) : EXIT_CODE_OK;
    if (code != EXIT_CODE_OK)
        return code;
    if (run->sheet != NULL && samples_sheet_wants(run->sheet, run->frames))
        samples_sheet_add(run->sheet, &view);
    if (run->json != NULL && !samples_json_add(run->json, &run->found, view.picture.pixels + 4 * pixel))
        return fail_without_memory();
    message_clear_line();
    if (prints_text(run))
        samples_print(&run->found);
    return EXIT_CODE_OK;
}

/* The picture is there. In the first frame the pixel is chosen, or found to be none of the object's. */
static int look_at_pixel(samples_run *run)
{
    int code = EXIT_CODE_OK;
    if (run->frames == 0)
        code = samples_pixel_choose(&run->job, run->plan.has_pixel, run->found.index, &run->found.x, &run->found.y);
    if (code != EXIT_CODE_OK)
        return code;
    helio_status status = samples_gather(&run->found, &run->job, run->found.index);
    if (status == HELIO_ERR_MEMORY)
        return fail_without_memory();
    return status == HELIO_OK ? tell_frame(run) : fail_with_library();
}

static int render_frame(samples_run *run, const helio_source_frame *frame)
{
    helio_environment_info light;
    stats_frame stats = {0};
    bool is_whole = false;
    if (render_job_light(&run->job, frame, &light, &stats) != HELIO_OK)
        return fail_with_library();
    note_frame(run, frame, &light);
    if (render_job_render(&run->job, frame, &stats, &is_whole) != HELIO_OK)
        return fail_with_library();
    return is_whole ? look_at_pixel(run) : EXIT_CODE_OK;
}

/* Where there is nothing but a sheet, most frames of a long sequence are not rendered. */
static bool is_wanted(const samples_run *run)
{
    return run->plan.draws_frames || run->json != NULL || run->sheet == NULL ||
           samples_sheet_wants(run->sheet, run->frames);
}

static bool is_done(const samples_run *run)
{
    return run->sheet != NULL && !run->plan.draws_frames && run->json == NULL && samples_sheet_is_full(run->sheet);
}

/* *is_end: there are no more frames. */
static int run_frame(samples_run *run, bool *is_end)
{
    helio_source_frame frame;
    stats_frame stats;
    int code = EXIT_CODE_OK;
    if (render_job_next(&run->job, &frame, &stats) != HELIO_OK)
        return fail_with_library();
    *is_end = frame.rgb == NULL && frame.sky == NULL;
    if (*is_end)
        return EXIT_CODE_OK;
    bool wanted = is_wanted(run);
    if (wanted)
        code = render_frame(run, &frame);
    run->frames++;
    progress_pass(&run->job.progress, wanted);
    return code;
}

/* ---- all frames --------------------------------------------------------------------------- */

static int tell_all(const samples_run *run)
{
    int code = EXIT_CODE_OK;
    if (run->frames == 0)
        return message_failure("%s has no frame that can be read", run->job.plan.light.specification);
    if (run->sheet != NULL)
        code = samples_sheet_write(run->sheet);
    if (code == EXIT_CODE_OK && run->json != NULL)
        code = samples_json_write(run->plan.json, run->json);
    return code;
}

static int tell_signal(const samples_run *run)
{
    if (run->written > 0)
        message_failure("stopped; %" PRIu64 " figure%s written to %s", run->written, run->written == 1 ? "" : "s",
                        run->job.plan.out);
    else
        message_failure("stopped; nothing was written");
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

static int run_all(samples_run *run)
{
    const cli_options *options = &run->plan.options;
    uint64_t total = run->job.source_info.is_dynamic ? run->job.source_info.frame_count : 1;
    bool is_end = false;
    int code = EXIT_CODE_OK;
    progress_start(&run->job.progress, total, (double)options->size[0] * options->size[1], options->quiet);
    while (code == EXIT_CODE_OK && !is_end && !is_done(run) && interrupt_signal() == 0)
        code = run_frame(run, &is_end);
    progress_end(&run->job.progress);
    frame_warnings_end(&run->job.warnings);
    if (interrupt_signal() != 0 && !is_end && code == EXIT_CODE_OK)
        return tell_signal(run);
    return code == EXIT_CODE_OK ? tell_all(run) : code;
}

int command_samples(const cli_options *options)
{
    samples_run run = {0};
    interrupt_install();
    int code = open_run(&run, options);
    if (code == EXIT_CODE_OK)
        code = run_all(&run);
    close_run(&run);
    return code;
}
