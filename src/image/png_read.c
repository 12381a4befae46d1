/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/image.h"
#include "image/png_animation.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <png.h>

enum { DEFLATE_RATIO = 1032 }; /* zlib's deflate cannot shrink anything more than this */

typedef struct png_decoder {
    png_structp library;
    png_infop info;
    char message[256];
    const image_file *file;
    size_t position; /* in file->bytes */
    helio_image *image;
    size_t channels; /* 3 or 4 */
    png_bytep rows;
    float *linear; /* what each sample value stands for */
} png_decoder;

static void on_error(png_structp library, png_const_charp message)
{
    png_decoder *decoder = png_get_error_ptr(library);
    snprintf(decoder->message, sizeof decoder->message, "%s", message);
    png_longjmp(library, 1);
}

static void on_warning(png_structp library, png_const_charp message)
{
    png_decoder *decoder = png_get_error_ptr(library);
    context_log(decoder->file->context, HELIO_LOG_WARNING, "%s: %s", decoder->file->path, message);
}

static void on_read(png_structp library, png_bytep data, size_t length)
{
    png_decoder *decoder = png_get_io_ptr(library);
    if (length > decoder->file->size - decoder->position)
        png_error(library, "the file is truncated");
    memcpy(data, decoder->file->bytes + decoder->position, length);
    decoder->position += length;
}

/* Asks for RGB or RGBA with 8 or 16 bits, whatever the file has. */
static void choose_transformations(png_structp library, png_infop info)
{
    png_set_expand(library);
    if ((png_get_color_type(library, info) & PNG_COLOR_MASK_COLOR) == 0)
        png_set_gray_to_rgb(library);
}

static helio_status read_header(png_decoder *decoder)
{
    png_structp library = decoder->library;
    png_set_user_limits(library, IMAGE_EDGE_LIMIT, IMAGE_EDGE_LIMIT);
    png_set_read_fn(library, decoder, on_read);
    png_read_info(library, decoder->info);
    uint64_t width = png_get_image_width(library, decoder->info);
    uint64_t height = png_get_image_height(library, decoder->info);
    bool alpha = (png_get_color_type(library, decoder->info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                 png_get_valid(library, decoder->info, PNG_INFO_tRNS) != 0;
    decoder->channels = alpha ? 4 : 3;
    uint64_t stored_bytes = png_get_rowbytes(library, decoder->info) * height;
    return image_create(decoder->file, width, height, alpha, stored_bytes / DEFLATE_RATIO, &decoder->image);
}

static size_t read_bytes(const void *from, uint64_t at, unsigned char *bytes, size_t size)
{
    const image_file *file = from;
    size_t rest = at < file->size ? file->size - (size_t)at : 0, count = size < rest ? size : rest;
    memcpy(bytes, file->bytes + (rest > 0 ? (size_t)at : 0), count);
    return count;
}

static void warn_of_animation(const image_file *file)
{
    uint32_t frames = png_animation_frames(read_bytes, file);
    if (frames > 1)
        context_log(file->context, HELIO_LOG_WARNING, "%s is an animation of %u pictures, of which the first is used",
                    file->path, frames);
}

static uint32_t read_length(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* The library takes memory for a chunk of text by the length that it claims, before it looks whether the file has so
 * many bytes; and it may read on behind the end. */
static helio_status check_chunks(const image_file *file)
{
    enum { SIGNATURE = 8, FRAME = 12 /* length, name and checksum */ };
    for (size_t at = SIGNATURE; file->size - at >= FRAME;) {
        size_t length = read_length(file->bytes + at);
        if (length > file->size - at - FRAME)
            break;
        if (memcmp(file->bytes + at + 4, "IEND", 4) == 0)
            return HELIO_OK;
        at += FRAME + length;
    }
    return fail(HELIO_ERR_DATA, "%s cannot be read as PNG: the file is truncated or damaged", file->path);
}

static helio_status make_curve(png_decoder *decoder, unsigned depth)
{
    size_t count = (size_t)1 << depth;
    decoder->linear = context_allocate(decoder->file->context, count, sizeof *decoder->linear);
    if (decoder->linear == NULL)
        return HELIO_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        decoder->linear[i] = srgb_decode((float)i / (float)(count - 1));
    return HELIO_OK;
}

/* Of 16 bits the 8 that are nearest. */
static void copy_row(png_decoder *decoder, uint32_t row, png_const_bytep bytes, unsigned depth)
{
    size_t width = decoder->image->width;
    uint8_t *texel = *decoder->file->texels + 4 * row * width;
    for (size_t column = 0; column < width; column++, texel += 4) {
        texel[3] = 255;
        for (size_t c = 0; c < decoder->channels; c++, bytes += depth / 8)
            texel[c] = depth == 8 ? bytes[0] : (uint8_t)((((unsigned)bytes[0] << 8 | bytes[1]) + 128) / 257);
    }
}

static void convert_row(png_decoder *decoder, uint32_t row, png_const_bytep bytes, unsigned depth)
{
    helio_image *image = decoder->image;
    size_t channels = decoder->channels, first = (size_t)row * image->width;
    for (size_t column = 0; column < image->width; column++) {
        unsigned samples[4] = {0};
        for (size_t c = 0; c < channels; c++, bytes += depth / 8)
            samples[c] = depth == 8 ? bytes[0] : (unsigned)bytes[0] << 8 | bytes[1];
        for (size_t c = 0; c < 3; c++)
            image->rgb[3 * (first + column) + c] = decoder->linear[samples[c]];
        if (image->alpha)
            image->alpha[first + column] = (float)samples[3] / (float)((1u << depth) - 1);
    }
}

static void store_row(png_decoder *decoder, uint32_t row, png_const_bytep bytes, unsigned depth)
{
    if (decoder->file->texels != NULL)
        copy_row(decoder, row, bytes, depth);
    else
        convert_row(decoder, row, bytes, depth);
}

/* Interlaced pictures come in seven passes over all rows, so that all must be kept; others need one row. */
static helio_status read_rows(png_decoder *decoder)
{
    png_structp library = decoder->library;
    choose_transformations(library, decoder->info);
    int passes = png_set_interlace_handling(library);
    png_read_update_info(library, decoder->info);
    size_t row_bytes = png_get_rowbytes(library, decoder->info), step = passes > 1 ? row_bytes : 0;
    unsigned depth = png_get_bit_depth(library, decoder->info);
    uint32_t height = decoder->image->height;
    if (row_bytes != decoder->image->width * decoder->channels * depth / 8)
        return fail(HELIO_ERR_DATA, "%s has a colour type that cannot be read", decoder->file->path);
    if (decoder->file->texels == NULL)
        HELIO_TRY(make_curve(decoder, depth));
    decoder->rows = context_allocate(decoder->file->context, passes > 1 ? height : 1, row_bytes);
    if (decoder->rows == NULL)
        return HELIO_ERR_MEMORY;
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t row = 0; row < height; row++) {
            png_read_row(library, decoder->rows + row * step, NULL);
            if (pass == passes - 1)
                store_row(decoder, row, decoder->rows + row * step, depth);
        }
    png_read_end(library, NULL);
    return HELIO_OK;
}

/* All that may jump: nothing here is a variable that would have to survive the jump. */
static helio_status decode(png_decoder *decoder)
{
    if (setjmp(png_jmpbuf(decoder->library)) != 0)
        return fail(HELIO_ERR_DATA, "%s cannot be read as PNG: %s", decoder->file->path, decoder->message);
    HELIO_TRY(read_header(decoder));
    return read_rows(decoder);
}

helio_status png_read(const image_file *file, helio_image **image)
{
    HELIO_TRY(check_chunks(file));
    warn_of_animation(file);
    png_decoder decoder = {.file = file};
    decoder.library = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, on_error, on_warning);
    decoder.info = decoder.library ? png_create_info_struct(decoder.library) : NULL;
    helio_status status = decoder.info ? decode(&decoder) : fail(HELIO_ERR_MEMORY, "no memory to read %s", file->path);
    png_destroy_read_struct(&decoder.library, &decoder.info, NULL);
    context_release(file->context, decoder.rows);
    context_release(file->context, decoder.linear);
    if (status == HELIO_OK)
        *image = decoder.image;
    else
        helio_image_destroy(file->context, decoder.image);
    return status;
}
