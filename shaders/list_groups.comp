#version 460
// SPDX-License-Identifier: MIT
//
// How many work groups the lists of points and misses are worth, by a single thread: for points side by side, for points
// one by one, for misses. parameter[0]: misses of a group.
#include "common.glsl"

const uint ACROSS = 32768u; // every device takes as many side by side

void put(uint which, uint groups)
{
    const uint across = min(groups, ACROSS);
    STEP.groups_of_lists.at[3u * which] = across;
    STEP.groups_of_lists.at[3u * which + 1u] = across > 0u ? (groups + across - 1u) / across : 1u;
    STEP.groups_of_lists.at[3u * which + 2u] = 1u;
}

void main()
{
    begin_with_step();
    const uint points = STEP.counts_of_lists.at[0], misses = STEP.counts_of_lists.at[1];
    put(0u, (points + STEP.points_of_group - 1u) / STEP.points_of_group);
    put(1u, points);
    put(2u, (misses + push.parameter[0] - 1u) / push.parameter[0]);
}
