/* SPDX-License-Identifier: MIT */
#include "environment_source.h"

#include "asset.h"
#include "message.h"
#include "number.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char SHIPPED_MAP[] = "sunrise.hdr";
static const double BRIGHTEST = 1e12;

static bool starts_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

static bool parse_constant(const char *numbers, float rgb[3])
{
    for (int channel = 0; channel < 3; channel++) {
        size_t length = strcspn(numbers, ",");
        char text[64];
        double number;
        if (length >= sizeof text || (numbers[length] == ',') != (channel < 2))
            return false;
        snprintf(text, sizeof text, "%.*s", (int)length, numbers);
        if (!number_parse(text, 0, BRIGHTEST, &number))
            return false;
        rgb[channel] = (float)number;
        numbers += length + 1;
    }
    return true;
}

/* A printf pattern such as frame_%04d.exr, or a pattern of the shell. */
static bool is_sequence(const char *path)
{
    if (strpbrk(path, "*?") != NULL)
        return true;
    const char *percent = strchr(path, '%');
    return percent != NULL && percent[1 + strspn(percent + 1, "0123456789")] == 'd';
}

static bool is_video(const char *path)
{
    static const char *const extensions[] = {".mp4", ".mkv", ".webm", ".mov", ".avi", ".m4v", ".mxf"};
    const char *extension = strrchr(path, '.');
    for (size_t i = 0; extension != NULL && i < sizeof extensions / sizeof extensions[0]; i++)
        if (strcasecmp(extension, extensions[i]) == 0)
            return true;
    return false;
}

/* Names the kind of a source that later versions read; NULL for a file. */
static const char *later_kind(const char *specification)
{
    if (starts_with(specification, "sky:"))
        return "a procedural sky";
    if (starts_with(specification, "lavfi:"))
        return "an FFmpeg filter";
    if (starts_with(specification, "v4l2:"))
        return "a camera";
    if (is_video(specification))
        return "a video";
    /* A file may well have such a name. */
    if (is_sequence(specification) && access(specification, F_OK) != 0)
        return "an image sequence";
    return NULL;
}

int environment_source_parse(const char *specification, environment_source *source)
{
    *source = (environment_source){.label = specification};
    if (specification == NULL) {
        source->label = source->path;
        if (!asset_find(SHIPPED_MAP, source->path, sizeof source->path))
            return message_failure("the map %s that comes with heliostat was not found; give one by --env SRC",
                                   SHIPPED_MAP);
        return EXIT_CODE_OK;
    }
    if (starts_with(specification, "constant:")) {
        if (!parse_constant(specification + strlen("constant:"), source->constant))
            return message_usage("--env constant:R,G,B takes three numbers from 0 to %g, not '%s'", BRIGHTEST,
                                 specification);
        return EXIT_CODE_OK;
    }
    const char *kind = later_kind(specification);
    if (kind != NULL)
        return message_usage("--env %s is %s, which is not in this version; give an image file or constant:R,G,B",
                             specification, kind);
    if (strlen(specification) >= sizeof source->path)
        return message_usage("--env takes a path of less than %zu bytes, not one of %zu", sizeof source->path,
                             strlen(specification));
    strcpy(source->path, specification);
    return EXIT_CODE_OK;
}

helio_status environment_source_read(const environment_source *source, helio_context *context, uint64_t max_pixels,
                                     environment_pixels *pixels)
{
    *pixels = (environment_pixels){.width = 1, .height = 1, .rgb = source->constant};
    if (source->path[0] == 0)
        return HELIO_OK;
    const helio_image_read_desc desc = {.max_pixels = max_pixels, .without_alpha = true};
    helio_status status = helio_image_read(context, source->path, &desc, &pixels->image);
    if (status != HELIO_OK)
        return status;
    const helio_image *image = pixels->image;
    pixels->width = image->width;
    pixels->height = image->height;
    pixels->rgb = image->rgb;
    pixels->layout = image->layout;
    pixels->bad = image->bad;
    return HELIO_OK;
}

void environment_pixels_release(environment_pixels *pixels, helio_context *context)
{
    if (pixels->image != NULL)
        helio_image_destroy(context, pixels->image);
    *pixels = (environment_pixels){0};
}
