/* SPDX-License-Identifier: MIT
 * random.h - hashes and low-discrepancy points; integers throughout, so that every machine draws the same. */
#ifndef HELIOSTAT_SRC_RANDOM_H
#define HELIOSTAT_SRC_RANDOM_H

#include <stdint.h>

/* A bijection of 32-bit integers in which every input bit changes every output bit with a probability near one half
 * (constants: C. Wellons, "hash-prospector", bias 0.17). */
static inline uint32_t hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static inline uint32_t hash_combine(uint32_t a, uint32_t b)
{
    return hash(a ^ (hash(b + 0x9e3779b9u) * 0x85ebca6bu + 0xc2b2ae35u));
}

/* The upper 24 bits as a float in [0, 1): never 1, which a plain division could round to. */
static inline float unit_float(uint32_t x)
{
    return (float)(int32_t)(x >> 8) * 0x1p-24f;
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/* The bits of the second coordinate of Sobol's sequence from the lowest up: Pascal's triangle modulo 2, which is a
 * product of five sparse matrices. */
static inline uint32_t pascal_transform(uint32_t x)
{
    x ^= (x & 0xaaaaaaaau) >> 1;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xff00ff00u) >> 8;
    return x ^ (x >> 16);
}

/* sobol() with its bits reversed, which is how scrambling wants it. */
static inline uint32_t sobol_reversed(uint32_t index, uint32_t dimension)
{
    return dimension == 0 ? index : pascal_transform(index);
}

/* Coordinate `dimension` (0 or 1) of point `index` of Sobol's sequence, as a fraction of 2^32. It is a (0,2)-sequence:
 * every aligned block of 2^k points has one point in each elementary interval. */
static inline uint32_t sobol(uint32_t index, uint32_t dimension)
{
    return reverse_bits(sobol_reversed(index, dimension));
}

/* Owen's nested uniform scrambling of a fraction of 2^32, by hash: each bit is flipped by a hash of the bits above it,
 * so that nets stay nets and each point becomes uniform (Laine and Karras 2011, Burley 2020; constants by N. Vegdahl
 * 2021). Takes the fraction with its bits reversed. */
static inline uint32_t owen_scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

/* The seed that scrambles one coordinate of the sequence that belongs to seed. */
static inline uint32_t dimension_seed(uint32_t seed, uint32_t dimension)
{
    return hash_combine(seed, dimension);
}

/* One coordinate of the Owen-scrambled sequence that belongs to seed. */
static inline uint32_t scrambled_sobol(uint32_t index, uint32_t dimension, uint32_t seed)
{
    return owen_scramble_reversed(sobol_reversed(index, dimension), dimension_seed(seed, dimension));
}

/* A third coordinate, below 1, for sets whose size is known: somewhere in stratum `index` of as many as there are
 * points. With the sequence's two, 2^k points are a (0,k,3)-net; and sets of any size, of which the sequence alone
 * makes nets only where it is a power of two, are even in this one. A point alone is not uniform, all of them together
 * are. */
static inline float stratified_unit(uint32_t index, float per_point, uint32_t seed)
{
    const float x = ((float)(int32_t)index + unit_float(hash(seed + index))) * per_point;
    return x < 0x1.fffffep-1f ? x : 0x1.fffffep-1f;
}

#endif
