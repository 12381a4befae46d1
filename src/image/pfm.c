/* SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "image/colour.h"
#include "image/image.h"
#include "image/number.h"
#include "image/picture.h"

#include "core/context.h"

#include <math.h>
#include <string.h>

/* What the three words after "PF" or "Pf" say. */
typedef struct pfm_header {
    bool grey, little_endian;
    uint32_t width, height;
    float scale;
    size_t length; /* bytes before the pixels */
} pfm_header;

enum { WORD_LENGTH = 63 };

static bool is_blank(unsigned char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/* Copies the next word and moves *at to the blank behind it. */
static bool next_word(const image_file *file, size_t *at, char word[WORD_LENGTH + 1])
{
    size_t length = 0;
    while (*at < file->size && is_blank(file->bytes[*at]))
        ++*at;
    while (*at < file->size && !is_blank(file->bytes[*at]) && length < WORD_LENGTH)
        word[length++] = (char)file->bytes[(*at)++];
    word[length] = 0;
    return length > 0 && *at < file->size && is_blank(file->bytes[*at]);
}

static bool read_size(const image_file *file, size_t *at, uint32_t *size)
{
    char word[WORD_LENGTH + 1];
    const char *text = word;
    return next_word(file, at, word) && number_read_size(&text, size) && *text == 0;
}

static bool read_scale(const image_file *file, size_t *at, double *scale)
{
    char word[WORD_LENGTH + 1];
    const char *text = word;
    return next_word(file, at, word) && number_read(&text, scale) && *text == 0;
}

static helio_status parse_header(const image_file *file, pfm_header *header)
{
    size_t at = 2;
    double scale;
    header->grey = file->bytes[1] == 'f';
    if (file->size < 3 || !is_blank(file->bytes[2]) || !read_size(file, &at, &header->width) ||
        !read_size(file, &at, &header->height) || !read_scale(file, &at, &scale))
        return fail(HELIO_ERR_DATA, "%s is not a PFM file: its head is not \"PF\" or \"Pf\", width, height and scale",
                    file->path);
    if (!isfinite((float)scale) || (float)scale == 0.0f)
        return fail(HELIO_ERR_DATA, "%s has the scale %g, which is no finite number other than 0", file->path, scale);
    header->little_endian = scale < 0;
    header->scale = (float)fabs(scale);
    header->length = at + 1;
    return HELIO_OK;
}

/* One blank ends the head. Programs that write text with CR LF leave two: believe in them where the size says so. */
static void skip_line_feed(const image_file *file, pfm_header *header, size_t pixel_bytes)
{
    if (file->bytes[header->length - 1] == '\r' && header->length < file->size && file->bytes[header->length] == '\n' &&
        file->size - header->length > pixel_bytes)
        header->length++;
}

static float read_float(const unsigned char bytes[4], bool little_endian)
{
    uint32_t bits = little_endian
                        ? bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24
                        : bytes[3] | (uint32_t)bytes[2] << 8 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[0] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Rows come from the bottom of the picture to its top. */
static void read_pixels(const image_file *file, const pfm_header *header, helio_image *image)
{
    const unsigned char *bytes = file->bytes + header->length;
    size_t row_floats = 3 * (size_t)image->width;
    for (uint32_t row = image->height; row-- > 0;) {
        float *out = image->rgb + row * row_floats;
        for (size_t i = 0; i < row_floats; i += header->grey ? 3 : 1, bytes += 4) {
            out[i] = read_float(bytes, header->little_endian);
            if (header->grey)
                out[i + 1] = out[i + 2] = out[i];
        }
    }
}

/* A scale of 1 must not touch the bits of NaNs. */
static void apply_scale(helio_image *image, float factor)
{
    if (factor == 1.0f)
        return;
    size_t floats = 3 * (size_t)image->width * image->height;
    for (size_t i = 0; i < floats; i++)
        image->rgb[i] *= factor;
}

helio_status pfm_read(const image_file *file, helio_image **image)
{
    pfm_header header = {0};
    HELIO_TRY(parse_header(file, &header));
    uint64_t pixel_bytes = (uint64_t)header.width * header.height * (header.grey ? 4 : 12);
    HELIO_TRY(image_create(file, header.width, header.height, false, header.length + pixel_bytes, image));
    skip_line_feed(file, &header, (size_t)pixel_bytes);
    read_pixels(file, &header, *image);
    image_count_bad(*image);
    apply_scale(*image, header.scale);
    return HELIO_OK;
}

static void write_float(unsigned char bytes[4], float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(bits >> 8 * i);
}

helio_status pfm_write_pixels(helio_context *context, file_writer *writer, const picture_pixels *pixels)
{
    unsigned char *row_bytes = context_allocate(context, pixels->width, 12);
    if (row_bytes == NULL)
        return HELIO_ERR_MEMORY;
    fprintf(writer->stream, "PF\n%u %u\n-1.0\n", pixels->width, pixels->height);
    for (uint32_t row = pixels->height; row-- > 0;) {
        const float *colours = pixels->colours + pixels->channels * row * pixels->width;
        for (size_t column = 0; column < pixels->width; column++)
            for (size_t c = 0; c < 3; c++)
                write_float(row_bytes + 12 * column + 4 * c, colours[pixels->channels * column + c]);
        fwrite(row_bytes, 12, pixels->width, writer->stream); /* failures are found by file_writer_commit() */
    }
    context_release(context, row_bytes);
    return HELIO_OK;
}

helio_status pfm_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc)
{
    (void)desc;
    return pfm_write_pixels(context, writer,
                            &(picture_pixels){picture->width, picture->height, picture->rgba, 4, NULL});
}
