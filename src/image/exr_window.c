/* SPDX-License-Identifier: MIT */
#include "image/exr.h"

#include "core/context.h"
#include "core/error.h"

#include <string.h>

enum { GROWTH_LIMIT = 64 }; /* a display window with more pixels per pixel of the data window is not believed */

typedef struct span {
    int64_t data, display, length; /* first pixel in either window, and how many they share */
} span;

/* What [data_min, data_max] and [display_min, display_max] have in common; length <= 0 if nothing. */
static span overlap(int64_t data_min, int64_t data_max, int64_t display_min, int64_t display_max)
{
    int64_t low = data_min > display_min ? data_min : display_min;
    int64_t high = data_max < display_max ? data_max : display_max;
    return (span){low - data_min, low - display_min, high - low + 1};
}

static bool is_sensible(const image_file *file, int64_t width, int64_t height, const helio_image *image)
{
    uint64_t data_pixels = (uint64_t)image->width * image->height;
    if (width < 1 || height < 1 || width > IMAGE_EDGE_LIMIT || height > IMAGE_EDGE_LIMIT)
        return false;
    uint64_t pixels = (uint64_t)width * (uint64_t)height;
    return pixels <= file->max_pixels && pixels <= GROWTH_LIMIT * data_pixels;
}

/* Replaces one array by a black one of the display window's size, and copies what both have. */
static helio_status fit_array(const image_file *file, float **array, size_t channels, uint32_t old_width,
                              const helio_image *fitted, span columns, span rows)
{
    size_t pixels = (size_t)fitted->width * fitted->height;
    float *to = context_allocate(file->context, pixels, channels * sizeof *to);
    if (to == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory for the %u x %u pixels of %s", fitted->width, fitted->height,
                    file->path);
    for (int64_t row = 0; row < rows.length; row++) {
        size_t source = (size_t)(rows.data + row) * old_width + (size_t)columns.data;
        size_t target = (size_t)(rows.display + row) * fitted->width + (size_t)columns.display;
        memcpy(to + channels * target, *array + channels * source, channels * sizeof(float) * (size_t)columns.length);
    }
    context_release(file->context, *array);
    *array = to;
    return HELIO_OK;
}

helio_status exr_window_fit(const image_file *file, exr_attr_box2i_t data, exr_attr_box2i_t display, helio_image *image)
{
    int64_t width = (int64_t)display.max.x - display.min.x + 1, height = (int64_t)display.max.y - display.min.y + 1;
    span columns = overlap(data.min.x, data.max.x, display.min.x, display.max.x);
    span rows = overlap(data.min.y, data.max.y, display.min.y, display.max.y);
    if (columns.length == width && rows.length == height && width == image->width && height == image->height)
        return HELIO_OK;
    if (!is_sensible(file, width, height, image) || columns.length < 1 || rows.length < 1) {
        context_log(file->context, HELIO_LOG_WARNING,
                    "%s: the display window does not fit the data window and is ignored", file->path);
        return HELIO_OK;
    }
    uint32_t old_width = image->width;
    image->width = (uint32_t)width;
    image->height = (uint32_t)height;
    HELIO_TRY(fit_array(file, &image->rgb, 3, old_width, image, columns, rows));
    return image->alpha == NULL ? HELIO_OK : fit_array(file, &image->alpha, 1, old_width, image, columns, rows);
}
