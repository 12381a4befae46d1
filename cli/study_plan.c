/* SPDX-License-Identifier: MIT */
#include "study_plan.h"

#include "asset.h"
#include "input_source.h"
#include "mesh_path.h"
#include "message.h"
#include "number.h"
#include "output_file.h"
#include "picture_list.h"
#include "study_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char SHIPPED_MAP[] = "sunrise.hdr";
enum { USUAL_DAY = 240, MOST_FRAMES = 1000 };

static bool is(const char *value, const char *word)
{
    return strcmp(value, word) == 0;
}

static int fail_for_memory(void)
{
    return message_failure("no memory for the lists of the study");
}

/* ---- numbers and words --------------------------------------------------------------------- */

/* Puts an item of a list where it belongs; returns an exit code after one sentence. */
typedef int take_item(study_plan *plan, const char *item);

static int take_strategy(study_plan *plan, const char *item)
{
    study_strategy strategy;
    int code = study_strategy_parse(item, plan->options, &strategy);
    if (code != EXIT_CODE_OK)
        return code;
    uint32_t other;
    if (study_plan_find(plan, strategy.name, &other))
        return message_usage("--strategies names %s twice", strategy.name);
    if (plan->strategy_count == STUDY_LIST)
        return message_usage("--strategies takes at most %d", STUDY_LIST);
    plan->strategies[plan->strategy_count++] = strategy;
    return EXIT_CODE_OK;
}

static int take_spp(study_plan *plan, const char *item)
{
    uint32_t spp, place = plan->spp_count;
    if (plan->spp_count == STUDY_LIST || !number_parse_whole(item, 1, 1 << 20, &spp))
        return message_usage("--spp takes up to %d whole numbers from 1 to 1048576, separated by commas, not '%s'",
                             STUDY_LIST, item);
    while (place > 0 && plan->spp[place - 1] > spp) {
        plan->spp[place] = plan->spp[place - 1];
        place--;
    }
    if (place > 0 && plan->spp[place - 1] == spp)
        return message_usage("--spp names %u twice", spp);
    plan->spp[place] = spp;
    plan->spp_count++;
    return EXIT_CODE_OK;
}

static int take_material(study_plan *plan, const char *item)
{
    size_t count = plan->material_count + 1;
    study_material *materials = realloc(plan->materials, count * sizeof *materials);
    if (materials == NULL)
        return fail_for_memory();
    plan->materials = materials;
    study_material *material = &materials[count - 1];
    *material = (study_material){.is_of_mesh = is(item, "file")};
    snprintf(material->name, sizeof material->name, "%s", item);
    for (uint32_t i = 0; i + 1 < count; i++)
        if (is(materials[i].name, item))
            return message_usage("--materials names %s twice", item);
    if (!material->is_of_mesh && helio_material_parse(item, &material->material) != HELIO_OK)
        return message_usage("--materials: %s", helio_last_error());
    plan->material_count++;
    return EXIT_CODE_OK;
}

/* ---- environments -------------------------------------------------------------------------- */

/* The name of a file without folder and ending; anything else as it is. */
static char *make_name(const char *specification)
{
    if (access(specification, F_OK) != 0)
        return strdup(specification);
    const char *part = specification + output_file_folder_length(specification), *dot = strrchr(part, '.');
    return dot != NULL && dot > part ? strndup(part, (size_t)(dot - part)) : strdup(part);
}

static bool has_name(const study_plan *plan, const char *name)
{
    for (uint32_t i = 0; i < plan->environment_count; i++)
        if (is(plan->environments[i].name, name))
            return true;
    return false;
}

static int add_environment(study_plan *plan, const char *specification)
{
    helio_status status = helio_source_check(specification, NULL);
    if (status != HELIO_OK)
        return status == HELIO_ERR_ARGUMENT ? message_usage("--envs: %s", helio_last_error())
                                            : message_failure("--envs: %s", helio_last_error());
    study_environment *list =
        realloc(plan->environments, ((size_t)plan->environment_count + 1) * sizeof *plan->environments);
    if (list == NULL)
        return fail_for_memory();
    plan->environments = list;
    char *name = make_name(specification);
    if (name != NULL && has_name(plan, name)) { /* files of one name in two folders */
        free(name);
        name = strdup(specification);
    }
    if (name != NULL && has_name(plan, name)) {
        free(name);
        return message_usage("--envs names %s twice", specification);
    }
    study_environment added = {strdup(specification), name};
    if (added.name == NULL || added.specification == NULL) {
        free(added.name);
        free(added.specification);
        return fail_for_memory();
    }
    list[plan->environment_count++] = added;
    return EXIT_CODE_OK;
}

/* Of 'DIR/?.exr' each file is a map of its own. */
static int take_environment(study_plan *plan, const char *item)
{
    static const frame_range all = {0};
    helio_source_kind kind = HELIO_SOURCE_FILE;
    bool is_glob = strpbrk(item, "*?[") != NULL && access(item, F_OK) != 0 &&
                   helio_source_check(item, &kind) == HELIO_OK && kind == HELIO_SOURCE_SEQUENCE;
    if (!is_glob)
        return add_environment(plan, item);
    picture_list list;
    int code = picture_list_find(&list, item, &all);
    for (size_t i = 0; code == EXIT_CODE_OK && i < list.count; i++)
        code = add_environment(plan, list.pictures[i].path);
    picture_list_release(&list);
    return code;
}

/* ---- all lists ----------------------------------------------------------------------------- */

typedef bool split_list(const char *text, const char **rest, char *item, size_t size);

static int take_list(study_plan *plan, const char *option, const char *text, split_list *split, take_item *take)
{
    char item[STUDY_NAME];
    for (const char *rest = text; rest != NULL;) {
        if (!split(text, &rest, item, sizeof item))
            return message_usage("--%s has an item that is empty or longer than %d bytes: '%s'", option, STUDY_NAME - 1,
                                 text);
        int code = take(plan, item);
        if (code != EXIT_CODE_OK)
            return code;
    }
    return EXIT_CODE_OK;
}

static int take_lists(study_plan *plan)
{
    const study_options *study = &plan->options->study;
    char shipped[STUDY_NAME];
    int code = take_list(plan, "strategies", study->strategies, study_list_take, take_strategy);
    if (code == EXIT_CODE_OK)
        code = take_list(plan, "spp", study->spp, study_list_take_plain, take_spp);
    if (code == EXIT_CODE_OK)
        code = take_list(plan, "materials", study->materials, study_list_take, take_material);
    if (code != EXIT_CODE_OK || study->envs != NULL)
        return code != EXIT_CODE_OK ? code : take_list(plan, "envs", study->envs, study_list_take, take_environment);
    if (!asset_find(SHIPPED_MAP, shipped, sizeof shipped))
        return message_failure("the map %s that comes with heliostat was not found; give maps by --envs LIST",
                               SHIPPED_MAP);
    return add_environment(plan, shipped);
}

static int take_shown(study_plan *plan, const char *item)
{
    uint32_t spp = 0, i = 0;
    bool is_number = number_parse_whole(item, 1, 1 << 20, &spp);
    while (i < plan->spp_count && plan->spp[i] != spp)
        i++;
    if (!is_number || i == plan->spp_count)
        return message_usage("--show-spp takes some of --spp %s, not '%s'", plan->options->study.spp, item);
    plan->is_shown[i] = true;
    return EXIT_CODE_OK;
}

static int choose_shown(study_plan *plan)
{
    const char *list = plan->options->study.shown_spp;
    bool shows_all = list != NULL && is(list, "all");
    plan->is_shown[plan->spp_count / 2] = list == NULL;
    for (uint32_t i = 0; shows_all && i < plan->spp_count; i++)
        plan->is_shown[i] = true;
    return list == NULL || shows_all ? EXIT_CODE_OK
                                     : take_list(plan, "show-spp", list, study_list_take_plain, take_shown);
}

/* ---- the scene ----------------------------------------------------------------------------- */

/* The words of the table are the library's own, so that these fail only if a build of the library knows fewer. */
static int parse_words(study_plan *plan)
{
    const cli_options *options = plan->options;
    if (helio_ground_parse(options->ground, &plan->ground) != HELIO_OK ||
        helio_tonemap_parse(options->tonemap, &plan->tonemap) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    return EXIT_CODE_OK;
}

static int check_words(const study_plan *plan)
{
    const cli_options *options = plan->options;
    float aspect = (float)options->size[0] / (float)options->size[1];
    if (options->quiet && options->verbose)
        return message_usage("--quiet and --verbose exclude each other; give one of them");
    if (plan->ground == HELIO_GROUND_SHADOW)
        return message_usage("study compares the light of surfaces, and --ground shadow is none; give none or plane");
    if (study_plan_has_quadrature(plan) && !is(options->study.visibility, "none"))
        return message_usage(
            "--reference-method quadrature knows no shadows; give --visibility none, or --reference-method samples");
    if (helio_camera_parse(options->camera, NULL, aspect, NULL) != HELIO_OK)
        return message_usage("--camera: %s", helio_last_error());
    return EXIT_CODE_OK;
}

static int choose_mesh(study_plan *plan)
{
    return mesh_path_choose(plan->options->mesh, plan->mesh);
}

/* Frames to take, and of how many a day of sky has. */
static int choose_frames(study_plan *plan)
{
    const study_options *study = &plan->options->study;
    const frame_range *frames = &plan->options->frames;
    int code = input_source_describe(plan->options, &plan->source);
    plan->sequence = study->sequence;
    plan->source.frames = study->day_frames > 0 ? study->day_frames : frames->is_given ? USUAL_DAY : study->sequence;
    if (code != EXIT_CODE_OK || !frames->is_given)
        return code;
    if (study->sequence != 1)
        return message_usage("--sequence and --frames exclude each other; give one of them");
    if (frames->last - frames->first >= MOST_FRAMES)
        return message_usage("--frames %u..%u are too many for a study; give at most %d", frames->first, frames->last,
                             MOST_FRAMES);
    plan->sequence = frames->last - frames->first + 1;
    return code;
}

int study_plan_make(study_plan *plan, const cli_options *options)
{
    static int (*const steps[])(study_plan *) = {parse_words, take_lists, choose_shown, choose_mesh};
    *plan = (study_plan){.options = options};
    int code = EXIT_CODE_OK;
    for (size_t i = 0; code == EXIT_CODE_OK && i < sizeof steps / sizeof steps[0]; i++)
        code = steps[i](plan);
    if (code == EXIT_CODE_OK)
        code = check_words(plan);
    return code == EXIT_CODE_OK ? choose_frames(plan) : code;
}

void study_plan_release(study_plan *plan)
{
    for (uint32_t i = 0; i < plan->environment_count; i++) {
        free(plan->environments[i].specification);
        free(plan->environments[i].name);
    }
    free(plan->environments);
    free(plan->materials);
    *plan = (study_plan){0};
}

/* ---- points -------------------------------------------------------------------------------- */

size_t study_plan_count(const study_plan *plan)
{
    return (size_t)plan->environment_count * plan->material_count * plan->strategy_count * plan->spp_count;
}

study_point study_plan_point(const study_plan *plan, size_t index)
{
    study_point point;
    point.spp = (uint32_t)(index % plan->spp_count);
    index /= plan->spp_count;
    point.strategy = (uint32_t)(index % plan->strategy_count);
    index /= plan->strategy_count;
    point.material = (uint32_t)(index % plan->material_count);
    point.environment = (uint32_t)(index / plan->material_count);
    return point;
}

size_t study_plan_index(const study_plan *plan, const study_point *point)
{
    size_t index = (size_t)point->environment * plan->material_count + point->material;
    return (index * plan->strategy_count + point->strategy) * plan->spp_count + point->spp;
}

bool study_plan_find(const study_plan *plan, const char *name, uint32_t *strategy)
{
    for (uint32_t i = 0; i < plan->strategy_count; i++)
        if (is(plan->strategies[i].name, name)) {
            *strategy = i;
            return true;
        }
    return false;
}

bool study_plan_shows(const study_plan *plan, uint32_t environment, uint32_t material)
{
    return (size_t)environment * plan->material_count + material < plan->options->study.pictures;
}

bool study_plan_has_quadrature(const study_plan *plan)
{
    return is(plan->options->study.reference_method, "quadrature");
}

void study_plan_describe_reference(const study_plan *plan, char text[STUDY_PLAN_REFERENCE])
{
    if (study_plan_has_quadrature(plan))
        snprintf(text, STUDY_PLAN_REFERENCE, "quadrature over all texels");
    else
        snprintf(text, STUDY_PLAN_REFERENCE, "%u samples of product+brdf per shading point",
                 plan->options->study.reference_spp);
}

uint32_t study_plan_still(uint32_t frames)
{
    return frames / 2;
}
