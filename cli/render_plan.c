/* SPDX-License-Identifier: MIT */
#include "render_plan.h"

#include "asset.h"
#include "message.h"
#include "output_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char SHIPPED_MESH[] = "dragon.ply.gz";

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
    if (helio_layout_parse(options->layout, &plan->layout) != HELIO_OK ||
        helio_strategy_parse(options->strategy, &plan->strategy) != HELIO_OK ||
        helio_weighting_parse(options->weighting, &plan->weighting) != HELIO_OK ||
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

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL && strcasecmp(dot + 1, extension) == 0;
}

static int check_output(const render_plan *plan)
{
    const cli_options *options = plan->options;
    const char *percent = strchr(options->out, '%');
    if (percent != NULL && percent[1 + strspn(percent + 1, "0123456789")] == 'd')
        return message_usage("--out %s names a sequence, which is not in this version; name one picture", options->out);
    if (helio_picture_check_path(options->out) != HELIO_OK)
        return message_usage("--out: %s", helio_last_error());
    if (options->aovs && !has_extension(options->out, "exr"))
        return message_usage("--aovs writes layers, which only EXR holds; give --out a name that ends in .exr, not %s",
                             options->out);
    if (plan->alpha && has_extension(options->out, "pfm"))
        message_warning("%s cannot hold the alpha channel of this picture; EXR and PNG can", options->out);
    if (options->stats != NULL && is(options->stats, options->out))
        return message_usage("--stats and --out both name %s; give two files", options->out);
    return EXIT_CODE_OK;
}

static int check_program(const cli_options *options)
{
    if (is(options->backend, "vulkan"))
        return message_usage("--backend vulkan is not in this version; give auto or cpu");
    if (options->quiet && options->verbose)
        return message_usage("--quiet and --verbose exclude each other; give one of them");
    return EXIT_CODE_OK;
}

static int choose_mesh(render_plan *plan)
{
    const char *mesh = plan->options->mesh;
    if (mesh == NULL) {
        if (asset_find(SHIPPED_MESH, plan->mesh, sizeof plan->mesh))
            return EXIT_CODE_OK;
        return message_failure("the dragon %s, which comes with the sources only, was not found; give a mesh by "
                               "--mesh FILE",
                               SHIPPED_MESH);
    }
    if (strlen(mesh) >= sizeof plan->mesh)
        return message_usage("--mesh takes a path of less than %zu bytes, not one of %zu", sizeof plan->mesh,
                             strlen(mesh));
    strcpy(plan->mesh, mesh);
    return EXIT_CODE_OK;
}

/* Options that are fine but change nothing here: people should not look for their effect. */
static void warn_of_idle_options(const render_plan *plan)
{
    const cli_options *options = plan->options;
    const char *strategy = helio_strategy_name(helio_strategy_resolve(plan->strategy));
    bool by_face = strncmp(strategy, "face", 4) == 0, has_brdf = strstr(strategy, "+brdf") != NULL;
    bool has_exposure = !isnan(options->exposure) || plan->tonemap != HELIO_TONEMAP_CLIP;
    if (options->no_beta && !by_face)
        message_warning("--no-beta changes nothing with --strategy %s", strategy);
    if (options->brdf_share != 0.5 && !has_brdf)
        message_warning("--brdf-share changes nothing with --strategy %s", strategy);
    if (plan->layout != HELIO_LAYOUT_AUTO && plan->source.path[0] == 0)
        message_warning("--layout changes nothing with --env %s", plan->source.label);
    if (has_exposure && !has_extension(options->out, "png"))
        message_warning("--exposure and --tonemap change nothing in %s: EXR and PFM hold radiance as it is",
                        options->out);
}

int render_plan_make(render_plan *plan, const cli_options *options)
{
    *plan = (render_plan){.options = options};
    int code = check_program(options);
    if (code == EXIT_CODE_OK)
        code = parse_words(plan);
    if (code == EXIT_CODE_OK)
        code = check_scene(plan);
    if (code == EXIT_CODE_OK)
        code = check_output(plan);
    if (code == EXIT_CODE_OK)
        code = environment_source_parse(options->env, &plan->source);
    if (code == EXIT_CODE_OK)
        code = choose_mesh(plan);
    const char *const inputs[] = {plan->source.path, plan->mesh, NULL};
    if (code == EXIT_CODE_OK)
        code = output_file_check("out", options->out, inputs);
    if (code == EXIT_CODE_OK && options->stats != NULL)
        code = output_file_check("stats", options->stats, inputs);
    if (code == EXIT_CODE_OK)
        warn_of_idle_options(plan);
    return code;
}
