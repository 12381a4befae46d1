/* SPDX-License-Identifier: MIT
 * pools.h - the pools from inside: structures of arrays, so that neighbouring samples are neighbours in memory. */
#ifndef HELIOSTAT_SRC_POOLS_H
#define HELIOSTAT_SRC_POOLS_H

#include "sampling/control.h"
#include "sampling/elementary.h"
#include "sampling/normal_bins.h"
#include "sampling/strategy.h"
#include "sampling/tables.h"

enum {
    POOL_SHARE = 8, /* a point takes at most one eighth of a pool, so that its neighbours have windows of their own */
    POOL_SHARE_OF_BIN = 4, /* ... one fourth of the pool of a bin, as its neighbours mostly read other pools as well */
    POOL_RUN_MOST = 256,   /* samples of the pool of a bin that are drawn together */
    POOL_PADDING = 16      /* floats that a kernel may read past the end: the lanes of the widest register */
};

/* The numbers of a sample, each in an array of its own. */
enum sample_array {
    SAMPLE_X,
    SAMPLE_Y,
    SAMPLE_Z,
    SAMPLE_RED,
    SAMPLE_GREEN,
    SAMPLE_BLUE,
    SAMPLE_DENSITY,
    SAMPLE_ARRAYS, /* what blocks of samples hold too, see gathering.h */

    /* Radiance / density, which is all that a point needs to know where no other technique can draw the sample. */
    SAMPLE_WEIGHTED_RED = SAMPLE_ARRAYS,
    SAMPLE_WEIGHTED_GREEN,
    SAMPLE_WEIGHTED_BLUE,
    POOL_ARRAYS
};

struct helio_pools {
    const helio_tables *tables;
    helio_strategy strategy; /* never AUTO */
    strategy_parts parts;
    uint32_t length;        /* M */
    uint32_t count;         /* pools: 6, 1, 6 B^2 or 0 */
    uint32_t techniques;    /* pools of which a point reads: 6, 1 or 0 */
    uint32_t pool_length;   /* samples in each: M, or 6 M where there is one pool */
    bool is_automatic;      /* the strategy was chosen by AUTO, and so may be left where ... */
    bool is_even;           /* ... the light is: all samples are then the surface's */
    normal_bins *bins;      /* what the pools of STRATEGY_LIGHT_BINS are drawn from; NULL for others */
    light_control *control; /* what is known of the light of these bins; NULL for others */
    uint64_t frame;         /* of the environment, when drawn */
    /* [POOL_ARRAYS], arrays `stride` floats apart: [count][pool_length] each, and POOL_PADDING more that may be read.
     * Directions in the map's space, radiance, density given the pool (1/sr). */
    float *samples;
    size_t stride;
};

/* One of the arrays of a pool: [pool_length]. */
static inline float *pools_array(const helio_pools *pools, uint32_t pool, enum sample_array array)
{
    return pools->samples + (size_t)array * pools->stride + (size_t)pool * pools->pool_length;
}

/* face_place_density()'s unit for the density with which a pool draws a direction; for pools of faces it must be the
 * pool's own. */
static inline float pools_unit_density(const helio_pools *pools, uint32_t pool, const face_place *at)
{
    if (pools->bins != NULL)
        return normal_bins_unit_density(pools->bins, pool, at);
    const float unit = tables_unit_density(pools->tables, at);
    return pools->parts.light == STRATEGY_LIGHT_WHOLE ? unit * tables_face_probability(pools->tables, at->face) : unit;
}

/* That density, 1/sr. */
static inline float pools_density(const helio_pools *pools, uint32_t pool, const face_place *at)
{
    return face_place_density(at->u, at->v, tables_texel_weight(pools->tables, at),
                              pools_unit_density(pools, pool, at));
}

/* Samples of a bin's pool that are shared out to tiles together: as many as the widest window has, if that is not too
 * many. */
static inline uint32_t pools_run_of_bin(const helio_pools *pools)
{
    const uint32_t widest = pools->pool_length / POOL_SHARE_OF_BIN;
    return widest < POOL_RUN_MOST ? widest : POOL_RUN_MOST;
}

/* First sample of the window from which a point reads `wanted` samples, at least 1: windows are aligned to powers of
 * two, so that each is a net of its own. choice: any hash. */
static inline uint32_t pools_window(uint32_t pool_length, uint32_t wanted, uint32_t choice)
{
    /* As many bits as wanted - 1 has, from a float's exponent: loops over points become vectors. */
    int32_t bits = (bits_of_float((float)(int32_t)(wanted - 1)) >> 23) - 126;
    bits = wanted > 1 ? bits : 0;
    uint32_t windows = pool_length >> bits;
    return (uint32_t)(((uint64_t)choice * windows) >> 32) << bits;
}

#endif
