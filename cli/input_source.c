/* SPDX-License-Identifier: MIT */
#include "input_source.h"

#include "message.h"

int input_source_check(const cli_options *options, const char *command_name)
{
    if (options->input == NULL)
        return message_usage("%s needs an environment map: heliostat %s SRC; heliostat %s --help shows what SRC may be",
                             command_name, command_name, command_name);
    if (options->quiet && options->verbose)
        return message_usage("--quiet and --verbose exclude each other; give one of them");
    helio_status status = helio_source_check(options->input, NULL);
    if (status == HELIO_ERR_ARGUMENT)
        return message_usage("%s", helio_last_error());
    return status == HELIO_OK ? EXIT_CODE_OK : message_failure("%s", helio_last_error());
}

static void print_log(void *user, helio_log_level level, const char *message)
{
    if (level <= HELIO_LOG_WARNING)
        frame_warnings_log(user, message);
    else
        message_note("%s", message);
}

helio_status input_source_context(const cli_options *options, frame_warnings *warnings, helio_context **context)
{
    warnings->tells_all = options->verbose;
    const helio_context_desc desc = {
        .threads = options->threads,
        .log_level = options->verbose ? HELIO_LOG_INFO : HELIO_LOG_WARNING,
        .log = print_log,
        .user = warnings,
    };
    return helio_context_create(&desc, context);
}

int input_source_describe(const cli_options *options, helio_source_desc *desc)
{
    *desc = (helio_source_desc){
        .has_frames = options->frames.is_given,
        .first = options->frames.first,
        .last = options->frames.last,
        .fps = options->fps,
        .frames = options->day_frames,
        .max_pixels = options->max_pixels,
    };
    /* The words of the table are the library's own, so that these fail only if a build of the library knows fewer. */
    if (helio_layout_parse(options->layout, &desc->layout) != HELIO_OK ||
        helio_transfer_parse(options->transfer, &desc->transfer) != HELIO_OK ||
        helio_on_missing_parse(options->on_missing, &desc->on_missing) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    return EXIT_CODE_OK;
}

int input_source_open(const cli_options *options, helio_context *context, helio_source **source)
{
    helio_source_desc desc;
    int code = input_source_describe(options, &desc);
    if (code != EXIT_CODE_OK)
        return code;
    helio_status status = helio_source_open(context, options->input, &desc, source);
    if (status == HELIO_ERR_ARGUMENT)
        return message_usage("%s", helio_last_error());
    return status == HELIO_OK ? EXIT_CODE_OK : message_failure("%s", helio_last_error());
}

void input_source_warn(frame_warnings *warnings, const char *label, const helio_source_frame *frame,
                       const helio_environment_info *light)
{
    stats_frame seen = {0};
    stats_note_bad_pixels(&seen, &frame->bad, &light->bad);
    frame_warnings_bad_pixels(warnings, label, &seen);
}
