/* SPDX-License-Identifier: MIT
 * map_pixels.h - the pixels of a map where the caller has them. */
#ifndef HELIOSTAT_SRC_MAP_PIXELS_H
#define HELIOSTAT_SRC_MAP_PIXELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* What a map is made of. */
typedef enum map_numbers {
    MAP_FLOATS,
    MAP_HALVES, /* IEEE binary16 */
    MAP_WORDS,  /* HELIO_PIXELS_RGB9E5: one for each pixel, and always light */
} map_numbers;

static inline uint32_t map_number_bytes(map_numbers numbers)
{
    return numbers == MAP_HALVES ? sizeof(uint16_t) : sizeof(uint32_t);
}

typedef struct map_pixels {
    const unsigned char *first; /* of row 0 */
    ptrdiff_t row_bytes;        /* from one row to the next */
    uint32_t pixel_bytes;
    map_numbers numbers;
} map_pixels;

static inline const unsigned char *map_pixels_at(const map_pixels *pixels, int64_t row, int64_t column)
{
    return pixels->first + row * pixels->row_bytes + column * (int64_t)pixels->pixel_bytes;
}

/* Exact; by bits, as not every machine converts. */
static inline float half_to_float(uint16_t half)
{
    const uint32_t exponents = UINT32_C(0x1f) << 23, least_normal = UINT32_C(113) << 23;
    uint32_t bits = (uint32_t)(half & 0x7fff) << 13, exponent = bits & exponents;
    float value, least;
    bits += exponent == exponents ? UINT32_C(224) << 23 /* infinite, or not a number */
            : exponent != 0       ? UINT32_C(112) << 23
                                  : least_normal;
    memcpy(&value, &bits, sizeof value);
    memcpy(&least, &least_normal, sizeof least);
    value -= exponent == 0 ? least : 0.0f;
    return half & 0x8000 ? -value : value;
}

/* Exact. */
static inline void word_to_floats(uint32_t word, float rgb[3])
{
    const uint32_t unit_bits = ((word >> 27) + 127 - 24) << 23;
    float unit;
    memcpy(&unit, &unit_bits, sizeof unit);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(word >> 9 * c & 511) * unit;
}

static inline void map_pixels_read(const map_pixels *pixels, int64_t row, int64_t column, float rgb[3])
{
    const unsigned char *at = map_pixels_at(pixels, row, column);
    uint16_t halves[3];
    uint32_t word;
    if (pixels->numbers == MAP_FLOATS) {
        memcpy(rgb, at, 3 * sizeof *rgb);
        return;
    }
    if (pixels->numbers == MAP_WORDS) {
        memcpy(&word, at, sizeof word);
        word_to_floats(word, rgb);
        return;
    }
    memcpy(halves, at, sizeof halves);
    for (int c = 0; c < 3; c++)
        rgb[c] = half_to_float(halves[c]);
}

#endif
