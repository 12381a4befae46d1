/* SPDX-License-Identifier: MIT */
#include "env/source_specification.h"

#include "core/error.h"
#include "core/file.h"
#include "core/specification.h"
#include "env/source_names.h"

#include <string.h>

#define BRIGHTEST 1e12f /* well below what an environment counts as infinite */

static bool has_video_extension(const char *path)
{
    static const char *const extensions[] = {"mp4", "mkv",  "webm", "mov", "avi", "m4v", "mxf", "ts",
                                             "mts", "m2ts", "mpg",  "wmv", "y4m", "ogv", "flv"};
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++)
        if (file_has_extension(path, extensions[i]))
            return true;
    return false;
}

bool source_specification_is_picture(const source_specification *s)
{
    static const char *const extensions[] = {"exr", "hdr", "pic", "rgbe", "pfm", "png", "jpg", "jpeg"};
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++)
        if (file_has_extension(s->path, extensions[i]))
            return true;
    return false;
}

void source_specification_take_as_file(source_specification *s)
{
    s->is_wrong_pattern = false;
    s->is_surely_video = has_video_extension(s->path);
    s->kind = s->is_surely_video ? HELIO_SOURCE_VIDEO : HELIO_SOURCE_FILE;
}

static helio_status parse_constant(source_specification *s)
{
    specification_field field = {
        .count = 3, .greatest = BRIGHTEST, .one_for_all = true, .key = "", .values = s->constant};
    s->kind = HELIO_SOURCE_CONSTANT;
    return specification_parse("environment", s->text, &field, 1);
}

static helio_status parse_sky(source_specification *s)
{
    HELIO_TRY(sky_specification_parse(s->text, &s->sky));
    s->kind = s->sky.is_day ? HELIO_SOURCE_SKY_DAY : HELIO_SOURCE_SKY;
    return HELIO_OK;
}

static helio_status parse_device(source_specification *s, const char *device, const char *example)
{
    s->kind = HELIO_SOURCE_DEVICE;
    s->device = device;
    s->path = s->text + strlen(device) + 1;
    if (s->path[0] == 0)
        return fail(HELIO_ERR_ARGUMENT, "environment \"%s\" lacks what follows the colon; write for example %s",
                    s->text, example);
    return HELIO_OK;
}

static helio_status parse_path(source_specification *s)
{
    if (strlen(s->text) >= SOURCE_PATH_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "environment \"%.60s...\" has %zu characters; a path has less than %d", s->text,
                    strlen(s->text), SOURCE_PATH_SIZE);
    source_specification_take_as_file(s);
    if (source_names_is_pattern(s->text)) {
        s->kind = HELIO_SOURCE_SEQUENCE;
        s->is_shell_pattern = true;
        return HELIO_OK;
    }
    switch (source_pattern_parse(s->text, &s->pattern)) {
    case PATTERN_NUMBER: s->kind = HELIO_SOURCE_SEQUENCE; break;
    case PATTERN_FACES: s->kind = HELIO_SOURCE_FILE; break;
    case PATTERN_WRONG: s->is_wrong_pattern = true; break;
    case PATTERN_NONE: break;
    }
    return HELIO_OK;
}

helio_status source_specification_parse(const char *text, source_specification *s)
{
    if (text == NULL || text[0] == 0)
        return fail(HELIO_ERR_ARGUMENT,
                    "a source needs a name; give a file, a pattern of files, sky:, lavfi:, v4l2: or "
                    "constant:R,G,B");
    *s = (source_specification){.text = text, .path = text};
    bool has_colon = strchr(text, ':') != NULL;
    if (has_colon && specification_has_name(text, "constant"))
        return parse_constant(s);
    if (has_colon && specification_has_name(text, "sky"))
        return parse_sky(s);
    if (specification_has_name(text, "lavfi") && has_colon)
        return parse_device(s, "lavfi", "lavfi:testsrc2=size=512x256");
    if (specification_has_name(text, "v4l2") && has_colon)
        return parse_device(s, "v4l2", "v4l2:/dev/video0");
    return parse_path(s);
}
