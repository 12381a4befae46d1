/* SPDX-License-Identifier: MIT */
#include "image/video_pixels.h"

#include "core/context.h"
#include "image/tonemap.h"
#include "image/video_colour.h"

#include <math.h>
#include <string.h>

static void copy_matrix(const colour_matrix *from, float to[3][3])
{
    for (int i = 0; i < 9; i++)
        to[i / 3][i % 3] = (float)from->m[i / 3][i % 3];
}

helio_status video_pixels_begin(video_pixels *pixels, helio_context *context, const helio_video_write_desc *desc,
                                int width)
{
    *pixels = (video_pixels){.context = context,
                             .look = {.exposure = desc->exposure, .tonemap = desc->tonemap},
                             .hdr = desc->hdr,
                             .factor = exp2f(desc->exposure)};
    colour_matrix matrix;
    video_colour_matrix(desc->hdr ? AVCOL_SPC_BT2020_NCL : AVCOL_SPC_BT709, &matrix);
    copy_matrix(&matrix, pixels->matrix);
    video_colour_rec709_to_bt2020(&matrix);
    copy_matrix(&matrix, pixels->rec2020);
    pixels->encoder = context_allocate(context, 1, sizeof *pixels->encoder);
    if (pixels->encoder == NULL)
        return HELIO_ERR_MEMORY;
    transfer_encoder_fill(pixels->encoder, desc->hdr ? HELIO_TRANSFER_PQ : HELIO_TRANSFER_SRGB);
    for (int i = 0; i < 6; i++) {
        pixels->lines[i / 3][i % 3] = context_allocate(context, (size_t)width, sizeof(float));
        if (pixels->lines[i / 3][i % 3] == NULL)
            return HELIO_ERR_MEMORY;
    }
    return HELIO_OK;
}

void video_pixels_end(video_pixels *pixels)
{
    for (int i = 0; i < 6; i++)
        context_release(pixels->context, pixels->lines[i / 3][i % 3]);
    context_release(pixels->context, pixels->encoder);
}

/* Where a pixel of the frame is in the picture. */
static size_t index_at(const helio_picture *picture, int x, int y)
{
    size_t column = (size_t)x < picture->width ? (size_t)x : picture->width - 1;
    size_t row = (size_t)y < picture->height ? (size_t)y : picture->height - 1;
    return row * picture->width + column;
}

/* R'G'B' of one pixel. */
static void encode(const video_pixels *pixels, const helio_picture *picture, size_t index, float signal[3])
{
    if (!pixels->hdr && picture->shown != NULL) {
        for (size_t c = 0; c < 3; c++)
            signal[c] = (float)picture->shown[4 * index + c] * (1.0f / 255);
        return;
    }
    const float *rgba = picture->rgba + 4 * index;
    float light[3];
    if (pixels->hdr)
        for (int c = 0; c < 3; c++) {
            const float *m = pixels->rec2020[c];
            light[c] = pixels->factor * (m[0] * rgba[0] + m[1] * rgba[1] + m[2] * rgba[2]);
        }
    else
        tonemap_linear(rgba, &pixels->look, light);
    for (int c = 0; c < 3; c++)
        signal[c] = transfer_encoder_look_up(pixels->encoder, light[c]);
}

/* Stores a code of 8 or of 10 bits. */
static void store(AVFrame *frame, int plane, int x, int y, int depth, float value)
{
    uint8_t *line = frame->data[plane] + (ptrdiff_t)y * frame->linesize[plane];
    unsigned code = (unsigned)(value + 0.5f);
    if (depth == 8) {
        line[x] = (uint8_t)code;
        return;
    }
    uint16_t word = (uint16_t)code;
    memcpy(line + 2 * (size_t)x, &word, sizeof word);
}

static void make_line(const video_pixels *pixels, const helio_picture *picture, int y, int width, float *const line[3])
{
    for (int x = 0; x < width; x++) {
        float rgb[3];
        encode(pixels, picture, index_at(picture, x, y), rgb);
        for (int c = 0; c < 3; c++) {
            const float *m = pixels->matrix[c];
            line[c][x] = m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2];
        }
    }
}

/* 1 2 1 around a luma sample of the line. */
static float smooth(const float *line, int x, int width)
{
    float left = line[x > 0 ? x - 1 : 0], right = line[x + 1 < width ? x + 1 : width - 1];
    return 0.25f * (left + 2 * line[x] + right);
}

/* 4:2:0: chroma lies on every other luma sample and between two lines. */
static void fill_yuv(const video_pixels *pixels, const helio_picture *picture, AVFrame *frame, int depth)
{
    float unit = (float)(1 << (depth - 8));
    for (int y = 0; y < frame->height; y += 2) {
        for (int i = 0; i < 2; i++) {
            make_line(pixels, picture, y + i, frame->width, pixels->lines[i]);
            for (int x = 0; x < frame->width; x++)
                store(frame, 0, x, y + i, depth, unit * (16 + 219 * pixels->lines[i][0][x]));
        }
        for (int c = 1; c < 3; c++)
            for (int x = 0; x < frame->width; x += 2) {
                float chroma = 0.5f * (smooth(pixels->lines[0][c], x, frame->width) +
                                       smooth(pixels->lines[1][c], x, frame->width));
                store(frame, c, x / 2, y / 2, depth, unit * (128 + 224 * chroma));
            }
    }
}

/* The planes are G, B and R. */
static void fill_gbr(const video_pixels *pixels, const helio_picture *picture, AVFrame *frame)
{
    static const int PLANES[3] = {2, 0, 1};
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++) {
            float rgb[3];
            encode(pixels, picture, index_at(picture, x, y), rgb);
            for (int c = 0; c < 3; c++)
                store(frame, PLANES[c], x, y, 10, 1023 * rgb[c]);
        }
}

/* The very bytes that a PNG has. */
static void fill_rgb(const video_pixels *pixels, const helio_picture *picture, AVFrame *frame)
{
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++) {
            const size_t index = index_at(picture, x, y);
            uint8_t rgb[4];
            if (picture->shown != NULL)
                memcpy(rgb, picture->shown + 4 * index, sizeof rgb);
            else
                tonemap_shown(picture->rgba + 4 * index, &pixels->look, rgb);
            uint32_t word = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
            memcpy(frame->data[0] + (ptrdiff_t)y * frame->linesize[0] + 4 * (size_t)x, &word, sizeof word);
        }
}

void video_pixels_fill(const video_pixels *pixels, const helio_picture *picture, AVFrame *frame)
{
    switch (frame->format) {
    case AV_PIX_FMT_0RGB32: fill_rgb(pixels, picture, frame); break;
    case AV_PIX_FMT_GBRP10: fill_gbr(pixels, picture, frame); break;
    case AV_PIX_FMT_YUV420P10: fill_yuv(pixels, picture, frame, 10); break;
    default: fill_yuv(pixels, picture, frame, 8); break;
    }
}
