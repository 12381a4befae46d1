// SPDX-License-Identifier: MIT
// state.glsl - the structures that are shared with the host, and copies of those in hand.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "layout.h"
#include "sampling/rules.h"

layout(buffer_reference, std430, buffer_reference_align = 8) buffer state_of_light
{
    layout_state all;
};

layout(buffer_reference, std430, buffer_reference_align = 8) buffer step_of_frame
{
    layout_step all;
};

// What lies in memory would be looked up anew after each write, so it is copied before the work begins. Compilers leave
// out what is not used.
layout_state STATE;
layout_step STEP;
