// SPDX-License-Identifier: MIT
// random.glsl - hashes and low-discrepancy points: the functions of src/core/random.h.

uint hash(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

uint hash_combine(uint a, uint b)
{
    return hash(a ^ (hash(b + 0x9e3779b9u) * 0x85ebca6bu + 0xc2b2ae35u));
}

float unit_float(uint x)
{
    return float(x >> 8) * (1.0 / 16777216.0);
}

uint pascal_transform(uint x)
{
    x ^= (x & 0xaaaaaaaau) >> 1;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xff00ff00u) >> 8;
    return x ^ (x >> 16);
}

uint sobol_reversed(uint index, uint dimension)
{
    return dimension == 0u ? index : pascal_transform(index);
}

uint owen_scramble_reversed(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return bitfieldReverse(x);
}

uint dimension_seed(uint seed, uint dimension)
{
    return hash_combine(seed, dimension);
}

uint scrambled_sobol(uint index, uint dimension, uint seed)
{
    return owen_scramble_reversed(sobol_reversed(index, dimension), dimension_seed(seed, dimension));
}

// Somewhere in stratum `index` of `count`, below 1.
float stratified_unit(uint index, uint count, uint seed)
{
    precise float x = (float(index) + unit_float(hash(seed + index))) * (1.0 / float(count));
    return min(x, 0.99999994);
}
