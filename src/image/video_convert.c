/* SPDX-License-Identifier: MIT */
#include "image/video_convert.h"

#include "core/context.h"
#include "image/pixel_fault.h"
#include "image/video_samples.h"

#include <math.h>
#include <string.h>

void video_converter_clear(video_converter *converter)
{
    helio_context *context = converter->context;
    context_release(context, converter->table);
    context_release(context, converter->rgb);
    for (int i = 0; i < 3; i++) {
        context_release(context, converter->component[i]);
        context_release(context, converter->signal[i]);
    }
    for (int i = 0; i < 4; i++)
        context_release(context, converter->chroma[i / 2][i % 2]);
    context_release(context, converter->blended);
    context_release(context, converter->across);
    *converter = (video_converter){.context = context};
}

static bool allocate(video_converter *converter, size_t width, size_t height)
{
    helio_context *context = converter->context;
    bool good = (converter->table = context_allocate(context, 1, sizeof *converter->table)) != NULL &&
                (converter->rgb = context_allocate(context, width * height, 3 * sizeof(float))) != NULL &&
                (converter->across = context_allocate(context, width, sizeof *converter->across)) != NULL &&
                (converter->blended = context_allocate(context, width, sizeof(float))) != NULL;
    for (int i = 0; good && i < 3; i++)
        good = (converter->component[i] = context_allocate(context, width, sizeof(float))) != NULL &&
               (converter->signal[i] = context_allocate(context, width, sizeof(float))) != NULL;
    for (int i = 0; good && i < 4; i++)
        good = (converter->chroma[i / 2][i % 2] = context_allocate(context, width, sizeof(float))) != NULL;
    return good;
}

static helio_status prepare(video_converter *converter, const AVFrame *frame, helio_transfer transfer)
{
    uint32_t width = (uint32_t)frame->width, height = (uint32_t)frame->height;
    if (converter->width != width || converter->height != height) {
        video_converter_clear(converter);
        if (!allocate(converter, width, height)) {
            video_converter_clear(converter);
            return HELIO_ERR_MEMORY;
        }
        converter->width = width;
        converter->height = height;
    }
    if (converter->table->transfer != transfer)
        transfer_table_fill(converter->table, transfer);
    return HELIO_OK;
}

/* ---- chroma ---- */

/* Where chroma samples lie between luma samples, in luma samples: 0 on the first of each group, 0.5 between two. */
typedef struct chroma_site {
    float x, y;
} chroma_site;

static chroma_site find_site(const AVFrame *frame, const AVPixFmtDescriptor *format)
{
    float middle_x = 0.5f * (float)((1 << format->log2_chroma_w) - 1);
    float middle_y = 0.5f * (float)((1 << format->log2_chroma_h) - 1);
    switch (frame->chroma_location) {
    case AVCHROMA_LOC_CENTER: return (chroma_site){middle_x, middle_y};
    case AVCHROMA_LOC_TOPLEFT: return (chroma_site){0, 0};
    case AVCHROMA_LOC_TOP: return (chroma_site){middle_x, 0};
    case AVCHROMA_LOC_BOTTOMLEFT: return (chroma_site){0, 2 * middle_y};
    case AVCHROMA_LOC_BOTTOM: return (chroma_site){middle_x, 2 * middle_y};
    default: return (chroma_site){0, middle_y}; /* left, as nearly all video without a tag is */
    }
}

static chroma_pair find_pair(int position, float site, int shift, int count)
{
    float place = ((float)position - site) / (float)(1 << shift);
    if (place <= 0)
        return (chroma_pair){0, 0, 0};
    int first = (int)place;
    if (first >= count - 1)
        return (chroma_pair){count - 1, count - 1, 0};
    return (chroma_pair){first, first + 1, place - (float)first};
}

/* A line of chroma codes, from the two that are kept or from the frame. */
static const float *chroma_line(video_converter *converter, const AVFrame *frame, const AVPixFmtDescriptor *format,
                                int component, int line, int count)
{
    float *kept = converter->chroma[component - 1][line & 1];
    if (converter->chroma_line[line & 1] != line)
        video_samples_read(frame, format, component, line, count, kept);
    return kept;
}

/* Linear interpolation of one component, down and then across. */
static void widen(video_converter *converter, const AVFrame *frame, const AVPixFmtDescriptor *format, int component,
                  chroma_pair down)
{
    int shift = format->log2_chroma_w, count = AV_CEIL_RSHIFT(frame->width, shift);
    const float *upper = chroma_line(converter, frame, format, component, down.first, count);
    const float *lower = chroma_line(converter, frame, format, component, down.second, count);
    float *blended = shift > 0 ? converter->blended : converter->component[component];
    for (int i = 0; i < count; i++)
        blended[i] = upper[i] + down.share * (lower[i] - upper[i]);
    for (int x = 0; shift > 0 && x < frame->width; x++) {
        chroma_pair across = converter->across[x];
        float left = blended[across.first];
        converter->component[component][x] = left + across.share * (blended[across.second] - left);
    }
}

static void read_chroma(video_converter *converter, const AVFrame *frame, const AVPixFmtDescriptor *format, int y)
{
    int shift = format->log2_chroma_h;
    chroma_pair down = find_pair(y, find_site(frame, format).y, shift, AV_CEIL_RSHIFT(frame->height, shift));
    for (int component = 1; component < 3; component++)
        widen(converter, frame, format, component, down);
    converter->chroma_line[down.first & 1] = down.first;
    converter->chroma_line[down.second & 1] = down.second;
}

/* Before the first line of a frame. */
static void begin_chroma(video_converter *converter, const AVFrame *frame, const AVPixFmtDescriptor *format)
{
    int shift = format->log2_chroma_w;
    float site = find_site(frame, format).x;
    converter->chroma_line[0] = converter->chroma_line[1] = -1;
    for (int x = 0; x < frame->width; x++)
        converter->across[x] = find_pair(x, site, shift, AV_CEIL_RSHIFT(frame->width, shift));
}

/* ---- lines ---- */

static void read_line(video_converter *converter, const AVFrame *frame, const AVPixFmtDescriptor *format, int y)
{
    bool has_chroma = format->nb_components >= 3;
    bool is_whole = format->log2_chroma_w == 0 && format->log2_chroma_h == 0;
    int whole = (has_chroma && is_whole) || format->flags & AV_PIX_FMT_FLAG_PAL ? 3 : 1;
    for (int component = 0; component < whole; component++)
        video_samples_read(frame, format, component, y, frame->width, converter->component[component]);
    if (has_chroma && !is_whole)
        read_chroma(converter, frame, format, y);
    for (int component = 1; !has_chroma && whole == 1 && component < 3; component++) /* grey */
        memcpy(converter->component[component], converter->component[0], (size_t)frame->width * sizeof(float));
}

/* R'G'B' of the line into converter->signal. */
static void find_signals(const video_converter *converter, const video_colour *colour)
{
    const float *restrict first = converter->component[0];
    const float *restrict second = converter->component[1], *restrict third = converter->component[2];
    for (int c = 0; c < 3; c++) {
        const float *m = colour->signal[c], *restrict own = converter->component[c];
        float *restrict signal = converter->signal[c], a = m[0], b = m[1], d = m[2], constant = m[3], scale = m[c];
        if (colour->is_rgb)
            for (size_t x = 0; x < converter->width; x++)
                signal[x] = scale * own[x] + constant;
        else
            for (size_t x = 0; x < converter->width; x++)
                signal[x] = a * first[x] + b * second[x] + d * third[x] + constant;
    }
}

/* Linear Rec. 709 of light in other primaries. Channels that are below 0 by no more than roundings are 0: grey is in
 * every gamut. */
static void find_rec709(const video_colour *colour, const float light[3], float rgb[3])
{
    const float rounding = 1e-6f * (fabsf(light[0]) + fabsf(light[1]) + fabsf(light[2])) + 1e-9f;
    for (int c = 0; c < 3; c++) {
        const float *m = colour->rec709[c], channel = m[0] * light[0] + m[1] * light[1] + m[2] * light[2];
        rgb[c] = channel < 0 && channel > -rounding ? 0 : channel;
    }
}

/* Linear Rec. 709 of the signals. step: from one pixel's place in rgb to the next's */
static void find_light(const video_converter *converter, const video_colour *colour, float *rgb, ptrdiff_t step)
{
    const transfer_table *table = converter->table;
    const float *red = converter->signal[0], *green = converter->signal[1], *blue = converter->signal[2];
    video_colour own = *colour;
    for (size_t x = 0; x < converter->width; x++, rgb += step) {
        const float light[3] = {transfer_look_up(table, red[x]), transfer_look_up(table, green[x]),
                                transfer_look_up(table, blue[x])};
        if (own.is_rec709)
            memcpy(rgb, light, sizeof light);
        else
            find_rec709(&own, light, rgb);
    }
}

/* Only float formats can hold what is no light. */
static void count_bad(const video_converter *converter, helio_bad_pixels *bad)
{
    for (size_t x = 0; x < converter->width; x++) {
        const float codes[3] = {converter->component[0][x], converter->component[1][x], converter->component[2][x]};
        pixel_fault fault = pixel_fault_of(codes);
        bad->nan += fault == PIXEL_NAN;
        bad->infinite += fault == PIXEL_INFINITE;
        bad->negative += fault == PIXEL_NEGATIVE;
    }
}

helio_status video_convert(video_converter *converter, const AVFrame *frame, const video_colour *colour,
                           const video_turn *turn, helio_bad_pixels *bad)
{
    helio_status status = prepare(converter, frame, colour->transfer);
    if (status != HELIO_OK)
        return status;
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(frame->format);
    ptrdiff_t width = turn->a != 0 ? frame->width : frame->height;
    ptrdiff_t height = turn->a != 0 ? frame->height : frame->width;
    ptrdiff_t across = 3 * (turn->a + turn->b * width), down = 3 * (turn->c + turn->d * width);
    bool from_right = turn->a < 0 || turn->c < 0, from_bottom = turn->b < 0 || turn->d < 0;
    float *start = converter->rgb + 3 * ((from_bottom ? height - 1 : 0) * width + (from_right ? width - 1 : 0));
    begin_chroma(converter, frame, format);
    *bad = (helio_bad_pixels){0};
    for (int y = 0; y < frame->height; y++) {
        read_line(converter, frame, format, y);
        find_signals(converter, colour);
        find_light(converter, colour, start + y * down, across);
        if (format->flags & AV_PIX_FMT_FLAG_FLOAT)
            count_bad(converter, bad);
    }
    return HELIO_OK;
}
