/* SPDX-License-Identifier: MIT
 * elementary.h - logarithm, exponential, sine, cosine and arc cosine as polynomials, so that loops over samples become
 * vectors.
 *
 * Minimax polynomials (Lawson's iteration in double precision, coefficients rounded to float), in Estrin's form where
 * many operations would else wait for each other. No branch, no table, no call; the same operations in every build, so
 * without fused multiply-adds also the same bits. The errors stated are those of these functions in float, rounding
 * included; tests compare all floats, or a dense grid, with libm. */
#ifndef HELIOSTAT_SRC_ELEMENTARY_H
#define HELIOSTAT_SRC_ELEMENTARY_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline int32_t bits_of_float(float x)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float float_of_bits(int32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline float magnitude(float x)
{
    return float_of_bits(bits_of_float(x) & 0x7fffffff);
}

/* a where mask is -1, b where it is 0. By bits: compilers make two branches of everything that follows an ordinary
 * choice. */
static inline float choose(int32_t mask, float a, float b)
{
    return float_of_bits((bits_of_float(a) & mask) | (bits_of_float(b) & ~mask));
}

/* x where mask is -1, +0 where it is 0, even if x is not a number. */
static inline float masked(float x, int32_t mask)
{
    return float_of_bits(bits_of_float(x) & mask);
}

/* 2^x for x <= 127, relative error below 2.5e-7. What would be smaller than 2^-100 becomes 2^-100: beside anything else
 * that is nothing, and products with it are still normal floats, which processors multiply many times as fast. */
static inline float exp2_fast(float x)
{
    const float shift = 0x1.8p23f; /* adding it rounds to an integer, which then is in the lowest bits */
    x = x > -100.0f ? x : -100.0f;
    float shifted = x + shift;
    float r = x - (shifted - shift), r2 = r * r; /* r: -1/2 ... 1/2 */
    float low = 0.240222424f * r + 0.693147004f, high = 0.00967151299f * r + 0.0555073358f;
    float power = 1.0f + r * (low + r2 * (high + r2 * 0.00132647273f));
    /* Of shifted the lowest bits alone survive: those of shift itself are gone. */
    return float_of_bits((int32_t)((uint32_t)bits_of_float(power) + ((uint32_t)bits_of_float(shifted) << 23)));
}

/* log2(1 - x) for 0 <= x < 1, relative error below 6e-7, however close to 0 x is. */
static inline float log2_one_minus(float x)
{
    const int32_t root_half = 0x3f3504f3; /* sqrt(1/2) */
    int32_t bits = bits_of_float(1.0f - x);
    int32_t exponent = (bits - root_half) >> 23;
    float mantissa = float_of_bits(bits - (int32_t)((uint32_t)exponent << 23)); /* sqrt(1/2) ... sqrt(2) */
    float f = choose(-(exponent == 0), -x, mantissa - 1.0f); /* -x has not lost what 1 - x rounds away */
    float f2 = f * f;
    float p01 = -0.721352816f * f + 1.4426949f, p23 = -0.360239625f * f + 0.480923235f;
    float p45 = -0.248876899f * f + 0.287098706f, p67 = -0.145811409f * f + 0.234042257f;
    return (float)exponent + f * ((p01 + f2 * p23) + (f2 * f2) * (p45 + f2 * p67));
}

/* log2(x) for normal floats above 0; absolute error below 3e-7 between 1/2 and 2, relative error below 3e-7 elsewhere.
 */
static inline float log2_fast(float x)
{
    const int32_t root_half = 0x3f3504f3; /* sqrt(1/2) */
    int32_t bits = bits_of_float(x);
    int32_t exponent = (bits - root_half) & (int32_t)0xff800000; /* x 2^23 */
    float f = float_of_bits(bits - exponent) - 1.0f, f2 = f * f;
    float p01 = -0.721352816f * f + 1.4426949f, p23 = -0.360239625f * f + 0.480923235f;
    float p45 = -0.248876899f * f + 0.287098706f, p67 = -0.145811409f * f + 0.234042257f;
    return (float)exponent * 0x1p-23f + f * ((p01 + f2 * p23) + (f2 * f2) * (p45 + f2 * p67));
}

/* 1 - 2^x for x <= 0, relative error below 3e-7, however close to 0 x is. */
static inline float one_minus_exp2(float x)
{
    float q = 0.000114580311f;
    q = q * x + 0.00129077933f;
    q = q * x + 0.00959627517f;
    q = q * x + 0.0554989539f;
    q = q * x + 0.24022606f;
    q = q * x + 0.693147182f;
    float near = -x * q, far = 1.0f - exp2_fast(x);
    return x > -1.0f ? near : far;
}

/* sin(2 pi t) for |t| <= 1/4 */
static inline float sine_of_quarter(float t)
{
    float z = t * t;
    float q = 39.5367088f;
    q = q * z - 76.5497818f;
    q = q * z + 81.6010056f;
    q = q * z - 41.3416557f;
    q = q * z + 6.28318501f;
    return t * q;
}

/* Sine and cosine of a part of a turn, 0 <= turn < 1; absolute error below 2.5e-7. */
static inline float sine_of_turn(float turn)
{
    float t = 0.5f - turn, a = magnitude(t);
    a = a > 0.25f ? 0.5f - a : a;
    float s = sine_of_quarter(a);
    return t < 0.0f ? -s : s;
}

static inline float cosine_of_turn(float turn)
{
    return -sine_of_quarter(0.25f - magnitude(turn - 0.5f));
}

/* The angle whose cosine is 1 - versine, 0 ... pi, for 0 <= versine <= 2 and what rounding adds. Abramowitz and Stegun
 * 4.4.46, which has no need of the cosine near 0: relative error below 4e-7, however small the angle is. */
static inline float angle_of_versine(float versine)
{
    float beyond = 2.0f - versine;
    beyond = beyond > 0.0f ? beyond : 0.0f;
    float near = versine < beyond ? versine : beyond, x = 1.0f - near;
    float q = -0.0012624911f;
    q = q * x + 0.0066700901f;
    q = q * x - 0.0170881256f;
    q = q * x + 0.0308918810f;
    q = q * x - 0.0501743046f;
    q = q * x + 0.0889789874f;
    q = q * x - 0.2145988016f;
    q = q * x + 1.5707963050f;
    float angle = sqrtf(near) * q;
    return versine < beyond ? angle : 3.14159265f - angle;
}

#endif
