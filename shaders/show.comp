#version 460
// SPDX-License-Identifier: MIT
//
// What a screen shows of a picture, eight bits a channel: src/image/tonemap.c. Pushed are the addresses of both, pixels,
// how, and the exposure's factor.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "layout.h"
#include "elementary.glsl"

layout(local_size_x_id = 0) in;

layout(push_constant, std430) uniform pushed
{
    vectors picture;
    uints shown;
    uint pixels, how;
    float factor;
} push;

const float MUCH = 1e30; // a stand-in for infinity that can be divided
const uint INFINITE_BITS = 0x7f800000u;

// 0 ... greatest. What is no number, and infinity, are told by bits, as devices may take it that there are none.
float clamped(float value, float greatest)
{
    const uint bits = floatBitsToUint(value);
    if (bits > INFINITE_BITS) // NaN, or with a sign
        return 0.0;
    return bits == INFINITE_BITS ? greatest : min(value, greatest);
}

float exposed(float value, float alpha)
{
    const uint bits = floatBitsToUint(value);
    if (bits > INFINITE_BITS || push.factor == 0.0)
        return 0.0;
    return bits == INFINITE_BITS ? MUCH : min(value / alpha * push.factor, MUCH);
}

// The power by functions of our own: of theirs devices promise little, and in software they take long.
float srgb_encode(float linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * exp2_fast(log2_fast(linear) / 2.4) - 0.055;
}

uint to_byte(float value)
{
    return uint(clamped(value, 1.0) * 255.0 + 0.5);
}

void main()
{
    const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
                       gl_LocalInvocationID.x;
    if (index >= push.pixels)
        return;
    const vec4 seen = push.picture.at[index];
    const bool has_alpha = (push.how & LAYOUT_SHOW_ALPHA) != 0u;
    const float alpha = clamped(seen.a, 1.0);
    vec3 light;
    for (int c = 0; c < 3; c++)
        light[c] = !has_alpha ? exposed(seen[c], 1.0) : alpha > 0.0 ? exposed(seen[c], alpha) : 0.0;
    if ((push.how & LAYOUT_SHOW_REINHARD) != 0u)
        light /= 1.0 + dot(light, vec3(0.2126, 0.7152, 0.0722));
    uint word = (has_alpha ? to_byte(alpha) : 255u) << 24;
    for (int c = 0; c < 3; c++)
        word |= to_byte(srgb_encode(clamped(light[c], 1.0))) << uint(8 * c);
    push.shown.at[index] = word;
}
