#version 460
// SPDX-License-Identifier: MIT
//
// How long the list of each tile is, and where it starts, by a single work group. As size_lists() in
// src/sampling/normal_bins.c. parameter[0]: samples of a tile for each that a pool takes x samples of a pool;
// parameter[1]: least of a tile that gives light.
#include "common.glsl"
#include "scan.glsl"

uint list_length(uint position, uint divisor)
{
    const float greatest = STATE.greatest.at[position];
    precise float wanted = float(push.parameter[0]) * greatest;
    uint length = push.parameter[1];
    while (length * divisor < uint(wanted) + push.parameter[1])
        length *= 2u;
    return greatest > 0.0 ? length : 0u;
}

void main()
{
    begin_with_state();
    const uint count = STATE.tile_count, each = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(each * gl_LocalInvocationID.x, count), end = min(begin + each, count);
    uint divisor = 0u, before, total;
    do { // shorter where all together are too long
        uint sum = 0u;
        divisor++;
        for (uint i = begin; i < end; i++)
            sum += list_length(i, divisor);
        before = sum_before_in_group(sum, total);
    } while (total > STATE.list_capacity);
    for (uint i = begin; i < end; i++) {
        STATE.list_starts.at[i] = before;
        before += list_length(i, divisor);
    }
    if (gl_LocalInvocationID.x == 0u)
        STATE.list_starts.at[count] = total;
}
