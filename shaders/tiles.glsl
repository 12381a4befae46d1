// SPDX-License-Identifier: MIT
// tiles.glsl - squares of texels, and bins of normals over them: as tiles.h and normal_bins.h. Needs tables.glsl.

// First row, or column, of the k-th tile of an edge.
uint tile_start(uint k)
{
    return k * STATE.size / STATE.tiles_per_edge;
}

// The tile of an edge that holds a row, or column.
uint tile_of_line(uint line)
{
    return ((line + 1u) * STATE.tiles_per_edge - 1u) / STATE.size;
}

uint tile_position(face_place at)
{
    const uint row = at.face * STATE.tiles_per_edge + tile_of_line(at.row);
    return STATE.tile_positions.at[row * STATE.tiles_per_edge + tile_of_line(at.column)];
}

// Density, 1/sr, of a direction given its tile.
float tile_density(face_place at)
{
    const uint line = (at.face * STATE.size + at.row) * STATE.tiles_per_edge;
    return float(texel_weight(at)) * STATE.segment_densities.at[line + tile_of_line(at.column)] *
           projection(at.u, at.v);
}

// Probability of a tile given the bin.
float tile_probability(uint bin, uint position)
{
    const uint first = bin * (STATE.tile_count + 1u) + position;
    return float(STATE.bin_sums.at[first + 1u] - STATE.bin_sums.at[first]) * STATE.bin_shares.at[bin];
}

// Density, 1/sr, of a direction given the bin.
float bin_density(uint bin, face_place at)
{
    return tile_probability(bin, tile_position(at)) * tile_density(at);
}

// The bin of a normal that is shaken.
float bin_warp(float u)
{
    precise float warped = u * (1.25 - 0.25 * u * u);
    return warped;
}

uint bin_of_normal(vec3 normal, uint random)
{
    const vec3 steps = vec3(random & 1023u, random >> 10 & 1023u, random >> 20 & 1023u) - 511.5;
    precise vec3 shaken = normal + steps * (STATE.shake / 512.0);
    const cube_position at = cube_project(shaken);
    const uint row = cube_texel(bin_warp(at.v), STATE.bins_per_edge);
    const uint column = cube_texel(bin_warp(at.u), STATE.bins_per_edge);
    return (at.face * STATE.bins_per_edge + row) * STATE.bins_per_edge + column;
}
