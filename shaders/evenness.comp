#version 460
// SPDX-License-Identifier: MIT
//
// Whether the light of a face is even: a face for each work group. As judge_face() in src/sampling/evenness.c.
#include "common.glsl"

const double GREATEST_VARIANCE = 0.016LF, ANGLE = 2.0943951023931953LF; // of a face, sr

shared double parts[gl_WorkGroupSize.x];

double moment(uint tile, uint which)
{
    return STATE.moments.at[3u * tile + which];
}

// Half the square of the difference between two tiles' means is what a border between them adds.
double step_between(uint a, uint b)
{
    const double difference = moment(a, 1u) / moment(a, 0u) - moment(b, 1u) / moment(b, 0u);
    return 0.25LF * difference * difference * (moment(a, 0u) + moment(b, 0u)) * 0.5LF;
}

double variance_of(uint tile)
{
    const double variance = moment(tile, 2u) - moment(tile, 1u) * moment(tile, 1u) / moment(tile, 0u);
    return variance > 0.0LF ? variance : 0.0LF; // a constant's may round to less
}

void main()
{
    begin_with_state();
    const uint face = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x, edge = STATE.tiles_per_edge;
    double sum = 0.0LF;
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
    const double mean = STATE.sums.all.flux[face] / ANGLE, most = GREATEST_VARIANCE * mean * mean * ANGLE;
    if (!(sum <= most + 1e-12LF * mean * mean))
        atomicAdd(STATE.sums.all.uneven_faces, 1u);
}
