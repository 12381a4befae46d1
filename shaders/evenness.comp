#version 460
// SPDX-License-Identifier: MIT
//
// Whether the light of a face is even: a face for each work group. As judge_face() in src/sampling/evenness.c, but for
// rounding.
#include "common.glsl"
#include "fixed_point.glsl"
#include "face_sums.glsl"
#include "division.glsl"
#include "face_light.glsl"

const float ANGLE = 2.0943951; // of a face, sr

shared float parts[gl_WorkGroupSize.x];

float moment(uint tile, uint which)
{
    return STATE.moments.at[3u * tile + which];
}

// Half the square of the difference between two tiles' means is what a border between them adds.
float step_between(uint a, uint b)
{
    const float difference = moment(a, 1u) / moment(a, 0u) - moment(b, 1u) / moment(b, 0u);
    return 0.25 * difference * difference * (moment(a, 0u) + moment(b, 0u)) * 0.5;
}

float variance_of(uint tile)
{
    const float variance = moment(tile, 2u) - moment(tile, 1u) * moment(tile, 1u) / moment(tile, 0u);
    return max(variance, 0.0); // a constant's may round to less
}

void main()
{
    begin_with_state();
    const uint face = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x, edge = STATE.tiles_per_edge;
    float sum = 0.0;
    for (uint i = thread; i < edge * edge; i += gl_WorkGroupSize.x) {
        const uint tile = face * edge * edge + i;
        sum += variance_of(tile);
        if (i % edge > 0u)
            sum += step_between(tile - 1u, tile);
        if (i >= edge)
            sum += step_between(tile - edge, tile);
    }
    parts[thread] = sum;
    barrier();
    if (thread != 0u)
        return;
    for (uint i = 1u; i < gl_WorkGroupSize.x; i++)
        sum += parts[i];
    const float mean = light_of_face(face).mean;
    if (!(sum <= RULE_EVEN_VARIANCE * mean * mean * ANGLE))
        atomicAdd(STATE.sums.all.uneven_faces, 1u);
}
