#version 460
// SPDX-License-Identifier: MIT
//
// The pixels that hit nothing: PIXELS for each thread, as software takes long to learn what is the same for all.
#include "common.glsl"

layout(constant_id = 1) const uint VISIBILITY = LAYOUT_SHADOWS_CAST;
layout(constant_id = 2) const uint PIXELS = 1u;

#include "random.glsl"
#include "cube.glsl"
#include "film.glsl"
#include "camera.glsl"
#include "background.glsl"

void main()
{
    begin_with_step();
    const uint first = group_index() * PIXELS * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    const uint end = min(first + PIXELS * gl_WorkGroupSize.x, STEP.counts_of_lists.at[1]);
    for (uint index = first; index < end; index += gl_WorkGroupSize.x) {
        const uint pixel = STEP.misses.at[index];
        film_add(pixel, background_at(pixel), false, false);
    }
}
