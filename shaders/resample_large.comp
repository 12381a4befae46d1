#version 460
// SPDX-License-Identifier: MIT
//
// A large texel of the cube for each work group, whose threads share its pixels. parameter[0]: how many there are.
#include "common.glsl"
#include "map.glsl"
#include "resample.glsl"

const uint THREADS_MOST = 128u;
shared vec3 sums[THREADS_MOST];

void add_patch(inout exact_sum sum, layout_view view, layout_patch rectangle)
{
    const ivec2 first = first_pixel(view, rectangle);
    const uint columns = rectangle.shape & 255u, count = (rectangle.shape >> 8) * columns;
    for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x)
        add(sum, weighted_pixel(rectangle.weight + i, first.x + view.row_sign * int(i / columns),
                                first.y + view.column_sign * int(i % columns)));
}

// The first thread gets the sum over all, a power of two.
vec3 sum_of_threads(vec3 own)
{
    const uint thread = gl_LocalInvocationID.x;
    sums[thread] = own;
    for (uint step = gl_WorkGroupSize.x / 2u; step > 0u; step /= 2u) {
        barrier();
        if (thread < step)
            sums[thread] += sums[thread + step];
    }
    return sums[thread];
}

void main()
{
    begin_with_state();
    begin_with_map();
    if (group_index() >= push.parameter[0])
        return;
    const layout_large large = MAP.large.at[group_index()];
    const layout_view view = view_of(large.view);
    const uint start = MAP.starts.at[large.place] & ~LAYOUT_IS_LARGE;
    const uint end = MAP.starts.at[large.place + 1u] & ~LAYOUT_IS_LARGE;
    exact_sum sum = exact_sum(vec3(0.0), vec3(0.0));
    for (uint i = start; i < end; i++)
        add_patch(sum, view, MAP.patches.at[i]);
    const vec3 all_threads = sum_of_threads(sum.sum);
    if (gl_LocalInvocationID.x == 0u)
        STATE.cube.at[large.texel] = all_threads;
}
