#version 460
// SPDX-License-Identifier: MIT
//
// A row of the cube for each work group: the map averaged over the solid angles of its texels, by the weights that the
// CPU has found. Large texels, which see many pixels, are left out: see resample_large.comp.
#include "common.glsl"
#include "map.glsl"
#include "resample.glsl"

vec3 sum_patch(layout_view view, layout_patch rectangle)
{
    const ivec2 first = first_pixel(view, rectangle);
    const uint rows = rectangle.shape >> 8, columns = rectangle.shape & 255u;
    uint weight = rectangle.weight;
    int row = first.x;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < rows; i++, row += view.row_sign) {
        int column = first.y;
        for (uint k = 0u; k < columns; k++, column += view.column_sign, weight++)
            sum += weighted_pixel(weight, row, column);
    }
    return sum;
}

void main()
{
    begin_with_state();
    begin_with_map();
    const uint index = gl_WorkGroupID.x, size = STATE.size, face = index / size, row = index % size;
    const bool from_below = 2u * row + 1u > size; // the middle of an odd number is counted from above
    const uint first = (from_below ? size - 1u - row : row) * MAP.edge;
    for (uint column = gl_LocalInvocationID.x; column < size; column += gl_WorkGroupSize.x) {
        const bool from_right = 2u * column + 1u > size;
        const layout_view view = view_of(face * 4u + (from_below ? 2u : 0u) + (from_right ? 1u : 0u));
        const uint place = view.first_start + first + (from_right ? size - 1u - column : column);
        const uint start = MAP.starts.at[place], end = MAP.starts.at[place + 1u] & ~LAYOUT_IS_LARGE;
        if ((start & LAYOUT_IS_LARGE) != 0u)
            continue;
        vec3 sum = vec3(0.0);
        for (uint i = start; i < end; i++)
            sum += sum_patch(view, MAP.patches.at[i]);
        STATE.cube.at[index * size + column] = sum;
    }
}
