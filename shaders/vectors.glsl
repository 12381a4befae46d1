// SPDX-License-Identifier: MIT
// vectors.glsl - reading vectors from memory. Needs state.glsl and the constant IS_SOFTWARE.

layout(buffer_reference, std430, buffer_reference_align = 16) buffer halves_of_vectors
{
    u64vec2 at[];
};

// Software fetches each number of each thread by itself, so that two at a time are half the work.
vec4 vector_at(vectors all, uint index)
{
    if (!IS_SOFTWARE)
        return all.at[index];
    const u64vec2 halves = halves_of_vectors(all).at[index];
    return vec4(uintBitsToFloat(unpackUint2x32(halves.x)), uintBitsToFloat(unpackUint2x32(halves.y)));
}
