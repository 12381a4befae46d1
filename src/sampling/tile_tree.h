/* SPDX-License-Identifier: MIT
 * tile_tree.h - how many of some samples each tile gets, and which of its list: shared out down a tree, from all tiles
 * to runs of groups, from a run to its groups, from a group to its tiles; for kernels.
 *
 * A node hands its n samples on by places at equal steps through the sum of its children's weights. Where the first is
 * follows from a random number that is the node's own and hangs on nothing but the node and the seed: where light
 * changes a little, samples move within the nodes that it changes, and most others keep theirs. Steps are of two kinds:
 *
 * - the node's own, its sum / n: what happens elsewhere only matters to it by n. Nothing is steadier.
 * - the same for all nodes, all weights / all samples: each node then gets its expected number rounded up or down, so
 *   that the error is less; but where the sum of all changes all steps do.
 *
 * Points walk down the tree one node after the other; bins, which weigh all tiles, share all samples of a level out
 * together by tile_levels.h, of which the first kind here is the plain version. See docs/method.md. */
#ifndef HELIOSTAT_SRC_TILE_TREE_H
#define HELIOSTAT_SRC_TILE_TREE_H

#include "core/random.h"
#include "sampling/fixed_point.h"
#include "sampling/normal_bins.h"

/* What is shared out by. */
typedef struct tile_tree {
    const uint32_t *sums;        /* [TILE_GROUPS + 1]: prefix sums over groups, below 2^31 */
    const uint32_t *weights;     /* [TILES_MOST], of groups for which know() was called; they sum to their group's */
    const uint32_t *list_starts; /* [TILES_MOST + 1] */
    void (*know)(void *user, uint32_t group); /* NULL, or called before the weights of a group are read */
    void *user;
    const listed_sample *listed; /* NULL, or what samples are to be read from: it is sent for */
} tile_tree;

/* The random number of a node: of a tile by its position, and of these. */
enum {
    TILE_TREE_GROUPS = TILES_MOST,
    TILE_TREE_RUNS = TILE_TREE_GROUPS + TILE_GROUPS,
    TILE_TREE_ROOT = TILE_TREE_RUNS + TILE_RUNS,
    TILE_TREE_ORDER, /* of the samples; no node */
};

static inline uint32_t tile_tree_random(uint32_t seed, uint32_t node)
{
    return hash(seed + node * 0x9e3779b9u);
}

/* The places that a node's samples still have to take, in units of 2^-32 of a weight: steps fall short of the whole by
 * less than one of these each. */
typedef struct tile_steps {
    uint64_t place, step;
    uint32_t left; /* samples */
} tile_steps;

static inline uint64_t tile_steps_part(uint64_t x, uint32_t fraction)
{
    return (x >> 32) * fraction + (((x & UINT32_MAX) * fraction) >> 32);
}

/* By steps of the node's own: from a random part of one. */
static inline tile_steps tile_steps_own(uint32_t sum, uint32_t samples, uint32_t random)
{
    if (samples == 1)
        return (tile_steps){(uint64_t)sum * random, 0, 1};
    const uint64_t step = ((uint64_t)sum << 32) / samples;
    return (tile_steps){tile_steps_part(step, random), step, samples};
}

/* By a step that is given, which is not 0: from a random one of the starts with which there are so many places below
 * the sum. These are those below what the sum is more than a multiple of the step if the number is rounded up, and the
 * others if it is rounded down. */
static inline tile_steps tile_steps_given(uint32_t sum, uint32_t samples, uint64_t step, uint32_t random)
{
    const uint64_t whole = (uint64_t)sum << 32;
    if (samples == 1 && whole < step)
        return (tile_steps){(uint64_t)sum * random, 0, 1};
    const int64_t rest = (int64_t)(whole - samples * step);
    const uint64_t start = rest < 0 ? tile_steps_part((uint64_t)rest + step, random)
                                    : (uint64_t)rest + tile_steps_part(step - (uint64_t)rest, random);
    return (tile_steps){start, step, samples};
}

/* The next place in whole weights: it lies in the child whose sum with all before it is the first above this. */
static inline uint32_t tile_steps_at(const tile_steps *steps)
{
    return (uint32_t)(steps->place >> 32);
}

enum { TILE_STEPS_FEW = 8 }; /* fewer are taken one by one sooner than by a division */

/* Steps over the places below a sum, of which the next is one, and returns how many they were. */
static inline uint32_t tile_steps_take(tile_steps *steps, uint32_t sum)
{
    const uint32_t left = steps->left;
    if (left > TILE_STEPS_FEW) {
        const uint64_t step = steps->step > 0 ? steps->step : 1; /* as it is: no sum of weights is 0 */
        const uint64_t below = ((((uint64_t)sum << 32) - 1) - steps->place) / step + 1;
        const uint32_t count = below < left ? (uint32_t)below : left;
        steps->place += count * steps->step;
        steps->left -= count;
        return count;
    }
    do
        steps->place += steps->step;
    while (--steps->left > 0 && tile_steps_at(steps) < sum);
    return left - steps->left;
}

/* On the way down: of all samples, those from `first` on, `count` of them, are wanted; `index` is the next. */
typedef struct tile_walk {
    const tile_tree *tree;
    uint64_t step; /* of all nodes, or 0 */
    uint32_t seed, first, count, index;
    tile_draw *draws;
} tile_walk;

static inline tile_steps tile_walk_begin(const tile_walk *w, uint32_t sum, uint32_t samples, uint32_t node)
{
    const uint32_t random = tile_tree_random(w->seed, node);
    return w->step != 0 ? tile_steps_given(sum, samples, w->step, random) : tile_steps_own(sum, samples, random);
}

static inline void tile_walk_put(tile_walk *w, uint32_t element, uint32_t position)
{
    if (w->index - w->first < w->count) {
        w->draws[w->index - w->first] = (tile_draw){element, position};
        if (w->tree->listed != NULL)
            __builtin_prefetch(&w->tree->listed[element]);
    }
    w->index++;
}

/* Elements at equal steps through the list, from a random start; mostly there is one. */
static inline void tile_walk_tile(tile_walk *w, uint32_t position, uint32_t samples)
{
    const uint32_t start = w->tree->list_starts[position], length = w->tree->list_starts[position + 1] - start;
    const uint32_t random = tile_tree_random(w->seed, position);
    if (samples == 1) {
        tile_walk_put(w, start + (uint32_t)(((uint64_t)length * random) >> 32), position);
        return;
    }
    for (tile_steps steps = tile_steps_own(length, samples, random); steps.left > 0; steps.left--) {
        tile_walk_put(w, start + tile_steps_at(&steps), position);
        steps.place += steps.step;
    }
}

enum { TILE_CHILDREN = 16 };
_Static_assert((int)TILE_CHILDREN == (int)TILE_GROUP && (int)TILE_CHILDREN == (int)TILE_RUN &&
                   (int)TILE_CHILDREN >= (int)TILE_RUNS,
               "what a node has at most");

/* The child that holds a place: as many end up to it. They are counted side by side, as a search would be guessed wrong
 * at each turn. */
static inline uint32_t tile_child_at(const int32_t *ends, int32_t place)
{
    int32_t below = 0;
#pragma omp simd reduction(+ : below)
    for (int child = 0; child < TILE_CHILDREN; child++)
        below += ends[child] <= place;
    return (uint32_t)below;
}

/* Most tiles of a group get no sample or one, and so each sample looks for its own. */
static inline void tile_walk_group(tile_walk *w, uint32_t group, uint32_t samples)
{
    const uint32_t total = w->tree->sums[group + 1] - w->tree->sums[group], first = group * TILE_GROUP;
    tile_steps steps = tile_walk_begin(w, total, samples, TILE_TREE_GROUPS + group);
    if (w->tree->know != NULL)
        w->tree->know(w->tree->user, group);
    const uint32_t *weights = w->tree->weights + first;
    uint32_t starts[TILE_CHILDREN];
    int32_t ends[TILE_CHILDREN];
    fixed_point_scan(weights, TILE_CHILDREN, 0, starts);
#pragma omp simd
    for (uint32_t i = 0; i < TILE_CHILDREN; i++)
        ends[i] = (int32_t)(starts[i] + weights[i]);
    uint32_t tile = tile_child_at(ends, (int32_t)tile_steps_at(&steps)), count = 1;
    while (--steps.left > 0) {
        steps.place += steps.step;
        const uint32_t next = tile_child_at(ends, (int32_t)tile_steps_at(&steps));
        if (next != tile) {
            tile_walk_tile(w, first + tile, count);
            tile = next;
            count = 0;
        }
        count++;
    }
    tile_walk_tile(w, first + tile, count);
}

/* True where a node's samples are none of those that are wanted: they are left out. */
static inline bool tile_walk_skips(tile_walk *w, uint32_t samples)
{
    const bool skips = w->index + samples <= w->first || w->index >= w->first + w->count;
    w->index += skips ? samples : 0;
    return skips;
}

static inline void tile_walk_run(tile_walk *w, uint32_t run, uint32_t samples)
{
    const uint32_t *sums = w->tree->sums + (size_t)run * TILE_RUN;
    tile_steps steps = tile_walk_begin(w, sums[TILE_RUN] - sums[0], samples, TILE_TREE_RUNS + run);
    for (uint32_t k = 0; steps.left > 0;) {
        while (sums[k + 1] - sums[0] <= tile_steps_at(&steps))
            k++;
        const uint32_t some = tile_steps_take(&steps, sums[k + 1] - sums[0]);
        if (!tile_walk_skips(w, some))
            tile_walk_group(w, run * TILE_RUN + k, some);
    }
}

/* Of `samples` samples, which are in the order of the tiles, those from `first` on, `count` of them. is_even: steps are
 * the same for all nodes. The sum of all weights must not be 0. */
static inline __attribute__((always_inline)) void tile_tree_draw(const tile_tree *tree, bool is_even, uint32_t samples,
                                                                 uint32_t first, uint32_t count, uint32_t seed,
                                                                 tile_draw *draws)
{
    const uint32_t total = tree->sums[TILE_GROUPS];
    tile_walk w = {.tree = tree, .seed = seed, .first = first, .count = count, .draws = draws};
    w.step = is_even ? ((uint64_t)total << 32) / samples : 0;
    tile_steps steps = tile_walk_begin(&w, total, samples, TILE_TREE_ROOT);
    for (uint32_t run = 0; steps.left > 0;) {
        while (tree->sums[(run + 1) * TILE_RUN] <= tile_steps_at(&steps))
            run++;
        const uint32_t some = tile_steps_take(&steps, tree->sums[(run + 1) * TILE_RUN]);
        if (!tile_walk_skips(&w, some))
            tile_walk_run(&w, run, some);
    }
}

#endif
