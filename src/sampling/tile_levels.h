/* SPDX-License-Identifier: MIT
 * tile_levels.h - the tree of tile_tree.h for all samples of a bin at once, level by level, by steps of each node's own;
 * for kernels.
 *
 * No group is left out, so that nodes are known by their numbers: the children of node k are nodes 16 k to 16 k + 15 of
 * the next level. On each level a sample is put at its place in the node, and lies in the child before which as many
 * others end as there are ends up to that place: they are counted, as a search would be guessed wrong at each turn. */
#ifndef HELIOSTAT_SRC_TILE_LEVELS_H
#define HELIOSTAT_SRC_TILE_LEVELS_H

#include "sampling/tile_tree.h"

enum { TILE_CHILDREN = 16 };
_Static_assert((int)TILE_CHILDREN == (int)TILE_GROUP && (int)TILE_CHILDREN == (int)TILE_RUN &&
                   (int)TILE_CHILDREN >= (int)TILE_RUNS,
               "what a node has at most");

/* Prefix sums over the nodes of each level; what is past the end of all repeats the last. */
typedef struct tile_levels {
    uint32_t all[2];
    uint32_t runs[TILE_CHILDREN + 1];
    uint32_t groups[TILE_CHILDREN * TILE_CHILDREN + 1];
    uint32_t tiles[TILES_MOST + 1];
} tile_levels;

/* sums: over `count` tiles, [count + 1]; the last is below 2^31. */
static inline void tile_levels_make(const uint32_t *sums, uint32_t count, tile_levels *levels)
{
    for (uint32_t i = 0; i <= count; i++)
        levels->tiles[i] = sums[i];
    for (uint32_t i = count + 1; i <= TILES_MOST; i++)
        levels->tiles[i] = sums[count];
    for (uint32_t i = 0; i <= TILE_CHILDREN * TILE_CHILDREN; i++)
        levels->groups[i] = levels->tiles[i < TILE_GROUPS ? i * TILE_GROUP : TILES_MOST];
    for (uint32_t i = 0; i <= TILE_CHILDREN; i++)
        levels->runs[i] = levels->groups[i * TILE_RUN];
    levels->all[0] = 0;
    levels->all[1] = sums[count];
}

/* Samples that are shared out, in the order of the nodes. */
typedef struct tile_samples {
    uint32_t count, seed;
    uint32_t *nodes;  /* [count] */
    uint32_t *places; /* [count]: in the prefix sums over the nodes */
} tile_samples;

/* Puts the samples of each node at equal steps through it. first: the number of node 0 for tile_tree_random(). */
static inline void tile_samples_place(tile_samples *samples, const uint32_t *sums, uint32_t first)
{
    for (uint32_t i = 0, end; i < samples->count; i = end) {
        const uint32_t node = samples->nodes[i], start = sums[node];
        for (end = i + 1; end < samples->count && samples->nodes[end] == node;)
            end++;
        tile_steps steps =
            tile_steps_own(sums[node + 1] - start, end - i, tile_tree_random(samples->seed, first + node));
        for (uint32_t k = i; k < end; k++, steps.place += steps.step)
            samples->places[k] = start + tile_steps_at(&steps);
    }
}

/* From each node to the child that holds the place. sums: over the children. */
static inline void tile_samples_descend(tile_samples *samples, const uint32_t *sums)
{
    for (uint32_t i = 0; i < samples->count; i++) {
        const int32_t place = (int32_t)samples->places[i];
        const int32_t *ends = (const int32_t *)sums + (size_t)samples->nodes[i] * TILE_CHILDREN + 1;
        int32_t below = 0;
#pragma omp simd reduction(+ : below)
        for (int k = 0; k < TILE_CHILDREN; k++)
            below += ends[k] <= place;
        samples->nodes[i] = samples->nodes[i] * TILE_CHILDREN + (uint32_t)below;
    }
}

/* Draws samples: positions of tiles and elements of their lists, in that order, [count] each. The same as
 * tile_tree_draw() makes of all of them. The sum of all tiles must not be 0. */
static inline void tile_levels_draw(const tile_levels *levels, const uint32_t *list_starts, uint32_t count,
                                    uint32_t seed, uint32_t *positions, uint32_t *elements)
{
    tile_samples samples = {count, seed, positions, elements};
    for (uint32_t i = 0; i < count; i++)
        positions[i] = 0;
    tile_samples_place(&samples, levels->all, TILE_TREE_ROOT);
    tile_samples_descend(&samples, levels->runs);
    tile_samples_place(&samples, levels->runs, TILE_TREE_RUNS);
    tile_samples_descend(&samples, levels->groups);
    tile_samples_place(&samples, levels->groups, TILE_TREE_GROUPS);
    tile_samples_descend(&samples, levels->tiles);
    tile_samples_place(&samples, list_starts, 0);
}

#endif
