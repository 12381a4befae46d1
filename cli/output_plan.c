/* SPDX-License-Identifier: MIT */
#include "output_plan.h"

#include "json_file.h"
#include "message.h"
#include "output_file.h"

#include <fnmatch.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char PICTURE_OUT[] = "heliostat.png", NUMBERED_OUT[] = "heliostat_%04d.png";

static bool is(const char *value, const char *word)
{
    return strcmp(value, word) == 0;
}

static int check_pattern(const render_plan *plan)
{
    numbered_path names;
    if (plan->sink == SINK_NUMBERED && !numbered_path_parse(plan->out, &names))
        return message_usage("--out %s takes one number, such as %%04d or %%d, and no other %%", plan->out);
    return EXIT_CODE_OK;
}

static helio_video_write_desc video_desc(const cli_options *options)
{
    return (helio_video_write_desc){
        .width = options->size[0],
        .height = options->size[1],
        .fps = options->fps,
        .codec = options->codec,
        .quality = (float)options->quality,
        .hdr = options->hdr,
    };
}

static int check_video(render_plan *plan)
{
    plan->video = video_desc(plan->options);
    if (plan->sink == SINK_VIDEO && helio_video_check_path(plan->out, &plan->video) != HELIO_OK)
        return message_usage("--out: %s", helio_last_error());
    return EXIT_CODE_OK;
}

/* A folder stands for numbered pictures in it. */
static int set_out(render_plan *plan, const char *out)
{
    plan->sink = frame_sink_kind_of(out);
    bool is_folder = frame_sink_is_folder(out);
    size_t length = strlen(out);
    int needed = snprintf(plan->out, sizeof plan->out, "%s%s%s", out, is_folder && out[length - 1] != '/' ? "/" : "",
                          is_folder ? NUMBERED_OUT : "");
    if (needed < 0 || (size_t)needed >= sizeof plan->out)
        return message_usage("--out takes a path of less than %zu bytes, not one of %d", sizeof plan->out, needed);
    return EXIT_CODE_OK;
}

/* What this build can write, such as ".exr, .pfm and .png". */
static const char *list_endings(bool is_video, char text[64])
{
    static const char *const kinds[2][4] = {{"x.exr", "x.pfm", "x.png", NULL}, {"x.mp4", "x.mov", "x.mkv", "x.webm"}};
    const helio_video_write_desc desc = {.width = 64, .height = 64};
    const char *endings[4];
    size_t count = 0, length = 0;
    for (size_t i = 0; i < 4 && kinds[is_video][i] != NULL; i++)
        if ((is_video ? helio_video_check_path(kinds[1][i], &desc) : helio_picture_check_path(kinds[0][i])) == HELIO_OK)
            endings[count++] = kinds[is_video][i] + 1;
    text[0] = 0;
    for (size_t i = 0; i < count; i++)
        length += (size_t)snprintf(text + length, 64 - length, "%s%s",
                                   i == 0          ? ""
                                   : i + 1 < count ? ", "
                                                   : " or ",
                                   endings[i]);
    return text;
}

/* The library knows why a picture cannot be written, but not that a video would do. */
static int fail_with_ending(const render_plan *plan, const char *out, helio_status status)
{
    char pictures[64], videos[64];
    if (status != HELIO_ERR_ARGUMENT)
        return message_usage("--out: %s", helio_last_error());
    list_endings(false, pictures);
    list_endings(true, videos);
    if (plan->sink == SINK_NUMBERED && helio_video_has_extension(out))
        return message_usage("--out %s: a video holds all frames and takes no number; give it a name without %%, or "
                             "numbered pictures one that ends in %s",
                             out, pictures);
    bool has_videos = plan->sink != SINK_NUMBERED && videos[0] != 0;
    return message_usage("--out %s: its ending tells no kind that this build writes; a picture ends in %s%s%s", out,
                         pictures, has_videos ? ", a video in " : "", has_videos ? videos : "");
}

static int check_files(const render_plan *plan)
{
    const cli_options *options = plan->options;
    const char *out = options->out != NULL ? plan->out : PICTURE_OUT;
    helio_status status = plan->sink != SINK_VIDEO ? helio_picture_check_path(out) : HELIO_OK;
    if (status != HELIO_OK)
        return fail_with_ending(plan, out, status);
    if (options->aovs && !output_file_has_extension(out, "exr"))
        return message_usage("--aovs writes layers, which only EXR holds; give --out a name that ends in .exr, not %s",
                             out);
    if (options->stats != NULL && is(options->stats, out))
        return message_usage("--stats and --out both name %s; give two files", out);
    return EXIT_CODE_OK;
}

static int check_contact_sheet(const cli_options *options)
{
    const char *sheet = options->contact_sheet;
    if (sheet == NULL)
        return EXIT_CODE_OK;
    if (!output_file_has_extension(sheet, "png") || helio_picture_check_path(sheet) != HELIO_OK)
        return message_usage("--contact-sheet writes a PNG; give it a name that ends in .png, not %s", sheet);
    if ((options->out != NULL && is(options->out, sheet)) || (options->stats != NULL && is(options->stats, sheet)))
        return message_usage("--contact-sheet and another option both name %s; give two files", sheet);
    return EXIT_CODE_OK;
}

int output_plan_check(render_plan *plan)
{
    const cli_options *options = plan->options;
    int code = options->out != NULL ? set_out(plan, options->out) : EXIT_CODE_OK;
    if (code == EXIT_CODE_OK)
        code = check_pattern(plan);
    if (code == EXIT_CODE_OK)
        code = check_video(plan);
    if (code == EXIT_CODE_OK)
        code = check_files(plan);
    return code == EXIT_CODE_OK ? check_contact_sheet(options) : code;
}

void output_plan_warn(const render_plan *plan)
{
    const cli_options *options = plan->options;
    bool is_video = plan->sink == SINK_VIDEO, is_shown = is_video || output_file_has_extension(plan->out, "png");
    bool has_exposure = !isnan(options->exposure) || plan->tonemap != HELIO_TONEMAP_CLIP;
    if (has_exposure && !is_shown && options->contact_sheet == NULL)
        message_warning("--exposure and --tonemap change nothing in %s: EXR and PFM hold radiance as it is", plan->out);
    if (plan->alpha && (is_video || output_file_has_extension(plan->out, "pfm")))
        message_warning("%s cannot hold the alpha channel of this picture; EXR and PNG can", plan->out);
    if ((options->codec != NULL || options->quality > 0 || options->hdr) && !is_video)
        message_warning("--codec, --quality and --hdr change nothing in %s, which is no video", plan->out);
    if (options->reference != NULL && options->stats == NULL && !options->verbose)
        message_warning("--reference changes nothing: errors are told by --stats and --verbose, and neither is given");
    if (options->resume && is_video)
        message_warning("%s is made anew: a video cannot be resumed, numbered pictures can", plan->out);
    if (options->resume && plan->sink == SINK_PICTURE)
        message_warning("--resume changes nothing for one picture");
}

/* ---- once the source is known ------------------------------------------------------------ */

bool output_plan_is_one_frame(const render_plan *plan)
{
    const frame_range *frames = &plan->options->frames;
    return frames->is_given && frames->first == frames->last;
}

static int choose_out(render_plan *plan, bool is_dynamic)
{
    if (plan->options->out == NULL)
        return set_out(plan, is_dynamic ? NUMBERED_OUT : PICTURE_OUT);
    if (plan->sink != SINK_PICTURE || !is_dynamic || output_plan_is_one_frame(plan))
        return EXIT_CODE_OK;
    const char *dot = strrchr(plan->out, '.');
    size_t folder = output_file_folder_length(plan->out);
    bool has_percent = strchr(plan->out + folder, '%') != NULL; /* which would not go with another one */
    return message_usage("--out %s is one picture, but %s has many frames; give --out a name with %%04d, as in "
                         "%.*s%s_%%04d%s, a folder or a video, or take one frame by --frames N..N",
                         plan->out, plan->light.specification, has_percent ? (int)folder : (int)(dot - plan->out),
                         plan->out, has_percent ? "frame" : "", dot);
}

/* Pictures that a glob finds may be inputs that are still to be read. */
static int check_glob(const render_plan *plan)
{
    const char *glob = plan->light.specification;
    char name[SINK_PATH_SIZE];
    numbered_path names;
    if (plan->light.kind != HELIO_SOURCE_SEQUENCE || plan->sink != SINK_NUMBERED ||
        !numbered_path_parse(plan->out, &names) || !numbered_path_format(&names, 0, name, sizeof name))
        return EXIT_CODE_OK;
    bool is_found =
        fnmatch(glob, name, FNM_PATHNAME) == 0 ||
        (output_file_is_same_folder(glob, name) &&
         fnmatch(glob + output_file_folder_length(glob), name + output_file_folder_length(name), FNM_PATHNAME) == 0);
    if (!is_found)
        return EXIT_CODE_OK;
    return message_usage("--out %s makes names that --env %s matches, so inputs might be replaced; give --out another "
                         "folder or name",
                         plan->out, glob);
}

/* "" without one. With a number in it, it is no file, and frames look for themselves. */
static const char *reference_of(const render_plan *plan)
{
    return plan->options->reference != NULL ? plan->options->reference : "";
}

static int check_sink(const render_plan *plan, helio_source *source, const char *const *inputs)
{
    char name[SINK_PATH_SIZE];
    numbered_path names;
    if (plan->sink != SINK_NUMBERED)
        return output_file_check("out", plan->out, source, inputs);
    if (!numbered_path_parse(plan->out, &names) || !numbered_path_format(&names, UINT32_MAX, name, sizeof name))
        return message_usage("--out %s makes names that are too long", plan->out);
    /* That of a first frame, as far as can be told: people should know the name that they read of. */
    numbered_path_format(&names, plan->options->frames.first, name, sizeof name);
    return output_file_check("out", name, source, inputs);
}

static int make_folder(render_plan *plan)
{
    return plan->sink == SINK_NUMBERED ? output_file_make_folder("out", plan->out, &plan->has_made_folder)
                                       : EXIT_CODE_OK;
}

int output_plan_check_beside(const render_plan *plan, const char *option, const char *path, helio_source *source)
{
    const char *const inputs[] = {plan->mesh, reference_of(plan), NULL};
    numbered_path names;
    if (path == NULL || json_file_is_printed(path))
        return EXIT_CODE_OK;
    bool is_frame = output_file_is_same(plan->out, path);
    if (plan->sink == SINK_NUMBERED && numbered_path_parse(plan->out, &names))
        is_frame = output_file_is_same_folder(plan->out, path) &&
                   numbered_path_makes(&names, path + output_file_folder_length(path));
    if (is_frame)
        return message_usage("--%s %s is the name of a picture or video that --out %s makes; give --%s another path",
                             option, path, plan->out, option);
    return output_file_check(option, path, source, inputs);
}

static int check_reports(const render_plan *plan, helio_source *source)
{
    const char *stats = plan->options->stats, *sheet = plan->options->contact_sheet;
    int code = output_plan_check_beside(plan, "stats", stats, source);
    if (code == EXIT_CODE_OK)
        code = output_plan_check_beside(plan, "contact-sheet", sheet, source);
    if (code == EXIT_CODE_OK && stats != NULL && sheet != NULL && output_file_is_same(stats, sheet))
        code = message_usage("--stats and --contact-sheet both name %s; give two files", sheet);
    return code;
}

int output_plan_check_names(const render_plan *plan, helio_source *source)
{
    const char *const inputs[] = {plan->mesh, NULL};
    int code = check_glob(plan);
    return code == EXIT_CODE_OK ? check_sink(plan, source, inputs) : code;
}

int output_plan_settle(render_plan *plan, helio_source *source)
{
    const char *const inputs[] = {plan->mesh, reference_of(plan), NULL};
    int code = choose_out(plan, helio_source_get_info(source).is_dynamic);
    if (code == EXIT_CODE_OK)
        code = check_glob(plan);
    if (code == EXIT_CODE_OK)
        code = make_folder(plan);
    if (code == EXIT_CODE_OK)
        code = check_reports(plan, source);
    return code == EXIT_CODE_OK ? check_sink(plan, source, inputs) : code;
}
