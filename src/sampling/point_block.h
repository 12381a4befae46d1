/* SPDX-License-Identifier: MIT
 * point_block.h - shading points side by side, so that what a point costs before its first sample is done for a whole
 * register of points at once. */
#ifndef HELIOSTAT_SRC_POINT_BLOCK_H
#define HELIOSTAT_SRC_POINT_BLOCK_H

#include "env/cube.h"
#include "sampling/strategy.h"

#include <stdalign.h>

enum { POINT_BLOCK = 32 };

/* A coordinate in an array each. */
typedef struct point_vectors {
    alignas(64) float x[POINT_BLOCK];
    alignas(64) float y[POINT_BLOCK];
    alignas(64) float z[POINT_BLOCK];
} point_vectors;

/* Arrays have room for whole registers: kernels compute points past count, too, which must hold numbers. */
typedef struct point_block {
    uint32_t count;
    bool is_free; /* nothing is in the way of samples, so that they need not show what is known */
    point_vectors normal, geometric_normal, view; /* in world space, until a kernel turns them to the map's */
    alignas(64) uint32_t seed[POINT_BLOCK];
    alignas(64) float surface_share[POINT_BLOCK]; /* part of its samples that the surface technique takes */
    alignas(64) uint32_t lobe_class[POINT_BLOCK]; /* see lobe_variance.h */
    bool weighs_tiles[POINT_BLOCK];               /* in place of reading pools of bins */
    /* How each divides its samples among the techniques, see helio_counts. */
    alignas(64) float expected[TECHNIQUES][POINT_BLOCK];
    alignas(64) float rounding[POINT_BLOCK]; /* where systematic rounding starts, in [0, 1) */
    alignas(64) uint32_t realised[TECHNIQUES][POINT_BLOCK];
    alignas(64) uint32_t pools[CUBE_FACES][POINT_BLOCK];   /* that each light technique reads */
    alignas(64) uint32_t windows[CUBE_FACES][POINT_BLOCK]; /* first sample that is read, in the arrays of all pools */
    alignas(64) float scales[CUBE_FACES][POINT_BLOCK];     /* 1 / expected, or 0 for pools that are not read */
} point_block;

static inline vec3 point_vector(const point_vectors *vectors, uint32_t i)
{
    return (vec3){vectors->x[i], vectors->y[i], vectors->z[i]};
}

static inline void point_vector_put(point_vectors *vectors, uint32_t i, vec3 vector)
{
    vectors->x[i] = vector.x;
    vectors->y[i] = vector.y;
    vectors->z[i] = vector.z;
}

#endif
