/* SPDX-License-Identifier: MIT */
#include "image/video_samples.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static void read_bytes(const uint8_t *source, int step, int count, float *samples)
{
    for (int i = 0; i < count; i++)
        samples[i] = source[(ptrdiff_t)i * step];
}

static void read_words(const uint8_t *source, int step, int shift, int depth, int count, float *samples)
{
    unsigned mask = (1u << depth) - 1;
    for (int i = 0; i < count; i++) {
        const uint8_t *word = source + (ptrdiff_t)i * step;
        samples[i] = (float)((((unsigned)word[1] << 8 | word[0]) >> shift) & mask);
    }
}

static void read_palette(const AVFrame *frame, int component, int line, int count, float *samples)
{
    const uint8_t *source = frame->data[0] + (ptrdiff_t)line * frame->linesize[0];
    for (int i = 0; i < count; i++) {
        uint32_t argb;
        memcpy(&argb, frame->data[1] + 4 * (size_t)source[i], sizeof argb);
        samples[i] = (float)(argb >> (16 - 8 * component) & 255);
    }
}

/* IEEE 754 binary16 and binary32, from their bits. */
static float float_from_bits(uint32_t bits, int depth)
{
    float value;
    if (depth == 32) {
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    int exponent = (int)(bits >> 10 & 31);
    float mantissa = (float)(bits & 1023);
    if (exponent == 31)
        value = mantissa > 0 ? NAN : INFINITY;
    else
        value = exponent == 0 ? ldexpf(mantissa, -24) : ldexpf(mantissa + 1024, exponent - 25);
    return bits & 0x8000 ? -value : value;
}

/* All other formats, in pieces: FFmpeg knows how each is packed. */
static void read_any(const AVFrame *frame, const AVPixFmtDescriptor *format, int component, int line, int count,
                     float *samples)
{
    bool is_float = (format->flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
    bool is_inverted = frame->format == AV_PIX_FMT_MONOWHITE;
    uint32_t codes[256];
    const uint8_t *data[4] = {frame->data[0], frame->data[1], frame->data[2], frame->data[3]};
    for (int first = 0; first < count; first += 256) {
        int piece = count - first < 256 ? count - first : 256;
        av_read_image_line2(codes, data, frame->linesize, format, first, line, component, piece, 0, sizeof *codes);
        for (int i = 0; i < piece; i++)
            samples[first + i] = is_float      ? float_from_bits(codes[i], format->comp[component].depth)
                                 : is_inverted ? (float)(1 - codes[i])
                                               : (float)codes[i];
    }
}

void video_samples_read(const AVFrame *frame, const AVPixFmtDescriptor *format, int component, int line, int count,
                        float *samples)
{
    if (format->flags & AV_PIX_FMT_FLAG_PAL) {
        read_palette(frame, component, line, count, samples);
        return;
    }
    const AVComponentDescriptor *place = &format->comp[component];
    const uint8_t *source = frame->data[place->plane] + (ptrdiff_t)line * frame->linesize[place->plane] + place->offset;
    bool is_odd = (format->flags & (AV_PIX_FMT_FLAG_BE | AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_FLOAT)) != 0;
    if (!is_odd && place->depth == 8 && place->shift == 0)
        read_bytes(source, place->step, count, samples);
    else if (!is_odd && place->depth > 8 && place->shift + place->depth <= 16)
        read_words(source, place->step, place->shift, place->depth, count, samples);
    else
        read_any(frame, format, component, line, count, samples);
}
