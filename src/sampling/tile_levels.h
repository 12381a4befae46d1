/* SPDX-License-Identifier: MIT
 * tile_levels.h - the tree of tile_tree.h for all samples of a bin at once, level by level, by steps of each node's
 * own; for kernels.
 *
 * No group is left out, so that nodes are known by their numbers: the children of node k are nodes 16 k to 16 k + 15 of
 * the next level. On each level a sample is put at its place in the node, and lies in the child before which as many
 * others end as there are ends up to that place: they are counted, as a search would be guessed wrong at each turn. */
#ifndef HELIOSTAT_SRC_TILE_LEVELS_H
#define HELIOSTAT_SRC_TILE_LEVELS_H

#include "sampling/tile_tree.h"

/* Prefix sums over the nodes of each level; what is past the end of all repeats the last. */
typedef struct tile_levels {
    uint32_t all[2];
    uint32_t runs[TILE_CHILDREN + 1];
    uint32_t groups[TILE_GROUPS + 1];
    uint32_t tiles[TILES_MOST + 1];
} tile_levels;

/* sums: over `count` tiles, [count + 1]; the last is below 2^31. */
static inline void tile_levels_make(const uint32_t *sums, uint32_t count, tile_levels *levels)
{
    for (uint32_t i = 0; i <= count; i++)
        levels->tiles[i] = sums[i];
    for (uint32_t i = count + 1; i <= TILES_MOST; i++)
        levels->tiles[i] = sums[count];
    for (uint32_t i = 0; i <= TILE_GROUPS; i++)
        levels->groups[i] = levels->tiles[i * TILE_GROUP];
    for (uint32_t i = 0; i <= TILE_CHILDREN; i++)
        levels->runs[i] = levels->groups[i < TILE_RUNS ? i * TILE_RUN : TILE_GROUPS];
    levels->all[0] = 0;
    levels->all[1] = sums[count];
}

enum {
    TILE_SAMPLES_MOST = 256,
    TILE_LANES = 16, /* samples, or children, that are looked at side by side */
};

/* Samples that are shared out, in the order of the nodes: [count] of each array, and lanes that may be read and written
 * past them. */
typedef struct tile_samples {
    uint32_t count, seed;
    alignas(64) uint32_t nodes[TILE_SAMPLES_MOST + TILE_LANES];    /* in the end the positions of tiles */
    alignas(64) uint32_t places[TILE_SAMPLES_MOST + TILE_LANES];   /* in the prefix sums over the nodes; in the end the
                                                                      elements of all lists */
    alignas(64) uint32_t children[TILE_SAMPLES_MOST + TILE_LANES]; /* for a while */
    alignas(64) uint32_t randoms[TILE_SAMPLES_MOST];               /* of the nodes */
} tile_samples;

/* The end of those that have the same node as sample i; past the last comes no node. */
static inline uint32_t tile_samples_end(const tile_samples *samples, uint32_t i)
{
    const uint32_t node = samples->nodes[i];
    do
        i++;
    while (samples->nodes[i] == node);
    return i;
}

static inline void tile_samples_find_randoms(tile_samples *samples, uint32_t first)
{
    const uint32_t count = samples->count, seed = samples->seed;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++)
        samples->randoms[i] = tile_tree_random(seed, first + samples->nodes[i]);
}

/* Puts samples i ... end - 1, all those of their node, at equal steps through its part of the sums. */
static inline void tile_samples_place(tile_samples *samples, const uint32_t *sums, uint32_t i, uint32_t end)
{
    const uint32_t node = samples->nodes[i], start = sums[node], sum = sums[node + 1] - start;
    tile_steps steps = tile_steps_own(sum, end - i, samples->randoms[i]);
    for (; i < end; i++, steps.place += steps.step)
        samples->places[i] = start + tile_steps_at(&steps);
}

/* tile_child_at() for samples side by side: TILE_LANES, few enough that all children are looked at in registers. */
static inline void tile_samples_count_all_ends(const int32_t *restrict ends, const uint32_t *restrict places,
                                               uint32_t first_child, uint32_t *restrict children)
{
#pragma omp simd
    for (int lane = 0; lane < TILE_LANES; lane++) {
        const int32_t place = (int32_t)places[lane];
        int32_t below = 0;
        for (int child = 0; child < TILE_CHILDREN; child++)
            below += ends[child] <= place;
        children[lane] = first_child + (uint32_t)below;
    }
}

/* From nodes that have many samples each to the children that hold their places. What is too much is overwritten by the
 * next. first: the number of node 0 for tile_tree_random(). sums: over the nodes, and over the children. */
static inline void tile_samples_descend_many(tile_samples *samples, uint32_t first, const uint32_t *sums,
                                             const uint32_t *child_sums)
{
    tile_samples_find_randoms(samples, first);
    for (uint32_t i = 0, end; i < samples->count; i = end) {
        const uint32_t first_child = samples->nodes[i] * TILE_CHILDREN;
        end = tile_samples_end(samples, i);
        tile_samples_place(samples, sums, i, end);
        for (uint32_t k = i; k < end; k += TILE_LANES)
            tile_samples_count_all_ends((const int32_t *)child_sums + first_child + 1, samples->places + k, first_child,
                                        samples->children + k);
    }
    for (uint32_t i = 0; i < samples->count; i++)
        samples->nodes[i] = samples->children[i];
}

/* The same for nodes that have few each. */
static inline void tile_samples_descend_few(tile_samples *samples, uint32_t first, const uint32_t *sums,
                                            const uint32_t *child_sums)
{
    tile_samples_find_randoms(samples, first);
    for (uint32_t i = 0, end; i < samples->count;) {
        const uint32_t first_child = samples->nodes[i] * TILE_CHILDREN;
        const int32_t *ends = (const int32_t *)child_sums + first_child + 1;
        end = tile_samples_end(samples, i);
        tile_samples_place(samples, sums, i, end);
        for (; i < end; i++)
            samples->nodes[i] = first_child + tile_child_at(ends, (int32_t)samples->places[i]);
    }
}

/* Elements at equal steps through the list of each tile. Most tiles have one sample, and are done all together. */
static inline void tile_samples_choose_elements(tile_samples *samples, const uint32_t *list_starts)
{
    const uint32_t count = samples->count;
    tile_samples_find_randoms(samples, 0);
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t start = list_starts[samples->nodes[i]], length = list_starts[samples->nodes[i] + 1] - start;
        samples->places[i] = start + (uint32_t)(((uint64_t)length * samples->randoms[i]) >> 32);
    }
    for (uint32_t i = 0, end; i < count; i = end) {
        end = tile_samples_end(samples, i);
        if (end - i > 1)
            tile_samples_place(samples, list_starts, i, end);
    }
}

/* Shares out `count` samples, at most TILE_SAMPLES_MOST: the same as tile_tree_draw() makes of all of them. The sum of
 * all tiles must not be 0. samples: all of its numbers must have been set once. */
static inline void tile_levels_draw(const tile_levels *levels, const uint32_t *list_starts, uint32_t count,
                                    uint32_t seed, tile_samples *samples)
{
    samples->count = count;
    samples->seed = seed;
    for (uint32_t i = 0; i < count; i++)
        samples->nodes[i] = 0;
    samples->nodes[count] = UINT32_MAX;
    tile_samples_descend_many(samples, TILE_TREE_ROOT, levels->all, levels->runs);
    tile_samples_descend_many(samples, TILE_TREE_RUNS, levels->runs, levels->groups);
    tile_samples_descend_few(samples, TILE_TREE_GROUPS, levels->groups, levels->tiles);
    tile_samples_choose_elements(samples, list_starts);
}

#endif
