/* SPDX-License-Identifier: MIT */
#include "convert_plan.h"

#include "input_source.h"
#include "message.h"
#include "output_file.h"

#include <fnmatch.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* A folder, or a name with %s, can only mean six faces. */
static bool names_faces(const char *path)
{
    struct stat status;
    size_t length = strlen(path);
    return strstr(path, "%s") != NULL || path[length - 1] == '/' ||
           (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

static int parse_words(convert_plan *plan)
{
    const cli_options *options = plan->options;
    const convert_options *convert = &options->convert;
    if ((convert->to != NULL && helio_layout_parse(convert->to, &plan->to) != HELIO_OK) ||
        helio_tonemap_parse(options->tonemap, &plan->write.tonemap) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    if (convert->to == NULL && names_faces(convert->out))
        plan->to = HELIO_LAYOUT_FACES;
    plan->write.half = convert->half;
    return EXIT_CODE_OK;
}

static int check_output(convert_plan *plan)
{
    const char *out = plan->options->convert.out;
    bool is_faces = plan->to == HELIO_LAYOUT_FACES;
    char name[CONVERT_PATH_SIZE];
    plan->is_numbered = numbered_path_is_pattern(out);
    if (plan->is_numbered && is_faces && !numbered_path_parse_faces(out, &plan->names))
        return message_usage("--out %s cannot name six files of each frame; give it one number and one %%s, as in "
                             "%.*smap_%%04d_%%s.hdr",
                             out, (int)output_file_folder_length(out), out);
    if (plan->is_numbered && !is_faces && !numbered_path_parse(out, &plan->names))
        return message_usage("--out %s takes one number, such as %%04d or %%d, and no other %%", out);
    if (!is_faces && names_faces(out))
        return message_usage("--out %s names six files or a folder, which only --to faces writes; give one file", out);
    if (plan->is_numbered && (!numbered_path_format(&plan->names, UINT32_MAX, name, sizeof name) ||
                              !numbered_path_format(&plan->names, 0, name, sizeof name)))
        return message_usage("--out %s makes names that are too long", out);
    if (helio_map_check_path(plan->is_numbered ? name : out, is_faces ? HELIO_LAYOUT_FACES : HELIO_LAYOUT_LATLONG) !=
        HELIO_OK)
        return message_usage("--out: %s", helio_last_error());
    plan->is_png = output_file_has_extension(out, "png");
    return EXIT_CODE_OK;
}

static int check_size(const convert_plan *plan)
{
    const convert_options *convert = &plan->options->convert;
    uint32_t width = convert->size[0], height = convert->size[1];
    helio_layout layout;
    if (width == 0)
        return EXIT_CODE_OK;
    if (convert->env_size != 0)
        return message_usage("--env-size and --size both tell the size of the map; give one of them");
    if ((uint64_t)width * height > UINT32_C(1) << 28)
        return message_usage("--size %ux%u is more than the 2^28 pixels that a map may have", width, height);
    if (plan->to == HELIO_LAYOUT_FACES && width != height)
        return message_usage("--size %ux%u is no face: faces are square, such as 512x512", width, height);
    if (plan->to != HELIO_LAYOUT_FACES && plan->to != HELIO_LAYOUT_AUTO &&
        helio_layout_guess(width, height, plan->to, &layout) != HELIO_OK)
        return message_usage("--size: %s", helio_last_error());
    return EXIT_CODE_OK;
}

/* Options that are fine but change nothing here: people should not look for their effect. */
static void warn_of_idle_options(const convert_plan *plan)
{
    const cli_options *options = plan->options;
    const char *out = options->convert.out;
    bool is_exr = output_file_has_extension(out, "exr") || names_faces(out);
    if (options->convert.half && !is_exr)
        message_warning("--half changes nothing in %s, which is no EXR", out);
    if ((options->convert.exposure != 0 || plan->write.tonemap != HELIO_TONEMAP_CLIP) && !plan->is_png)
        message_warning("--exposure and --tonemap change nothing in %s: only a PNG needs them", out);
}

int convert_plan_make(convert_plan *plan, const cli_options *options)
{
    *plan = (convert_plan){.options = options};
    int code = input_source_check(options, "convert");
    if (code == EXIT_CODE_OK && options->convert.out == NULL)
        code =
            message_usage("convert needs a place for the result: --out PATH, which ends in .exr, .hdr, .pfm or .png");
    if (code == EXIT_CODE_OK)
        code = parse_words(plan);
    if (code == EXIT_CODE_OK)
        code = check_output(plan);
    if (code == EXIT_CODE_OK)
        code = check_size(plan);
    if (code == EXIT_CODE_OK)
        warn_of_idle_options(plan);
    return code;
}

/* Is it the same text, or the same folder? */
static bool is_same_place(const char *a, const char *b)
{
    struct stat first, second;
    return strcmp(a, b) == 0 || (stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
                                 first.st_ino == second.st_ino);
}

/* ---- once the source is known ------------------------------------------------------------ */

/* --out is one map, or six files, but there are many frames. */
static int ask_for_number(const convert_plan *plan, const helio_source_info *source)
{
    const char *out = plan->options->convert.out, *dot = strrchr(out, '.'), *faces = strstr(out, "%s");
    char advice[CONVERT_PATH_SIZE];
    size_t length = strlen(out);
    while (length > 1 && out[length - 1] == '/')
        length--;
    if (plan->to == HELIO_LAYOUT_FACES && faces == NULL) /* a folder, which may not be there */
        snprintf(advice, sizeof advice, "%.*s_%%04d_%%s.hdr", (int)length, out);
    else if (faces != NULL)
        snprintf(advice, sizeof advice, "%.*s%%04d_%s", (int)(faces - out), out, faces);
    else
        snprintf(advice, sizeof advice, "%.*s_%%04d%s", dot ? (int)(dot - out) : 0, out, dot ? dot : "");
    return message_usage("--out %s is one map, but %s has many frames; give --out a name with %%04d, as in %s, or take "
                         "one frame by --frames N..N",
                         out, source->label, advice);
}

int convert_plan_settle(convert_plan *plan, const helio_source_info *source)
{
    const frame_range *frames = &plan->options->frames;
    const char *out = plan->options->convert.out;
    bool is_one = frames->is_given && frames->first == frames->last;
    char name[CONVERT_PATH_SIZE];
    if (!plan->is_numbered && source->is_dynamic && !is_one)
        return ask_for_number(plan, source);
    if (plan->to == HELIO_LAYOUT_FACES && is_same_place(out, source->label))
        return message_usage("--out %s would replace the input; give it another folder or name", out);
    /* Files that the source has still to read must not be replaced. */
    if (plan->is_numbered && numbered_path_format(&plan->names, frames->first, name, sizeof name) &&
        (strcmp(out, source->label) == 0 || fnmatch(source->label, name, FNM_PATHNAME) == 0))
        return message_usage("--out %s makes names that %s means too, so inputs might be replaced; give --out another "
                             "folder or name",
                             out, source->label);
    return plan->is_numbered ? output_file_make_folder("out", out, &plan->has_made_folder) : EXIT_CODE_OK;
}

void convert_plan_release(const convert_plan *plan)
{
    if (plan->has_made_folder)
        output_file_remove_folder(plan->options->convert.out);
}

int convert_plan_shape(const convert_plan *plan, const map_shape *from, map_shape *to)
{
    const convert_options *convert = &plan->options->convert;
    *to = *from;
    if (plan->to != HELIO_LAYOUT_AUTO)
        to->layout = plan->to;
    else if (from->layout == HELIO_LAYOUT_FACES) /* --out names one file, or it would be plan->to */
        to->layout = HELIO_LAYOUT_STRIP;
    if (convert->size[0] != 0) {
        helio_layout layout;
        to->width = convert->size[0];
        to->height = to->layout == HELIO_LAYOUT_FACES ? 6 * convert->size[1] : convert->size[1];
        if (helio_layout_guess(to->width, to->height, to->layout, &layout) != HELIO_OK)
            return message_usage("--size: %s", helio_last_error());
        return EXIT_CODE_OK;
    }
    if (convert->env_size == 0 && map_shape_is_same(from, to) && to->layout != HELIO_LAYOUT_FACES)
        return EXIT_CODE_OK;
    uint32_t size = convert->env_size != 0 ? convert->env_size : map_shape_fineness(from);
    if (helio_layout_shape(to->layout, size, &to->width, &to->height) != HELIO_OK)
        return message_usage("%s", helio_last_error());
    return EXIT_CODE_OK;
}

/* The six files that the library makes of a folder, or of a name with %s. */
static int check_faces(const char *out, helio_source *source)
{
    static const char *const faces[] = {"px", "nx", "py", "ny", "pz", "nz"};
    const char *percent = strstr(out, "%s");
    for (size_t i = 0; i < 6; i++) {
        char path[CONVERT_PATH_SIZE];
        int length = percent != NULL
                         ? snprintf(path, sizeof path, "%.*s%s%s", (int)(percent - out), out, faces[i], percent + 2)
                         : snprintf(path, sizeof path, "%s/%s.exr", out, faces[i]);
        if (length < CONVERT_PATH_SIZE && helio_source_check_output(source, path) != HELIO_OK)
            return message_failure("%s; give --out another folder or name", helio_last_error());
    }
    return EXIT_CODE_OK;
}

int convert_plan_path(const convert_plan *plan, helio_source *source, const helio_source_frame *frame,
                      char path[CONVERT_PATH_SIZE])
{
    const char *out = plan->options->convert.out;
    const char *const inputs[] = {frame->name, NULL};
    if (plan->is_numbered ? !numbered_path_format(&plan->names, frame->index, path, CONVERT_PATH_SIZE)
                          : snprintf(path, CONVERT_PATH_SIZE, "%s", out) >= CONVERT_PATH_SIZE)
        return message_usage("--out takes a path of less than %d bytes", CONVERT_PATH_SIZE);
    return plan->to == HELIO_LAYOUT_FACES ? check_faces(path, source) : output_file_check("out", path, source, inputs);
}
