/* SPDX-License-Identifier: MIT */
#include "samples_plan.h"

#include "figure_path.h"
#include "message.h"
#include "number.h"
#include "output_plan.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char STILL_OUT[] = "samples.png", NUMBERED_OUT[] = "samples_%04d.png";

enum { USUAL_DAY_FRAMES = 6, GREATEST_PIXEL = 16383 };

/* ---- the pixel ---------------------------------------------------------------------------- */

static bool parse_pixel(const char *text, uint32_t *x, uint32_t *y)
{
    char column[16];
    size_t length = strcspn(text, ",");
    if (length >= sizeof column || text[length] != ',')
        return false;
    snprintf(column, sizeof column, "%.*s", (int)length, text);
    return number_parse_whole(column, 0, UINT32_MAX, x) && number_parse_whole(text + length + 1, 0, UINT32_MAX, y);
}

static int choose_pixel(samples_plan *plan, const char *text)
{
    const uint32_t *size = plan->options.size;
    plan->has_pixel = text != NULL;
    if (text == NULL) {
        plan->x = size[0] / 2;
        plan->y = size[1] / 2;
        return EXIT_CODE_OK;
    }
    if (!parse_pixel(text, &plan->x, &plan->y))
        return message_usage("--pixel takes a column and a row, such as 640,360, counted from 0 at the upper left, not "
                             "'%s'",
                             text);
    if (plan->x < size[0] && plan->y < size[1])
        return EXIT_CODE_OK;
    return message_usage("--pixel %" PRIu32 ",%" PRIu32 " is outside of the picture of %" PRIu32 "x%" PRIu32
                         " pixels; columns go from 0 to %" PRIu32 ", rows from 0 to %" PRIu32,
                         plan->x, plan->y, size[0], size[1], size[0] - 1, size[1] - 1);
}

/* ---- figures ------------------------------------------------------------------------------ */

static int set_out(samples_plan *plan, render_job *job, const char *out)
{
    render_plan *scene = &job->plan;
    if (strlen(out) >= sizeof scene->out)
        return message_usage("--out takes a path of less than %zu bytes, not one of %zu", sizeof scene->out,
                             strlen(out));
    strcpy(scene->out, out);
    scene->sink = numbered_path_is_pattern(out) ? SINK_NUMBERED : SINK_PICTURE;
    if (scene->sink == SINK_NUMBERED && !numbered_path_parse(scene->out, &plan->names))
        return message_usage("--out %s takes one number, such as %%04d or %%d, and no other %%", out);
    return figure_path_check("out", out, "samples");
}

#ifdef HELIO_WITH_CAIRO
enum { CAN_DRAW = 1 };
#else
enum { CAN_DRAW = 0 };
#endif

static int check_outputs(samples_plan *plan, render_job *job, const samples_options *given)
{
    plan->sheet = given->contact_sheet;
    plan->json = given->json;
    plan->draws_frames = given->out != NULL || (CAN_DRAW && plan->sheet == NULL && plan->json == NULL);
    int code = given->out != NULL ? set_out(plan, job, given->out) : EXIT_CODE_OK;
    if (code == EXIT_CODE_OK && plan->sheet != NULL)
        code = figure_path_check("contact-sheet", plan->sheet, "samples");
    if (code != EXIT_CODE_OK || plan->json == NULL)
        return code;
    bool is_twice = (given->out != NULL && strcmp(given->out, plan->json) == 0) ||
                    (plan->sheet != NULL && strcmp(plan->sheet, plan->json) == 0);
    return is_twice ? message_usage("--json and another option both name %s; give two files", plan->json) : code;
}

/* ---- the plan ----------------------------------------------------------------------------- */

/* What render would have been told: nothing of what it writes. */
static cli_options options_of_scene(const cli_options *options)
{
    cli_options scene = *options;
    scene.strategy = options->samples.strategy != NULL ? options->samples.strategy : "face";
    if (options->samples.day_frames > 0)
        scene.day_frames = options->samples.day_frames;
    return scene;
}

int samples_plan_make(samples_plan *plan, const cli_options *options, render_job *job)
{
    const samples_options *given = &options->samples;
    *plan = (samples_plan){.options = options_of_scene(options)};
    *job = (render_job){0};
    int code = choose_pixel(plan, given->pixel);
    if (code != EXIT_CODE_OK)
        return code;
    bool many = given->contact_sheet != NULL || (given->out != NULL && numbered_path_is_pattern(given->out));
    code = render_plan_make_scene(&job->plan, &plan->options, many);
    if (code == EXIT_CODE_OK && given->day_frames == 0)
        job->plan.source.frames = USUAL_DAY_FRAMES;
    return code == EXIT_CODE_OK ? check_outputs(plan, job, given) : code;
}

/* ---- once the source is known ------------------------------------------------------------- */

static int choose_out(samples_plan *plan, render_job *job)
{
    bool has_many = job->source_info.is_dynamic && !output_plan_is_one_frame(&job->plan);
    if (plan->options.samples.out == NULL)
        return set_out(plan, job, has_many ? NUMBERED_OUT : STILL_OUT);
    if (!has_many || job->plan.sink == SINK_NUMBERED)
        return EXIT_CODE_OK;
    return message_usage("--out %s is one figure, but %s has many frames; give --out a name with %%04d, take one frame "
                         "by --frames N..N, or have six drawn by --contact-sheet FILE",
                         job->plan.out, job->plan.light.specification);
}

static int check_json(const samples_plan *plan, render_job *job)
{
    if (plan->json == NULL || strcmp(plan->json, "-") == 0)
        return EXIT_CODE_OK;
    return output_plan_check_beside(&job->plan, "json", plan->json, job->source);
}

int samples_plan_settle(samples_plan *plan, render_job *job)
{
    int code = plan->draws_frames ? choose_out(plan, job) : EXIT_CODE_OK;
    if (code == EXIT_CODE_OK && plan->draws_frames)
        code = output_plan_check_names(&job->plan, job->source);
    if (code == EXIT_CODE_OK)
        code = output_plan_check_beside(&job->plan, "contact-sheet", plan->sheet, job->source);
    if (code == EXIT_CODE_OK)
        code = check_json(plan, job);
    if (code == EXIT_CODE_OK)
        render_plan_settle_scene(&job->plan, job->source);
    return code;
}
