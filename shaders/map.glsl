// SPDX-License-Identifier: MIT
// map.glsl - pixels of a map as the host has sent them. Needs common.glsl.
//
// By bits throughout: what is no light is told by them, and devices may take the smallest floats for 0.

layout(constant_id = 1) const uint NUMBERS = 0u; // map_numbers of map_pixels.h
const uint FLOATS = 0u, HALVES = 1u, WORDS = 2u;

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer map_of_frame
{
    layout_map all;
};

const uint SIGN = 0x80000000u, INFINITE_BITS = 0x7f800000u, BRIGHTEST_BITS = 0x7149f2cau; // PIXEL_BRIGHTEST, 1e30

layout_map MAP;

void begin_with_map()
{
    MAP = map_of_frame(uint64_t(push.step_now)).all;
}

layout_view view_of(uint index)
{
    return map_of_frame(uint64_t(push.step_now)).all.views[index];
}

// IEEE binary16 as a float, exactly.
uint half_bits(uint number)
{
    const uint bits = (number & 0x7fffu) << 13, exponent = bits & (0x1fu << 23), least = 113u << 23;
    if (exponent == 0u) {
        precise float value = uintBitsToFloat(bits + least) - uintBitsToFloat(least);
        return floatBitsToUint(value) | (number & 0x8000u) << 16;
    }
    return bits + ((exponent == 0x1fu << 23 ? 224u : 112u) << 23) | (number & 0x8000u) << 16;
}

uint number_bits(uint index)
{
    if (NUMBERS != HALVES)
        return MAP.pixels.at[index];
    return half_bits(MAP.pixels.at[index >> 1] >> (index % 2u * 16u) & 0xffffu);
}

// A shared exponent: channels of 9 bits by powers of two, exactly.
uvec3 word_bits(uint word)
{
    const float unit = uintBitsToFloat(((word >> 27) + 127u - 24u) << 23);
    return floatBitsToUint(vec3(uvec3(word, word >> 9, word >> 18) & 511u) * unit);
}

uvec3 pixel_bits(uint pixel)
{
    if (NUMBERS == WORDS)
        return word_bits(MAP.pixels.at[pixel]);
    const uint first = pixel * MAP.channels;
    return uvec3(number_bits(first), number_bits(first + 1u), number_bits(first + 2u));
}

// pixel_clean() of pixel_fault.h.
vec3 clean(uvec3 bits)
{
    const bool is_finite = all(lessThanEqual(bits & ~SIGN, uvec3(BRIGHTEST_BITS)));
    return is_finite ? uintBitsToFloat(bits * uvec3(lessThan(bits, uvec3(SIGN)))) : vec3(0.0);
}
