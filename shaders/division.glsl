// SPDX-License-Identifier: MIT
// division.glsl - quotients rounded as processors round them. Devices may be off by 2.5 units in the last place, and then
// integers that hang on a quotient come out differently.

const uint MANTISSA = 0x007fffffu, ONE = 0x3f800000u;

// a / b, to the nearest float. b and the quotient are normal and positive, and so is a unless it is 0.
float divide(float a, float b)
{
    const uint bits_a = floatBitsToUint(a), bits_b = floatBitsToUint(b);
    const uint x = (bits_a & MANTISSA) + (MANTISSA + 1u), y = (bits_b & MANTISSA) + (MANTISSA + 1u);
    const uint shift = x < y ? 24u : 23u; // for which x 2^shift / y has the bits of a float
    precise float near = float(x) / float(y) * float(1u << shift) + 0.5;
    uint quotient = uint(near);
    int rest = int((x << shift) - quotient * y); // so small that the bits above these do not matter
    for (; 2 * rest > int(y); rest -= int(y))
        quotient++;
    for (; 2 * rest < -int(y); rest += int(y))
        quotient--;
    const uint exponent = (bits_a >> 23) - (bits_b >> 23) + (ONE >> 23) - (shift - 23u);
    return a > 0.0 ? uintBitsToFloat((exponent << 23) + (quotient & MANTISSA)) : 0.0;
}
