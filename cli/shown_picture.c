/* SPDX-License-Identifier: MIT */
#include "shown_picture.h"

#include <stddef.h>

/* As PNG and video show it, before the sRGB curve. Adds it to a sum. */
static void add_shown(const float *pixel, const shown_picture *picture, double sum[3])
{
    float shown[3];
    helio_tonemap_apply(picture->tonemap, picture->exposure, pixel, shown);
    for (int c = 0; c < 3; c++)
        sum[c] += (double)shown[c];
}

/* The mean of the pixels of columns[0] ... columns[1] - 1, rows likewise. */
static void fill_pixel(const shown_picture *picture, const uint32_t columns[2], const uint32_t rows[2], float rgb[3])
{
    double sum[3] = {0};
    for (uint32_t row = rows[0]; row < rows[1]; row++)
        for (uint32_t column = columns[0]; column < columns[1]; column++)
            add_shown(picture->pixels + ((size_t)row * picture->width + column) * picture->channels, picture, sum);
    double area = (double)(columns[1] - columns[0]) * (rows[1] - rows[0]);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / area);
}

static uint32_t edge_of(uint32_t index, uint32_t pixels, uint32_t shrunk_pixels)
{
    return (uint32_t)((uint64_t)index * pixels / shrunk_pixels);
}

void shown_picture_shrink(const shown_picture *picture, uint32_t width, uint32_t height, float *rgb)
{
    for (uint32_t row = 0; row < height; row++) {
        const uint32_t rows[2] = {edge_of(row, picture->height, height), edge_of(row + 1, picture->height, height)};
        for (uint32_t column = 0; column < width; column++, rgb += 3) {
            const uint32_t columns[2] = {edge_of(column, picture->width, width),
                                         edge_of(column + 1, picture->width, width)};
            fill_pixel(picture, columns, rows, rgb);
        }
    }
}
