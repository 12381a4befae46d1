/* SPDX-License-Identifier: MIT
 *
 * Radiance pictures out: scan lines in the new coding where the format has it, else pixel by pixel. A pixel's greatest
 * mantissa is 128 or more, so none can be taken for a repeat (1 1 1 n) or for the mark of a scan line (2 2 n n). */
#include "core/context.h"
#include "core/error.h"
#include "image/layout_comment.h"
#include "image/map.h"

#include <math.h>

enum {
    NEW_CODING_LEAST = 8, /* pixels in a scan line of the new coding */
    NEW_CODING_MOST = 32767,
    SHORTEST_RUN = 3,
    LONGEST_RUN = 127,
    LONGEST_LITERAL = 128,
    EXPONENT_BIAS = 128,
    EXPONENT_MOST = 127, /* 255 - EXPONENT_BIAS */
    EXPONENT_LEAST = -127,
};

/* What a mantissa holds of the channel. Readers add one half. */
static unsigned char mantissa(float value, int exponent)
{
    double scaled = ldexp((double)value, 8 - exponent);
    return (unsigned char)(scaled > 0 ? fmin(scaled, 255) : 0); /* NaN becomes 0 */
}

static void encode_pixel(const float rgb[3], unsigned char rgbe[4])
{
    float greatest = fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    int exponent = 0;
    if (greatest > 0)
        (void)frexp(fmin((double)greatest, ldexp(1, EXPONENT_MOST) * (255.0 / 256)), &exponent);
    if (!(greatest > 0) || exponent < EXPONENT_LEAST) {
        rgbe[0] = rgbe[1] = rgbe[2] = rgbe[3] = 0;
        return;
    }
    for (int c = 0; c < 3; c++)
        rgbe[c] = mantissa(rgb[c], exponent);
    rgbe[3] = (unsigned char)(exponent + EXPONENT_BIAS);
}

static uint32_t run_length(const unsigned char *rgbe, uint32_t left)
{
    uint32_t run = 1;
    while (run < left && run < LONGEST_RUN && rgbe[4 * (size_t)run] == rgbe[0])
        run++;
    return run;
}

/* One component of a scan line: runs of one value, and what lies between them. */
static unsigned char *encode_component(const unsigned char *rgbe, uint32_t length, unsigned char *out)
{
    for (uint32_t done = 0; done < length;) {
        uint32_t literal = 0, run = 0;
        while (done + literal < length && literal < LONGEST_LITERAL) {
            run = run_length(rgbe + 4 * (size_t)(done + literal), length - done - literal);
            if (run >= SHORTEST_RUN)
                break;
            literal++;
            run = 0;
        }
        if (literal > 0) {
            *out++ = (unsigned char)literal;
            for (uint32_t i = 0; i < literal; i++)
                *out++ = rgbe[4 * (size_t)(done + i)];
        }
        if (run > 0) {
            *out++ = (unsigned char)(128 + run);
            *out++ = rgbe[4 * (size_t)(done + literal)];
        }
        done += literal + run;
    }
    return out;
}

static void write_line(FILE *stream, const unsigned char *rgbe, uint32_t length, unsigned char *coded)
{
    if (length < NEW_CODING_LEAST || length > NEW_CODING_MOST) {
        fwrite(rgbe, 4, length, stream); /* failures are found by file_writer_commit() */
        return;
    }
    unsigned char *out = coded;
    *out++ = 2;
    *out++ = 2;
    *out++ = (unsigned char)(length >> 8);
    *out++ = (unsigned char)(length & 255);
    for (int component = 0; component < 4; component++)
        out = encode_component(rgbe + component, length, out);
    fwrite(coded, 1, (size_t)(out - coded), stream);
}

static void write_header(FILE *stream, const helio_map *map)
{
    char comment[LAYOUT_COMMENT_SIZE];
    fprintf(stream, "#?RADIANCE\n");
    if (map->layout != HELIO_LAYOUT_AUTO) {
        layout_comment_format(map->layout, comment);
        fprintf(stream, "# %s\n", comment);
    }
    fprintf(stream, "SOFTWARE=heliostat %s\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", HELIO_VERSION_TEXT, map->height,
            map->width);
}

helio_status radiance_write_map(helio_context *context, file_writer *writer, const helio_map *map,
                                const helio_map_write_desc *desc)
{
    (void)desc;
    /* A literal of one value takes two bytes, and no coding takes more than that for a value. */
    unsigned char *rgbe = context_allocate(context, map->width, 4), *coded = context_allocate(context, map->width, 12);
    if (rgbe == NULL || coded == NULL) {
        context_release(context, rgbe);
        context_release(context, coded);
        return fail(HELIO_ERR_MEMORY, "no memory to write %s", writer->path);
    }
    write_header(writer->stream, map);
    for (size_t row = 0; row < map->height; row++) {
        const float *rgb = map->rgb + 3 * row * map->width;
        for (size_t column = 0; column < map->width; column++)
            encode_pixel(rgb + 3 * column, rgbe + 4 * column);
        write_line(writer->stream, rgbe, map->width, coded);
    }
    context_release(context, coded);
    context_release(context, rgbe);
    return HELIO_OK;
}
