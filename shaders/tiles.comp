#version 460
// SPDX-License-Identifier: MIT
//
// A tile for each work group: prefix sums over its part of the rows, and what a unit of weight in each part adds to the
// density. As sum_row_of_tiles() in src/sampling/tiles.c.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "fixed_point.glsl"
#include "division.glsl"
#include "scan.glsl"

// Rows first ... first + count - 1 of all faces' rows, columns begin ... end - 1.
struct tile_area {
    uint first, count, begin, end;
};

layout_row_sum segment(tile_area area, uint i)
{
    const uint texels = (area.first + i) * (STATE.size + 1u);
    return layout_row_sum(STATE.rows.at[texels + area.end] - STATE.rows.at[texels + area.begin],
                          STATE.weights.at[area.first + i].exponent);
}

int find_exponent(tile_area area)
{
    uint highest = 0u;
    for (uint i = gl_LocalInvocationID.x; i < area.count; i += gl_WorkGroupSize.x) {
        const layout_row_sum part = segment(area, i);
        highest = max(highest, part.sum != 0u ? uint(top_bit(part) + 0x10000) : 0u);
    }
    highest = greatest_in_group(highest);
    return highest != 0u ? common_exponent(int(highest) - 0x10000, summand_bits(area.count)) : 0;
}

uint sum_segments(tile_area area, int exponent, uint to)
{
    uint sum = 0u;
    for (uint block = 0u; block < area.count; block += gl_WorkGroupSize.x) {
        const uint i = block + gl_LocalInvocationID.x;
        uint total, own = i < area.count ? rescale(segment(area, i), exponent) : 0u;
        const uint before = sum + sum_before_in_group(own, total);
        if (i < area.count)
            STATE.tile_sums.at[to + i] = before;
        sum += total;
    }
    return sum;
}

void find_densities(tile_area area, int exponent, uint total, uint column)
{
    const float quarter_texels = 0.25 * (float(STATE.size) * float(STATE.size));
    for (uint i = gl_LocalInvocationID.x; i < area.count; i += gl_WorkGroupSize.x) {
        const layout_row_sum part = segment(area, i);
        const float probability = float(rescale(part, exponent)) / float(total);
        STATE.segment_densities.at[(area.first + i) * STATE.tiles_per_edge + column] =
            part.sum != 0u ? probability / float(part.sum) * quarter_texels : 0.0;
    }
}

// See find_spread() in tiles.c.
float find_spread(tile_area area, int exponent, uint total)
{
    uint64_t squares = uint64_t(0);
    for (uint i = 0u; i < area.count; i++) {
        const uint64_t part = uint64_t(rescale(segment(area, i), exponent));
        squares += part * part;
    }
    if (squares == uint64_t(0))
        return STATE.tile_radius;
    const uint64_t all = area.count * squares, lit = uint64_t(total) * total;
    const uvec2 halves = unpackUint2x32(all);
    const int cut = max(halves.y != 0u ? findMSB(halves.y) + 9 : findMSB(halves.x) - 23, 0);
    precise float spread = STATE.tile_radius * divide(float(uint(lit >> cut)), float(uint(all >> cut)));
    return spread;
}

void main()
{
    begin_with_state();
    const uint position = gl_WorkGroupID.x, edge = STATE.tiles_per_edge, grid = STATE.tile_grid.at[position];
    const uint column = grid % edge, row = grid / edge % edge, face = grid / (edge * edge);
    const tile_area area = tile_area(face * STATE.size + tile_start(row), tile_start(row + 1u) - tile_start(row),
                                     tile_start(column), tile_start(column + 1u));
    const int exponent = find_exponent(area);
    const uint to = position * STATE.tile_stride, total = sum_segments(area, exponent, to);
    find_densities(area, exponent, total, column);
    if (gl_LocalInvocationID.x != 0u)
        return;
    STATE.tile_sums.at[to + area.count] = total;
    STATE.tile_totals.at[position] = layout_row_sum(total, exponent);
    STATE.tile_spreads.at[position] = find_spread(area, exponent, total);
}
