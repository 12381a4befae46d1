// SPDX-License-Identifier: MIT
// resample.glsl - sums over the pixels under a texel of the cube. Needs map.glsl.

// What rounding loses is carried along (Kahan).
struct exact_sum {
    vec3 sum, lost;
};

void add(inout exact_sum to, vec3 value)
{
    precise vec3 more = value - to.lost;
    precise vec3 total = to.sum + more;
    precise vec3 added = total - to.sum;
    precise vec3 lost = added - more;
    to = exact_sum(total, lost);
}

// Where a view finds the first pixel of a patch: row and column, which counts parts of pixels. Columns of a patch lie in
// one quarter of the map, so that none is beyond an edge if the first is not.
ivec2 first_pixel(layout_view view, layout_patch rectangle)
{
    const int width = int(MAP.width << MAP.part_shift);
    int column = view.column_offset + view.column_sign * int(rectangle.column);
    column += column < -width ? 2 * width : column < 0 ? width : column >= width ? -width : 0; // division takes longer
    return ivec2(view.row_offset + view.row_sign * int(rectangle.row), column);
}

vec3 weighted_pixel(uint weight, int row, int column)
{
    return MAP.weights.at[weight] * clean(pixel_bits(uint(row) * MAP.width + uint(column >> MAP.part_shift)));
}
