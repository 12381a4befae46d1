/* SPDX-License-Identifier: MIT */
#include "frame_error.h"

#include "machine.h"
#include "message.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

static int failure(void)
{
    return message_failure("--reference: %s", helio_last_error());
}

/* ---- opening ------------------------------------------------------------------------------- */

static int make_comparison(frame_error *error)
{
    const helio_comparison_desc desc = {.width = error->size[0],
                                        .height = error->size[1],
                                        .without_lab = !helio_comparison_has_lab(),
                                        .without_flip = true};
    return helio_comparison_create(error->context, &desc, &error->comparison) == HELIO_OK ? EXIT_CODE_OK : failure();
}

static int read_reference(frame_error *error, const char *name)
{
    helio_image_destroy(error->context, error->reference);
    error->reference = NULL;
    if (picture_file_read(error->context, name, 0, &error->reference) != HELIO_OK)
        return failure();
    const helio_image *found = error->reference;
    if (found->is_encoded && !error->is_told)
        message_warning("--reference %s holds what a screen shows, and not radiance: errors mean little", name);
    error->is_told = found->is_encoded;
    if (found->width == error->size[0] && found->height == error->size[1])
        return EXIT_CODE_OK;
    return message_failure("--reference %s has %" PRIu32 "x%" PRIu32 " pixels, and what is rendered %" PRIu32
                           "x%" PRIu32 "; give --size %" PRIu32 "x%" PRIu32,
                           name, found->width, found->height, error->size[0], error->size[1], found->width,
                           found->height);
}

int frame_error_open(frame_error *error, helio_context *context, const char *path, const uint32_t size[2])
{
    *error = (frame_error){.context = context, .path = path, .size = {size[0], size[1]}};
    if (path == NULL)
        return EXIT_CODE_OK;
    error->has_numbers = access(path, F_OK) != 0 && numbered_path_parse(path, &error->names);
    int code = make_comparison(error);
    if (code == EXIT_CODE_OK && !error->has_numbers)
        code = read_reference(error, path);
    if (code == EXIT_CODE_OK && !helio_comparison_has_lab())
        message_warning("this build has no lcms2, so that --reference measures relmse alone");
    return code;
}

void frame_error_close(frame_error *error)
{
    helio_image_destroy(error->context, error->reference);
    helio_comparison_destroy(error->comparison);
    *error = (frame_error){0};
}

/* ---- frames -------------------------------------------------------------------------------- */

bool frame_error_name(const frame_error *error, uint64_t index, char name[FRAME_ERROR_PATH])
{
    if (error->has_numbers)
        return numbered_path_format(&error->names, index, name, FRAME_ERROR_PATH);
    return snprintf(name, FRAME_ERROR_PATH, "%s", error->path != NULL ? error->path : "") < FRAME_ERROR_PATH;
}

int frame_error_prepare(frame_error *error, uint64_t index, stats_frame *stats)
{
    char name[FRAME_ERROR_PATH];
    double start = machine_milliseconds();
    if (!error->has_numbers)
        return EXIT_CODE_OK;
    if (!frame_error_name(error, index, name))
        return message_failure("the name of frame %" PRIu64 " by --reference %s is too long", index, error->path);
    int code = read_reference(error, name);
    stats->error_ms += machine_milliseconds() - start;
    return code;
}

int frame_error_measure(frame_error *error, const helio_picture *picture, float exposure, helio_tonemap tonemap,
                        stats_frame *stats)
{
    helio_comparison_info info;
    double start = machine_milliseconds();
    if (error->path == NULL)
        return EXIT_CODE_OK;
    const helio_comparison_pair pair = {.picture = picture->rgba,
                                        .picture_channels = 4,
                                        .reference = error->reference->rgb,
                                        .mask = picture->object,
                                        .exposure = exposure,
                                        .tonemap = tonemap};
    if (helio_comparison_measure(error->comparison, &pair, &info) != HELIO_OK)
        return failure();
    stats->has_error = true;
    stats->relmse = info.relmse;
    stats->lab_mean = info.lab_mean;
    stats->error_ms += machine_milliseconds() - start;
    if (info.pixels == 0)
        return EXIT_CODE_OK;
    error->relmse += info.relmse;
    error->lab += info.lab_mean;
    error->frames++;
    return EXIT_CODE_OK;
}

void frame_error_tell(const frame_error *error)
{
    double frames = (double)error->frames;
    if (error->frames == 0)
        return;
    if (isnan(error->lab))
        message_note("mean error against %s: relmse %.5g", error->path, error->relmse / frames);
    else
        message_note("mean error against %s: relmse %.5g, lab_mean %.5g", error->path, error->relmse / frames,
                     error->lab / frames);
}
