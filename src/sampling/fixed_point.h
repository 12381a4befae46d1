/* SPDX-License-Identifier: MIT
 * fixed_point.h - weights as integers, scaled by a power of two that depends on the largest alone, and their prefix
 * sums; for kernels. Integers from floats by exact powers of two and one rounding, so every instruction set gives the
 * same. */
#ifndef HELIOSTAT_SRC_FIXED_POINT_H
#define HELIOSTAT_SRC_FIXED_POINT_H

#include <stdint.h>
#include <string.h>

/* The exponent e for which the largest weight x 2^e is below 2^bits, and nearly reaches it. At most 126, so that 2^e is
 * a normal float and a weight that a machine might flush to zero comes out as 0 or 1 in either case. The largest is 0
 * or more; that it might be subnormal makes no difference by then. */
static inline int fixed_point_exponent(float largest, int bits)
{
    int32_t pattern;
    memcpy(&pattern, &largest, sizeof pattern);
    const int exponent = pattern != 0 ? (pattern >> 23) - 126 : 0;
    return bits - exponent < 126 ? bits - exponent : 126;
}

/* 2^exponent, by its bits: exponents are those of fixed_point_exponent(). */
static inline float fixed_point_power(int32_t exponent)
{
    const int32_t bits = (exponent + 127) * (1 << 23);
    float power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* A weight as an integer: rounded, and at least 1 for one above 0, however small. */
static inline uint32_t fixed_point_integer(float weight, float factor)
{
    int32_t least = weight > 0.0f, integer = (int32_t)(weight * factor + 0.5f);
    return (uint32_t)(integer > least ? integer : least);
}

static inline void fixed_point_quantise(const float *restrict weights, uint32_t count, float factor,
                                        uint32_t *restrict integers)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++)
        integers[i] = fixed_point_integer(weights[i], factor);
}

/* Writes the sums of the integers before each, beginning with sum, and returns that of all. */
static inline uint32_t fixed_point_scan(const uint32_t *restrict integers, uint32_t count, uint32_t sum,
                                        uint32_t *restrict sums)
{
#pragma omp simd reduction(inscan, + : sum)
    for (uint32_t i = 0; i < count; i++) {
        sums[i] = sum;
#pragma omp scan exclusive(sum)
        sum += integers[i];
    }
    return sum;
}

static inline uint32_t fixed_point_total(const uint32_t *integers, uint32_t count, uint32_t sum)
{
#pragma omp simd reduction(+ : sum)
    for (uint32_t i = 0; i < count; i++)
        sum += integers[i];
    return sum;
}

#endif
