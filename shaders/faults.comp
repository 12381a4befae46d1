#version 460
// SPDX-License-Identifier: MIT
//
// Counts pixels of a map that are no light, some with each thread: pixel_fault_of() of pixel_fault.h.
#include "common.glsl"
#include "map.glsl"

layout(constant_id = 2) const uint PIXELS = 16u; // of a thread

uvec3 fault_of(uvec3 bits)
{
    const uvec3 size = bits & ~SIGN;
    if (any(greaterThan(size, uvec3(INFINITE_BITS))))
        return uvec3(1u, 0u, 0u);
    if (any(greaterThan(size, uvec3(BRIGHTEST_BITS))))
        return uvec3(0u, 1u, 0u);
    return uvec3(0u, 0u, any(greaterThan(bits, uvec3(SIGN))) ? 1u : 0u); // -0 is not
}

void main()
{
    begin_with_map();
    const uint count = MAP.width * MAP.height, threads = gl_WorkGroupSize.x;
    const uint first = group_index() * threads * PIXELS + gl_LocalInvocationID.x;
    uvec3 faults = uvec3(0u);
    for (uint i = 0u; i < PIXELS && first + i * threads < count; i++)
        faults += fault_of(pixel_bits(first + i * threads));
    if (faults == uvec3(0u))
        return;
    atomicAdd(MAP.faults.all.nan, faults.x);
    atomicAdd(MAP.faults.all.infinite, faults.y);
    atomicAdd(MAP.faults.all.negative, faults.z);
}
