/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/picture.h"
#include "image/tonemap.h"

#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <png.h>

typedef struct png_encoder {
    png_structp library;
    png_infop info;
    char message[256];
    const char *path;
    helio_context *context;
    FILE *stream;
    png_bytep row;
} png_encoder;

static void on_error(png_structp library, png_const_charp message)
{
    png_encoder *encoder = png_get_error_ptr(library);
    int reason = errno; /* the library only says that writing failed */
    bool is_file = encoder->stream != NULL && ferror(encoder->stream) && reason != 0;
    snprintf(encoder->message, sizeof encoder->message, "%s", is_file ? strerror(reason) : message);
    png_longjmp(library, 1);
}

static void on_warning(png_structp library, png_const_charp message)
{
    png_encoder *encoder = png_get_error_ptr(library);
    context_log(encoder->context, HELIO_LOG_WARNING, "%s: %s", encoder->path, message);
}

/* What is shown already, or is to be shown. */
static void fill_row(png_encoder *encoder, const picture_pixels *pixels, const helio_picture_write_desc *desc,
                     size_t row)
{
    const size_t bytes = desc->alpha ? 4 : 3, first = row * pixels->width;
    for (size_t column = 0; column < pixels->width; column++) {
        if (pixels->shown != NULL) {
            memcpy(encoder->row + bytes * column, pixels->shown + (first + column) * 4, bytes);
            continue;
        }
        const float *colour = pixels->colours + (first + column) * pixels->channels;
        const float rgba[4] = {colour[0], colour[1], colour[2], pixels->channels == 4 ? colour[3] : 1};
        tonemap_pixel(rgba, desc, encoder->row + bytes * column);
    }
}

/* All that may jump: nothing here is a variable that would have to survive the jump. */
static helio_status encode(png_encoder *encoder, const picture_pixels *pixels, const helio_picture_write_desc *desc)
{
    png_structp library = encoder->library;
    if (setjmp(png_jmpbuf(library)) != 0)
        return fail(HELIO_ERR_IO, "%s cannot be written: %s", encoder->path, encoder->message);
    png_init_io(library, encoder->stream);
    png_set_user_limits(library, pixels->width, pixels->height);
    png_set_IHDR(library, encoder->info, pixels->width, pixels->height, 8,
                 desc->alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(library, encoder->info, PNG_sRGB_INTENT_RELATIVE);
    png_set_compression_level(library, 3); /* 0.6 of the time of 6, the default, for files a tenth larger */
    png_write_info(library, encoder->info);
    for (size_t row = 0; row < pixels->height; row++) {
        fill_row(encoder, pixels, desc, row);
        png_write_row(library, encoder->row);
    }
    png_write_end(library, NULL);
    return HELIO_OK;
}

helio_status png_write_pixels(helio_context *context, file_writer *writer, const picture_pixels *pixels,
                              const helio_picture_write_desc *desc)
{
    png_encoder encoder = {.path = writer->path, .context = context, .stream = writer->stream};
    encoder.row = context_allocate(context, pixels->width, 4);
    encoder.library = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
    encoder.info = encoder.library ? png_create_info_struct(encoder.library) : NULL;
    helio_status status = encoder.row && encoder.info ? encode(&encoder, pixels, desc)
                                                      : fail(HELIO_ERR_MEMORY, "no memory to write %s", writer->path);
    png_destroy_write_struct(&encoder.library, &encoder.info);
    context_release(context, encoder.row);
    return status;
}

helio_status png_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc)
{
    const picture_pixels pixels = {picture->width, picture->height, picture->rgba, 4, picture->shown};
    return png_write_pixels(context, writer, &pixels, desc);
}
