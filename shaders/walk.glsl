// SPDX-License-Identifier: MIT
// walk.glsl - the threads of a work group walk over the texels of a rectangle, row by row, without a division
// for each. Needs common.glsl.

struct walk {
    uvec2 at, stride; // column and row
    uint columns;     // at least 1
};

walk begin_walk(uint columns)
{
    const uint thread = gl_LocalInvocationID.x, threads = gl_WorkGroupSize.x;
    return walk(uvec2(thread % columns, thread / columns), uvec2(threads % columns, threads / columns), columns);
}

// As many texels further as there are threads.
void go_on(inout walk w)
{
    w.at += w.stride;
    if (w.at.x >= w.columns)
        w.at = uvec2(w.at.x - w.columns, w.at.y + 1u);
}
