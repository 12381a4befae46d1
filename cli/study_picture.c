/* SPDX-License-Identifier: MIT */
#include "study_picture.h"

#include "false_colour.h"
#include "srgb.h"

#include <math.h>
#include <stdlib.h>

enum { BORDER = 8 }; /* pixels around the object */

static const float UNCOMPARED = 0.08f; /* grey, linear */

/* Of one axis: what is seen of first ... last, with the border, but no more than so many pixels. */
static void place(uint32_t first, uint32_t last, uint32_t size, uint32_t largest, uint32_t *start, uint32_t *length)
{
    uint32_t from = first > BORDER ? first - BORDER : 0, to = size - last > BORDER ? last + BORDER : size;
    uint32_t excess = to - from > largest ? to - from - largest : 0;
    *start = from + excess / 2;
    *length = to - from - excess;
}

study_window study_window_find(const float *mask, const uint32_t size[2], const uint32_t largest[2])
{
    uint32_t first[2] = {size[0], size[1]}, last[2] = {0, 0};
    for (uint32_t y = 0; y < size[1]; y++)
        for (uint32_t x = 0; x < size[0]; x++) {
            if (mask[(size_t)y * size[0] + x] < 0.5f)
                continue;
            first[0] = x < first[0] ? x : first[0];
            last[0] = x + 1 > last[0] ? x + 1 : last[0];
            first[1] = y < first[1] ? y : first[1];
            last[1] = y + 1;
        }
    study_window window;
    bool is_seen = last[0] > 0;
    place(is_seen ? first[0] : 0, is_seen ? last[0] : size[0], size[0], largest[0], &window.left, &window.width);
    place(is_seen ? first[1] : 0, is_seen ? last[1] : size[1], size[1], largest[1], &window.top, &window.height);
    return window;
}

/* What a pixel of the whole picture looks like, linear in 0..1. */
typedef void look(const void *data, size_t pixel, float rgb[3]);

static helio_status write_window(helio_context *context, const char *path, const study_window *window, uint32_t width,
                                 look *look_at, const void *data)
{
    size_t pixels = (size_t)window->width * window->height;
    float *rgba = malloc(4 * pixels * sizeof *rgba);
    if (rgba == NULL)
        return HELIO_ERR_MEMORY;
    for (size_t i = 0; i < pixels; i++) {
        size_t row = window->top + i / window->width, column = window->left + i % window->width;
        look_at(data, row * width + column, rgba + 4 * i);
        rgba[4 * i + 3] = 1;
    }
    const helio_picture picture = {.width = window->width, .height = window->height, .rgba = rgba};
    helio_status status = helio_picture_write(context, path, &picture, NULL);
    free(rgba);
    return status;
}

typedef struct shown_radiance {
    const float *pixels;
    uint32_t channels;
    float exposure;
    helio_tonemap tonemap;
} shown_radiance;

static void look_at_radiance(const void *data, size_t pixel, float rgb[3])
{
    const shown_radiance *shown = data;
    helio_tonemap_apply(shown->tonemap, shown->exposure, shown->pixels + shown->channels * pixel, rgb);
}

helio_status study_picture_write(helio_context *context, const char *path, const study_window *window,
                                 const float *pixels, uint32_t width, uint32_t channels, float exposure,
                                 helio_tonemap tonemap)
{
    const shown_radiance shown = {pixels, channels, exposure, tonemap};
    return write_window(context, path, window, width, look_at_radiance, &shown);
}

typedef struct shown_errors {
    const float *errors;
    double range;
} shown_errors;

static void look_at_error(const void *data, size_t pixel, float rgb[3])
{
    const shown_errors *shown = data;
    double colour[3];
    float error = shown->errors[pixel];
    rgb[0] = rgb[1] = rgb[2] = UNCOMPARED;
    if (isnan(error))
        return;
    false_colour((double)error / shown->range, colour);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)srgb_decode(colour[c]);
}

helio_status study_picture_write_errors(helio_context *context, const char *path, const study_window *window,
                                        const float *errors, uint32_t width, double range)
{
    const shown_errors shown = {errors, range};
    return write_window(context, path, window, width, look_at_error, &shown);
}
