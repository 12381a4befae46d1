#version 460
// SPDX-License-Identifier: MIT
//
// The triangles of the mesh as the camera sees them, in the order of the tree. Depth is near / distance, which floats
// resolve alike however far away it is.
#include "state.glsl"

layout(push_constant, std430) uniform pushed
{
    state_of_light state;
    step_of_frame step_now;
    uint parameter[4];
} push;

layout(location = 0) flat out uint triangle;

vec3 camera_vector(uint i)
{
    step_of_frame now = push.step_now;
    return vec3(now.all.camera[3u * i], now.all.camera[3u * i + 1u], now.all.camera[3u * i + 2u]);
}

void main()
{
    step_of_frame now = push.step_now;
    const uint vertex = uint(gl_VertexIndex);
    const vec3 corner = now.all.triangles.at[vertex].xyz - camera_vector(0u);
    const float half_height = now.all.camera[12], aspect = now.all.camera[13], near = 1e-5 * now.all.extent;
    triangle = vertex / 3u;
    gl_Position = vec4(dot(corner, camera_vector(2u)) / (half_height * aspect),
                       -dot(corner, camera_vector(3u)) / half_height, near, dot(corner, camera_vector(1u)));
}
