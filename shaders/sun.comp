#version 460
// SPDX-License-Identifier: MIT
//
// Adds the sun's disc to the cube of a sky, a thread for each texel that sees some of it. How much that is the CPU has
// found, see src/env/sun_disc.h.
#include "common.glsl"
#include "sky.glsl"

void main()
{
    begin_with_state();
    sky_of_frame sky = sent_sky();
    const uint index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (index >= sky.all.sun_count)
        return;
    const layout_sun_texel seen = sky.sun[index];
    STATE.cube.at[seen.texel] += vec3(seen.rgb[0], seen.rgb[1], seen.rgb[2]);
}
