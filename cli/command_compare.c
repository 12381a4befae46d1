/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "compare_plan.h"
#include "compared_files.h"
#include "error_figure.h"
#include "input_source.h"
#include "interrupt.h"
#include "machine.h"
#include "message.h"
#include "output_file.h"
#include "progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct compare_job {
    const cli_options *options;
    compare_plan plan;
    comparison_report report;
    frame_warnings warnings;
    progress_bar progress;
    helio_context *context;
    helio_comparison *comparison; /* made for the size of the first pair */
    double range;                 /* of the figures' scale; 0: not known yet */
} compare_job;

static int failure(void)
{
    return message_failure("%s", helio_last_error());
}

/* ---- comparing ----------------------------------------------------------------------------- */

static int check_size(const compare_job *job, const compared_frame *frame, const helio_image *picture)
{
    const comparison_report *report = &job->report;
    if (picture->width == report->width && picture->height == report->height)
        return EXIT_CODE_OK;
    return message_failure("%s has %" PRIu32 "x%" PRIu32 " pixels, where other frames have %" PRIu32 "x%" PRIu32
                           "; give a sequence of one size",
                           frame->picture, picture->width, picture->height, report->width, report->height);
}

static int make_comparison(compare_job *job, const compared_files *files)
{
    const helio_comparison_desc desc = {
        .width = files->picture->width,
        .height = files->picture->height,
        .without_lab = !helio_comparison_has_lab(),
        .flicker = job->report.is_sequence,
        .pixels_per_degree = (float)job->options->compare.pixels_per_degree,
    };
    job->report.width = desc.width;
    job->report.height = desc.height;
    progress_start(&job->progress, job->report.count, (double)desc.width * desc.height,
                   job->options->quiet || !job->report.is_sequence);
    return helio_comparison_create(job->context, &desc, &job->comparison) == HELIO_OK ? EXIT_CODE_OK : failure();
}

static helio_comparison_pair pair_of(const compare_job *job, const compared_files *files)
{
    return (helio_comparison_pair){.picture = files->picture->rgb,
                                   .reference = files->reference->rgb,
                                   .mask = files->mask.mask,
                                   .exposure = job->report.exposure,
                                   .tonemap = job->plan.tonemap};
}

static int find_exposure(compare_job *job, const compared_files *files)
{
    const helio_comparison_pair pair = pair_of(job, files);
    if (files->reference->is_encoded)
        return EXIT_CODE_OK;
    helio_status status = helio_comparison_auto_exposure(job->comparison, &pair, &job->report.exposure);
    return status == HELIO_OK ? EXIT_CODE_OK : failure();
}

/* All frames have the same: auto means that of the frame in the middle, as the first and the last are often dark. */
static int choose_exposure(compare_job *job, const compared_files *first)
{
    compared_frame middle = job->report.frames[job->report.count / 2];
    compared_files files;
    job->report.has_auto_exposure = isnan(job->options->compare.exposure);
    if (!job->report.has_auto_exposure) {
        job->report.exposure = (float)job->options->compare.exposure;
        return EXIT_CODE_OK;
    }
    if (job->report.count < 2)
        return find_exposure(job, first);
    int code = compared_files_read(job->context, job->options->max_pixels, &middle, &files);
    if (code == EXIT_CODE_OK)
        code = check_size(job, &middle, files.picture);
    if (code == EXIT_CODE_OK)
        code = find_exposure(job, &files);
    compared_files_release(job->context, &files);
    return code;
}

static void warn(compare_job *job, const compared_frame *frame, const compared_files *files)
{
    char text[1024];
    if (files->picture->is_encoded != files->reference->is_encoded) {
        snprintf(text, sizeof text, "%.300s holds %s, and %.300s %s; errors mean little unless both are of one kind",
                 frame->picture, files->picture->is_encoded ? "what a screen shows" : "radiance", frame->reference,
                 files->reference->is_encoded ? "what a screen shows" : "radiance");
        frame_warnings_log(&job->warnings, text);
    }
    if (frame->info.skipped > 0) {
        snprintf(text, sizeof text, "%.300s: %" PRIu64 " pixel%s NaN or infinite in it or in %.300s and left out",
                 frame->picture, frame->info.skipped, frame->info.skipped == 1 ? " is" : "s are", frame->reference);
        frame_warnings_log(&job->warnings, text);
    }
}

static int measure(compare_job *job, compared_frame *frame, const compared_files *files)
{
    bool is_first = job->comparison == NULL;
    int code = is_first ? make_comparison(job, files) : check_size(job, frame, files->picture);
    if (code == EXIT_CODE_OK && is_first)
        code = choose_exposure(job, files);
    if (code != EXIT_CODE_OK)
        return code;
    const helio_comparison_pair pair = pair_of(job, files);
    double start = machine_milliseconds();
    if (helio_comparison_measure(job->comparison, &pair, &frame->info) != HELIO_OK)
        return failure();
    if (job->options->verbose)
        message_note("%s: compared with %s in %.0f ms", frame->picture, frame->reference,
                     machine_milliseconds() - start);
    warn(job, frame, files);
    return EXIT_CODE_OK;
}

/* ---- the picture of errors ----------------------------------------------------------------- */

static int write_errors(const compare_job *job, const char *path, const float *errors)
{
    size_t pixels = (size_t)job->report.width * job->report.height;
    float *rgba = malloc(4 * pixels * sizeof *rgba);
    if (rgba == NULL)
        return message_failure("no memory to write %s", path);
    for (size_t i = 0; i < 4 * pixels; i++)
        rgba[i] = i % 4 == 3 ? 1 : errors[i / 4];
    const helio_picture picture = {.width = job->report.width, .height = job->report.height, .rgba = rgba};
    helio_status status = helio_picture_write(job->context, path, &picture, NULL);
    free(rgba);
    return status == HELIO_OK ? EXIT_CODE_OK : failure();
}

static int draw_errors(compare_job *job, const compared_frame *frame, const char *path, const float *errors)
{
    const comparison_report *report = &job->report;
    if (job->range <= 0)
        job->range = error_figure_range(job->plan.map, errors, (size_t)report->width * report->height);
    const error_figure figure = {.errors = errors,
                                 .width = report->width,
                                 .height = report->height,
                                 .map = job->plan.map,
                                 .range = job->range,
                                 .picture = frame->picture,
                                 .reference = frame->reference,
                                 .info = &frame->info,
                                 .exposure = (double)report->exposure};
    return error_figure_write(path, &figure);
}

static int write_map(compare_job *job, const compared_frame *frame)
{
    const char *const inputs[] = {frame->picture, frame->reference, frame->mask != NULL ? frame->mask : "", NULL};
    const float *errors = helio_comparison_map(job->comparison, job->plan.map);
    char path[COMPARE_PATH_SIZE];
    if (job->options->compare.out == NULL || frame->info.pixels == 0)
        return EXIT_CODE_OK;
    int code = compare_plan_name(&job->plan, frame->number, path);
    if (code == EXIT_CODE_OK)
        code = output_file_check("out", path, NULL, inputs);
    if (code != EXIT_CODE_OK)
        return code;
    return job->plan.is_drawn ? draw_errors(job, frame, path, errors) : write_errors(job, path, errors);
}

/* ---- all frames ---------------------------------------------------------------------------- */

static int compare_frame(compare_job *job, compared_frame *frame)
{
    compared_files files;
    int code = compared_files_read(job->context, job->options->max_pixels, frame, &files);
    if (code == EXIT_CODE_OK)
        code = measure(job, frame, &files);
    compared_files_release(job->context, &files);
    if (code == EXIT_CODE_OK)
        code = write_map(job, frame);
    progress_pass(&job->progress, true);
    if (progress_update(&job->progress, 0) || code != EXIT_CODE_OK)
        return code;
    message_failure("stopped after %" PRIu64 " of %zu frames; their numbers are not told", job->progress.passed,
                    job->report.count);
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

/* Not one pixel was compared in any frame. */
static int check_pixels(const compare_job *job)
{
    const comparison_report *report = &job->report;
    const compared_frame *first = &report->frames[0];
    uint64_t pixels = 0, skipped = 0;
    for (size_t i = 0; i < report->count; i++) {
        pixels += report->frames[i].info.pixels;
        skipped += report->frames[i].info.skipped;
    }
    if (pixels > 0)
        return EXIT_CODE_OK;
    if (skipped > 0)
        return message_failure("%s and %s have no pixel to compare: all %" PRIu64
                               " in the mask are NaN or infinite in one of them",
                               report->picture, report->reference, skipped);
    return message_failure("the mask of %s has no pixel of 0.5 or more, so that nothing is compared; give another one "
                           "by --mask",
                           first->mask);
}

static int tell(const compare_job *job)
{
    const compare_options *compare = &job->options->compare;
    bool is_json_printed = compare->json != NULL && compare->json[0] == '-' && compare->json[1] == 0;
    int code = check_pixels(job);
    if (code == EXIT_CODE_OK && !helio_comparison_has_lab())
        message_warning("this build has no lcms2, so lab_mean and de2000_mean are left out");
    if (code == EXIT_CODE_OK && compare->json != NULL)
        code = comparison_report_write_json(compare->json, &job->report);
    if (code == EXIT_CODE_OK && !is_json_printed && !job->options->quiet)
        comparison_report_print(&job->report);
    return code;
}

static int compare_all(compare_job *job)
{
    int code = EXIT_CODE_OK;
    if (input_source_context(job->options, &job->warnings, &job->context) != HELIO_OK)
        return failure();
    for (size_t i = 0; i < job->report.count && code == EXIT_CODE_OK; i++)
        code = compare_frame(job, &job->report.frames[i]);
    progress_end(&job->progress);
    frame_warnings_end(&job->warnings);
    return code == EXIT_CODE_OK ? tell(job) : code;
}

int command_compare(const cli_options *options)
{
    compare_job job = {.options = options, .range = options->compare.range};
    int code = compare_plan_make(&job.plan, options);
    job.report = (comparison_report){.picture = options->input,
                                     .reference = options->reference,
                                     .is_sequence = job.plan.pictures.kind != LIST_FILE,
                                     .tonemap = options->tonemap,
                                     .pixels_per_degree = options->compare.pixels_per_degree,
                                     .frames = job.plan.frames,
                                     .count = job.plan.pictures.count};
    interrupt_install();
    if (code == EXIT_CODE_OK)
        code = compare_all(&job);
    helio_comparison_destroy(job.comparison);
    helio_context_destroy(job.context);
    compare_plan_release(&job.plan);
    return code;
}
