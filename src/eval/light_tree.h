/* SPDX-License-Identifier: MIT
 * light_tree.h - the light of a cube in squares of all sizes, so that smooth functions can be summed against all texels
 * at once.
 *
 * Each face is divided into four squares, these into four, and so on down to leaves of some texels. In a square, the
 * integral of radiance x F over the texels is sum_k weight_k F(point_k) over 8 x 8 Gauss points: exact where
 * F(u, v) = sqrt(1 + u^2 + v^2) f(direction) is a polynomial of degree 7 in u and in v. The cosine to a normal is one
 * of degree 1, in squares of any size. */
#ifndef HELIOSTAT_SRC_LIGHT_TREE_H
#define HELIOSTAT_SRC_LIGHT_TREE_H

#include "env/environment.h"
#include "eval/gauss.h"

enum {
    TREE_ORDER = 8,
    TREE_POINTS = TREE_ORDER * TREE_ORDER,
    LEAF_TEXELS = 16,   /* at most along the edge of a leaf ... */
    LEAF_COLUMNS = 128, /* ... unless there would be more leaves than these along the edge of a face, */
    LEAF_LIMIT = CUBE_MAX_SIZE / LEAF_COLUMNS /* so that it may be these */
};

/* A rectangle of a face. */
typedef struct face_rectangle {
    double u0, u1, v0, v1;
} face_rectangle;

typedef struct light_tree {
    helio_context *context;
    const helio_environment *environment;
    uint32_t depth; /* of the leaves; the faces have depth 0 */
    gauss_rule rule;
    float *weights; /* [nodes][3][TREE_POINTS], point row * TREE_ORDER + column */
    uint8_t *lit;   /* [nodes]: is there a texel that is not black? */
} light_tree;

typedef struct light_node {
    uint32_t face, depth, row, column; /* of 2^depth each way */
} light_node;

/* Takes the memory and gathers the environment's current frame. Leaves the tree empty if it fails. */
helio_status light_tree_create(const helio_environment *environment, light_tree *tree);
void light_tree_destroy(light_tree *tree);

/* First texel of the k-th of 2^depth columns or rows of nodes; k may be 2^depth. */
static inline uint32_t light_tree_texel(const light_tree *tree, uint32_t depth, uint32_t k)
{
    return (uint32_t)(((uint64_t)k * tree->environment->size) >> depth);
}

static inline size_t light_tree_index(const light_node *node)
{
    size_t before = 2 * (((size_t)1 << (2 * node->depth)) - 1); /* 6 (1 + 4 + ... + 4^(depth - 1)) */
    return before + ((((size_t)node->face << node->depth) + node->row) << node->depth) + node->column;
}

static inline double light_tree_coordinate(const light_tree *tree, uint32_t texel)
{
    return 2.0 * texel / tree->environment->size - 1.0;
}

face_rectangle light_tree_rectangle(const light_tree *tree, const light_node *node);

#endif
