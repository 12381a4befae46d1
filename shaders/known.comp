#version 460
// SPDX-License-Identifier: MIT
//
// A bin of normals for each work group: its known light, from that of the tiles. As know_bin() in
// src/sampling/control_kernel.c.
#include "common.glsl"
#include "control.glsl"

shared vec3 parts[LAYOUT_CONTROL_ROWS * gl_WorkGroupSize.x];

void main()
{
    begin_with_state();
    const uint bin = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    const vec4 cell = STATE.bins.at[bin];
    vec3 sums[LAYOUT_CONTROL_ROWS] = vec3[LAYOUT_CONTROL_ROWS](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint tile = thread; tile < STATE.tile_count; tile += gl_WorkGroupSize.x) {
        const control_line line = control_line_of(cell, dot(cell.xyz, STATE.tiles.at[tile].xyz));
        for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
            sums[row] +=
                (row < 3u ? line.slope : line.offset) * STATE.tile_light.at[tile * LAYOUT_CONTROL_ROWS + row].rgb;
    }
    for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
        parts[LAYOUT_CONTROL_ROWS * thread + row] = sums[row];
    barrier();
    if (thread >= LAYOUT_CONTROL_ROWS)
        return;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < gl_WorkGroupSize.x; i++)
        sum += parts[LAYOUT_CONTROL_ROWS * i + thread];
    STATE.known.at[bin * LAYOUT_CONTROL_ROWS + thread] = vec4(sum, 0.0);
}
