#version 460
// SPDX-License-Identifier: MIT
//
// The pixels that hit nothing.
#include "common.glsl"

layout(constant_id = 1) const uint VISIBILITY = LAYOUT_SHADOWS_CAST;

#include "random.glsl"
#include "cube.glsl"
#include "film.glsl"
#include "camera.glsl"
#include "background.glsl"

void main()
{
    begin_with_step();
    const uint index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (index >= STEP.counts_of_lists.at[1])
        return;
    const uint pixel = STEP.misses.at[index];
    film_add(pixel, background_at(pixel), false, false);
}
