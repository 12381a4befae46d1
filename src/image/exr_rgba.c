/* SPDX-License-Identifier: MIT */
#include "image/exr.h"

#include "core/context.h"
#include "core/error.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include <ImfCRgbaFile.h>

/* The library keeps its last error message in one place for all threads. */
static pthread_mutex_t message_mutex = PTHREAD_MUTEX_INITIALIZER;

static bool has_same_window(const ImfInputFile *input, exr_attr_box2i_t window)
{
    exr_attr_box2i_t found;
    ImfHeaderDataWindow(ImfInputHeader(input), &found.min.x, &found.min.y, &found.max.x, &found.max.y);
    return memcmp(&found, &window, sizeof found) == 0;
}

/* Reads all pixels of the data window. The caller holds the mutex. */
static bool read_half(ImfInputFile *input, exr_attr_box2i_t window, size_t width, ImfRgba *pixels)
{
    /* The library wants the address that pixel (0, 0) would have, which may lie far outside the array. */
    intptr_t offset = ((intptr_t)window.min.y * (intptr_t)width + window.min.x) * (intptr_t)sizeof *pixels;
    ImfRgba *origin = (ImfRgba *)((uintptr_t)pixels - (uintptr_t)offset);
    return ImfInputSetFrameBuffer(input, origin, 1, width) && ImfInputReadPixels(input, window.min.y, window.max.y);
}

/* The library's words may hold words of the file. The caller holds the mutex. */
static helio_status fail_with_library(const image_file *file)
{
    char reason[512];
    snprintf(reason, sizeof reason, "%s", ImfErrorMessage());
    image_make_printable(reason);
    return fail(HELIO_ERR_DATA, "%s cannot be read as OpenEXR: %s", file->path, reason);
}

static helio_status read_file(const image_file *file, exr_attr_box2i_t window, size_t width, ImfRgba *pixels)
{
    pthread_mutex_lock(&message_mutex);
    ImfInputFile *input = ImfOpenInputFile(file->path);
    bool same = input != NULL && has_same_window(input, window);
    bool good = same && read_half(input, window, width, pixels);
    helio_status status = HELIO_OK;
    if (input != NULL && !same)
        status = fail(HELIO_ERR_DATA, "%s has two data windows, or was changed while it was read", file->path);
    else if (!good)
        status = fail_with_library(file);
    if (input != NULL)
        ImfCloseInputFile(input);
    pthread_mutex_unlock(&message_mutex);
    return status;
}

/* Returns how many pixels have a colour that is infinite. */
static size_t convert(const ImfRgba *pixels, helio_image *image)
{
    size_t count = (size_t)image->width * image->height, infinite = 0;
    for (size_t i = 0; i < count; i++) {
        float rgba[4];
        ImfHalfToFloatArray(4, &pixels[i].r, rgba);
        memcpy(image->rgb + 3 * i, rgba, 3 * sizeof(float));
        if (image->alpha != NULL)
            image->alpha[i] = rgba[3];
        infinite += isinf(rgba[0]) || isinf(rgba[1]) || isinf(rgba[2]);
    }
    return infinite;
}

helio_status exr_rgba_read(const image_file *file, const exr_channels *channels, exr_attr_box2i_t window,
                           helio_image *image)
{
    if (channels->part != 0 || channels->has_layer)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s has DWA compression or chroma in a layer or a later part, which this version of OpenEXR "
                    "cannot read; save it with ZIP and as R, G, B",
                    file->path);
    ImfRgba *pixels = context_allocate(file->context, (size_t)image->width * image->height, sizeof *pixels);
    if (pixels == NULL)
        return HELIO_ERR_MEMORY;
    helio_status status = read_file(file, window, image->width, pixels);
    size_t infinite = status == HELIO_OK ? convert(pixels, image) : 0;
    context_release(file->context, pixels);
    if (infinite > 0 && channels->has_float)
        context_log(file->context, HELIO_LOG_WARNING,
                    "%s: %zu pixels are infinite, as OpenEXR reads this file with half floats, which end at 65504",
                    file->path, infinite);
    return status;
}
