#version 460
// SPDX-License-Identifier: MIT
//
// BINS bins of normals for each work group: their known light, from that of the tiles. As know_bin() in
// src/sampling/control_kernel.c. Processors want many groups; software reads what it knows of a tile for several at once.
#include "common.glsl"
#include "control.glsl"

layout(constant_id = 1) const uint BINS = 1u;

const uint ROWS = BINS * LAYOUT_CONTROL_ROWS; // of all
shared vec3 parts[ROWS * gl_WorkGroupSize.x];

// The last bin in place of those beyond.
uint bin_at(uint i)
{
    return min(gl_WorkGroupID.x * BINS + i, STATE.bin_count - 1u);
}

void add_tile(uint tile, vec4 cells[BINS], inout vec3 sums[ROWS])
{
    const vec3 centre = vector_at(STATE.tiles, tile).xyz;
    vec3 light[LAYOUT_CONTROL_ROWS];
    for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
        light[row] = vector_at(STATE.tile_light, tile * LAYOUT_CONTROL_ROWS + row).rgb;
    for (uint i = 0u; i < BINS; i++) {
        const control_line line = control_line_of(cells[i], dot(cells[i].xyz, centre));
        for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++)
            sums[i * LAYOUT_CONTROL_ROWS + row] += (row < 3u ? line.slope : line.offset) * light[row];
    }
}

void main()
{
    begin_with_state();
    const uint thread = gl_LocalInvocationID.x;
    vec4 cells[BINS];
    vec3 sums[ROWS];
    for (uint i = 0u; i < BINS; i++)
        cells[i] = vector_at(STATE.bins, bin_at(i));
    for (uint row = 0u; row < ROWS; row++)
        sums[row] = vec3(0.0);
    for (uint tile = thread; tile < STATE.tile_count; tile += gl_WorkGroupSize.x)
        add_tile(tile, cells, sums);
    for (uint row = 0u; row < ROWS; row++)
        parts[ROWS * thread + row] = sums[row];
    barrier();
    for (uint row = thread; row < ROWS; row += gl_WorkGroupSize.x) {
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < gl_WorkGroupSize.x; i++)
            sum += parts[ROWS * i + row];
        STATE.known.at[bin_at(row / LAYOUT_CONTROL_ROWS) * LAYOUT_CONTROL_ROWS + row % LAYOUT_CONTROL_ROWS] =
            vec4(sum, 0.0);
    }
}
