/* SPDX-License-Identifier: MIT */
#include "eval/light_tree.h"

#include "core/context.h"

#include <string.h>

enum {
    LEAST_POINTS = 4,       /* along the edge of a texel, to integrate over it ... */
    LEAST_LEAF_POINTS = 32, /* ... and along that of a leaf */
    AXIS_POINTS = LEAST_POINTS * LEAF_LIMIT,
};

face_rectangle light_tree_rectangle(const light_tree *tree, const light_node *node)
{
    return (face_rectangle){
        light_tree_coordinate(tree, light_tree_texel(tree, node->depth, node->column)),
        light_tree_coordinate(tree, light_tree_texel(tree, node->depth, node->column + 1)),
        light_tree_coordinate(tree, light_tree_texel(tree, node->depth, node->row)),
        light_tree_coordinate(tree, light_tree_texel(tree, node->depth, node->row + 1)),
    };
}

/* ---- leaves ---- */

/* The points of a row or column of texels within a leaf, and the leaf's polynomials there. */
typedef struct leaf_axis {
    uint32_t texels, points; /* points of each texel */
    double place[AXIS_POINTS], weight[AXIS_POINTS], basis[AXIS_POINTS][TREE_ORDER];
} leaf_axis;

_Static_assert((int)AXIS_POINTS >= (int)LEAST_POINTS * (int)LEAF_TEXELS &&
                   (int)AXIS_POINTS >= (int)LEAST_LEAF_POINTS + (int)LEAF_TEXELS,
               "any leaf fits into leaf_axis");

static void measure_axis(const light_tree *tree, uint32_t first, uint32_t end, leaf_axis *axis)
{
    uint32_t texels = end - first, fitting = (LEAST_LEAF_POINTS + texels - 1) / texels;
    const gauss_rule within = gauss_make(fitting > LEAST_POINTS ? fitting : LEAST_POINTS);
    double half = 1.0 / tree->environment->size, low = light_tree_coordinate(tree, first);
    axis->texels = texels;
    axis->points = within.count;
    for (uint32_t i = 0; i < texels * within.count; i++) {
        uint32_t texel = i / within.count, point = i % within.count;
        double place = low + half * (2.0 * texel + 1.0 + within.points[point]);
        axis->place[i] = place;
        axis->weight[i] = half * within.weights[point];
        for (uint32_t a = 0; a < TREE_ORDER; a++)
            axis->basis[i][a] = gauss_basis(&tree->rule, a, (place - low) / (half * texels) - 1.0);
    }
}

/* Adds one line of points, v = v_axis->place[line], to the sums over lines of the leaf. rgb: of its row of texels. */
static void add_line(const leaf_axis *u_axis, const leaf_axis *v_axis, uint32_t line, const float *rgb,
                     double sums[3][TREE_POINTS])
{
    double along[3][TREE_ORDER] = {{0}}, v = v_axis->place[line];
    for (uint32_t i = 0; i < u_axis->texels * u_axis->points; i++) {
        const float *texel = rgb + 3 * (size_t)(i / u_axis->points);
        double u = u_axis->place[i], squared = 1.0 + u * u + v * v, weight = u_axis->weight[i] / (squared * squared);
        for (int c = 0; c < 3; c++)
            for (uint32_t a = 0; a < TREE_ORDER; a++)
                along[c][a] += weight * (double)texel[c] * u_axis->basis[i][a];
    }
    for (int c = 0; c < 3; c++)
        for (uint32_t b = 0; b < TREE_ORDER; b++)
            for (uint32_t a = 0; a < TREE_ORDER; a++)
                sums[c][b * TREE_ORDER + a] += v_axis->weight[line] * v_axis->basis[line][b] * along[c][a];
}

static bool is_lit(const light_tree *tree, uint32_t face, const uint32_t rows[2], const uint32_t columns[2])
{
    for (uint32_t row = rows[0]; row < rows[1]; row++) {
        const float *rgb = environment_texel(tree->environment, face, row, columns[0]);
        for (size_t i = 0; i < 3 * (size_t)(columns[1] - columns[0]); i++)
            if (rgb[i] > 0.0f)
                return true;
    }
    return false;
}

/* Weights are summed against F; what kernels take is f, of unit vectors. */
static void store_weights(const light_tree *tree, const light_node *node, double sums[3][TREE_POINTS])
{
    float *weights = tree->weights + light_tree_index(node) * 3 * TREE_POINTS;
    face_rectangle r = light_tree_rectangle(tree, node);
    for (uint32_t k = 0; k < TREE_POINTS; k++) {
        double u = 0.5 * (r.u0 + r.u1 + tree->rule.points[k % TREE_ORDER] * (r.u1 - r.u0));
        double v = 0.5 * (r.v0 + r.v1 + tree->rule.points[k / TREE_ORDER] * (r.v1 - r.v0));
        for (int c = 0; c < 3; c++)
            weights[(size_t)c * TREE_POINTS + k] = (float)(sums[c][k] * sqrt(1.0 + u * u + v * v));
    }
}

/* ---- the tree above them ---- */

/* What the parent's polynomials along one axis are at the points of a child. */
typedef struct child_axis {
    double basis[TREE_ORDER][TREE_ORDER]; /* [point of the child][polynomial of the parent] */
} child_axis;

static void measure_child(const light_tree *tree, double low, double high, double child_low, double child_high,
                          child_axis *axis)
{
    for (uint32_t i = 0; i < TREE_ORDER; i++) {
        double place = 0.5 * (child_low + child_high + tree->rule.points[i] * (child_high - child_low));
        for (uint32_t a = 0; a < TREE_ORDER; a++)
            axis->basis[i][a] = gauss_basis(&tree->rule, a, (2.0 * place - low - high) / (high - low));
    }
}

/* A polynomial of the parent is one of the child, so nothing is lost. */
static void add_child(const child_axis *u_axis, const child_axis *v_axis, double child[3][TREE_POINTS],
                      double sums[3][TREE_POINTS])
{
    for (int c = 0; c < 3; c++)
        for (uint32_t j = 0; j < TREE_ORDER; j++) {
            double along[TREE_ORDER] = {0};
            for (uint32_t i = 0; i < TREE_ORDER; i++)
                for (uint32_t a = 0; a < TREE_ORDER; a++)
                    along[a] += child[c][j * TREE_ORDER + i] * u_axis->basis[i][a];
            for (uint32_t b = 0; b < TREE_ORDER; b++)
                for (uint32_t a = 0; a < TREE_ORDER; a++)
                    sums[c][b * TREE_ORDER + a] += v_axis->basis[j][b] * along[a];
        }
}

static void gather_leaf(const light_tree *tree, const light_node *node, double sums[3][TREE_POINTS])
{
    const uint32_t depth = node->depth;
    const uint32_t rows[2] = {light_tree_texel(tree, depth, node->row), light_tree_texel(tree, depth, node->row + 1)};
    const uint32_t columns[2] = {light_tree_texel(tree, depth, node->column),
                                 light_tree_texel(tree, depth, node->column + 1)};
    leaf_axis u_axis, v_axis;
    tree->lit[light_tree_index(node)] = is_lit(tree, node->face, rows, columns);
    if (!tree->lit[light_tree_index(node)])
        return;
    measure_axis(tree, columns[0], columns[1], &u_axis);
    measure_axis(tree, rows[0], rows[1], &v_axis);
    for (uint32_t line = 0; line < v_axis.texels * v_axis.points; line++)
        add_line(&u_axis, &v_axis, line,
                 environment_texel(tree->environment, node->face, rows[0] + line / v_axis.points, columns[0]), sums);
}

/* Fills the node and all below it; sums: [3][TREE_POINTS], 0 before. */
static void gather_node(const light_tree *tree, const light_node *node, double sums[3][TREE_POINTS])
{
    size_t index = light_tree_index(node);
    if (node->depth == tree->depth) {
        gather_leaf(tree, node, sums);
        store_weights(tree, node, sums);
        return;
    }
    face_rectangle whole = light_tree_rectangle(tree, node);
    for (uint32_t k = 0; k < 4; k++) {
        light_node child = {node->face, node->depth + 1, 2 * node->row + k / 2, 2 * node->column + k % 2};
        double child_sums[3][TREE_POINTS] = {{0}};
        child_axis u_axis, v_axis;
        gather_node(tree, &child, child_sums);
        tree->lit[index] |= tree->lit[light_tree_index(&child)];
        face_rectangle part = light_tree_rectangle(tree, &child);
        measure_child(tree, whole.u0, whole.u1, part.u0, part.u1, &u_axis);
        measure_child(tree, whole.v0, whole.v1, part.v0, part.v1, &v_axis);
        add_child(&u_axis, &v_axis, child_sums, sums);
    }
    store_weights(tree, node, sums);
}

static void gather_face(void *data, size_t face)
{
    double sums[3][TREE_POINTS] = {{0}};
    gather_node(data, &(light_node){.face = (uint32_t)face}, sums);
}

/* ---- life ---- */

static uint32_t leaf_depth(uint32_t size)
{
    uint32_t depth = 0, most = size / LEAF_COLUMNS > LEAF_TEXELS ? size / LEAF_COLUMNS : LEAF_TEXELS;
    while (((size - 1) >> depth) + 1 > most)
        depth++;
    return depth;
}

helio_status light_tree_create(const helio_environment *environment, light_tree *tree)
{
    environment_settle(environment);
    helio_context *context = environment->context;
    *tree = (light_tree){.context = context,
                         .environment = environment,
                         .depth = leaf_depth(environment->size),
                         .rule = gauss_make(TREE_ORDER)};
    size_t nodes = light_tree_index(&(light_node){.depth = tree->depth + 1});
    tree->weights = context_allocate(context, nodes, 3 * TREE_POINTS * sizeof *tree->weights);
    tree->lit = context_allocate(context, nodes, sizeof *tree->lit);
    if (tree->weights == NULL || tree->lit == NULL) {
        light_tree_destroy(tree);
        return HELIO_ERR_MEMORY;
    }
    context_parallel_for(context, CUBE_FACES, gather_face, tree);
    return HELIO_OK;
}

void light_tree_destroy(light_tree *tree)
{
    context_release(tree->context, tree->weights);
    context_release(tree->context, tree->lit);
    tree->weights = NULL;
    tree->lit = NULL;
}
