/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "convert_plan.h"
#include "input_source.h"
#include "interrupt.h"
#include "machine.h"
#include "map_converter.h"
#include "message.h"
#include "progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

typedef struct convert_job {
    convert_plan plan;
    map_converter converter;
    frame_warnings warnings;
    bool told_of_range;
    map_shape to; /* of the last frame */
    uint64_t frames;
    char path[CONVERT_PATH_SIZE]; /* of the last frame */
} convert_job;

static bool check(helio_status status)
{
    if (status != HELIO_OK)
        message_failure("%s", helio_last_error());
    return status == HELIO_OK;
}

enum { SKY_SIZE = 512 }; /* of the cube, where no option tells */

static int choose_shapes(const convert_job *job, map_conversion *work)
{
    const helio_source_frame *frame = work->frame;
    work->from = (map_shape){frame->layout, frame->width, frame->height};
    if (frame->rgb == NULL) {
        uint32_t wanted = job->plan.options->convert.env_size, size = wanted ? wanted : SKY_SIZE;
        work->from = (map_shape){HELIO_LAYOUT_LATLONG, 4 * size, 2 * size};
    }
    return convert_plan_shape(&job->plan, &work->from, &work->to);
}

/* Of the first frame, for all of them: pictures of a sequence should not flicker. */
static bool find_exposure(convert_job *job, map_conversion *work)
{
    double wanted = job->plan.options->convert.exposure;
    if (job->frames > 0 || !job->plan.is_png)
        return true;
    if (isnan(wanted) && !map_converter_find_light(&job->converter, work))
        return false;
    job->plan.write.exposure = isnan(wanted) ? work->light.auto_exposure : (float)wanted;
    return true;
}

/* Once is enough for a sequence. */
static void warn_of_lost_range(convert_job *job, const map_shape *shape, float exposure)
{
    size_t pixels = (size_t)shape->width * shape->height, lost = 0;
    float white = exp2f(-exposure);
    const float *rgb = job->converter.out.rgb;
    for (size_t i = 0; i < pixels; i++, rgb += 3)
        lost += rgb[0] > white || rgb[1] > white || rgb[2] > white;
    if (lost == 0 || job->told_of_range)
        return;
    job->told_of_range = true;
    message_warning("%s holds 8 bits: %.3g %% of its pixels are brighter than white, and how much is lost; .exr, "
                    ".hdr and .pfm keep it",
                    job->path, 100.0 * (double)lost / (double)pixels);
}

static bool write_map(convert_job *job, map_conversion *work)
{
    const map_shape *to = &work->to;
    if (!find_exposure(job, work))
        return false;
    if (job->plan.is_png)
        warn_of_lost_range(job, to, job->plan.write.exposure);
    const helio_map map = {
        .width = to->width, .height = to->height, .rgb = job->converter.out.rgb, .layout = to->layout};
    return check(helio_map_write(job->converter.context, job->path, &map, &job->plan.write));
}

static int convert_frame(convert_job *job, const helio_source_frame *frame)
{
    map_conversion work = {.frame = frame};
    double start = machine_milliseconds();
    int code = convert_plan_path(&job->plan, frame, job->path);
    if (code == EXIT_CODE_OK)
        code = choose_shapes(job, &work);
    if (code != EXIT_CODE_OK)
        return code;
    if (!map_converter_run(&job->converter, &work))
        return EXIT_CODE_FAILED;
    input_source_warn(&job->warnings, frame, &work.light);
    if (!write_map(job, &work))
        return EXIT_CODE_FAILED;
    job->to = work.to;
    if (job->plan.options->verbose)
        message_note("%s: %" PRIu32 "x%" PRIu32 " %s, %s, to %s: %" PRIu32 "x%" PRIu32 " %s, in %.0f ms", frame->name,
                     work.from.width, work.from.height, helio_layout_name(work.from.layout),
                     work.is_copy ? "pixel by pixel" : "through a cube", job->path, work.to.width, work.to.height,
                     helio_layout_name(work.to.layout), machine_milliseconds() - start);
    return EXIT_CODE_OK;
}

static int stopped(const convert_job *job)
{
    if (job->frames == 0)
        message_failure("stopped; nothing was written to %s", job->plan.options->convert.out);
    else
        message_failure("stopped after %" PRIu64 " frames; %s is the last", job->frames, job->path);
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

static int convert_frames(convert_job *job, progress_bar *progress)
{
    for (;;) {
        helio_source_frame frame;
        helio_status status = helio_source_next(job->converter.source, &frame);
        if (interrupt_signal() != 0)
            return stopped(job);
        if (!check(status))
            return EXIT_CODE_FAILED;
        if (frame.rgb == NULL && frame.sky == NULL)
            break;
        int code = convert_frame(job, &frame);
        if (code != EXIT_CODE_OK)
            return code;
        job->frames++;
        progress_pass(progress, true);
        progress_update(progress, 0);
    }
    return job->frames > 0 ? EXIT_CODE_OK
                           : message_failure("%s holds no frame that could be converted", job->plan.options->input);
}

/* total: 0 where nobody knows. */
static int show_frames(convert_job *job, uint64_t total)
{
    progress_bar progress;
    progress_start(&progress, total, 0, job->plan.options->quiet || !job->plan.is_numbered || total == 1);
    int code = convert_frames(job, &progress);
    progress_end(&progress);
    return code;
}

static int run_job(convert_job *job)
{
    const cli_options *options = job->plan.options;
    map_converter *converter = &job->converter;
    if (!check(input_source_context(options, &job->warnings, &converter->context)))
        return EXIT_CODE_FAILED;
    int code = input_source_open(options, converter->context, &converter->source);
    if (code != EXIT_CODE_OK)
        return code;
    const helio_source_info info = helio_source_get_info(converter->source);
    code = convert_plan_settle(&job->plan, &info);
    if (code == EXIT_CODE_OK)
        code = show_frames(job, info.frame_count);
    frame_warnings_end(&job->warnings);
    if (code != EXIT_CODE_OK || options->quiet)
        return code;
    printf("%s: %" PRIu32 "x%" PRIu32 " %s", options->convert.out, job->to.width, job->to.height,
           helio_layout_name(job->to.layout));
    if (job->plan.is_numbered)
        printf(", %" PRIu64 " frame%s", job->frames, job->frames == 1 ? "" : "s");
    printf("\n");
    return EXIT_CODE_OK;
}

int command_convert(const cli_options *options)
{
    interrupt_install();
    convert_job job = {0};
    int code = convert_plan_make(&job.plan, options);
    if (code != EXIT_CODE_OK)
        return code;
    job.converter.turn = map_turn_make(options->rotate, options->flip);
    job.converter.intensity = (float)options->intensity;
    code = run_job(&job);
    map_converter_release(&job.converter);
    helio_source_close(job.converter.source);
    helio_context_destroy(job.converter.context);
    return code;
}
