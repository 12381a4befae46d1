/* SPDX-License-Identifier: MIT */
#include "eval/quadrature.h"

#include "core/context.h"
#include "eval/face_points.h"
#include "eval/horizon.h"
#include "eval/lobe.h"
#include "sampling/kernels.h"

#include <string.h>

/* A grid is as fine as it must be for `fineness` = (distance between its points) / (scale of what is summed). Each step
 * makes the errors some 16 times smaller, where the functions are smooth. */
static const double COARSEST = 1.0, STEP = 0.5;
enum { STEPS = 6 }; /* at most */

/* What may stand for a node, and for a texel or a part of one, by its radius / (scale x fineness): a node's points, or
 * a grid of 1, 2, ... Gauss points in rows and columns. The errors of all are about the same. */
static const double NODE_LIMIT = 1.2;
static const double CELL_LIMITS[QUADRATURE_RULES] = {0.02, 0.15, 0.6, 1.2};
static const double CUT_LIMIT = 0.15;     /* the same where a horizon cuts it */
static const double CUT_EDGE = 0.03125;   /* half edge / fineness there, however smooth the BRDF is ... */
static const double CUT_LOBE_EDGE = 0.01; /* ... or where it is cut off at a lobe's own horizon like no polynomial */
static const double GEOMETRY_SCALE = 0.5; /* of (1 + u^2 + v^2)^-2 */
static const double LEAST_EDGE = 0x1p-30; /* is divided no more */

/* The sum of one BRDF, or of one part of a BRDF, at a point. */
typedef struct summation {
    const quadrature *q;
    const kernel_set *kernels;
    gathering g;
    lobe lobe;
    horizons horizons;
    double fineness;
    face_points cells; /* of texels and their parts, until they fill a block */
    sample_block block;
    double sums[3];
    uint64_t evaluations;
} summation;

/* ---- points ---- */

static void sum_block(summation *s)
{
    s->kernels->weigh(&s->g, &s->block);
    block_sum sum = s->kernels->sum_block(&s->block);
    for (int c = 0; c < 3; c++)
        s->sums[c] += (double)sum.rgb[c];
    s->evaluations += s->block.count;
}

static void flush(summation *s)
{
    if (s->cells.count == 0)
        return;
    s->kernels->aim(&s->cells, &s->block);
    sum_block(s);
    s->cells.count = 0;
}

static void add_place(summation *s, double u, double v, double area, double spread, const float *rgb)
{
    face_points_add(&s->cells, u, v, area, spread, rgb);
    if (s->cells.count == BLOCK_SAMPLES)
        flush(s);
}

_Static_assert((int)TREE_POINTS == (int)BLOCK_SAMPLES, "a node fills a block");

static void add_node(summation *s, const light_node *node, const face_rectangle *r)
{
    const light_tree *tree = &s->q->tree;
    const cube_face *f = &cube_faces[node->face];
    float(*to)[BLOCK_STRIDE] = s->block.samples;
    for (uint32_t row = 0; row < TREE_ORDER; row++) {
        float v = (float)(0.5 * (r->v0 + r->v1 + tree->rule.points[row] * (r->v1 - r->v0)));
        vec3 base = add_scaled(f->axis, f->down, v);
        for (uint32_t column = 0; column < TREE_ORDER; column++) {
            float u = (float)(0.5 * (r->u0 + r->u1 + tree->rule.points[column] * (r->u1 - r->u0)));
            float scale_by = 1.0f / sqrtf(1.0f + u * u + v * v);
            vec3 direction = scale(add_scaled(base, f->right, u), scale_by);
            uint32_t i = row * TREE_ORDER + column;
            to[SAMPLE_X][i] = direction.x;
            to[SAMPLE_Y][i] = direction.y;
            to[SAMPLE_Z][i] = direction.z;
            to[SAMPLE_DENSITY][i] = 1.0f;
        }
    }
    const float *weights = tree->weights + light_tree_index(node) * 3 * TREE_POINTS;
    memcpy(to[SAMPLE_RED], weights, TREE_POINTS * sizeof *weights);
    memcpy(to[SAMPLE_GREEN], weights + TREE_POINTS, TREE_POINTS * sizeof *weights);
    memcpy(to[SAMPLE_BLUE], weights + 2 * TREE_POINTS, TREE_POINTS * sizeof *weights);
    s->block.count = TREE_POINTS;
    sum_block(s);
}

/* ---- how fine ---- */

/* The angle from a rectangle's middle to its corners, no less than it is, and the direction of the middle. */
static double radius_of(uint32_t face, const face_rectangle *r, vec3 *middle)
{
    double u = 0.5 * (r->u0 + r->u1), v = 0.5 * (r->v0 + r->v1);
    double half_u = 0.5 * (r->u1 - r->u0), half_v = 0.5 * (r->v1 - r->v0);
    double near_u = fmax(0.0, fabs(u) - half_u), near_v = fmax(0.0, fabs(v) - half_v);
    *middle = cube_direction(face, (float)u, (float)v);
    return sqrt((half_u * half_u + half_v * half_v) / (1.0 + near_u * near_u + near_v * near_v));
}

/* Least scale of the BRDF in a rectangle, or 0 where the lobe does not reach it. */
static double scale_in(const summation *s, uint32_t face, const face_rectangle *r, double *radius)
{
    vec3 middle;
    *radius = radius_of(face, r, &middle);
    if (lobe_distance(&s->lobe, middle) - *radius > s->lobe.reach)
        return 0.0;
    return lobe_scale(&s->lobe, middle, *radius);
}

/* What will do for a texel or a part of one. */
typedef struct cell_plan {
    int rule;    /* in q->rules; -1: it must be divided */
    bool is_cut; /* if a horizon cuts it: what is left of it can be summed at once, else it must be divided */
} cell_plan;

static cell_plan plan_cell(const summation *s, double half_edge, double radius, double least_scale)
{
    double roughness = radius / least_scale, coarseness = fmax(roughness, half_edge / GEOMETRY_SCALE);
    double cut_edge = lobe_has_horizon(&s->lobe) ? CUT_LOBE_EDGE : CUT_EDGE;
    cell_plan plan = {-1, half_edge <= cut_edge * s->fineness && roughness <= CUT_LIMIT * s->fineness};
    for (int i = QUADRATURE_RULES - 1; i >= 0 && coarseness <= CELL_LIMITS[i] * s->fineness; i--)
        plan.rule = i;
    return plan;
}

/* ---- texels and their parts ---- */

static void add_grid(summation *s, const face_rectangle *r, int rule_index, const float *rgb)
{
    const gauss_rule *rule = &s->q->rules[rule_index];
    double half = 0.5 * (r->u1 - r->u0), area = half * half;
    if (rule_index == 0) {
        add_place(s, r->u0 + half, r->v0 + half, 4.0 * area, area / 6.0, rgb);
        return;
    }
    for (uint32_t row = 0; row < rule->count; row++)
        for (uint32_t column = 0; column < rule->count; column++)
            add_place(s, r->u0 + half * (1.0 + rule->points[column]), r->v0 + half * (1.0 + rule->points[row]),
                      area * rule->weights[column] * rule->weights[row], 0.0, rgb);
}

/* Strang and Fix's three points, exact for polynomials of degree 2. */
static void add_triangle(summation *s, const double u[3], const double v[3], const float *rgb)
{
    double area = 0.5 * fabs((u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]));
    double sum_u = u[0] + u[1] + u[2], sum_v = v[0] + v[1] + v[2];
    for (int i = 0; i < 3; i++)
        add_place(s, (sum_u + 3.0 * u[i]) / 6.0, (sum_v + 3.0 * v[i]) / 6.0, area / 3.0, 0.0, rgb);
}

static void add_cut(summation *s, const face_rectangle *r, const float *rgb)
{
    face_polygon polygon = horizons_clip(&s->horizons, s->cells.face, r);
    for (uint32_t i = 2; i < polygon.count; i++)
        add_triangle(s, (const double[3]){polygon.u[0], polygon.u[i - 1], polygon.u[i]},
                     (const double[3]){polygon.v[0], polygon.v[i - 1], polygon.v[i]}, rgb);
}

static void add_cell(summation *s, const face_rectangle *r, const float *rgb);

static void add_quarters(summation *s, const face_rectangle *r, const float *rgb)
{
    double u = 0.5 * (r->u0 + r->u1), v = 0.5 * (r->v0 + r->v1);
    add_cell(s, &(face_rectangle){r->u0, u, r->v0, v}, rgb);
    add_cell(s, &(face_rectangle){u, r->u1, r->v0, v}, rgb);
    add_cell(s, &(face_rectangle){r->u0, u, v, r->v1}, rgb);
    add_cell(s, &(face_rectangle){u, r->u1, v, r->v1}, rgb);
}

/* A texel or a square part of one: as few points as will do, or four parts. */
static void add_cell(summation *s, const face_rectangle *r, const float *rgb)
{
    horizon_side side = horizons_side(&s->horizons, s->cells.face, r);
    double radius, least_scale;
    if (side == HORIZON_BELOW)
        return;
    least_scale = scale_in(s, s->cells.face, r, &radius);
    if (least_scale == 0.0)
        return;
    cell_plan plan = plan_cell(s, 0.5 * (r->u1 - r->u0), radius, least_scale);
    if (r->u1 - r->u0 < LEAST_EDGE)
        plan = (cell_plan){0, true};
    if (side == HORIZON_ABOVE && plan.rule >= 0)
        add_grid(s, r, plan.rule, rgb);
    else if (side == HORIZON_CUT && plan.is_cut)
        add_cut(s, r, rgb);
    else
        add_quarters(s, r, rgb);
}

static bool is_lit(const float *rgb)
{
    return rgb[0] > 0.0f || rgb[1] > 0.0f || rgb[2] > 0.0f;
}

/* Some texels of a leaf that lie in one row. */
typedef struct texel_row {
    uint32_t count;
    double u, v;      /* of the first one's corner */
    double edge;      /* of a texel */
    const float *rgb; /* [count][3] */
} texel_row;

static face_rectangle texel_of(const texel_row *row, uint32_t i)
{
    double u = row->u + i * row->edge;
    return (face_rectangle){u, u + row->edge, row->v, row->v + row->edge};
}

/* Texels first ... end - 1, which are above all horizons. */
static void add_run(summation *s, const texel_row *row, uint32_t first, uint32_t end, int rule)
{
    double half = 0.5 * row->edge, area = row->edge * row->edge;
    for (uint32_t i = first; i < end; i++) {
        const float *rgb = row->rgb + 3 * (size_t)i;
        if (rule == 0)
            add_place(s, row->u + half + i * row->edge, row->v + half, area, area / 24.0, rgb);
        else if (is_lit(rgb))
            add_grid(
                s, &(face_rectangle){row->u + i * row->edge, row->u + (i + 1) * row->edge, row->v, row->v + row->edge},
                rule, rgb);
    }
}

/* What is above all horizons, or cut by one, is a run of the row, as what lies above them is convex. */
static void add_known_row(summation *s, const texel_row *row, const cell_plan *plan)
{
    double least[LEAF_LIMIT], most[LEAF_LIMIT];
    face_rectangle corner = texel_of(row, 0);
    horizons_measure(&s->horizons, s->cells.face, &corner, row->count, least, most);
    uint32_t first = 0, end = 0;
    for (uint32_t i = 0; i < row->count; i++) {
        if (least[i] >= 0.0) {
            first = end > 0 ? first : i;
            end = i + 1;
        } else if (most[i] > 0.0 && is_lit(row->rgb + 3 * (size_t)i)) {
            face_rectangle r = texel_of(row, i);
            add_cut(s, &r, row->rgb + 3 * (size_t)i);
        }
    }
    add_run(s, row, first, end, plan->rule);
}

static void add_row(summation *s, const texel_row *row)
{
    for (uint32_t i = 0; i < row->count; i++) {
        face_rectangle r = texel_of(row, i);
        if (is_lit(row->rgb + 3 * (size_t)i))
            add_cell(s, &r, row->rgb + 3 * (size_t)i);
    }
}

/* Where the BRDF is smooth enough all over the leaf, its texels share a plan. */
static void add_texels(summation *s, const light_node *node, double least_scale)
{
    const light_tree *tree = &s->q->tree;
    double half = 1.0 / tree->environment->size;
    cell_plan plan = plan_cell(s, half, sqrt(2.0) * half, least_scale);
    bool is_known = plan.rule >= 0 && plan.rule < QUADRATURE_RULES - 1 && plan.is_cut;
    uint32_t column = light_tree_texel(tree, node->depth, node->column);
    uint32_t last_row = light_tree_texel(tree, node->depth, node->row + 1);
    for (uint32_t i = light_tree_texel(tree, node->depth, node->row); i < last_row; i++) {
        const texel_row row = {light_tree_texel(tree, node->depth, node->column + 1) - column,
                               light_tree_coordinate(tree, column), light_tree_coordinate(tree, i), 2.0 * half,
                               environment_texel(tree->environment, node->face, i, column)};
        if (is_known)
            add_known_row(s, &row, &plan);
        else
            add_row(s, &row);
    }
}

/* ---- the tree ---- */

static void add_tree(summation *s, const light_node *node)
{
    const light_tree *tree = &s->q->tree;
    if (!tree->lit[light_tree_index(node)])
        return;
    face_rectangle r = light_tree_rectangle(tree, node);
    horizon_side side = horizons_side(&s->horizons, node->face, &r);
    if (side == HORIZON_BELOW)
        return;
    double radius, least_scale = scale_in(s, node->face, &r, &radius);
    if (least_scale == 0.0)
        return;
    if (side == HORIZON_ABOVE && radius <= NODE_LIMIT * least_scale * s->fineness) {
        add_node(s, node, &r);
    } else if (node->depth == tree->depth) {
        add_texels(s, node, least_scale);
    } else {
        for (uint32_t k = 0; k < 4; k++)
            add_tree(s, &(light_node){node->face, node->depth + 1, 2 * node->row + k / 2, 2 * node->column + k % 2});
    }
}

/* The sum over all texels with grids of this fineness. */
static void sum_up(summation *s, double fineness, double rgb[3])
{
    s->fineness = fineness;
    memset(s->sums, 0, sizeof s->sums);
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        s->cells.face = face;
        add_tree(s, &(light_node){.face = face});
        flush(s);
    }
    memcpy(rgb, s->sums, sizeof s->sums);
}

/* ---- points to be lit ---- */

static void begin_horizons(summation *s)
{
    vec3 normal = s->g.surface.normal, flat = s->g.geometric_normal;
    s->horizons.count = 0;
    horizons_add(&s->horizons, normal);
    if (flat.x != normal.x || flat.y != normal.y || flat.z != normal.z)
        horizons_add(&s->horizons, flat);
    if (lobe_has_horizon(&s->lobe))
        horizons_add(&s->horizons, s->g.surface.mirror);
}

static void begin(summation *s, const quadrature *q, const helio_shading_point *point)
{
    const helio_environment *environment = q->tree.environment;
    vec3 normal = environment_to_map(environment, vec3_from(point->normal));
    vec3 view = brdf_lift_view(normal, environment_to_map(environment, vec3_from(point->view)));
    s->q = q;
    s->kernels = kernels_of(context_isa(environment->context));
    s->g = (gathering){.environment = environment,
                       .geometric_normal = environment_to_map(environment, vec3_from(point->geometric_normal))};
    brdf_prepare_value(&s->g.surface, &point->material, normal, view);
}

static double greatest(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

/* Relative; directions are floats, which matters to narrow lobes. */
static double rounding_of(const lobe *l)
{
    return 2e-6 + 2e-8 / l->width;
}

/* Does a finer grid change nothing? A matte surface has exact sums but where a horizon cuts texels, and these may be
 * small enough. */
static bool is_settled(const summation *s, double fineness)
{
    return s->g.surface.kind == HELIO_MATERIAL_DIFFUSE &&
           1.0 / s->q->tree.environment->size <= fmin(CUT_EDGE, CELL_LIMITS[0] * GEOMETRY_SCALE) * fineness;
}

/* Ever finer grids, until two of them agree. */
static void add_surface(summation *s, quadrature_result *result)
{
    double rgb[3], finer[3], change[3] = {0}, fineness = COARSEST;
    s->lobe = lobe_measure(&s->g.surface);
    begin_horizons(s);
    sum_up(s, fineness, rgb);
    for (int i = 0; i < STEPS && !is_settled(s, fineness * STEP); i++) {
        fineness *= STEP;
        sum_up(s, fineness, finer);
        for (int c = 0; c < 3; c++) {
            change[c] = fabs(finer[c] - rgb[c]);
            rgb[c] = finer[c];
        }
        if (greatest(change) <= s->q->tolerance * greatest(rgb))
            break;
    }
    for (int c = 0; c < 3; c++) {
        result->rgb[c] += rgb[c];
        result->bound[c] += change[c] + rounding_of(&s->lobe) * rgb[c];
    }
}

static bool is_black(const float rgb[3])
{
    return rgb[0] == 0.0f && rgb[1] == 0.0f && rgb[2] == 0.0f;
}

/* The matte and the glossy part apart: the one is smooth, the other soon at its end. */
static void add_phong(summation *s, quadrature_result *result)
{
    const brdf whole = s->g.surface;
    if (!is_black(whole.diffuse)) {
        s->g.surface.kind = HELIO_MATERIAL_DIFFUSE;
        add_surface(s, result);
    }
    if (!is_black(whole.specular)) {
        s->g.surface = whole;
        memset(s->g.surface.diffuse, 0, sizeof s->g.surface.diffuse);
        s->g.surface.colours[0] = (vec3){0, 0, 0};
        add_surface(s, result);
    }
}

void quadrature_point(const quadrature *q, const helio_shading_point *point, quadrature_result *result)
{
    summation s = {0};
    *result = (quadrature_result){0};
    begin(&s, q, point);
    if (point->material.kind == HELIO_MATERIAL_PHONG)
        add_phong(&s, result);
    else
        add_surface(&s, result);
    result->evaluations = s.evaluations;
}

/* ---- life ---- */

helio_status quadrature_create(const helio_environment *environment, double tolerance, quadrature **out)
{
    *out = NULL;
    quadrature *q = context_allocate(environment->context, 1, sizeof *q);
    if (q == NULL)
        return HELIO_ERR_MEMORY;
    q->tolerance = tolerance;
    for (uint32_t i = 0; i < QUADRATURE_RULES; i++)
        q->rules[i] = gauss_make(i + 1);
    helio_status status = light_tree_create(environment, &q->tree);
    if (status != HELIO_OK) {
        context_release(environment->context, q);
        return status;
    }
    *out = q;
    return HELIO_OK;
}

void quadrature_destroy(quadrature *q)
{
    if (q == NULL)
        return;
    helio_context *context = q->tree.context;
    light_tree_destroy(&q->tree);
    context_release(context, q);
}
