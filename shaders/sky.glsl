// SPDX-License-Identifier: MIT
// sky.glsl - a sky as the host has sent it. Needs common.glsl.

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer sky_of_frame
{
    layout_sky all;
    layout_sun_texel sun[];
};

sky_of_frame sent_sky()
{
    return sky_of_frame(uint64_t(push.step_now));
}
