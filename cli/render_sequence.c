/* SPDX-License-Identifier: MIT */
#include "render_sequence.h"

#include "day_exposure.h"
#include "finished_frame.h"
#include "interrupt.h"
#include "machine.h"
#include "message.h"
#include "output_file.h"
#include "sequence_report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* ---- failures ---------------------------------------------------------------------------- */

static bool fail_with(render_sequence *sequence, const char *sentence)
{
    sequence->failed = true;
    snprintf(sequence->error, sizeof sequence->error, "%s", sentence);
    return false;
}

static bool check(render_sequence *sequence, helio_status status)
{
    return status == HELIO_OK || fail_with(sequence, helio_last_error());
}

/* For functions that have told it themselves. */
static bool check_code(render_sequence *sequence, int code)
{
    return code == EXIT_CODE_OK || fail_with(sequence, "");
}

/* ---- the first frame --------------------------------------------------------------------- */

static bool open_sink(render_sequence *sequence)
{
    const render_plan *plan = &sequence->job->plan;
    frame_sink_desc desc = {
        .kind = plan->sink,
        .path = plan->out,
        .picture = {.exposure = sequence->exposure, .tonemap = plan->tonemap, .alpha = plan->alpha},
        .video = plan->video,
    };
    if (desc.video.fps <= 0)
        desc.video.fps = sequence->job->source_info.fps;
    if (frame_sink_open(&sequence->sink, sequence->job->context, &desc) == HELIO_OK)
        return true;
    return fail_with(sequence, sequence->sink.error);
}

static bool open_sheet(render_sequence *sequence)
{
    const cli_options *options = sequence->job->plan.options;
    uint64_t total = sequence->job->source_info.frame_count;
    if (options->contact_sheet == NULL ||
        contact_sheet_make(&sequence->sheet, options->size[0], options->size[1], total))
        return true;
    return fail_with(sequence, "there is no memory for the contact sheet");
}

/* The exposure of all frames is that of the first, but for a day. Lights the first frame. */
static bool light_first(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats)
{
    render_job *job = sequence->job;
    double exposure = job->plan.options->exposure;
    bool is_day = job->source_info.kind == HELIO_SOURCE_SKY_DAY;
    sequence->exposure = (float)exposure;
    if (is_day && isnan(exposure) &&
        !check(sequence,
               day_exposure_find(job->context, job->plan.light.specification, job->environment, &sequence->exposure)))
        return false;
    helio_environment_info light;
    const bool is_asked = !is_day && isnan(exposure);
    if (!check(sequence, render_job_light(job, frame, is_asked || job->device == NULL ? &light : NULL, stats)))
        return false;
    if (is_asked)
        sequence->exposure = light.auto_exposure;
    return true;
}

/* On a terminal a bar tells as much. */
static void tell_start(const render_sequence *sequence)
{
    const render_job *job = sequence->job;
    const uint32_t *size = job->plan.options->size;
    uint64_t total = job->progress.total;
    char count[32] = "";
    if (!job->progress.is_logged || total == 1)
        return;
    if (total > 0)
        snprintf(count, sizeof count, "%" PRIu64 " ", total);
    message_note("%sframes of %" PRIu32 "x%" PRIu32 " to %s", count, size[0], size[1], job->plan.out);
}

static bool begin(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats)
{
    if (!light_first(sequence, frame, stats) || !open_sink(sequence) || !open_sheet(sequence))
        return false;
    tell_start(sequence);
    return true;
}

/* ---- each frame -------------------------------------------------------------------------- */

static void show(render_sequence *sequence, const helio_source_frame *frame, const shown_picture *picture)
{
    char label[FRAME_LABEL_SIZE];
    frame_label_make(frame, label);
    if (sequence->job->plan.options->contact_sheet != NULL && contact_sheet_wants(&sequence->sheet, sequence->frames))
        contact_sheet_add(&sequence->sheet, picture, label);
}

static bool write_frame(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats)
{
    const render_job *job = sequence->job;
    const helio_picture picture = helio_renderer_picture(job->renderer);
    const shown_picture shown = {.pixels = picture.rgba,
                                 .width = picture.width,
                                 .height = picture.height,
                                 .channels = 4,
                                 .exposure = sequence->exposure,
                                 .tonemap = job->plan.tonemap};
    double start = machine_milliseconds();
    if (frame_sink_add(&sequence->sink, frame->index, &picture) != HELIO_OK)
        return fail_with(sequence, sequence->sink.error);
    stats->write_ms = machine_milliseconds() - start;
    show(sequence, frame, &shown);
    return true;
}

static void show_finished(render_sequence *sequence, const helio_source_frame *frame, const finished_frame *finished)
{
    const helio_image *image = finished->image;
    shown_picture shown = {.pixels = image->rgb, .width = image->width, .height = image->height, .channels = 3};
    if (!finished->is_shown) {
        shown.exposure = sequence->exposure;
        shown.tonemap = sequence->job->plan.tonemap;
    }
    show(sequence, frame, &shown);
}

/* Where an earlier run has made the frame it is left as it is. */
static bool take_finished(render_sequence *sequence, const helio_source_frame *frame, bool *is_finished)
{
    const render_job *job = sequence->job;
    const uint32_t *size = job->plan.options->size;
    char name[SINK_PATH_SIZE];
    finished_frame finished;
    *is_finished = false;
    if (!job->plan.options->resume || job->plan.sink != SINK_NUMBERED ||
        !frame_sink_name(&sequence->sink, frame->index, name))
        return true;
    if (!check_code(sequence, finished_frame_read(job->context, name, size[0], size[1], &finished)))
        return false;
    if (finished.image == NULL)
        return true;
    show_finished(sequence, frame, &finished);
    helio_image_destroy(job->context, finished.image);
    sequence->skipped++;
    return *is_finished = true;
}

/* Names of frames are known only now. */
static bool check_name(render_sequence *sequence, const helio_source_frame *frame)
{
    char name[SINK_PATH_SIZE];
    char reference[FRAME_ERROR_PATH];
    const char *const inputs[] = {sequence->job->plan.mesh, reference, NULL};
    if (!frame_error_name(&sequence->job->error, frame->index, reference))
        reference[0] = 0; /* a name that is too long is that of no file */
    if (sequence->job->plan.sink != SINK_NUMBERED || !frame_sink_name(&sequence->sink, frame->index, name))
        return true;
    return check_code(sequence, output_file_check("out", name, sequence->job->source, inputs));
}

static bool measure_error(render_sequence *sequence, stats_frame *stats)
{
    render_job *job = sequence->job;
    const helio_picture picture = helio_renderer_picture(job->renderer);
    return check_code(sequence,
                      frame_error_measure(&job->error, &picture, sequence->exposure, job->plan.tonemap, stats));
}

/* Is what is written what a screen shows, of eight bits? */
static bool writes_shown(const render_plan *plan)
{
    return plan->sink == SINK_VIDEO ? !plan->video.hdr : output_file_has_extension(plan->out, "png");
}

/* Radiance is only asked for where somebody wants it, as it has far to come from a device. */
static void ask_for_pictures(render_sequence *sequence)
{
    render_job *job = sequence->job;
    const bool is_shown = writes_shown(&job->plan);
    const bool is_on_sheet =
        job->plan.options->contact_sheet != NULL && contact_sheet_wants(&sequence->sheet, sequence->frames);
    sequence->look = (helio_picture_write_desc){.exposure = sequence->exposure,
                                                .tonemap = job->plan.tonemap,
                                                .alpha = job->plan.alpha && job->plan.sink != SINK_VIDEO};
    job->shown = is_shown ? &sequence->look : NULL;
    job->no_radiance = is_shown && !is_on_sheet && job->error.path == NULL;
}

static bool render_frame(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats)
{
    bool is_whole;
    if (!check_code(sequence, frame_error_prepare(&sequence->job->error, frame->index, stats)))
        return false;
    ask_for_pictures(sequence);
    if (!check(sequence, render_job_render(sequence->job, frame, stats, &is_whole)))
        return false;
    if (!is_whole)
        return fail_with(sequence, "");
    return measure_error(sequence, stats) && write_frame(sequence, frame, stats);
}

/* started: when the work on this frame began. */
static bool end_frame(render_sequence *sequence, stats_frame *stats, double started)
{
    stats->total_ms = machine_milliseconds() - started - stats->error_ms;
    if (sequence->job->plan.options->stats == NULL || stats_list_add(&sequence->stats, stats))
        return true;
    return fail_with(sequence, "there is no memory for more statistics");
}

static bool light_frame(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats, bool is_lit)
{
    helio_environment_info info;
    render_job *job = sequence->job;
    return is_lit || check(sequence, render_job_light(job, frame, job->device == NULL ? &info : NULL, stats));
}

static bool process(render_sequence *sequence, const helio_source_frame *frame, stats_frame *stats, double started)
{
    bool is_first = sequence->frames == 0, is_finished;
    if (is_first && !begin(sequence, frame, stats))
        return false;
    if (!take_finished(sequence, frame, &is_finished))
        return false;
    if (!is_finished && !(light_frame(sequence, frame, stats, is_first) && check_name(sequence, frame) &&
                          render_frame(sequence, frame, stats) && end_frame(sequence, stats, started)))
        return false;
    sequence->frames++;
    progress_pass(&sequence->job->progress, !is_finished);
    return true;
}

/* False after the last one. */
static bool run_frame(render_sequence *sequence)
{
    helio_source_frame frame;
    stats_frame stats;
    double started = machine_milliseconds();
    if (!check(sequence, render_job_next(sequence->job, &frame, &stats)))
        return false;
    bool is_end = frame.rgb == NULL && frame.sky == NULL;
    return !is_end && process(sequence, &frame, &stats, started) && interrupt_signal() == 0;
}

/* What is left of it: a still picture or the last frame that is written is not spoilt by a signal that comes late. */
static void end(render_sequence *sequence)
{
    progress_end(&sequence->job->progress);
    if (frame_sink_close(&sequence->sink) != HELIO_OK && !sequence->failed)
        fail_with(sequence, sequence->sink.error);
    frame_warnings_end(&sequence->job->warnings);
    if (sequence->job->plan.options->verbose)
        frame_error_tell(&sequence->job->error);
    bool is_complete = sequence->frames > 0 && sequence->frames == sequence->job->source_info.frame_count;
    if (interrupt_signal() != 0 && !is_complete && !sequence->failed)
        fail_with(sequence, "");
    if (sequence->frames == 0 && !sequence->failed) {
        char sentence[SINK_ERROR_SIZE];
        snprintf(sentence, sizeof sentence, "%.4000s has no frame that can be read",
                 sequence->job->plan.light.specification);
        fail_with(sequence, sentence);
    }
}

int render_sequence_run(render_job *job)
{
    const cli_options *options = job->plan.options;
    render_sequence sequence = {.job = job, .started = machine_milliseconds()};
    uint64_t total = job->source_info.is_dynamic ? job->source_info.frame_count : 1;
    progress_start(&job->progress, total, (double)options->size[0] * options->size[1], options->quiet);
    while (run_frame(&sequence))
        ;
    end(&sequence);
    int code = sequence_report_write(&sequence);
    contact_sheet_release(&sequence.sheet);
    stats_list_release(&sequence.stats);
    return code;
}
