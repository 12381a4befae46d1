/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "convert_plan.h"
#include "input_source.h"
#include "interrupt.h"
#include "machine.h"
#include "map_converter.h"
#include "message.h"
#include "output_file.h"
#include "progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct convert_job {
    convert_plan plan;
    map_converter converter;
    frame_warnings warnings;
    bool told_of_range, told_of_layout;
    map_shape to;       /* of the last frame */
    bool shapes_differ; /* of the frames so far */
    bool is_one_file;   /* with many frames */
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

/* PFM and PNG have no place for the layout's name. Once is enough here too. */
static void warn_of_lost_layout(convert_job *job, const map_shape *shape)
{
    helio_layout guessed;
    bool is_kept = !output_file_has_extension(job->path, "pfm") && !output_file_has_extension(job->path, "png");
    if (is_kept || job->told_of_layout || shape->layout == HELIO_LAYOUT_FACES ||
        (shape->width == 1 && shape->height == 1))
        return;
    if (helio_layout_guess(shape->width, shape->height, HELIO_LAYOUT_AUTO, &guessed) == HELIO_OK &&
        guessed == shape->layout)
        return;
    job->told_of_layout = true;
    message_warning("%s cannot tell that its layout is %s: read it with --layout %s, or write .exr or .hdr, which can",
                    job->path, helio_layout_name(shape->layout), helio_layout_name(shape->layout));
}

static bool write_map(convert_job *job, map_conversion *work)
{
    const map_shape *to = &work->to;
    if (!find_exposure(job, work))
        return false;
    if (job->plan.is_png)
        warn_of_lost_range(job, to, job->plan.write.exposure);
    warn_of_lost_layout(job, to);
    const helio_map map = {
        .width = to->width, .height = to->height, .rgb = job->converter.out.rgb, .layout = to->layout};
    return check(helio_map_write(job->converter.context, job->path, &map, &job->plan.write));
}

/* Files of a sequence have names of their own. */
static void warn_of_frame(convert_job *job, const helio_source_frame *frame, const helio_environment_info *light)
{
    char label[CONVERT_PATH_SIZE];
    if (job->is_one_file)
        snprintf(label, sizeof label, "%s: frame %" PRIu64, frame->name, frame->index);
    else
        snprintf(label, sizeof label, "%s", frame->name);
    if (frame->rgb != NULL)
        frame_warnings_size(&job->warnings, label, frame);
    input_source_warn(&job->warnings, label, frame, light);
}

static int convert_frame(convert_job *job, const helio_source_frame *frame)
{
    map_conversion work = {.frame = frame};
    double start = machine_milliseconds();
    int code = convert_plan_path(&job->plan, job->converter.source, frame, job->path);
    if (code == EXIT_CODE_OK)
        code = choose_shapes(job, &work);
    if (code != EXIT_CODE_OK)
        return code;
    if (!map_converter_run(&job->converter, &work))
        return EXIT_CODE_FAILED;
    warn_of_frame(job, frame, &work.light);
    if (!write_map(job, &work))
        return EXIT_CODE_FAILED;
    const map_shape *to = &work.to;
    job->shapes_differ |=
        job->frames > 0 && (to->width != job->to.width || to->height != job->to.height || to->layout != job->to.layout);
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
        message_failure("stopped after %" PRIu64 " frame%s; %s is the last", job->frames, job->frames == 1 ? "" : "s",
                        job->path);
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

/* What is written stays, and a damaged frame is not the end of the way. */
static int broken_off(const convert_job *job, helio_status status)
{
    const char *reason = helio_last_error();
    if (job->frames == 0)
        return message_failure("%s", reason);
    /* Of sequences the reason names the option itself. */
    bool can_skip = job->is_one_file && status == HELIO_ERR_DATA && job->plan.options->on_missing[1] == 't';
    return message_failure("%s; %" PRIu64 " map%s before it %s written and stay%s, %s is the last%s", reason,
                           job->frames, job->frames == 1 ? "" : "s", job->frames == 1 ? "is" : "are",
                           job->frames == 1 ? "s" : "", job->path,
                           can_skip ? "; --on-missing skip leaves out what cannot be decoded" : "");
}

static int convert_frames(convert_job *job, progress_bar *progress)
{
    for (;;) {
        helio_source_frame frame;
        helio_status status = helio_source_next(job->converter.source, &frame);
        if (interrupt_signal() != 0)
            return stopped(job);
        if (status != HELIO_OK)
            return broken_off(job, status);
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

static void tell_result(const convert_job *job)
{
    const map_shape *to = &job->to;
    printf("%s: ", job->plan.options->convert.out);
    if (job->plan.is_numbered)
        printf("%" PRIu64 " frame%s of ", job->frames, job->frames == 1 ? "" : "s");
    if (job->shapes_differ)
        printf("different sizes or layouts, the last of ");
    if (to->layout == HELIO_LAYOUT_FACES)
        printf("six files of %" PRIu32 "x%" PRIu32 ", the faces of a cube\n", to->width, to->width);
    else
        printf("%" PRIu32 "x%" PRIu32 " %s\n", to->width, to->height, helio_layout_name(to->layout));
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
    job->is_one_file = info.is_dynamic && info.kind != HELIO_SOURCE_SEQUENCE;
    code = convert_plan_settle(&job->plan, &info);
    if (code == EXIT_CODE_OK)
        code = show_frames(job, info.frame_count);
    frame_warnings_end(&job->warnings);
    if (code == EXIT_CODE_OK && !options->quiet)
        tell_result(job);
    return code;
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
    convert_plan_release(&job.plan);
    return code;
}
