#version 460
// SPDX-License-Identifier: MIT
//
// A tile for each work group: the integrals of its radiance x direction, and its hue. As src/sampling/tile_colours.c.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "walk.glsl"

const uint LEAST_CELLS = 32u, WAYS = 3u;

// Along the face's axis, right and down.
shared vec3 parts[WAYS * gl_WorkGroupSize.x];

// Of a texel that is cut into so many cells along its edges. See find_row_moments() in control_kernel.c.
vec3 integrate(float u, float v, float width, uint split)
{
    const float area = width * width;
    vec3 sum = vec3(0.0);
    for (uint row = 0u; row < split; row++)
        for (uint column = 0u; column < split; column++) {
            const vec2 at = vec2(u, v) + (vec2(column, row) + 0.5) * width;
            const float q = 1.0 / (1.0 + at.x * at.x + at.y * at.y), square = area * q * q, term = area / 3.0 * q;
            const float side = square * (1.0 + term * (1.0 - 3.0 * q));
            sum += vec3(square * (1.0 + term * (2.0 - 3.0 * q)), side * at.x, side * at.y);
        }
    return sum;
}

void write_tile(uint position, uint face, vec3 axis, vec3 right, vec3 down)
{
    const vec3 along = cube_point(face, 0.0, 0.0);
    const vec3 across = cube_point(face, 1.0, 0.0) - along, below = cube_point(face, 0.0, 1.0) - along;
    const vec3 centre = vector_at(STATE.tiles, position).xyz;
    vec3 towards = vec3(0.0);
    for (uint row = 0u; row < 3u; row++) {
        const vec3 moment = axis * along[row] + right * across[row] + down * below[row];
        STATE.tile_light.at[position * LAYOUT_CONTROL_ROWS + row] = vec4(moment, 0.0);
        towards += moment * centre[row];
    }
    STATE.tile_light.at[position * LAYOUT_CONTROL_ROWS + 3u] = vec4(towards, 0.0);
    const float value = 0.2126 * towards.r + 0.7152 * towards.g + 0.0722 * towards.b;
    const float brightness = value > 0.0 ? value : 1.0;
    STATE.tile_hues.at[position] = vec4(towards / brightness, brightness);
}

void main()
{
    begin_with_state();
    const uint edge = STATE.tiles_per_edge, grid = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    const uint row = grid / edge % edge, column = grid % edge, face = grid / (edge * edge);
    const uint top = tile_start(row), left = tile_start(column), rows = tile_start(row + 1u) - top;
    const uint split = (LEAST_CELLS + STATE.size - 1u) / STATE.size;
    const float texel = 2.0 / float(STATE.size);
    vec3 axis = vec3(0.0), right = vec3(0.0), down = vec3(0.0);
    for (walk w = begin_walk(tile_start(column + 1u) - left); w.at.y < rows; go_on(w)) {
        const uint y = top + w.at.y, x = left + w.at.x;
        const vec3 rgb = texel_radiance(texel_index(face, y, x));
        const vec3 ways =
            integrate(float(x) * texel - 1.0, float(y) * texel - 1.0, texel / float(split), split);
        axis += rgb * ways.x;
        right += rgb * ways.y;
        down += rgb * ways.z;
    }
    parts[WAYS * thread] = axis;
    parts[WAYS * thread + 1u] = right;
    parts[WAYS * thread + 2u] = down;
    barrier();
    if (thread < WAYS) {
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < gl_WorkGroupSize.x; i++)
            sum += parts[WAYS * i + thread];
        parts[thread] = sum; // of its own way, which nobody else reads in this loop
    }
    barrier();
    if (thread == 0u)
        write_tile(STATE.tile_positions.at[grid], face, parts[0], parts[1], parts[2]);
}
