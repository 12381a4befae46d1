/* SPDX-License-Identifier: MIT
 *
 * Built from above: each set of triangles is divided where the surface area heuristic says, among 16 places along the
 * longest axis of the triangles' centres. Deep down, where that has found nothing good, in the middle, so that the tree
 * is no deeper than the shaders' stacks. */
#include "vulkan/bvh.h"

#include "core/context.h"
#include "core/error.h"

#include <math.h>
#include <string.h>

enum { BINS = 16, DEEPEST_BY_AREA = 32, DEPTH = 64 };
static const uint32_t MOST_TRIANGLES = 1u << 28;

typedef struct box {
    float least[3], greatest[3];
} box;

static const box EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(box *sum, const box *more)
{
    for (int axis = 0; axis < 3; axis++) {
        sum->least[axis] = fminf(sum->least[axis], more->least[axis]);
        sum->greatest[axis] = fmaxf(sum->greatest[axis], more->greatest[axis]);
    }
}

/* Half of it. In double, as coordinates may be as large as meshes allow. */
static double box_area(const box *b)
{
    double x = (double)b->greatest[0] - (double)b->least[0], y = (double)b->greatest[1] - (double)b->least[1];
    double z = (double)b->greatest[2] - (double)b->least[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

static float box_centre(const box *b, int axis)
{
    return 0.5f * b->least[axis] + 0.5f * b->greatest[axis];
}

typedef struct builder {
    const helio_mesh *mesh;
    bvh *tree;
    box *boxes; /* [triangles] */
} builder;

/* A set of triangles, order[first] ... order[end - 1], whose node is to be written to a child of its parent. */
typedef struct part {
    uint32_t first, end, depth;
    uint32_t *child;
} part;

static box box_of_triangle(const helio_mesh *mesh, uint32_t triangle)
{
    box sum = EMPTY;
    for (int corner = 0; corner < 3; corner++) {
        const float *p = mesh->positions + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + (size_t)corner];
        const box point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        box_add(&sum, &point);
    }
    return sum;
}

static box box_of_part(const builder *b, uint32_t first, uint32_t end)
{
    box sum = EMPTY;
    for (uint32_t i = first; i < end; i++)
        box_add(&sum, &b->boxes[b->tree->order[i]]);
    return sum;
}

/* ---- where to divide ---------------------------------------------------------------------- */

/* Places along an axis: a triangle is in the bin of its centre. */
typedef struct division {
    int axis;
    float start, scale; /* bins in a unit of length */
    uint32_t bin;       /* the first of the second half */
} division;

static uint32_t bin_of(const division *d, const box *b)
{
    float place = (box_centre(b, d->axis) - d->start) * d->scale;
    return place > 0.0f ? (place < (float)(BINS - 1) ? (uint32_t)place : BINS - 1) : 0;
}

/* False where all centres are one. */
static bool choose_axis(const builder *b, const part *p, division *d)
{
    box centres = EMPTY;
    float longest = 0.0f;
    for (uint32_t i = p->first; i < p->end; i++) {
        const box *own = &b->boxes[b->tree->order[i]];
        const box centre = {{box_centre(own, 0), box_centre(own, 1), box_centre(own, 2)},
                            {box_centre(own, 0), box_centre(own, 1), box_centre(own, 2)}};
        box_add(&centres, &centre);
    }
    for (int axis = 0; axis < 3; axis++)
        if (centres.greatest[axis] - centres.least[axis] > longest) {
            longest = centres.greatest[axis] - centres.least[axis];
            *d = (division){.axis = axis, .start = centres.least[axis], .scale = (float)BINS / longest};
        }
    return longest > 0.0f && isfinite(d->scale);
}

typedef struct bins {
    box boxes[BINS];
    uint32_t counts[BINS];
} bins;

/* Area x number of triangles of both halves is least there. */
static uint32_t best_bin(const bins *all)
{
    double after[BINS], least = HUGE_VAL;
    box sum = EMPTY;
    uint32_t count = 0, best = BINS / 2;
    for (uint32_t i = BINS - 1; i > 0; i--) {
        box_add(&sum, &all->boxes[i]);
        count += all->counts[i];
        after[i] = box_area(&sum) * count;
    }
    sum = EMPTY;
    count = 0;
    for (uint32_t i = 1; i < BINS; i++) {
        box_add(&sum, &all->boxes[i - 1]);
        count += all->counts[i - 1];
        const double cost = box_area(&sum) * count + after[i];
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

/* Brings the triangles of the first half to the front; returns where the second half begins. */
static uint32_t partition(builder *b, const part *p, const division *d)
{
    uint32_t low = p->first, high = p->end;
    while (low < high) {
        if (bin_of(d, &b->boxes[b->tree->order[low]]) < d->bin) {
            low++;
        } else {
            const uint32_t moved = b->tree->order[low];
            b->tree->order[low] = b->tree->order[--high];
            b->tree->order[high] = moved;
        }
    }
    return low;
}

static uint32_t divide(builder *b, const part *p)
{
    const uint32_t middle = p->first + (p->end - p->first) / 2;
    division d = {0};
    bins all = {{{{0}, {0}}}, {0}};
    if (p->depth >= DEEPEST_BY_AREA || !choose_axis(b, p, &d))
        return middle;
    for (int i = 0; i < BINS; i++)
        all.boxes[i] = EMPTY;
    for (uint32_t i = p->first; i < p->end; i++) {
        const box *own = &b->boxes[b->tree->order[i]];
        const uint32_t bin = bin_of(&d, own);
        box_add(&all.boxes[bin], own);
        all.counts[bin]++;
    }
    d.bin = best_bin(&all);
    const uint32_t place = partition(b, p, &d);
    return place > p->first && place < p->end ? place : middle;
}

/* ---- nodes -------------------------------------------------------------------------------- */

static uint32_t make_leaf(const part *p)
{
    return BVH_LEAF | p->first << 3 | (p->end - p->first - 1);
}

/* A node for the part, and what is left to do for its halves. */
static uint32_t make_node(builder *b, const part *p, part halves[2])
{
    const uint32_t number = b->tree->node_count++, place = divide(b, p);
    bvh_node *node = &b->tree->nodes[number];
    const box left = box_of_part(b, p->first, place), right = box_of_part(b, place, p->end);
    memcpy(node->left_least, left.least, sizeof left.least);
    memcpy(node->left_greatest, left.greatest, sizeof left.greatest);
    memcpy(node->right_least, right.least, sizeof right.least);
    memcpy(node->right_greatest, right.greatest, sizeof right.greatest);
    halves[0] = (part){p->first, place, p->depth + 1, &node->left};
    halves[1] = (part){place, p->end, p->depth + 1, &node->right};
    return number;
}

static void build(builder *b)
{
    uint32_t root;
    part waiting[2 * DEPTH];
    uint32_t count = 0;
    waiting[count++] = (part){0, b->tree->triangle_count, 0, &root};
    while (count > 0) {
        const part p = waiting[--count];
        /* The root is a node in any case. */
        if (p.end - p.first <= BVH_LEAF_TRIANGLES && p.depth > 0) {
            *p.child = make_leaf(&p);
            continue;
        }
        *p.child = make_node(b, &p, waiting + count);
        count += 2;
    }
}

/* A root whose second half is empty. */
static void build_single(builder *b)
{
    bvh_node *node = &b->tree->nodes[b->tree->node_count++];
    const box own = b->boxes[0];
    *node = (bvh_node){.left = BVH_LEAF, .right = BVH_LEAF};
    memcpy(node->left_least, own.least, sizeof own.least);
    memcpy(node->left_greatest, own.greatest, sizeof own.greatest);
    memcpy(node->right_least, own.least, sizeof own.least);
    memcpy(node->right_greatest, own.greatest, sizeof own.greatest);
}

static void write_triangles(const builder *b)
{
    for (uint32_t i = 0; i < b->tree->triangle_count; i++)
        for (size_t corner = 0; corner < 3; corner++)
            memcpy(b->tree->triangles[i][corner],
                   b->mesh->positions + 3 * (size_t)b->mesh->triangles[3 * (size_t)b->tree->order[i] + corner],
                   3 * sizeof(float));
}

static helio_status build_all(builder *b)
{
    bvh *tree = b->tree;
    tree->nodes = context_allocate(tree->context, tree->triangle_count, sizeof *tree->nodes);
    tree->triangles = context_allocate(tree->context, tree->triangle_count, sizeof *tree->triangles);
    b->boxes = context_allocate(tree->context, tree->triangle_count, sizeof *b->boxes);
    b->tree->order = context_allocate(tree->context, tree->triangle_count, sizeof *b->tree->order);
    if (!tree->nodes || !tree->triangles || !b->boxes || !b->tree->order)
        return HELIO_ERR_MEMORY;
    for (uint32_t i = 0; i < tree->triangle_count; i++) {
        b->boxes[i] = box_of_triangle(b->mesh, i);
        b->tree->order[i] = i;
    }
    if (tree->triangle_count == 1)
        build_single(b);
    else
        build(b);
    write_triangles(b);
    return HELIO_OK;
}

helio_status bvh_create(helio_context *context, const helio_mesh *mesh, bvh *out)
{
    bvh tree = {.context = context, .triangle_count = mesh->triangle_count};
    builder b = {.mesh = mesh, .tree = &tree};
    *out = (bvh){0};
    if (mesh->triangle_count > MOST_TRIANGLES)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "a mesh of %u triangles has too many for a graphics processor, which takes %u",
                    mesh->triangle_count, MOST_TRIANGLES);
    helio_status status = build_all(&b);
    context_release(context, b.boxes);
    if (status != HELIO_OK)
        bvh_destroy(&tree);
    else
        *out = tree;
    return status;
}

void bvh_destroy(bvh *tree)
{
    if (tree->context == NULL)
        return;
    context_release(tree->context, tree->nodes);
    context_release(tree->context, tree->triangles);
    context_release(tree->context, tree->order);
    *tree = (bvh){0};
}
