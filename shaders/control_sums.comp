#version 460
// SPDX-License-Identifier: MIT
//
// A bin of normals for each work group: prefix sums over the chunks of its pool of what samples stand for. As add_known()
// in src/sampling/bins_kernel.c.
#include "common.glsl"
#include "control.glsl"

shared vec3 parts[LAYOUT_CONTROL_ROWS * gl_WorkGroupSize.x];

void add_sample(uint index, vec4 bin, inout vec3 sums[LAYOUT_CONTROL_ROWS])
{
    const vec3 direction = vector_at(STATE.pools, index).xyz;
    const vec4 light = vector_at(STATE.pools, STATE.pool_stride + index); // and the tile
    const vec3 centre = vector_at(STATE.tiles, uint(light.w)).xyz;
    const control_line line = control_line_of(bin, dot(bin.xyz, centre));
    const vec4 factors = vec4(line.slope * direction, line.offset * dot(centre, direction));
    for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
        sums[row] += factors[row] * light.rgb;
}

void main()
{
    begin_with_state();
    const uint bin = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x, threads = gl_WorkGroupSize.x;
    const uint chunks = STATE.pool_length / LAYOUT_CONTROL_CHUNK, to = control_sums_of(bin);
    const vec4 cell = vector_at(STATE.bins, bin);
    vec3 sum = vec3(0.0); // of a row
    if (thread < LAYOUT_CONTROL_ROWS)
        STATE.control_sums.at[to + thread] = vec4(0.0);
    for (uint block = 0u; block < chunks; block += threads) {
        vec3 sums[LAYOUT_CONTROL_ROWS] = vec3[LAYOUT_CONTROL_ROWS](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
        const uint count = min(threads, chunks - block);
        for (uint i = 0u; thread < count && i < LAYOUT_CONTROL_CHUNK; i++)
            add_sample(bin * STATE.pool_length + (block + thread) * LAYOUT_CONTROL_CHUNK + i, cell, sums);
        barrier(); // the block before has been read
        for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
            parts[LAYOUT_CONTROL_ROWS * thread + row] = sums[row];
        barrier();
        for (uint i = 0u; thread < LAYOUT_CONTROL_ROWS && i < count; i++) {
            sum += parts[LAYOUT_CONTROL_ROWS * i + thread];
            STATE.control_sums.at[to + (block + i + 1u) * LAYOUT_CONTROL_ROWS + thread] = vec4(sum, 0.0);
        }
    }
}
