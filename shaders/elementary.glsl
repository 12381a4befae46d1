// SPDX-License-Identifier: MIT
// elementary.glsl - logarithm, exponential, sine and cosine as polynomials: the functions of
// src/sampling/elementary.h, as devices promise little for their own.

float exp2_fast(float x)
{
    const float shift = 12582912.0; // adding it rounds to an integer, which then is in the lowest bits
    x = max(x, -100.0);
    precise float shifted = x + shift, r = x - (shifted - shift);
    const float r2 = r * r, low = 0.240222424 * r + 0.693147004, high = 0.00967151299 * r + 0.0555073358;
    const float power = 1.0 + r * (low + r2 * (high + r2 * 0.00132647273));
    return uintBitsToFloat(floatBitsToUint(power) + (floatBitsToUint(shifted) << 23));
}

// log2(1 - x) for 0 <= x < 1, however close to 0 x is.
float log2_one_minus(float x)
{
    const int root_half = 0x3f3504f3, bits = floatBitsToInt(1.0 - x), exponent = (bits - root_half) >> 23;
    const float f = exponent == 0 ? -x : intBitsToFloat(bits - (exponent << 23)) - 1.0, f2 = f * f;
    const float p01 = -0.721352816 * f + 1.4426949, p23 = -0.360239625 * f + 0.480923235;
    const float p45 = -0.248876899 * f + 0.287098706, p67 = -0.145811409 * f + 0.234042257;
    return float(exponent) + f * ((p01 + f2 * p23) + (f2 * f2) * (p45 + f2 * p67));
}

// log2(x) for normal floats above 0.
float log2_fast(float x)
{
    const int bits = floatBitsToInt(x), exponent = (bits - 0x3f3504f3) & int(0xff800000u);
    const float f = intBitsToFloat(bits - exponent) - 1.0, f2 = f * f;
    const float p01 = -0.721352816 * f + 1.4426949, p23 = -0.360239625 * f + 0.480923235;
    const float p45 = -0.248876899 * f + 0.287098706, p67 = -0.145811409 * f + 0.234042257;
    return float(exponent) * (1.0 / 8388608.0) + f * ((p01 + f2 * p23) + (f2 * f2) * (p45 + f2 * p67));
}

// 1 - 2^x for x <= 0, however close to 0 x is.
float one_minus_exp2(float x)
{
    float q = 0.000114580311;
    q = q * x + 0.00129077933;
    q = q * x + 0.00959627517;
    q = q * x + 0.0554989539;
    q = q * x + 0.24022606;
    q = q * x + 0.693147182;
    return x > -1.0 ? -x * q : 1.0 - exp2_fast(x);
}

// The angle whose cosine is 1 - versine, however small it is.
float angle_of_versine(float versine)
{
    const float beyond = max(2.0 - versine, 0.0), near = min(versine, beyond), x = 1.0 - near;
    float q = -0.0012624911;
    q = q * x + 0.0066700901;
    q = q * x - 0.0170881256;
    q = q * x + 0.0308918810;
    q = q * x - 0.0501743046;
    q = q * x + 0.0889789874;
    q = q * x - 0.2145988016;
    q = q * x + 1.5707963050;
    const float angle = sqrt(near) * q;
    return versine < beyond ? angle : 3.14159265 - angle;
}

// sin(2 pi t) for |t| <= 1/4
float sine_of_quarter(float t)
{
    const float z = t * t;
    float q = 39.5367088;
    q = q * z - 76.5497818;
    q = q * z + 81.6010056;
    q = q * z - 41.3416557;
    q = q * z + 6.28318501;
    return t * q;
}

float sine_of_turn(float turn)
{
    const float t = 0.5 - turn, a = abs(t), s = sine_of_quarter(a > 0.25 ? 0.5 - a : a);
    return t < 0.0 ? -s : s;
}

float cosine_of_turn(float turn)
{
    return -sine_of_quarter(0.25 - abs(turn - 0.5));
}
