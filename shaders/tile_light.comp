#version 460
// SPDX-License-Identifier: MIT
//
// The light of all tiles in proportion to the brightest, by a single work group. As find_light() in
// src/sampling/tiles.c.
#include "common.glsl"
#include "fixed_point.glsl"
#include "scan.glsl"

const float LEAST_LIGHT = 8.67361738e-19; // 2^-60

// Exactly, but for the rounding of the sum to a float.
float light_of(layout_row_sum total, int exponent)
{
    if (total.sum == 0u)
        return 0.0;
    const int power = -total.exponent - exponent;
    return power < -120 ? LEAST_LIGHT : max(float(total.sum) * power_of_two(power), LEAST_LIGHT);
}

layout_row_sum total_at(uint position)
{
    return layout_row_sum(STATE.tile_totals.at[position].sum, STATE.tile_totals.at[position].exponent);
}

void main()
{
    begin_with_state();
    uint highest = 0u;
    for (uint i = gl_LocalInvocationID.x; i < STATE.tile_count; i += gl_WorkGroupSize.x) {
        const layout_row_sum total = total_at(i);
        highest = max(highest, total.sum != 0u ? uint(top_bit(total) + 0x10000) : 0u);
    }
    const int exponent = int(greatest_in_group(highest)) - 0x10000 + 1; // the brightest is below 2^this
    for (uint i = gl_LocalInvocationID.x; i < STATE.tile_count; i += gl_WorkGroupSize.x)
        STATE.tiles.at[i].w = light_of(total_at(i), exponent);
}
