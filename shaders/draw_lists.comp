#version 460
// SPDX-License-Identifier: MIT
//
// Samples of the lists of tiles: one for each thread. As draw_tiles() in src/sampling/pools_kernel.c.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "pool_store.glsl"

// The tile whose list holds an element: the last that starts at it or before; lists may be empty.
uint find_tile(uint element)
{
    uint low = 0u, high = STATE.tile_count;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (STATE.list_starts.at[middle] <= element)
            low = middle;
        else
            high = middle;
    }
    return low;
}

face_place draw(uint position, uint index, uint length)
{
    const uint seed = hash_combine(hash_combine(STEP.pool_seed, STATE.pool_count), position);
    const uint edge = STATE.tiles_per_edge, grid = STATE.tile_grid.at[position], face = grid / (edge * edge);
    const uint tile_row = grid / edge % edge, first_row = tile_start(tile_row);
    const uint first_column = tile_start(grid % edge), columns = tile_start(grid % edge + 1u) - first_column;
    const uint64_t stratum = (uint64_t(index) << 32) + hash_combine(dimension_seed(seed, 1u), index);
    const uint reversed = uint((uint64_t(bitfieldReverse(index)) * length) >> 32);
    uint x = owen_scramble_reversed(pascal_transform(reversed), dimension_seed(seed, 0u)), y = uint(stratum / length);
    const uint row = first_row + invert(STATE.tile_sums, position * STATE.tile_stride,
                                        tile_start(tile_row + 1u) - first_row, y);
    const uint texels = (face * STATE.size + row) * (STATE.size + 1u) + first_column;
    const uint column = first_column + invert(STATE.rows, texels, columns, x);
    return place_in_texel(face, row, y, column, x);
}

void main()
{
    begin_with_step();
    const uint element = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (element >= STATE.list_starts.at[STATE.tile_count])
        return;
    const uint position = find_tile(element), start = STATE.list_starts.at[position];
    const face_place at = draw(position, element - start, STATE.list_starts.at[position + 1u] - start);
    const vec3 radiance = texel_radiance(texel_index(at.face, at.row, at.column));
    const float density = tile_density(at);
    STATE.listed.at[2u * element] = vec4(cube_direction(at.face, at.u, at.v), density);
    STATE.listed.at[2u * element + 1u] = vec4(weighted(radiance, density), 0.0);
}
