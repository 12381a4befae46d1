/* SPDX-License-Identifier: MIT */
#include "sequence_report.h"

#include "interrupt.h"
#include "json_file.h"
#include "machine.h"
#include "message.h"

#include <inttypes.h>
#include <stdio.h>

/* What is to be said of the frames that there are. */
static void describe_frames(const render_sequence *sequence, char text[64])
{
    uint64_t count = sequence->sink.written + sequence->skipped, total = sequence->job->source_info.frame_count;
    if (total > 0)
        snprintf(text, 64, "%" PRIu64 " of %" PRIu64 " frames", count, total);
    else
        snprintf(text, 64, "%" PRIu64 " frame%s", count, count == 1 ? "" : "s");
}

/* One sentence about the sequence that ended early, and the exit code. */
static int tell_failure(const render_sequence *sequence, int signal)
{
    const render_job *job = sequence->job;
    const char *reason = signal != 0 ? "stopped" : sequence->error;
    char frames[64];
    describe_frames(sequence, frames);
    int code = signal != 0 ? EXIT_CODE_SIGNAL + signal : EXIT_CODE_FAILED;
    if (sequence->sink.written + sequence->skipped > 0)
        message_failure("%s%s%s written to %s", reason, reason[0] != 0 ? "; " : "", frames, job->plan.out);
    else if (sequence->sink.lost > 0)
        message_failure("%s; nothing is kept of its %" PRIu64 " frame%s", sequence->sink.error, sequence->sink.lost,
                        sequence->sink.lost == 1 ? "" : "s");
    else if (signal != 0)
        message_failure("stopped; nothing was written to %s", job->plan.out);
    else if (reason[0] != 0)
        message_failure("%s", reason);
    return code;
}

static int write_stats(const render_sequence *sequence)
{
    const render_job *job = sequence->job;
    const cli_options *options = job->plan.options;
    const char *error = sequence->error[0] != 0 ? sequence->error : "stopped";
    helio_device_info device = {0};
    if (job->device != NULL)
        device = helio_device_get_info(job->device);
    stats_summary summary = {
        .strategy = helio_strategy_name(helio_strategy_resolve(job->plan.strategy)),
        .spp = options->spp,
        .width = options->size[0],
        .height = options->size[1],
        .threads = helio_context_threads(job->context),
        .isa = helio_context_isa(job->context),
        .passes = job->passes,
        .ev = (double)sequence->exposure,
        .skipped = sequence->skipped,
        .device = job->device != NULL ? device.name : NULL,
        .error = sequence->failed ? error : NULL,
    };
    return stats_write(options->stats, &sequence->stats, &summary);
}

/* The frames are there, whatever becomes of the sheet. */
static int write_sheet(const render_sequence *sequence)
{
    const render_job *job = sequence->job;
    const char *path = job->plan.options->contact_sheet;
    helio_status status = contact_sheet_write(&sequence->sheet, job->context, path);
    if (status == HELIO_OK)
        return EXIT_CODE_OK;
    char frames[64];
    describe_frames(sequence, frames);
    if (status == HELIO_ERR_MEMORY)
        return message_failure("no memory for the contact sheet %s; %s written to %s", path, frames, job->plan.out);
    return message_failure("%s; %s written to %s", helio_last_error(), frames, job->plan.out);
}

/* What goes beside the frames; of a sequence that ended early too, if there are frames. */
static int write_reports(const render_sequence *sequence)
{
    const cli_options *options = sequence->job->plan.options;
    int code = EXIT_CODE_OK;
    if (options->contact_sheet != NULL && sequence->sheet.count > 0)
        code = write_sheet(sequence);
    if (options->stats != NULL) {
        int stats = write_stats(sequence);
        code = code == EXIT_CODE_OK ? stats : code;
    }
    return code;
}

static void tell_success(const render_sequence *sequence)
{
    const render_job *job = sequence->job;
    const uint32_t *size = job->plan.options->size;
    const char *strategy = helio_strategy_name(helio_strategy_resolve(job->plan.strategy));
    double seconds = (machine_milliseconds() - sequence->started) / 1e3;
    char frames[64];
    describe_frames(sequence, frames);
    if (job->plan.sink == SINK_PICTURE)
        printf("%s: %" PRIu32 "x%" PRIu32 ", %.2f s, strategy %s\n", job->plan.out, size[0], size[1], seconds,
               strategy);
    else if (sequence->sink.written == 0)
        printf("%s: %s, %" PRIu32 "x%" PRIu32 ", all of an earlier run\n", job->plan.out, frames, size[0], size[1]);
    else
        printf("%s: %s, %" PRIu32 "x%" PRIu32 ", %.2f s, %.3g frames/s, strategy %s\n", job->plan.out, frames, size[0],
               size[1], seconds, (double)sequence->sink.written / seconds, strategy);
}

/* A picture that came to nothing has no statistics; a part of a sequence has. */
int sequence_report_write(const render_sequence *sequence)
{
    bool has_frames = sequence->sink.written + sequence->skipped > 0;
    int code = EXIT_CODE_OK;
    if (sequence->failed)
        code = tell_failure(sequence, interrupt_signal());
    if (has_frames) {
        int reports = write_reports(sequence);
        code = code == EXIT_CODE_OK ? reports : code;
    }
    const cli_options *options = sequence->job->plan.options;
    if (code == EXIT_CODE_OK && !options->quiet && !json_file_is_printed(options->stats))
        tell_success(sequence);
    return code;
}
