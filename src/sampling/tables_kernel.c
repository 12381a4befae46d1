/* SPDX-License-Identifier: MIT
 *
 * One row of the tables: weights, their common exponent, integers, prefix sums. */
#include "sampling/kernels.h"
#include "sampling/texel_weight.h"

enum { PIECE = 256 }; /* texels from weights to sums at a time, so that the integers stay in the nearest cache */

/* The weights of a row, and the largest of them. The bits of floats that are not negative are ordered like the floats,
 * and compilers are freer to reorder the maximum of integers. */
static inline __attribute__((always_inline)) float weigh_texels(texel_weight_kind kind, const float *restrict rgb,
                                                                const float *restrict solid_angles, float level,
                                                                uint32_t size, float *restrict weights)
{
    const float quarter = texel_quarter(size);
    int32_t largest_bits = 0;
#pragma omp simd reduction(max : largest_bits)
    for (uint32_t i = 0; i < size; i++) {
        const float solid_angle = kind == WEIGHT_LUMINANCE ? 0.0f : solid_angles[i];
        weights[i] = texel_weight(kind, vec3_from(rgb + 3 * (size_t)i), solid_angle, quarter, level);
        int32_t bits = bits_of_float(weights[i]);
        largest_bits = bits > largest_bits ? bits : largest_bits;
    }
    return float_of_bits(largest_bits);
}

static float weigh_row(const float *rgb, const float *solid_angles, float level, uint32_t size, float *weights)
{
    switch (texel_weight_kind_of(solid_angles != NULL, level)) {
    case WEIGHT_LUMINANCE: return weigh_texels(WEIGHT_LUMINANCE, rgb, NULL, 0.0f, size, weights);
    case WEIGHT_FLUX_ABOVE: return weigh_texels(WEIGHT_FLUX_ABOVE, rgb, solid_angles, level, size, weights);
    default: return weigh_texels(WEIGHT_FLUX, rgb, solid_angles, 0.0f, size, weights);
    }
}

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, float level, uint32_t size, uint32_t *sums)
{
    float weights[CUBE_MAX_SIZE];
    uint32_t integers[PIECE], sum = 0;
    float largest = weigh_row(rgb, solid_angles, level, size, weights);
    int exponent = fixed_point_exponent(largest, tables_summand_bits(size));
    float factor = fixed_point_power(exponent);
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
