// SPDX-License-Identifier: MIT
// common.glsl - what every pass begins with: extensions, the structures shared with the host, and where they are.
//
// Sizes of work groups are constants of specialisation: processors want many threads, software that plays one wants few,
// as each barrier costs it dear. Nothing here depends on the size of subgroups, and no subgroup operation is used.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "layout.h"

layout(local_size_x_id = 0) in;

layout(buffer_reference, std430, buffer_reference_align = 8) buffer state_of_light
{
    layout_state all;
};

layout(buffer_reference, std430, buffer_reference_align = 8) buffer step_of_frame
{
    layout_step all;
};

layout(push_constant, std430) uniform pushed
{
    state_of_light state;
    step_of_frame step_now;
    uint parameter[4];
} push;

// What lies in memory would be looked up anew after each write, so passes copy these before they begin. Compilers leave
// out what is not used.
layout_state STATE;
layout_step STEP;

void begin_with_state()
{
    STATE = push.state.all;
}

void begin_with_step()
{
    STATE = push.state.all;
    STEP = push.step_now.all;
}

// Groups lie in two dimensions, as devices take only so many side by side: the last row may have too many.
uint group_index()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}
