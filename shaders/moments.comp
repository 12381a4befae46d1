#version 460
// SPDX-License-Identifier: MIT
//
// A tile for each work group: solid angle, and the integrals of what the luminance differs by from the face's mean and of
// its square. So floats do where moments_of() in src/sampling/evenness.c, for the same variance, has doubles.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "walk.glsl"
#include "fixed_point.glsl"
#include "face_sums.glsl"
#include "division.glsl"
#include "face_light.glsl"

shared float parts[3u * gl_WorkGroupSize.x];

void main()
{
    begin_with_state();
    const uint edge = STATE.tiles_per_edge, grid = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    const uint row = grid / edge % edge, column = grid % edge, face = grid / (edge * edge);
    const uint top = tile_start(row), left = tile_start(column), rows = tile_start(row + 1u) - top;
    const face_light all = light_of_face(face);
    float angles = 0.0, light = 0.0, squares = 0.0;
    for (walk w = begin_walk(tile_start(column + 1u) - left); w.at.y < rows; go_on(w)) {
        const uint y = top + w.at.y, x = left + w.at.x;
        const vec3 rgb = texel_radiance(texel_index(face, y, x));
        precise float luminance = 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
        precise float value = luminance * all.factor - all.mean;
        const float angle = STATE.solid_angles.at[y * STATE.size + x];
        angles += angle;
        light += value * angle;
        squares += value * value * angle;
    }
    parts[3u * thread] = angles;
    parts[3u * thread + 1u] = light;
    parts[3u * thread + 2u] = squares;
    barrier();
    if (thread >= 3u)
        return;
    float sum = 0.0;
    for (uint i = 0u; i < gl_WorkGroupSize.x; i++)
        sum += parts[3u * i + thread];
    STATE.moments.at[3u * grid + thread] = sum;
}
