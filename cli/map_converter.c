/* SPDX-License-Identifier: MIT */
#include "map_converter.h"

#include "message.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static bool reserve(map_buffer *buffer, const map_shape *shape)
{
    size_t pixels = (size_t)shape->width * shape->height;
    if (pixels <= buffer->pixels)
        return true;
    free(buffer->rgb);
    buffer->rgb = pixels <= SIZE_MAX / (3 * sizeof(float)) ? malloc(pixels * 3 * sizeof(float)) : NULL;
    buffer->pixels = buffer->rgb ? pixels : 0;
    if (buffer->rgb == NULL)
        message_failure("no memory for a map of %" PRIu32 "x%" PRIu32 " pixels; give a smaller --env-size or --size",
                        shape->width, shape->height);
    return buffer->rgb != NULL;
}

static bool check(helio_status status)
{
    if (status != HELIO_OK)
        message_failure("%s", helio_last_error());
    return status == HELIO_OK;
}

/* ---- pixels that stay where they are ---------------------------------------------------- */

/* As environments do: what is no light becomes 0. */
static void copy_light(const float *from, size_t pixels, float *to, helio_bad_pixels *bad)
{
    const float brightest = 1e30f;
    for (size_t i = 0; i < pixels; i++, from += 3, to += 3) {
        bool is_nan = isnan(from[0]) || isnan(from[1]) || isnan(from[2]);
        bool is_infinite =
            !is_nan && (fabsf(from[0]) > brightest || fabsf(from[1]) > brightest || fabsf(from[2]) > brightest);
        bool is_negative = !is_nan && !is_infinite && (from[0] < 0 || from[1] < 0 || from[2] < 0);
        bad->nan += is_nan;
        bad->infinite += is_infinite;
        bad->negative += is_negative;
        for (int c = 0; c < 3; c++)
            to[c] = is_nan || is_infinite || !(from[c] > 0) ? 0 : from[c];
    }
}

static bool copy_map(map_converter *converter, map_conversion *work)
{
    const map_shape *shape = &work->from;
    const map_turn *turn = &converter->turn;
    bool is_turned = !map_turn_is_none(turn);
    map_buffer *clean = is_turned ? &converter->between : &converter->out;
    if (!reserve(clean, shape) || !reserve(&converter->out, shape))
        return false;
    copy_light(work->frame->rgb, (size_t)shape->width * shape->height, clean->rgb, &work->light.bad);
    if (is_turned)
        map_turn_latlong(turn, shape->width, shape->height, clean->rgb, converter->out.rgb);
    return true;
}

/* ---- everything else, through a cube ----------------------------------------------------- */

static bool make_environment(map_converter *converter, uint32_t size)
{
    if (converter->environment != NULL && converter->cube_size == size)
        return true;
    helio_environment_destroy(converter->environment);
    converter->environment = NULL;
    const helio_environment_desc desc = {.cube_size = size};
    converter->cube_size = size;
    return check(helio_environment_create(converter->context, &desc, &converter->environment));
}

/* Makes the environment's frame from other pixels than the source's. */
static bool update(map_converter *converter, const map_shape *shape, const float *rgb, helio_environment_info *light)
{
    helio_status status = helio_environment_reshape(converter->environment, shape->width, shape->height, shape->layout);
    return check(status == HELIO_OK ? helio_environment_update(converter->environment, rgb, light) : status);
}

static bool unfold(map_converter *converter, const map_shape *shape, map_buffer *buffer)
{
    helio_layout layout = shape->layout == HELIO_LAYOUT_FACES ? HELIO_LAYOUT_STRIP : shape->layout;
    return reserve(buffer, shape) &&
           check(helio_environment_unfold(converter->environment, layout, shape->width, shape->height, buffer->rgb));
}

/* A lat-long map can be turned before it becomes a cube. */
static bool load_turned(map_converter *converter, map_conversion *work)
{
    const map_shape *from = &work->from;
    helio_bad_pixels bad = {0};
    if (!reserve(&converter->between, from) || !reserve(&converter->turned, from))
        return false;
    copy_light(work->frame->rgb, (size_t)from->width * from->height, converter->between.rgb, &bad);
    map_turn_latlong(&converter->turn, from->width, from->height, converter->between.rgb, converter->turned.rgb);
    bool good = update(converter, from, converter->turned.rgb, &work->light);
    work->light.bad = bad;
    return good;
}

static bool turn_faces(map_converter *converter)
{
    const map_shape faces = {HELIO_LAYOUT_STRIP, converter->cube_size, 6 * converter->cube_size};
    if (!reserve(&converter->turned, &faces))
        return false;
    map_turn_cube(&converter->turn, converter->cube_size, helio_environment_cube(converter->environment),
                  converter->turned.rgb);
    return update(converter, &faces, converter->turned.rgb, NULL);
}

/* By an angle that takes no face to a face: as a lat-long map, twice as fine as the cube where memory allows. */
static bool turn_between(map_converter *converter)
{
    const uint32_t fine = converter->cube_size < MAP_FINEST / 2 ? 2 * converter->cube_size : MAP_FINEST / 2;
    const map_shape between = {HELIO_LAYOUT_LATLONG, 4 * fine, 2 * fine};
    if (!reserve(&converter->turned, &between) || !unfold(converter, &between, &converter->between))
        return false;
    map_turn_latlong(&converter->turn, between.width, between.height, converter->between.rgb, converter->turned.rgb);
    return update(converter, &between, converter->turned.rgb, NULL);
}

static bool convert_map(map_converter *converter, map_conversion *work)
{
    const map_turn *turn = &converter->turn;
    const map_shape *from = &work->from, *to = &work->to;
    if (!make_environment(converter, map_shape_cube(from, to)))
        return false;
    work->has_light = true;
    bool is_turned = !map_turn_is_none(turn);
    if (is_turned && work->frame->rgb != NULL && from->layout == HELIO_LAYOUT_LATLONG)
        return load_turned(converter, work) && unfold(converter, to, &converter->out);
    if (!check(helio_source_apply(converter->source, work->frame, converter->environment, &work->light)))
        return false;
    if (is_turned && !map_turn_is_square(turn) && to->layout == HELIO_LAYOUT_LATLONG) {
        if (!unfold(converter, to, &converter->between) || !reserve(&converter->out, to))
            return false;
        map_turn_latlong(turn, to->width, to->height, converter->between.rgb, converter->out.rgb);
        return true;
    }
    if (is_turned && !(map_turn_is_square(turn) ? turn_faces(converter) : turn_between(converter)))
        return false;
    return unfold(converter, to, &converter->out);
}

static void brighten(map_converter *converter, const map_shape *shape)
{
    float factor = converter->intensity;
    size_t numbers = 3 * (size_t)shape->width * shape->height;
    if (factor != 1)
        for (size_t i = 0; i < numbers; i++)
            converter->out.rgb[i] *= factor;
}

bool map_converter_run(map_converter *converter, map_conversion *work)
{
    const helio_source_frame *frame = work->frame;
    bool stays = map_turn_is_none(&converter->turn) || work->from.layout == HELIO_LAYOUT_LATLONG;
    work->is_copy = frame->rgb != NULL && stays && map_shape_is_same(&work->from, &work->to);
    if (!(work->is_copy ? copy_map(converter, work) : convert_map(converter, work)))
        return false;
    brighten(converter, &work->to);
    return true;
}

bool map_converter_find_light(map_converter *converter, map_conversion *work)
{
    enum { ENOUGH = 64 }; /* texels along the edge of a face */
    helio_bad_pixels bad = work->light.bad;
    if (work->has_light)
        return true;
    if (!make_environment(converter, ENOUGH) ||
        !check(helio_source_apply(converter->source, work->frame, converter->environment, &work->light)))
        return false;
    work->light.bad = bad;
    work->has_light = true;
    return true;
}

void map_converter_release(map_converter *converter)
{
    helio_environment_destroy(converter->environment);
    free(converter->between.rgb);
    free(converter->turned.rgb);
    free(converter->out.rgb);
}
