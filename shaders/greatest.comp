#version 460
// SPDX-License-Identifier: MIT
//
// The probability of each tile, the greatest over some of the bins: neighbours differ little. As find_greatest() in
// src/sampling/normal_bins.c. parameter[0]: the step from bin to bin.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"

void main()
{
    begin_with_state();
    const uint position = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    float greatest = 0.0;
    if (position >= STATE.tile_count)
        return;
    for (uint bin = 0u; bin < STATE.bin_count; bin += push.parameter[0])
        greatest = max(greatest, tile_probability(bin, position));
    STATE.greatest.at[position] = greatest;
}
