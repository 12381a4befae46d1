/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "finished_frame.h"
#include "interrupt.h"
#include "message.h"
#include "numbered_path.h"
#include "output_file.h"
#include "reference_report.h"
#include "reference_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* References of all frames of a source. */
typedef struct reference_sequence {
    reference_plan plan;
    render_job job;
    json_t *frames; /* of --stats */
    uint64_t count; /* frames that came */
} reference_sequence;

static int open_job(reference_sequence *sequence)
{
    render_job *job = &sequence->job;
    int code = render_plan_make(&job->plan, &sequence->plan.render);
    if (code == EXIT_CODE_OK && job->plan.sink == SINK_VIDEO)
        return message_usage("--out %s is a video, which holds no reference; give it a name that ends in .exr",
                             job->plan.out);
    if (code == EXIT_CODE_OK)
        code = render_job_open_source(job);
    if (code == EXIT_CODE_OK)
        code = render_plan_settle(&job->plan, job->source);
    return code == EXIT_CODE_OK ? render_job_open_parts(job) : code;
}

static bool find_name(const reference_sequence *sequence, uint64_t index, char name[SINK_PATH_SIZE])
{
    const render_plan *plan = &sequence->job.plan;
    numbered_path names;
    if (plan->sink != SINK_NUMBERED)
        return snprintf(name, SINK_PATH_SIZE, "%s", plan->out) < SINK_PATH_SIZE;
    return numbered_path_parse(plan->out, &names) && numbered_path_format(&names, index, name, SINK_PATH_SIZE);
}

/* Of numbered pictures, an earlier run may have finished this one. */
static int look_for_finished(reference_sequence *sequence, const char *name, bool *is_finished)
{
    const uint32_t *size = sequence->plan.render.size;
    char checkpoint[SINK_PATH_SIZE + 16];
    finished_frame finished;
    *is_finished = false;
    snprintf(checkpoint, sizeof checkpoint, "%s.checkpoint", name);
    if (!sequence->plan.resume || sequence->job.plan.sink != SINK_NUMBERED || access(checkpoint, F_OK) == 0)
        return EXIT_CODE_OK;
    int code = finished_frame_read(sequence->job.context, name, size[0], size[1], &finished);
    if (code != EXIT_CODE_OK)
        return code;
    *is_finished = finished.image != NULL;
    helio_image_destroy(sequence->job.context, finished.image);
    return EXIT_CODE_OK;
}

static int check_name(reference_sequence *sequence, const char *name)
{
    const char *const inputs[] = {sequence->job.plan.mesh, NULL};
    return output_file_check("out", name, sequence->job.source, inputs);
}

static int compute(reference_sequence *sequence, const helio_source_frame *frame, const char *name)
{
    reference_run run = {.plan = &sequence->plan, .job = &sequence->job};
    helio_environment_info light;
    stats_frame stats = {0};
    double exposure = sequence->plan.render.exposure;
    if (render_job_light(&sequence->job, frame, &light, &stats) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    int code = reference_run_frame(&run, frame->index, name, isnan(exposure) ? light.auto_exposure : (float)exposure);
    if (run.info.pieces > 0)
        json_array_append_new(sequence->frames, reference_report_frame(&run, frame->index));
    return code;
}

/* *is_end after the last frame. */
static int run_frame(reference_sequence *sequence, bool *is_end)
{
    helio_source_frame frame;
    stats_frame stats;
    char name[SINK_PATH_SIZE];
    bool is_finished;
    if (render_job_next(&sequence->job, &frame, &stats) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    *is_end = frame.rgb == NULL && frame.sky == NULL;
    if (*is_end)
        return EXIT_CODE_OK;
    sequence->count++;
    if (!find_name(sequence, frame.index, name))
        return message_failure("the name of a frame by %s is too long", sequence->job.plan.out);
    int code = look_for_finished(sequence, name, &is_finished);
    if (code != EXIT_CODE_OK || is_finished)
        return code;
    code = check_name(sequence, name);
    return code == EXIT_CODE_OK ? compute(sequence, &frame, name) : code;
}

static int run_frames(reference_sequence *sequence)
{
    bool is_end = false;
    int code = EXIT_CODE_OK;
    while (code == EXIT_CODE_OK && !is_end && interrupt_signal() == 0)
        code = run_frame(sequence, &is_end);
    frame_warnings_end(&sequence->job.warnings);
    if (code == EXIT_CODE_OK && !is_end && sequence->count < sequence->job.source_info.frame_count) {
        message_failure("stopped; references of further frames were not begun");
        return EXIT_CODE_SIGNAL + interrupt_signal();
    }
    if (code == EXIT_CODE_OK && sequence->count == 0)
        return message_failure("%s has no frame that can be read", sequence->job.plan.light.specification);
    return code;
}

int command_reference(const cli_options *options)
{
    reference_sequence sequence = {.frames = json_array()};
    interrupt_install();
    int code = reference_plan_make(&sequence.plan, options);
    if (code == EXIT_CODE_OK)
        code = open_job(&sequence);
    if (code == EXIT_CODE_OK) {
        code = run_frames(&sequence);
        if (options->stats != NULL && json_array_size(sequence.frames) > 0) {
            int stats = reference_report_write(&sequence.plan, &sequence.job, json_incref(sequence.frames));
            code = code == EXIT_CODE_OK ? stats : code;
        }
    }
    json_decref(sequence.frames);
    render_job_close(&sequence.job);
    return code;
}
