#version 460
// SPDX-License-Identifier: MIT
//
// A bin of normals for each work group: prefix sums of the weights that it gives to the tiles. As weigh_tiles() in
// src/sampling/tiles_kernel.c, to the bit.
#include "common.glsl"
#include "fixed_point.glsl"
#include "division.glsl"
#include "scan.glsl"

struct normal_bin {
    vec3 centre;
    float reach, edge, bend;
};

normal_bin bin_at(uint bin)
{
    const vec4 numbers = vector_at(STATE.bins, bin);
    precise float edge = RULE_BIN_EDGE * numbers.w;
    return normal_bin(numbers.xyz, numbers.w, edge, divide(1.0, 4.0 * edge));
}

// See normal_bin_cosine().
float bin_cosine(normal_bin bin, float cosine)
{
    precise float within = max(cosine + bin.reach, 0.0), risen = max(cosine + bin.edge, 0.0);
    precise float bent = risen * risen * bin.bend;
    precise float result = (cosine < bin.edge ? bent : cosine) + RULE_BIN_LEAST * within;
    return result;
}

float weigh(normal_bin bin, uint position)
{
    vec4 tile = vector_at(STATE.tiles, position);
    precise float cosine = bin.centre.x * tile.x + bin.centre.y * tile.y + bin.centre.z * tile.z;
    precise float weight = tile.w * bin_cosine(bin, cosine);
    return weight;
}

void main()
{
    begin_with_state();
    const uint bin = gl_WorkGroupID.x, count = STATE.tile_count, to = bin * (count + 1u);
    const normal_bin own = bin_at(bin);
    uint largest = 0u, sum = 0u;
    for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x)
        largest = max(largest, floatBitsToUint(weigh(own, i)));
    const int exponent = fixed_point_exponent(greatest_in_group(largest), summand_bits(count));
    const float factor = power_of_two(exponent);
    const uint each = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(each * gl_LocalInvocationID.x, count), end = min(begin + each, count);
    for (uint i = begin; i < end; i++)
        sum += fixed_point_integer(weigh(own, i), factor);
    uint total, before = sum_before_in_group(sum, total);
    for (uint i = begin; i < end; i++) {
        STATE.bin_sums.at[to + i] = before;
        before += fixed_point_integer(weigh(own, i), factor);
    }
    if (gl_LocalInvocationID.x != 0u)
        return;
    STATE.bin_sums.at[to + count] = total;
    STATE.bin_shares.at[bin] = total != 0u ? divide(1.0, float(total)) : 0.0;
}
