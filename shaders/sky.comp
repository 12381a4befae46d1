#version 460
// SPDX-License-Identifier: MIT
//
// The cube of a sky without the sun's disc, a thread for each texel: src/env/sky_kernel.c and sky_cube.c.
#include "common.glsl"
#include "elementary.glsl"
#include "cube.glsl"
#include "sky.glsl"

const uint TOP = 2u, GROUND = 3u; // faces

layout_sky SKY;

vec3 three(float from[3])
{
    return vec3(from[0], from[1], from[2]);
}

// The model's second factor times the first, see sky_model.h. versine: 1 - cos gamma.
vec3 light_of(float up, float versine)
{
    const float gamma = angle_of_versine(versine), inverse = 1.0 / (up + 0.01), root_up = sqrt(up);
    const float cosine = 1.0 - versine, square = cosine * cosine;
    vec3 light;
    for (int c = 0; c < 3; c++) {
        const float horizon = 1.0 + SKY.horizon[c] * exp2_fast(SKY.horizon_exponent[c] * inverse);
        const float q = SKY.mie_near[c] + SKY.mie_far[c] * versine, mie = (1.0 + square) / (q * sqrt(q));
        const float value = SKY.constant[c] + SKY.glow[c] * exp2_fast(SKY.glow_exponent[c] * gamma) +
                            SKY.rayleigh[c] * square + SKY.mie[c] * mie + SKY.zenith[c] * root_up;
        light[c] = max(value * horizon, 0.0) + SKY.even[c];
    }
    return light;
}

// At face coordinates.
vec3 light_at(uint face, float u, float v)
{
    if (face == GROUND || (face != TOP && v > 0.0))
        return three(SKY.ground);
    const float along_axis = 1.0 / sqrt(1.0 + u * u + v * v);
    const vec3 away = cube_point(face, u, v) * along_axis - three(SKY.sun);
    return light_of(face == TOP ? along_axis : -v * along_axis, 0.5 * dot(away, away));
}

// By solid angles.
vec3 average(uint face, uint row, uint column)
{
    const uint samples = SKY.samples;
    const float steps = 1.0 / float(STATE.size * samples);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < samples * samples; i++) {
        const uvec2 place = uvec2(column, row) * samples + uvec2(i % samples, i / samples);
        const vec2 at = vec2(2u * place + 1u) * steps - 1.0;
        const float square = 1.0 + dot(at, at), weight = 1.0 / (square * sqrt(square));
        sum += weight * light_at(face, at.x, at.y);
        weights += weight;
    }
    return sum / weights;
}

void main()
{
    begin_with_state();
    SKY = sent_sky().all;
    const uint index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x, size = STATE.size;
    if (index >= 6u * size * size)
        return;
    const uint face = index / (size * size), row = index / size % size, column = index % size;
    if (SKY.samples > 1u) {
        STATE.cube.at[index] = average(face, row, column);
        return;
    }
    const vec2 at = vec2(uvec2(column, row) * 2u + 1u) / float(size) - 1.0;
    STATE.cube.at[index] = light_at(face, at.x, at.y);
}
