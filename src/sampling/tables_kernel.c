/* SPDX-License-Identifier: MIT
 *
 * One row of the tables: weights, their common exponent, integers, prefix sums. */
#include "core/vector.h"
#include "sampling/fixed_point.h"
#include "sampling/kernels.h"

enum { PIECE = 256 }; /* texels from weights to sums at a time, so that the integers stay in the nearest cache */

/* A texel that is lit weighs at least this much, the smallest float that no machine flushes to zero. */
static const float LEAST_WEIGHT = 0x1p-126f;

/* Luminance x relative solid angle. Relative to 4 / K sr, the largest that a texel of a fine cube has, so that no
 * product overflows. */
static inline float weigh(const float *texel, float relative_solid_angle)
{
    float weight = luminance(texel) * relative_solid_angle;
    float brightest = texel[0] > texel[1] ? texel[0] : texel[1];
    brightest = brightest > texel[2] ? brightest : texel[2];
    float least = brightest > 0.0f ? LEAST_WEIGHT : 0.0f;
    return weight > least ? weight : least;
}

/* The weights of a row, and the largest of them. The bits of floats that are not negative are ordered like the floats,
 * and compilers are freer to reorder the maximum of integers. by_angle is a constant where this is expanded. */
static inline __attribute__((always_inline)) float weigh_texels(bool by_angle, const float *restrict rgb,
                                                                const float *restrict solid_angles, uint32_t size,
                                                                float *restrict weights)
{
    float quarter_texels = 0.25f * (float)size * (float)size;
    int32_t largest_bits = 0;
#pragma omp simd reduction(max : largest_bits)
    for (uint32_t i = 0; i < size; i++) {
        weights[i] = weigh(rgb + 3 * (size_t)i, by_angle ? solid_angles[i] * quarter_texels : 1.0f);
        int32_t bits = bits_of_float(weights[i]);
        largest_bits = bits > largest_bits ? bits : largest_bits;
    }
    return float_of_bits(largest_bits);
}

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, uint32_t size, uint32_t *sums)
{
    float weights[CUBE_MAX_SIZE];
    uint32_t integers[PIECE], sum = 0;
    float largest = solid_angles != NULL ? weigh_texels(true, rgb, solid_angles, size, weights)
                                         : weigh_texels(false, rgb, solid_angles, size, weights);
    int exponent = fixed_point_exponent(largest, tables_summand_bits(size));
    float factor = ldexpf(1.0f, exponent);
    for (uint32_t first = 0; first < size; first += PIECE) {
        uint32_t count = size - first < PIECE ? size - first : PIECE;
        fixed_point_quantise(weights + first, count, factor, integers);
        sum = sums != NULL ? fixed_point_scan(integers, count, sum, sums + first)
                           : fixed_point_total(integers, count, sum);
    }
    if (sums != NULL)
        sums[size] = sum;
    return (row_sum){sum, exponent};
}
