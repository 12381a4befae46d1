/* SPDX-License-Identifier: MIT */
#include "render_plan.h"

#include "input_source.h"
#include "mesh_path.h"
#include "message.h"
#include "output_file.h"
#include "output_plan.h"

#include <math.h>
#include <string.h>

enum { USUAL_DAY_FRAMES = 240 };

static bool is(const char *value, const char *word)
{
    return strcmp(value, word) == 0;
}

float render_plan_aspect(const render_plan *plan)
{
    return (float)plan->options->size[0] / (float)plan->options->size[1];
}

/* The words of the table are the library's own, so that this fails only if a build of the library knows fewer. */
static int parse_words(render_plan *plan)
{
    const cli_options *options = plan->options;
    if (helio_strategy_parse(options->strategy, &plan->strategy) != HELIO_OK ||
        helio_weighting_parse(options->weighting, &plan->weighting) != HELIO_OK ||
        helio_strategy_check_weighting(plan->strategy, plan->weighting) != HELIO_OK ||
        helio_ground_parse(options->ground, &plan->ground) != HELIO_OK ||
        helio_tonemap_parse(options->tonemap, &plan->tonemap) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    if (options->background != NULL)
        plan->background = is(options->background, "env") ? HELIO_BACKGROUND_ENVIRONMENT : HELIO_BACKGROUND_NONE;
    plan->alpha = plan->background == HELIO_BACKGROUND_NONE ||
                  (plan->background == HELIO_BACKGROUND_DEFAULT && plan->ground == HELIO_GROUND_SHADOW);
    return EXIT_CODE_OK;
}

/* The mesh is not read yet, but mistakes show all the same. */
static int check_camera(const render_plan *plan)
{
    if (helio_camera_parse(plan->options->camera, NULL, render_plan_aspect(plan), NULL) != HELIO_OK)
        return message_usage("--camera: %s", helio_last_error());
    return EXIT_CODE_OK;
}

static int check_scene(render_plan *plan)
{
    const cli_options *options = plan->options;
    plan->has_material = !is(options->material, "file");
    if (plan->has_material && helio_material_parse(options->material, &plan->material) != HELIO_OK)
        return message_usage("--material: %s", helio_last_error());
    if (plan->ground == HELIO_GROUND_SHADOW && is(options->visibility, "none"))
        return message_usage(
            "--ground shadow catches shadows, and --visibility none casts none; give --visibility ray");
    return check_camera(plan);
}

static int choose_light(render_plan *plan, bool may_be_sequence)
{
    const cli_options *options = plan->options;
    int code = input_source_describe(options, &plan->source);
    return code != EXIT_CODE_OK ? code : light_source_choose(options->env, may_be_sequence, &plan->light);
}

static int check_program(const cli_options *options)
{
    if (options->quiet && options->verbose)
        return message_usage("--quiet and --verbose exclude each other; give one of them");
    return EXIT_CODE_OK;
}

/* Options that are fine but change nothing here: people should not look for their effect. */
static void warn_of_idle_sampling(const render_plan *plan)
{
    const cli_options *options = plan->options;
    const char *strategy = helio_strategy_name(helio_strategy_resolve(plan->strategy));
    bool by_face = strncmp(strategy, "face", 4) == 0, has_brdf = strstr(strategy, "+brdf") != NULL;
    if (options->device != NULL && !is(options->backend, "vulkan"))
        message_warning("--device changes nothing with --backend %s", options->backend);
    if (options->no_beta && !by_face)
        message_warning("--no-beta changes nothing with --strategy %s", strategy);
    if (options->no_control && strncmp(strategy, "product", 7) != 0)
        message_warning("--no-control changes nothing with --strategy %s", strategy);
    if (options->bins != 8 && strncmp(strategy, "product", 7) != 0)
        message_warning("--bins changes nothing with --strategy %s", strategy);
    if (options->brdf_share != 0.5 && !has_brdf)
        message_warning("--brdf-share changes nothing with --strategy %s", strategy);
}

static void warn_of_idle_source(const render_plan *plan)
{
    const cli_options *options = plan->options;
    helio_source_kind kind = plan->light.kind;
    bool has_map = kind != HELIO_SOURCE_CONSTANT && kind != HELIO_SOURCE_SKY && kind != HELIO_SOURCE_SKY_DAY;
    bool is_coded = kind == HELIO_SOURCE_VIDEO || kind == HELIO_SOURCE_DEVICE;
    const char *source = plan->light.specification;
    if (plan->source.layout != HELIO_LAYOUT_AUTO && !has_map)
        message_warning("--layout changes nothing with --env %s", source);
    if (plan->source.transfer != HELIO_TRANSFER_AUTO && !is_coded)
        message_warning("--transfer changes nothing with --env %s, which is no video", source);
    if (options->on_missing[1] != 't' && kind != HELIO_SOURCE_SEQUENCE && !is_coded)
        message_warning("--on-missing changes nothing with --env %s, which is no sequence of files and no video",
                        source);
    if (options->day_frames != USUAL_DAY_FRAMES && kind != HELIO_SOURCE_SKY_DAY)
        message_warning("--day-frames changes nothing with --env %s; it is for sky:day", source);
}

static int begin(render_plan *plan, const cli_options *options)
{
    *plan = (render_plan){.options = options};
    int code = check_program(options);
    if (code == EXIT_CODE_OK)
        code = parse_words(plan);
    return code == EXIT_CODE_OK ? check_scene(plan) : code;
}

static int choose_inputs(render_plan *plan, bool may_be_sequence)
{
    int code = choose_light(plan, may_be_sequence);
    return code == EXIT_CODE_OK ? mesh_path_choose(plan->options->mesh, plan->mesh) : code;
}

int render_plan_make(render_plan *plan, const cli_options *options)
{
    int code = begin(plan, options);
    if (code == EXIT_CODE_OK)
        code = output_plan_check(plan);
    return code == EXIT_CODE_OK ? choose_inputs(plan, options->out == NULL || plan->sink != SINK_PICTURE) : code;
}

int render_plan_make_scene(render_plan *plan, const cli_options *options, bool may_be_sequence)
{
    int code = begin(plan, options);
    return code == EXIT_CODE_OK ? choose_inputs(plan, may_be_sequence) : code;
}

void render_plan_settle_scene(render_plan *plan, const helio_source *source)
{
    plan->light.kind = helio_source_get_info(source).kind;
    warn_of_idle_sampling(plan);
    warn_of_idle_source(plan);
}

int render_plan_settle(render_plan *plan, helio_source *source)
{
    plan->light.kind = helio_source_get_info(source).kind;
    int code = output_plan_settle(plan, source);
    if (code != EXIT_CODE_OK)
        return code;
    render_plan_settle_scene(plan, source);
    output_plan_warn(plan);
    return EXIT_CODE_OK;
}

void render_plan_release(const render_plan *plan)
{
    if (plan->has_made_folder)
        output_file_remove_folder(plan->out);
}
