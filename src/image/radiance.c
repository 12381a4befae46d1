/* SPDX-License-Identifier: MIT
 *
 * Radiance pictures (.hdr, .pic): four bytes a pixel, three mantissas and a common exponent. A scan line is in one of
 * two codings, told apart by its first bytes:
 *  - new: 2 2 and its length, then the four components one after the other, each in runs;
 *  - old: pixel by pixel, where 1 1 1 n repeats the last pixel. Without such repeats it is a plain array.
 */
#include "core/context.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/image.h"
#include "image/radiance_header.h"

#include <math.h>
#include <string.h>

enum {
    NEW_CODING_LEAST = 8, /* pixels in a scan line of the new coding */
    NEW_CODING_MOST = 32767,
    PIXELS_PER_BYTE = 1024, /* more than the repeats of the old coding reach in any scan line of a real picture */
};

typedef struct byte_reader {
    const unsigned char *at, *end;
} byte_reader;

static size_t left(const byte_reader *reader)
{
    return (size_t)(reader->end - reader->at);
}

/* One component of a scan line: a count above 128 starts a run of one value, others that many values. */
static const char *decode_component(byte_reader *reader, unsigned char *values, uint32_t length)
{
    for (uint32_t done = 0; done < length;) {
        if (left(reader) < 2)
            return "ends in the middle of a scan line";
        uint32_t count = *reader->at++;
        bool is_run = count > 128;
        count = is_run ? count - 128 : count;
        if (count == 0 || count > length - done)
            return "is damaged: a run does not fit its scan line";
        if (left(reader) < (is_run ? 1 : count))
            return "ends in the middle of a scan line";
        if (is_run)
            memset(values + done, reader->at[0], count);
        else
            memcpy(values + done, reader->at, count);
        reader->at += is_run ? 1 : count;
        done += count;
    }
    return NULL;
}

static const char *decode_old_line(byte_reader *reader, unsigned char *rgbe, uint32_t length)
{
    unsigned shift = 0; /* successive repeats are the digits of one count, the lowest first */
    const unsigned char *last = NULL;
    for (uint32_t done = 0; done < length;) {
        if (left(reader) < 4)
            return "ends in the middle of a scan line";
        const unsigned char *pixel = reader->at;
        reader->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            for (size_t component = 0; component < 4; component++)
                rgbe[component * length + done] = pixel[component];
            last = pixel;
            done++;
            shift = 0;
            continue;
        }
        if (last == NULL || shift > 16 || (uint32_t)pixel[3] << shift > length - done)
            return "is damaged: a run does not fit its scan line";
        uint32_t count = (uint32_t)pixel[3] << shift;
        for (size_t component = 0; component < 4; component++)
            memset(rgbe + component * length + done, last[component], count);
        done += count;
        shift += 8;
    }
    return NULL;
}

/* Decodes one scan line to [4][length]. Returns what is wrong, or NULL. */
static const char *decode_line(byte_reader *reader, unsigned char *rgbe, uint32_t length)
{
    bool is_new = length >= NEW_CODING_LEAST && length <= NEW_CODING_MOST && left(reader) >= 4 && reader->at[0] == 2 &&
                  reader->at[1] == 2 && reader->at[2] < 128;
    if (!is_new)
        return decode_old_line(reader, rgbe, length);
    if ((uint32_t)(reader->at[2] << 8 | reader->at[3]) != length)
        return "is damaged: a scan line has another length than the picture";
    reader->at += 4;
    const char *problem = NULL;
    for (int component = 0; component < 4 && problem == NULL; component++)
        problem = decode_component(reader, rgbe + (size_t)component * length, length);
    return problem;
}

/* Where pixel 0 of a scan line goes, and how far it is to the next pixel. */
static void place_line(const radiance_header *header, const helio_image *image, uint32_t line, size_t *start,
                       ptrdiff_t *step)
{
    uint32_t row = header->lines_are_columns ? 0 : line, column = header->lines_are_columns ? line : 0;
    if (header->y_plus)
        row = image->height - 1 - row;
    if (header->x_minus)
        column = image->width - 1 - column;
    *start = (size_t)row * image->width + column;
    if (header->lines_are_columns)
        *step = header->y_plus ? -(ptrdiff_t)image->width : (ptrdiff_t)image->width;
    else
        *step = header->x_minus ? -1 : 1;
}

/* What one step of a mantissa is worth, for each exponent and channel. */
typedef struct radiance_units {
    double unit[256][3];
} radiance_units;

static void make_units(const radiance_header *header, radiance_units *units)
{
    for (int exponent = 0; exponent < 256; exponent++)
        for (int c = 0; c < 3; c++)
            units->unit[exponent][c] = exponent ? ldexp(1.0, exponent - 136) / header->divisor[c] : 0;
}

/* The middle of what the mantissa stands for, exactly 0 where the exponent is 0. */
static void store_line(const radiance_header *header, const radiance_units *units, const unsigned char *rgbe,
                       helio_image *image, uint32_t line)
{
    size_t start;
    ptrdiff_t step;
    place_line(header, image, line, &start, &step);
    const size_t length = header->line_length;
    const unsigned char *exponents = rgbe + 3 * length;
    for (size_t i = 0; i < length; i++) {
        float *rgb = image->rgb + 3 * ((ptrdiff_t)start + step * (ptrdiff_t)i);
        const double *unit = units->unit[exponents[i]];
        for (size_t c = 0; c < 3; c++)
            rgb[c] = (float)((rgbe[c * length + i] + 0.5) * unit[c]);
    }
}

static helio_status read_lines(const image_file *file, const radiance_header *header, helio_image *image)
{
    unsigned char *rgbe = context_allocate(file->context, header->line_length, 4);
    if (rgbe == NULL)
        return HELIO_ERR_MEMORY;
    radiance_units units;
    make_units(header, &units);
    byte_reader reader = {file->bytes + header->length, file->bytes + file->size};
    helio_status status = HELIO_OK;
    for (uint32_t line = 0; line < header->line_count && status == HELIO_OK; line++) {
        const char *problem = decode_line(&reader, rgbe, header->line_length);
        if (problem != NULL)
            status = fail(HELIO_ERR_DATA, "%s %s (%u of %u)", file->path, problem, line + 1, header->line_count);
        else
            store_line(header, &units, rgbe, image, line);
    }
    context_release(file->context, rgbe);
    return status;
}

static void convert_colour(const image_file *file, const radiance_header *header, helio_image *image)
{
    colour_matrix matrix;
    if (header->xyz)
        matrix = colour_xyz_to_rec709();
    else if (!header->has_primaries || colour_is_rec709(&header->primaries))
        return;
    else if (!colour_to_rec709(&header->primaries, &matrix)) {
        context_log(file->context, HELIO_LOG_INFO, "%s has PRIMARIES that span no colours; taken as Rec. 709",
                    file->path);
        return;
    }
    colour_apply(&matrix, image->rgb, (size_t)image->width * image->height);
}

helio_status radiance_read(const image_file *file, helio_image **out)
{
    radiance_header header;
    HELIO_TRY(radiance_header_parse(file, &header));
    uint32_t width = header.lines_are_columns ? header.line_count : header.line_length;
    uint32_t height = header.lines_are_columns ? header.line_length : header.line_count;
    uint64_t least_for_lines = (uint64_t)header.line_count * 4;
    uint64_t least_for_pixels = (uint64_t)width * height / PIXELS_PER_BYTE;
    uint64_t least = least_for_lines > least_for_pixels ? least_for_lines : least_for_pixels;
    helio_image *image;
    HELIO_TRY(image_create(file, width, height, false, header.length + least, &image));
    helio_status status = read_lines(file, &header, image);
    if (status != HELIO_OK) {
        helio_image_destroy(file->context, image);
        return status;
    }
    convert_colour(file, &header, image);
    image->layout = layout_comment_read(header.layout, width, height);
    *out = image;
    return HELIO_OK;
}
