/* SPDX-License-Identifier: MIT
 *
 * The weights of the tiles of the map for one bin of normals. */
#include "sampling/fixed_point.h"
#include "sampling/kernels.h"

/* The weights, and the largest of them; see tables_kernel.c for why by its bits. Tiles past count are black. */
static float weigh(const tiles *t, const normal_bin *bin, uint32_t count, float *restrict weights)
{
    const normal_bin b = *bin;
    int32_t largest_bits = 0;
#pragma omp simd reduction(max : largest_bits)
    for (uint32_t i = 0; i < count; i++) {
        float cosine = b.centre.x * t->x[i] + b.centre.y * t->y[i] + b.centre.z * t->z[i];
        weights[i] = t->light[i] * normal_bin_cosine(&b, cosine);
        int32_t bits = bits_of_float(weights[i]);
        largest_bits = bits > largest_bits ? bits : largest_bits;
    }
    return float_of_bits(largest_bits);
}

uint32_t KERNEL(weigh_tiles)(const tiles *t, const normal_bin *bin, uint32_t *sums)
{
    alignas(64) float weights[TILES_MOST];
    alignas(64) uint32_t integers[TILES_MOST];
    int exponent = fixed_point_exponent(weigh(t, bin, t->count, weights), tables_summand_bits(t->count));
    fixed_point_quantise(weights, t->count, fixed_point_power(exponent), integers);
    return sums[t->count] = fixed_point_scan(integers, t->count, 0, sums);
}
