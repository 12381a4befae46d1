#version 460
// SPDX-License-Identifier: MIT
//
// Pools of bins of normals, from the lists of the tiles: a sample for each thread. As draw_bin() in
// src/sampling/bins_kernel.c. parameter[0]: samples of a pool that are shared out together.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "pool_store.glsl"

uint first_sum; // of the bin

uint tree_sum(uint i)
{
    return STATE.bin_sums.at[first_sum + i];
}

uint tree_run(uint run)
{
    return min(run * (LAYOUT_TILE_RUN * LAYOUT_TILE_GROUP), STATE.tile_count);
}

const bool TREE_IS_EVEN = false;
#include "tile_tree.glsl"

// Down to the tile of the sample that lies at a place in the pool; seed receives the run's own.
tree_sample find_tile(uint place, inout uint seed)
{
    const uint length = push.parameter[0];
    seed = hash_combine(seed, place / length);
    const uint bits = bitfieldReverse(place % length) ^ tree_random(seed, TREE_NODE_ORDER);
    uint run;
    tree_sample s = begin_in_run(seed, uint((uint64_t(bits) * length) >> 32), length, run);
    s = descend(s, LAYOUT_TILE_GROUP, tree_random(seed, TREE_NODE_RUNS + run));
    return descend(s, 1u, tree_random(seed, TREE_NODE_GROUPS + s.begin / LAYOUT_TILE_GROUP));
}

void main()
{
    begin_with_step();
    const uint sample_index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    const uint bin = sample_index / STATE.pool_length;
    first_sum = bin * (STATE.tile_count + 1u);
    if (bin >= STATE.bin_count)
        return;
    if (STATE.bin_shares.at[bin] == 0.0) {
        store_sample(sample_index, vec3(0.0), 0.0, vec3(0.0), 0u);
        return;
    }
    uint seed = hash_combine(STEP.pool_seed, bin);
    const tree_sample s = find_tile(sample_index % STATE.pool_length, seed);
    const uint position = s.begin, weight = tree_sum(s.end) - tree_sum(s.begin);
    const uint start = STATE.list_starts.at[position], length = STATE.list_starts.at[position + 1u] - start;
    const uint element = start + tree_element(s, seed, position, length);
    const float probability = float(weight) * STATE.bin_shares.at[bin];
    const vec4 direction = vector_at(STATE.listed, 2u * element);
    const vec3 light = min(vector_at(STATE.listed, 2u * element + 1u).rgb * (1.0 / probability), vec3(GREATEST_FLOAT));
    store_sample(sample_index, direction.xyz, probability * direction.w, light, position);
}
