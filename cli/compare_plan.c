/* SPDX-License-Identifier: MIT */
#include "compare_plan.h"

#include "figure_path.h"
#include "message.h"
#include "output_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- options ------------------------------------------------------------------------------- */

static int check_words(const cli_options *options)
{
    const compare_options *compare = &options->compare;
    if (options->input == NULL || options->reference == NULL)
        return message_usage("compare needs a picture and its reference: heliostat compare PICTURE REFERENCE");
    if (options->quiet && options->verbose)
        return message_usage("--quiet and --verbose exclude each other; give one of them");
    if (options->quiet && compare->json == NULL && compare->out == NULL)
        return message_usage("compare --quiet would tell nothing; give --json FILE or --out PICTURE as well, or leave "
                             "--quiet out");
    if (compare->json != NULL && compare->out != NULL && output_file_is_same(compare->json, compare->out))
        return message_usage("--json and --out both name %s; give two files", compare->json);
    return EXIT_CODE_OK;
}

/* The errors themselves in .exr and .pfm; figures in what figures are drawn in. */
static int check_out(compare_plan *plan)
{
    const char *out = plan->options->compare.out;
    if (out == NULL)
        return EXIT_CODE_OK;
    plan->is_drawn = !output_file_has_extension(out, "exr") && !output_file_has_extension(out, "pfm");
    plan->has_numbers = numbered_path_is_pattern(out);
    if (plan->has_numbers && !numbered_path_parse(out, &plan->out))
        return message_usage("--out %s takes one number, such as %%04d or %%d, and no other %%", out);
    if (plan->is_drawn)
        return figure_path_check("out", out, "compare");
    return helio_picture_check_path(out) == HELIO_OK ? EXIT_CODE_OK : message_usage("--out: %s", helio_last_error());
}

static int check_map(compare_plan *plan)
{
    const compare_options *compare = &plan->options->compare;
    /* The words of the table are the library's own, so that these fail only if a build of the library knows fewer. */
    if (helio_error_map_parse(compare->map, &plan->map) != HELIO_OK ||
        helio_tonemap_parse(plan->options->tonemap, &plan->tonemap) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    bool needs_lab = plan->map == HELIO_ERROR_MAP_LAB || plan->map == HELIO_ERROR_MAP_DE2000;
    if (compare->out != NULL && needs_lab && !helio_comparison_has_lab())
        return message_usage("--metric-map %s needs lcms2, which this build lacks; give --metric-map relative or flip",
                             compare->map);
    return EXIT_CODE_OK;
}

/* ---- files --------------------------------------------------------------------------------- */

static int find_lists(compare_plan *plan)
{
    const cli_options *options = plan->options;
    int code = picture_list_find(&plan->pictures, options->input, &options->frames);
    if (code == EXIT_CODE_OK)
        code = picture_list_find(&plan->references, options->reference, &options->frames);
    if (code == EXIT_CODE_OK && options->compare.mask != NULL)
        code = picture_list_find(&plan->masks, options->compare.mask, &options->frames);
    return code;
}

static int match_lists(compare_plan *plan)
{
    const picture_list *pictures = &plan->pictures;
    plan->frames = calloc(pictures->count, sizeof *plan->frames);
    if (plan->frames == NULL)
        return message_failure("no memory for %zu frames", pictures->count);
    int code = EXIT_CODE_OK;
    for (size_t i = 0; i < pictures->count && code == EXIT_CODE_OK; i++) {
        compared_frame *frame = &plan->frames[i];
        frame->number = pictures->pictures[i].number;
        frame->picture = pictures->pictures[i].path;
        code = picture_list_partner(pictures, &plan->references, i, &frame->reference);
        if (code == EXIT_CODE_OK && plan->masks.count > 0)
            code = picture_list_partner(pictures, &plan->masks, i, &frame->mask);
    }
    return code;
}

static int check_numbers(const compare_plan *plan)
{
    const char *out = plan->options->compare.out, *dot;
    if (out == NULL || plan->has_numbers || plan->pictures.kind == LIST_FILE)
        return EXIT_CODE_OK;
    dot = strrchr(out, '.');
    return message_usage("--out %s is one picture, but %s is a sequence; give --out a name with %%04d, as in "
                         "%.*s_%%04d%s",
                         out, plan->pictures.word, (int)(dot - out), out, dot);
}

/* Would a numbered file that is written replace one that is read? */
static int check_replacing(const compare_plan *plan, const char *input)
{
    const char *out = plan->options->compare.out;
    if (!output_file_is_same_folder(out, input) ||
        !numbered_path_makes(&plan->out, input + output_file_folder_length(input)))
        return EXIT_CODE_OK;
    return message_failure("--out %s makes names such as that of %s, which is read; give --out another name", out,
                           input);
}

static int check_outputs(const compare_plan *plan, const char *const *inputs)
{
    const compare_options *compare = &plan->options->compare;
    int code = EXIT_CODE_OK;
    if (compare->json != NULL && strcmp(compare->json, "-") != 0)
        code = output_file_check("json", compare->json, NULL, inputs);
    if (code == EXIT_CODE_OK && compare->out != NULL && !plan->has_numbers)
        code = output_file_check("out", compare->out, NULL, inputs);
    for (; code == EXIT_CODE_OK && plan->has_numbers && *inputs != NULL; inputs++)
        code = check_replacing(plan, *inputs);
    return code;
}

static int check_files(const compare_plan *plan)
{
    const picture_list *const lists[] = {&plan->pictures, &plan->references, &plan->masks};
    size_t count = plan->pictures.count + plan->references.count + plan->masks.count, filled = 0;
    const char **inputs = malloc((count + 1) * sizeof *inputs);
    if (inputs == NULL)
        return message_failure("no memory for the names of %zu files", count);
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < lists[k]->count; i++)
            inputs[filled++] = lists[k]->pictures[i].path;
    inputs[filled] = NULL;
    int code = check_outputs(plan, inputs);
    free(inputs);
    return code;
}

/* ---- the plan ------------------------------------------------------------------------------ */

int compare_plan_make(compare_plan *plan, const cli_options *options)
{
    *plan = (compare_plan){.options = options};
    int code = check_words(options);
    if (code == EXIT_CODE_OK)
        code = check_map(plan);
    if (code == EXIT_CODE_OK)
        code = check_out(plan);
    if (code == EXIT_CODE_OK)
        code = find_lists(plan);
    if (code == EXIT_CODE_OK)
        code = check_numbers(plan);
    if (code == EXIT_CODE_OK)
        code = match_lists(plan);
    return code == EXIT_CODE_OK ? check_files(plan) : code;
}

void compare_plan_release(compare_plan *plan)
{
    picture_list_release(&plan->pictures);
    picture_list_release(&plan->references);
    picture_list_release(&plan->masks);
    free(plan->frames);
}

int compare_plan_name(const compare_plan *plan, uint64_t number, char path[COMPARE_PATH_SIZE])
{
    const char *out = plan->options->compare.out;
    bool fits = plan->has_numbers ? numbered_path_format(&plan->out, number, path, COMPARE_PATH_SIZE)
                                  : snprintf(path, COMPARE_PATH_SIZE, "%s", out) < COMPARE_PATH_SIZE;
    return fits ? EXIT_CODE_OK : message_failure("the name of a file by --out %s is too long", out);
}
