/* SPDX-License-Identifier: MIT
 * bvh.h - a tree of boxes over the triangles of a mesh, in the form that shaders walk through. */
#ifndef HELIOSTAT_SRC_VULKAN_BVH_H
#define HELIOSTAT_SRC_VULKAN_BVH_H

#include <heliostat/scene.h>

enum { BVH_LEAF_TRIANGLES = 4 };

/* A child: the number of a node, or BVH_LEAF | first triangle << 3 | number of triangles - 1. */
#define BVH_LEAF 0x80000000u

/* The boxes of both children: least and greatest corners. */
typedef struct bvh_node {
    float left_least[3];
    uint32_t left;
    float left_greatest[3];
    uint32_t right;
    float right_least[3];
    float unused;
    float right_greatest[3];
    float unused_too;
} bvh_node;
_Static_assert(sizeof(bvh_node) == 64, "as in rays.glsl");

typedef struct bvh {
    helio_context *context;
    uint32_t node_count, triangle_count;
    bvh_node *nodes;          /* [node_count]: at least 1, the first is the root */
    float (*triangles)[3][4]; /* [triangle_count]: corners, in the order of the leaves */
    uint32_t *order;          /* [triangle_count]: which of the mesh's each is */
} bvh;

/* HELIO_ERR_UNSUPPORTED for a mesh of more triangles than a leaf can number, 2^28. */
helio_status bvh_create(helio_context *context, const helio_mesh *mesh, bvh *out);
void bvh_destroy(bvh *tree);

#endif
