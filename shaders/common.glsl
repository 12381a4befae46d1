// SPDX-License-Identifier: MIT
// common.glsl - what every pass begins with.
//
// Sizes of work groups are constants of specialisation: processors want many threads, software that plays one wants few,
// as each barrier costs it dear. Nothing here depends on the size of subgroups, and no subgroup operation is used.
#include "state.glsl"

layout(constant_id = 31) const bool IS_SOFTWARE = false; // see pipeline.c
#include "vectors.glsl"

layout(local_size_x_id = 0) in;

layout(push_constant, std430) uniform pushed
{
    state_of_light state;
    step_of_frame step_now;
    uint parameter[4];
} push;

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
