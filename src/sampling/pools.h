/* SPDX-License-Identifier: MIT
 * pools.h - the pools from inside: structures of arrays, so that neighbouring samples are neighbours in memory. */
#ifndef HELIOSTAT_SRC_POOLS_H
#define HELIOSTAT_SRC_POOLS_H

#include "sampling/strategy.h"
#include "sampling/tables.h"

enum {
    POOL_SHARE = 8
}; /* a point takes at most one eighth of a pool, so that its neighbours have windows of their own */

struct helio_pools {
    const helio_tables *tables;
    helio_strategy strategy; /* never AUTO */
    strategy_parts parts;
    uint32_t length;      /* M */
    uint32_t count;       /* pools: 6, 1 or 0 */
    uint32_t pool_length; /* samples in each: M, or 6 M where there is one pool */
    uint64_t frame;       /* of the environment, when drawn */
    float *memory;
    /* Each [count][pool_length]. Directions in the map's space; density given the pool, 1/sr. */
    float *direction_x, *direction_y, *direction_z;
    float *red, *green, *blue;
    float *density;
};

/* First sample of the window from which a point reads `wanted` samples: windows are aligned to powers of two, so that
 * each is a net of its own. choice: any hash. */
uint32_t pools_window(const helio_pools *pools, uint32_t wanted, uint32_t choice);

#endif
