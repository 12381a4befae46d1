/* SPDX-License-Identifier: MIT
 *
 * The tree of boxes holds every triangle once, inside of all boxes above it, and is no deeper than the shaders' stacks;
 * also for meshes that cannot be divided well. */
#include "support.h"

#include "vulkan/bvh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 }; /* STACK in rays.glsl */

/* Triangles with all corners in a cube of this side; of a soup, corners near to each other. */
static helio_mesh *make_mesh(helio_context *context, uint32_t count, float side, uint64_t seed)
{
    float *positions = calloc((size_t)count * 9, sizeof *positions);
    uint32_t *triangles = calloc((size_t)count * 3, sizeof *triangles);
    helio_mesh *mesh;
    assert_non_null(positions);
    assert_non_null(triangles);
    for (uint32_t i = 0; i < count * 3; i++) {
        triangles[i] = i;
        for (uint32_t axis = 0; axis < 3; axis++)
            positions[3 * i + axis] = i % 3 == 0
                                          ? side * (float)random_unit(&seed)
                                          : positions[3 * (i - 1) + axis] + 0.05f * (float)(random_unit(&seed) - 0.5);
    }
    const helio_mesh_desc desc = {
        .vertex_count = 3 * count, .triangle_count = count, .positions = positions, .triangles = triangles};
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    free(positions);
    free(triangles);
    return mesh;
}

typedef struct walk {
    const bvh *tree;
    uint8_t *seen; /* [triangles] */
    uint32_t nodes, deepest;
} walk;

static void look_at_leaf(walk *w, uint32_t leaf, const float least[3], const float greatest[3])
{
    const uint32_t first = (leaf & ~BVH_LEAF) >> 3, count = (leaf & 7u) + 1;
    assert_true(first + count <= w->tree->triangle_count);
    for (uint32_t i = first; i < first + count; i++) {
        w->seen[i]++;
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++) {
                const float at = w->tree->triangles[i][corner][axis];
                assert_true(at >= least[axis] && at <= greatest[axis]);
            }
    }
}

static void look_at(walk *w, uint32_t child, const float least[3], const float greatest[3], uint32_t depth)
{
    w->deepest = depth > w->deepest ? depth : w->deepest;
    if ((child & BVH_LEAF) != 0) {
        look_at_leaf(w, child, least, greatest);
        return;
    }
    const bvh_node *node = &w->tree->nodes[child];
    assert_true(child < w->tree->node_count);
    w->nodes++;
    for (int axis = 0; axis < 3; axis++) {
        assert_true(node->left_least[axis] >= least[axis] && node->left_greatest[axis] <= greatest[axis]);
        assert_true(node->right_least[axis] >= least[axis] && node->right_greatest[axis] <= greatest[axis]);
    }
    look_at(w, node->left, node->left_least, node->left_greatest, depth + 1);
    look_at(w, node->right, node->right_least, node->right_greatest, depth + 1);
}

static void check_tree(helio_context *context, helio_mesh *mesh)
{
    static const float least[] = {-INFINITY, -INFINITY, -INFINITY}, greatest[] = {INFINITY, INFINITY, INFINITY};
    bvh tree;
    assert_ok(bvh_create(context, mesh, &tree));
    walk w = {.tree = &tree, .seen = calloc(mesh->triangle_count, 1)};
    assert_non_null(w.seen);
    look_at(&w, 0, least, greatest, 0);
    assert_int_equal(w.nodes, tree.node_count);
    assert_true(w.deepest < DEEPEST);
    print_message("%u triangles: %u nodes, %u deep\n", mesh->triangle_count, w.nodes, w.deepest);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        assert_int_equal(w.seen[i], mesh->triangle_count > 1 ? 1 : 2);
    free(w.seen);
    bvh_destroy(&tree);
    helio_mesh_destroy(context, mesh);
}

static void every_triangle_is_in_its_boxes(void **state)
{
    static const uint32_t counts[] = {1, 2, 3, 4, 5, 17, 1000, 30000};
    helio_context *context = make_context(1, NULL);
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        check_tree(context, make_mesh(context, counts[i], 2.0f, i));
    helio_context_destroy(context);
}

/* All in one place; in places that lie ever closer, so that each division leaves one triangle behind. */
static void meshes_that_cannot_be_divided_are_no_deeper(void **state)
{
    helio_context *context = make_context(1, NULL);
    (void)state;
    helio_mesh *heap = make_mesh(context, 3000, 0.0f, 3), *row = make_mesh(context, 3000, 1.0f, 4);
    for (uint32_t i = 0; i < 9000; i++)
        for (uint32_t axis = 0; axis < 3; axis++) {
            heap->positions[3 * i + axis] = (float)(i % 3) * (axis == i % 3 ? 1.0f : 0.0f);
            row->positions[3 * i + axis] = ldexpf(1.0f, 60 - (int)(i / 3 % 120)) * (axis == i % 3 ? 1.1f : 1.0f);
        }
    check_tree(context, heap);
    check_tree(context, row);
    helio_context_destroy(context);
}

static void no_memory_is_told(void **state)
{
    memory_count count = {0};
    helio_context *context = make_context(1, &count);
    helio_mesh *mesh = make_mesh(context, 100, 1.0f, 5);
    const size_t live = count.live, taken = count.taken;
    bvh tree;
    (void)state;
    for (size_t allowed = 0; allowed < 4; allowed++) {
        count.refuse_after = count.taken + allowed > 0 ? count.taken + allowed : 1;
        assert_int_equal(bvh_create(context, mesh, &tree), HELIO_ERR_MEMORY);
        assert_int_equal(count.live, live);
    }
    count.refuse_after = 0;
    assert_true(count.taken > taken);
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_triangle_is_in_its_boxes),
        cmocka_unit_test(meshes_that_cannot_be_divided_are_no_deeper),
        cmocka_unit_test(no_memory_is_told),
    };
    return cmocka_run_group_tests_name("vulkan_tree", tests, NULL, NULL);
}
