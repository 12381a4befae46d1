#version 460
// SPDX-License-Identifier: MIT
//
// Pools of bins of normals, from the lists of the tiles: a sample for each thread. As draw_bin() in
// src/sampling/pools_kernel.c, in double where it is.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "pool_store.glsl"

uint find_tile(uint first, uint whole)
{
    uint low = 0u, high = STATE.tile_count;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (STATE.bin_sums.at[first + middle] <= whole)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void main()
{
    begin_with_step();
    const uint sample_index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    const uint bin = sample_index / STATE.pool_length, first = bin * (STATE.tile_count + 1u);
    if (bin >= STATE.bin_count)
        return;
    if (STATE.bin_shares.at[bin] == 0.0) {
        store_sample(sample_index, vec3(0.0), 0.0, vec3(0.0), 0u);
        return;
    }
    const uint seed = hash_combine(STEP.pool_seed, bin), total = STATE.bin_sums.at[first + STATE.tile_count];
    const uint x = scrambled_sobol(sample_index % STATE.pool_length, 0u, seed);
    const double place = double(x >> 1) * (double(total) * (1.0LF / 2147483648.0LF));
    const uint position = find_tile(first, uint(place));
    const uint start = STATE.list_starts.at[position], length = STATE.list_starts.at[position + 1u] - start;
    const uint before = STATE.bin_sums.at[first + position];
    const uint weight = STATE.bin_sums.at[first + position + 1u] - before;
    const double within = (place - double(before)) / double(weight);
    const uint element = start + min(uint(within * double(length)), length - 1u);
    const float probability = float(weight) * STATE.bin_shares.at[bin];
    const vec4 direction = STATE.listed.at[2u * element];
    const vec3 light = min(STATE.listed.at[2u * element + 1u].rgb * (1.0 / probability), vec3(GREATEST_FLOAT));
    store_sample(sample_index, direction.xyz, probability * direction.w, light, position);
}
