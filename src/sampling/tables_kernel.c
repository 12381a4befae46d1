/* SPDX-License-Identifier: MIT
 *
 * One row of the tables: weights, their common exponent, integers, prefix sums. Integers from floats by exact powers of
 * two and one rounding, so every instruction set gives the same. */
#include "core/vector.h"
#include "sampling/kernels.h"

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, uint32_t size, uint32_t *sums);

enum { PIECE = 256 }; /* texels from weights to sums at a time, so that the integers stay in the nearest cache */

/* Luminance x relative solid angle (solid_angles NULL: luminance alone). Relative to 4 / K sr, the largest that a texel
 * of a fine cube has, so that no product overflows. Returns the largest. */
static float weigh_texels(const float *restrict rgb, const float *restrict solid_angles, uint32_t size,
                          float *restrict weights)
{
    float largest = 0.0f, quarter_texels = 0.25f * (float)size * (float)size;
    if (solid_angles == NULL) {
#pragma omp simd reduction(max : largest)
        for (uint32_t i = 0; i < size; i++) {
            weights[i] = luminance(rgb + 3 * (size_t)i);
            largest = weights[i] > largest ? weights[i] : largest;
        }
        return largest;
    }
#pragma omp simd reduction(max : largest)
    for (uint32_t i = 0; i < size; i++) {
        weights[i] = luminance(rgb + 3 * (size_t)i) * (solid_angles[i] * quarter_texels);
        largest = weights[i] > largest ? weights[i] : largest;
    }
    return largest;
}

/* The weights as integers: rounded, and at least 1 for a texel that is lit, however dark. */
static void quantise(const float *restrict rgb, const float *restrict weights, uint32_t count, float factor,
                     uint32_t *restrict integers)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const float *texel = rgb + 3 * (size_t)i;
        float brightest = texel[0] > texel[1] ? texel[0] : texel[1];
        brightest = brightest > texel[2] ? brightest : texel[2];
        int32_t least = brightest > 0.0f, integer = (int32_t)(weights[i] * factor + 0.5f);
        integers[i] = (uint32_t)(integer > least ? integer : least);
    }
}

/* The exponent e for which the largest weight x 2^e is below 2^bits, and nearly reaches it. At most 126, so that 2^e is
 * a normal float and a weight that a machine might flush to zero comes out as 0 or 1 in either case. */
static int row_exponent(float largest, int bits)
{
    int exponent = 0;
    frexpf(largest, &exponent);
    return bits - exponent < 126 ? bits - exponent : 126;
}

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, uint32_t size, uint32_t *sums)
{
    float weights[CUBE_MAX_SIZE];
    uint32_t integers[PIECE], sum = 0;
    int exponent = row_exponent(weigh_texels(rgb, solid_angles, size, weights), tables_summand_bits(size));
    float factor = ldexpf(1.0f, exponent);
    for (uint32_t first = 0; first < size; first += PIECE) {
        uint32_t count = size - first < PIECE ? size - first : PIECE;
        quantise(rgb + 3 * (size_t)first, weights + first, count, factor, integers);
        for (uint32_t i = 0; i < count; i++) {
            if (sums != NULL)
                sums[first + i] = sum;
            sum += integers[i];
        }
    }
    if (sums != NULL)
        sums[size] = sum;
    return (row_sum){sum, exponent};
}
