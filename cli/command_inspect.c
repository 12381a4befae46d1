/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "figure_path.h"
#include "input_source.h"
#include "inspect.h"
#include "map_shape.h"
#include "message.h"
#include "output_file.h"

#include <inttypes.h>
#include <string.h>

enum { COARSEST = 64, FINEST = 1024, SKY_SIZE = 512 };

/* The cube that is looked at: as fine as the map, or fine enough to find a sun; and fine enough to tell how texels lie
 * to a horizontal surface. */
static uint32_t choose_cube(const helio_source_frame *frame)
{
    const map_shape shape = {frame->layout, frame->width, frame->height};
    if (frame->rgb == NULL)
        return SKY_SIZE;
    uint32_t size = map_shape_fineness(&shape);
    if (size < COARSEST)
        size *= (COARSEST + size - 1) / size;
    return size < FINEST ? size : FINEST;
}

typedef struct inspection {
    const cli_options *options;
    frame_warnings warnings;
    helio_context *context;
    helio_source *source;
    helio_source_info info;
    helio_environment *environment;
} inspection;

static int failure(void)
{
    return message_failure("%s", helio_last_error());
}

static int check_outputs(const inspection *job, const char *input)
{
    const inspect_options *inspect = &job->options->inspect;
    const char *const inputs[] = {input, NULL};
    int code = EXIT_CODE_OK;
    if (inspect->json != NULL && strcmp(inspect->json, "-") != 0)
        code = output_file_check("json", inspect->json, job->source, inputs);
    if (code == EXIT_CODE_OK && inspect->out != NULL)
        code = output_file_check("out", inspect->out, job->source, inputs);
    return code;
}

static int check_options(const cli_options *options)
{
    const inspect_options *inspect = &options->inspect;
    int code = input_source_check(options, "inspect");
    if (code == EXIT_CODE_OK && options->quiet && inspect->json == NULL && inspect->out == NULL)
        code = message_usage("inspect --quiet would tell nothing; give --json FILE or --out PICTURE as well, or leave "
                             "--quiet out");
    if (code == EXIT_CODE_OK && inspect->out != NULL)
        code = figure_path_check("out", inspect->out, "inspect");
    if (code == EXIT_CODE_OK && inspect->out != NULL && inspect->json != NULL &&
        strcmp(inspect->out, inspect->json) == 0)
        code = message_usage("--json and --out both name %s; give two files", inspect->out);
    return code;
}

static int make_cube(inspection *job, const helio_source_frame *frame, helio_environment_info *light)
{
    const helio_environment_desc desc = {.cube_size = choose_cube(frame)};
    helio_status status = helio_environment_create(job->context, &desc, &job->environment);
    if (status == HELIO_OK)
        status = helio_source_apply(job->source, frame, job->environment, light);
    return status == HELIO_OK ? EXIT_CODE_OK : failure();
}

static int tell(const inspection *job, const inspect_findings *found)
{
    const inspect_options *inspect = &job->options->inspect;
    int code = EXIT_CODE_OK;
    if (inspect->json != NULL)
        code = inspect_write_json(inspect->json, found);
    if (code == EXIT_CODE_OK && inspect->out != NULL)
        code = inspect_draw(inspect->out, found, helio_environment_cube(job->environment));
    bool is_json_printed = inspect->json != NULL && strcmp(inspect->json, "-") == 0;
    if (code == EXIT_CODE_OK && !is_json_printed && !job->options->quiet)
        inspect_print(found);
    return code;
}

static int inspect_frame(inspection *job, const helio_source_frame *frame)
{
    helio_environment_info light;
    inspect_findings found;
    int code = check_outputs(job, frame->name);
    if (code == EXIT_CODE_OK)
        code = make_cube(job, frame, &light);
    if (code != EXIT_CODE_OK)
        return code;
    const inspect_subject subject = {.frame = frame,
                                     .source = &job->info,
                                     .environment = job->environment,
                                     .light = &light,
                                     .layout_is_given = strcmp(job->options->layout, "auto") != 0};
    if (!inspect_measure(&subject, &found))
        return EXIT_CODE_FAILED;
    return tell(job, &found);
}

static int inspect_source(inspection *job)
{
    helio_source_frame frame;
    if (input_source_context(job->options, &job->warnings, &job->context) != HELIO_OK)
        return failure();
    int code = input_source_open(job->options, job->context, &job->source);
    if (code != EXIT_CODE_OK)
        return code;
    job->info = helio_source_get_info(job->source);
    if (helio_source_next(job->source, &frame) != HELIO_OK)
        return failure();
    if (frame.rgb == NULL && frame.sky == NULL)
        return message_failure("%s holds no frame that could be looked at", job->options->input);
    return inspect_frame(job, &frame);
}

int command_inspect(const cli_options *options)
{
    int code = check_options(options);
    if (code != EXIT_CODE_OK)
        return code;
    inspection job = {.options = options};
    code = inspect_source(&job);
    helio_environment_destroy(job.environment);
    helio_source_close(job.source);
    helio_context_destroy(job.context);
    return code;
}
