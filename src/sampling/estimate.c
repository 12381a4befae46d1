/* SPDX-License-Identifier: MIT
 *
 * The estimator: multi-sample MIS with the balance heuristic over the light techniques (a pool per face, or one of the
 * map or of a bin of normals) and the surface technique (BRDF or cosine). Every sample contributes L rho cos / sum_k
 * m_k pdf_k, with the expected counts m_k; rho without the diffuse lobe where its light is known. */
#include "sampling/estimate.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "sampling/kernels.h"

#include <string.h>

enum { DEFAULT_SAMPLES = 64 };
static const float DEFAULT_BRDF_SHARE = 0.5f;

float estimate_brdf_share(float given)
{
    return given != 0.0f ? given : DEFAULT_BRDF_SHARE;
}

helio_status estimate_check_share(float share)
{
    if (!(share > 0.0f && share < 1.0f))
        return fail(HELIO_ERR_ARGUMENT,
                    "a BRDF share of %g cannot be used; give a number between 0 and 1, both excluded", (double)share);
    return HELIO_OK;
}

helio_status estimate_resolve(const helio_pools *pools, const helio_estimate_desc *given, helio_estimate_desc *desc)
{
    if (pools == NULL)
        return fail(HELIO_ERR_ARGUMENT, "an estimate needs pools");
    const helio_environment *environment = pools->tables->environment;
    if (pools->frame == 0 || pools->frame != environment->frame)
        return fail(
            HELIO_ERR_ARGUMENT,
            "the pools were drawn for frame %llu but the environment is at frame %llu; call helio_tables_update "
            "and helio_pools_draw",
            (unsigned long long)pools->frame, (unsigned long long)environment->frame);
    *desc = given ? *given : (helio_estimate_desc){0};
    uint32_t limit = helio_pools_sample_limit(pools);
    if (desc->samples == 0)
        desc->samples = DEFAULT_SAMPLES < limit ? DEFAULT_SAMPLES : limit;
    if (desc->samples > limit)
        return fail(HELIO_ERR_ARGUMENT,
                    "%u samples are more than these pools give a point; use at most %u and more passes", desc->samples,
                    limit);
    desc->brdf_share = estimate_brdf_share(desc->brdf_share);
    HELIO_TRY(estimate_check_share(desc->brdf_share));
    return HELIO_OK;
}

/* ---- points side by side ---- */

/* Whether there is a specular lobe. */
static bool shines(const helio_material *material)
{
    return material->kind == HELIO_MATERIAL_GGX ||
           (material->kind == HELIO_MATERIAL_PHONG && luminance(material->specular) > 0.0f);
}

/* Part of a point's samples that the surface technique takes. Pools of bins hold the product of light and cosine, and
 * tiles that of light and BRDF, so that BRDF samples have only the specular lobe to look after, the more the narrower
 * it is. How many they are the kernel prepare_points() finds for calm lobes, and begin_tiles() for others; here it
 * matters whether there are any. */
static float surface_share(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc)
{
    if (pools->techniques == 0 || pools->is_even)
        return 1.0f;
    if (pools->parts.surface == STRATEGY_SURFACE_NONE)
        return 0.0f;
    return pools->bins == NULL || shines(&point->material) ? desc->brdf_share : 0.0f;
}

/* Of the lobe, where it is all that reflects. */
static uint32_t class_of_lobe(const helio_pools *pools, const helio_material *material)
{
    if (pools->bins == NULL)
        return LOBE_UNASKED;
    const float edge = pools->bins->tiles->edge, alpha = material->roughness * material->roughness;
    if (material->kind == HELIO_MATERIAL_GGX && material->metallic == 1.0f)
        return lobe_class(alpha * alpha, edge);
    if (material->kind == HELIO_MATERIAL_PHONG && !(luminance(material->diffuse) > 0.0f))
        return lobe_class(1.0f / fmaxf(material->exponent, 1e-3f), edge);
    return LOBE_UNASKED;
}

/* Counts and windows of the points, and their directions in the map's space. is_free: nothing is in the way of their
 * samples, so that these need not show what is known. */
static void prepare_points(const helio_pools *pools, uint32_t count, const helio_shading_point *points,
                           const helio_estimate_desc *desc, bool is_free, point_block *block)
{
    static const helio_shading_point nowhere = {0}; /* what fills up registers */
    const uint32_t padded = (count + POOL_PADDING - 1) / POOL_PADDING * POOL_PADDING;
    block->count = count;
    block->is_free = is_free;
    for (uint32_t i = 0; i < padded; i++) {
        const helio_shading_point *point = i < count ? &points[i] : &nowhere;
        point_vector_put(&block->normal, i, vec3_from(point->normal));
        point_vector_put(&block->geometric_normal, i, vec3_from(point->geometric_normal));
        point_vector_put(&block->view, i, vec3_from(point->view));
        block->seed[i] = point->seed;
        block->surface_share[i] = surface_share(pools, point, desc);
        block->lobe_class[i] = class_of_lobe(pools, &point->material);
    }
    kernels_of(context_isa(pools->tables->environment->context))->prepare_points(pools, desc, block);
}

static void prepare_surface(const point_block *block, uint32_t i, const helio_material *material, brdf *surface)
{
    brdf_prepare_value(surface, material, point_vector(&block->normal, i), point_vector(&block->view, i));
}

/* ---- what is known before samples are taken ---- */

/* sum_k m_k pdf_k over the light techniques has one term: faces share no direction, and other strategies have one pool.
 */
static void expect_in_faces(gathering *g)
{
    const helio_pools *pools = g->pools;
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        if (pools->techniques == CUBE_FACES)
            g->expected_in_face[face] = g->counts.expected[face];
        else
            g->expected_in_face[face] = pools->techniques ? g->counts.expected[0] : 0.0f;
    }
}

static void begin_surface_samples(gathering *g, uint32_t seed)
{
    if (g->pools->parts.surface == STRATEGY_SURFACE_COSINE) {
        const helio_material matte = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};
        g->proposal = brdf_prepare(&matte, g->surface.normal, g->surface.view);
    } else {
        if (g->has_tiles)
            g->surface.specular_share = 1.0f; /* only what the pools do not know; there is a specular lobe, or no
                                                 sample would be taken */
        else
            brdf_prepare_share(&g->surface);
        g->proposal = g->surface;
    }
    g->proposal_axes = brdf_find_axes(&g->proposal);
    g->surface_seed = hash_combine(seed, STREAM_SURFACE);
    expect_in_faces(g);
}

/* Most points that shine, of a strategy with pools of bins and BRDF samples, read no pool but weigh tiles. */
static void begin_tiles(gathering *g, const helio_estimate_desc *desc, uint32_t seed, float rounding)
{
    const kernel_set *kernels = kernels_of(context_isa(g->environment->context));
    const tiles *t = g->pools->bins->tiles;
    brdf surface = g->surface;
    tile_lobe lobe;
    brdf_prepare_share(&surface);
    tile_lobe_prepare(&lobe, t, &surface);
    g->knows_diffuse &= lobe.diffuse > 0.0f;
    lobe.knows_diffuse = g->knows_diffuse;
    lobe.geometric_normal = g->geometric_normal;
    kernels->weigh_point(t, &lobe, &g->tiles);
    g->tile_seed = hash_combine(seed, STREAM_WINDOW);
    g->counts = (helio_counts){0};
    if (g->tiles.total == 0) /* as for a bin that is lit, but only below the horizon of this normal */
        return;
    const float need = point_tiles_need(&g->tiles, tile_lobe_need(t, &surface)), samples = (float)desc->samples;
    g->counts.expected[TECHNIQUE_SURFACE] = samples * strategy_share_of_need(need, desc->brdf_share);
    g->counts.expected[0] = samples - g->counts.expected[TECHNIQUE_SURFACE];
    const uint32_t light = (uint32_t)(g->counts.expected[0] + rounding);
    g->counts.realised[0] = light < desc->samples ? light : desc->samples;
    g->counts.realised[TECHNIQUE_SURFACE] = desc->samples - g->counts.realised[0];
}

/* For point i of a block that is prepared. */
static void begin(gathering *g, const helio_pools *pools, const helio_shading_point *point,
                  const helio_estimate_desc *desc, const point_block *block, uint32_t i)
{
    g->pools = pools;
    g->environment = pools->tables->environment;
    g->geometric_normal = point_vector(&block->geometric_normal, i);
    prepare_surface(block, i, &point->material, &g->surface);
    for (uint32_t k = 0; k < TECHNIQUES; k++) {
        g->counts.expected[k] = block->expected[k][i];
        g->counts.realised[k] = block->realised[k][i];
    }
    for (uint32_t k = 0; k < pools->techniques; k++)
        g->windows[k] = block->windows[k][i];
    g->pool = block->pools[0][i];
    g->has_tiles = block->weighs_tiles[i];
    g->knows_diffuse = g->has_tiles && block->is_free && !desc->no_control;
    if (g->has_tiles)
        begin_tiles(g, desc, point->seed, block->rounding[i]);
    if (g->counts.expected[TECHNIQUE_SURFACE] > 0.0f)
        begin_surface_samples(g, point->seed);
}

/* ---- samples ---- */

/* How far a point has come with its samples. */
typedef struct sample_cursor {
    uint32_t technique, taken; /* samples of that technique */
} sample_cursor;

/* Takes what fits of one technique, and steps on when it is exhausted. */
static uint32_t take_some(const gathering *g, uint32_t room, sample_cursor *cursor)
{
    uint32_t rest = g->counts.realised[cursor->technique] - cursor->taken, count = rest < room ? rest : room;
    if (count == rest)
        *cursor = (sample_cursor){cursor->technique + 1, 0};
    else
        cursor->taken += count;
    return count;
}

/* Which samples of which techniques come next, as many as fit in a block. */
typedef struct block_plan {
    pool_piece pieces[CUBE_FACES]; /* of pools */
    uint32_t piece_count;
    struct own_samples {
        uint32_t first, count;
    } tiles, surface; /* of those that the point draws itself */
} block_plan;

static void plan_block(const gathering *g, sample_cursor *cursor, block_plan *plan)
{
    uint32_t room = BLOCK_SAMPLES;
    *plan = (block_plan){0};
    while (cursor->technique < TECHNIQUES && room > 0) {
        const uint32_t technique = cursor->technique, first = cursor->taken, count = take_some(g, room, cursor);
        room -= count;
        if (count == 0)
            continue;
        if (technique == TECHNIQUE_SURFACE)
            plan->surface = (struct own_samples){first, count};
        else if (g->has_tiles)
            plan->tiles = (struct own_samples){first, count};
        else
            plan->pieces[plan->piece_count++] = (pool_piece){technique, g->windows[technique] + first, count};
    }
}

static void empty_block(sample_block *block)
{
    block->count = block->draw_count = 0;
    memset(block->hue, 0, sizeof block->hue);
}

/* Chooses the next samples, as many as fit, and sends for what is far away in memory. False if there are none left. */
static bool choose_block(gathering *g, const kernel_set *kernels, sample_cursor *cursor, block_plan *plan,
                         sample_block *block)
{
    plan_block(g, cursor, plan);
    empty_block(block);
    if (plan->tiles.count > 0)
        kernels->choose_tiles(g, plan->tiles.first, plan->tiles.count, block);
    if (plan->surface.count > 0)
        kernels->aim_surface(g, plan->surface.first, plan->surface.count, block);
    return plan->tiles.count + plan->surface.count + plan->piece_count > 0;
}

/* Takes them, and finds what each contributes. */
static void take_block(gathering *g, const kernel_set *kernels, const block_plan *plan, sample_block *block)
{
    if (plan->tiles.count > 0)
        kernels->take_tiles(g, block);
    if (plan->piece_count > 0)
        kernels->take_pools(g, plan->pieces, plan->piece_count, block);
    if (plan->surface.count > 0)
        kernels->take_surface(g, block);
    kernels->weigh(g, block);
}

static vec3 block_direction(const gathering *g, const sample_block *block, uint32_t i)
{
    const vec3 direction = {block->samples[SAMPLE_X][i], block->samples[SAMPLE_Y][i], block->samples[SAMPLE_Z][i]};
    return environment_to_world(g->environment, direction);
}

/* ---- sums ---- */

/* The samples of a block that contribute, and their world-space directions. */
typedef struct ray_list {
    uint32_t count;
    uint8_t samples[BLOCK_SAMPLES];
    float x[BLOCK_SAMPLES], y[BLOCK_SAMPLES], z[BLOCK_SAMPLES];
} ray_list;

static void list_rays(const gathering *g, const sample_block *block, ray_list *rays)
{
    rays->count = 0;
    for (uint32_t i = 0; i < block->count; i++) {
        if (!(block->red[i] + block->green[i] + block->blue[i] > 0.0f))
            continue;
        vec3 direction = block_direction(g, block, i);
        rays->samples[rays->count] = (uint8_t)i;
        rays->x[rays->count] = direction.x;
        rays->y[rays->count] = direction.y;
        rays->z[rays->count] = direction.z;
        rays->count++;
    }
}

/* Asks for all directions of a block at once, as ray tracers answer them faster than one by one, and takes the light of
 * those in shadow away. Returns how many were asked for. */
static uint32_t cast_shadows(const gathering *g, const helio_shading_point *point, const helio_estimate_desc *desc,
                             sample_block *block)
{
    ray_list rays;
    bool visible[BLOCK_SAMPLES];
    list_rays(g, block, &rays);
    if (rays.count > 0)
        desc->visibility(desc->user, point, rays.count, rays.x, rays.y, rays.z, visible);
    for (uint32_t i = 0; i < rays.count; i++)
        if (!visible[i])
            block->red[rays.samples[i]] = block->green[rays.samples[i]] = block->blue[rays.samples[i]] = 0.0f;
    return rays.count;
}

static void add_to(float sums[3], const float more[3])
{
    for (int c = 0; c < 3; c++)
        sums[c] += more[c];
}

/* What is known of the light of a point that weighs tiles: its mean hue, of which its samples' mean differs by chance.
 * hues: sums over its light samples. Of what these bring, the point's weights are a guess, times the square of their
 * part of all: where they are few their mean hue is as noisy as it is of little weight (docs/method.md). */
static void control_hue(const gathering *g, const helio_estimate_desc *desc, const float hues[3], float control[3])
{
    const float part = estimate_control_part(desc->no_control, desc->visibility != NULL);
    if (part == 0.0f || g->counts.realised[0] == 0)
        return;
    const vec3 sum = add(g->surface.colours[0], g->surface.colours[1]);
    const float colour[3] = {sum.x, sum.y, sum.z}, samples = (float)g->counts.realised[0];
    const float share = g->counts.expected[0] / (float)desc->samples;
    const float brightness = g->tiles.brightness * g->pools->bins->tiles->colours.per_light / luminance(colour);
    const float factor = part * share * share * brightness * g->environment->intensity;
    for (int c = 0; c < 3; c++)
        control[c] = control_finite(factor * colour[c] * (g->tiles.hue[c] - hues[c] / samples));
}

/* ... and its diffuse light from where that is known, which its samples leave out. hues: as above. */
static void control_tiles(const gathering *g, const helio_estimate_desc *desc, const float hues[3], float control[3])
{
    control_hue(g, desc, hues, control);
    if (!g->knows_diffuse)
        return;
    const vec3 sum = g->surface.colours[0];
    const float colour[3] = {sum.x, sum.y, sum.z};
    for (int c = 0; c < 3; c++)
        control[c] += colour[c] * g->tiles.irradiance[c] * g->environment->intensity;
}

static bool reads_pools_alone(const point_block *block, uint32_t i)
{
    return block->surface_share[i] == 0.0f;
}

/* Points whose samples are taken block by block, one after the other; the next is begun while the samples of the one
 * whose turn it is are on their way from memory. */
typedef struct point_queue {
    const helio_pools *pools;
    const kernel_set *kernels;
    const helio_shading_point *points;
    const helio_estimate_desc *desc;
    const point_block *block;
    uint32_t count;
    uint32_t current, next; /* the latter is count if no other follows */
    bool has_begun;         /* the next */
    uint32_t turn;          /* which of these is of the current point; the other is of the next */
    gathering gatherings[2];
} point_queue;

static void begin_next(point_queue *queue)
{
    const bool is_free = queue->block->is_free;
    if (queue->has_begun)
        return;
    queue->has_begun = true;
    while (queue->next < queue->count && is_free && reads_pools_alone(queue->block, queue->next))
        queue->next++;
    if (queue->next < queue->count)
        begin(&queue->gatherings[1 - queue->turn], queue->pools, &queue->points[queue->next], queue->desc, queue->block,
              queue->next);
}

static void step_on(point_queue *queue)
{
    queue->current = queue->next++;
    queue->turn = 1 - queue->turn;
    queue->has_begun = false;
}

static void estimate_by_blocks(point_queue *queue, estimate_result *result)
{
    gathering *g = &queue->gatherings[queue->turn];
    const kernel_set *kernels = queue->kernels;
    const helio_shading_point *point = &queue->points[queue->current];
    const helio_estimate_desc *desc = queue->desc;
    sample_block block;
    block_plan plan;
    float hues[3] = {0};
    for (sample_cursor cursor = {0}; choose_block(g, kernels, &cursor, &plan, &block);) {
        begin_next(queue);
        take_block(g, kernels, &plan, &block);
        block_sum sum = kernels->sum_block(&block);
        result->info.samples += block.count;
        result->info.useful += sum.useful;
        add_to(result->unoccluded, sum.rgb);
        add_to(hues, block.hue);
        if (desc->visibility != NULL && sum.useful > 0) {
            result->info.rays += cast_shadows(g, point, desc, &block);
            sum = kernels->sum_block(&block); /* in the same order: what nothing shadows stays the same number */
        }
        add_to(result->visible, sum.rgb);
    }
    begin_next(queue); /* after a point without samples */
    if (g->has_tiles)
        control_tiles(g, desc, hues, result->control);
}

static bool has_points_of_pools(const point_block *block)
{
    bool has = false;
    for (uint32_t i = 0; i < block->count; i++)
        has |= reads_pools_alone(block, i);
    return has;
}

/* For points that read pools alone. Nothing asks for single samples, so that they need no blocks. */
static void estimate_from_pools(const helio_pools *pools, uint32_t samples, const helio_shading_point *points,
                                const point_block *block, estimate_result *results)
{
    const helio_environment *environment = pools->tables->environment;
    brdf surfaces[POINT_BLOCK];
    block_sum sums[POINT_BLOCK];
    for (uint32_t i = 0; i < block->count; i++)
        prepare_surface(block, i, &points[i].material, &surfaces[i]);
    kernels_of(context_isa(environment->context))->sum_light(pools, samples, block, surfaces, sums);
    for (uint32_t i = 0; i < block->count; i++) {
        if (!reads_pools_alone(block, i))
            continue;
        results[i] = (estimate_result){.info = {.useful = sums[i].useful}};
        for (uint32_t k = 0; k < pools->techniques; k++)
            results[i].info.samples += block->realised[k][i];
        for (int c = 0; c < 3; c++)
            results[i].visible[c] = results[i].unoccluded[c] = sums[i].rgb[c] * environment->intensity;
    }
}

float estimate_control_part(bool no_control, bool has_visibility)
{
    if (no_control)
        return 0.0f;
    return has_visibility ? 0.5f : 1.0f;
}

/* For matte points that read a pool, if there is one. */
static void find_control(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                         const point_block *block, uint32_t i, float control[3])
{
    const float part = estimate_control_part(desc->no_control, desc->visibility != NULL);
    if (pools->control == NULL || part == 0.0f || point->material.kind != HELIO_MATERIAL_DIFFUSE ||
        !reads_pools_alone(block, i))
        return;
    const uint32_t pool = block->pools[0][i];
    const vec3 irradiance = control_difference(pools->control, pool, block->windows[0][i] - pool * pools->pool_length,
                                               block->realised[0][i], point_vector(&block->normal, i));
    const float light[3] = {irradiance.x, irradiance.y, irradiance.z};
    const float factor = part * (float)(1.0 / PI) * pools->tables->environment->intensity;
    for (int c = 0; c < 3; c++)
        control[c] = factor * point->material.diffuse[c] * light[c];
}

void estimate_points(const helio_pools *pools, uint32_t count, const helio_shading_point *points,
                     const helio_estimate_desc *desc, estimate_result *results)
{
    point_block block;
    prepare_points(pools, count, points, desc, desc->visibility == NULL, &block);
    memset(results, 0, count * sizeof *results);
    if (desc->visibility == NULL && has_points_of_pools(&block))
        estimate_from_pools(pools, desc->samples, points, &block, results);
    point_queue queue;
    queue.pools = pools;
    queue.kernels = kernels_of(context_isa(pools->tables->environment->context));
    queue.points = points;
    queue.desc = desc;
    queue.block = &block;
    queue.count = count;
    queue.next = queue.turn = 0;
    queue.has_begun = false;
    begin_next(&queue);
    while (queue.next < count) {
        step_on(&queue);
        estimate_by_blocks(&queue, &results[queue.current]);
    }
    for (uint32_t i = 0; i < count; i++)
        find_control(pools, &points[i], desc, &block, i, results[i].control);
}

/* ---- the public functions ---- */

static helio_status check_unit(const char *name, const float direction[3])
{
    float square = dot(vec3_from(direction), vec3_from(direction));
    if (fabsf(square - 1.0f) <= 2e-3f)
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT, "the %s of a shading point has length %g; give a unit vector", name,
                sqrt((double)square));
}

/* Checks what a caller gives, but not its material, and fills in defaults. */
static helio_status resolve_directions(const helio_shading_point *given, helio_shading_point *point)
{
    *point = *given;
    const float *flat = point->geometric_normal;
    if (flat[0] == 0.0f && flat[1] == 0.0f && flat[2] == 0.0f)
        memcpy(point->geometric_normal, point->normal, sizeof point->normal);
    HELIO_TRY(check_unit("normal", point->normal));
    HELIO_TRY(check_unit("geometric normal", point->geometric_normal));
    return check_unit("view", point->view);
}

static bool is_same_colour(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool is_same_material(const helio_material *a, const helio_material *b)
{
    return a->kind == b->kind && is_same_colour(a->diffuse, b->diffuse) && is_same_colour(a->specular, b->specular) &&
           a->exponent == b->exponent && a->metallic == b->metallic && a->roughness == b->roughness;
}

/* The renderer, which makes its points itself, does without. */
static helio_status resolve_points(uint32_t count, const helio_shading_point *given, helio_shading_point *points)
{
    for (uint32_t i = 0; i < count; i++) {
        HELIO_TRY(resolve_directions(&given[i], &points[i]));
        /* Neighbours mostly have the same. */
        if (i == 0 || !is_same_material(&given[i].material, &given[i - 1].material))
            HELIO_TRY(helio_material_check(&given[i].material));
    }
    return HELIO_OK;
}

helio_status helio_estimate(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                            float radiance[3], helio_estimate_info *info)
{
    if (radiance == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_estimate needs a place for the radiance");
    return helio_estimate_points(pools, 1, point, desc, (float(*)[3])radiance, info);
}

/* At most POINT_BLOCK of them. */
static helio_status estimate_checked(const helio_pools *pools, uint32_t count, const helio_shading_point *given,
                                     const helio_estimate_desc *desc, float (*radiance)[3], helio_estimate_info *infos)
{
    helio_shading_point points[POINT_BLOCK];
    estimate_result results[POINT_BLOCK];
    HELIO_TRY(resolve_points(count, given, points));
    estimate_points(pools, count, points, desc, results);
    for (uint32_t i = 0; i < count; i++) {
        estimate_radiance(&results[i], radiance[i]);
        if (infos != NULL)
            infos[i] = results[i].info;
    }
    return HELIO_OK;
}

helio_status helio_estimate_points(const helio_pools *pools, uint32_t count, const helio_shading_point *points,
                                   const helio_estimate_desc *given, float (*radiance)[3], helio_estimate_info *infos)
{
    helio_estimate_desc desc;
    if (count > 0 && (points == NULL || radiance == NULL))
        return fail(HELIO_ERR_ARGUMENT, "an estimate needs shading points and a place for their radiance");
    HELIO_TRY(estimate_resolve(pools, given, &desc));
    for (uint32_t first = 0; first < count; first += POINT_BLOCK) {
        uint32_t some = count - first < POINT_BLOCK ? count - first : POINT_BLOCK;
        HELIO_TRY(estimate_checked(pools, some, points + first, &desc, radiance + first,
                                   infos != NULL ? infos + first : NULL));
    }
    return HELIO_OK;
}

/* For one that weighs tiles. */
static void find_tile_control(gathering *g, const helio_estimate_desc *desc, float control[3])
{
    const kernel_set *kernels = kernels_of(context_isa(g->environment->context));
    float hues[3] = {0};
    sample_block block;
    for (uint32_t first = 0; first < g->counts.realised[0]; first += BLOCK_SAMPLES) {
        const uint32_t rest = g->counts.realised[0] - first;
        empty_block(&block);
        kernels->choose_tiles(g, first, rest < BLOCK_SAMPLES ? rest : BLOCK_SAMPLES, &block);
        kernels->take_tiles(g, &block);
        add_to(hues, block.hue);
    }
    control_tiles(g, desc, hues, control);
}

/* control: NULL where nobody wants it, as that of a point that weighs tiles takes its samples once more. */
static helio_status begin_checked(const helio_pools *pools, const helio_shading_point *given_point,
                                  const helio_estimate_desc *given, gathering *g, float control[3])
{
    helio_estimate_desc desc;
    helio_shading_point point;
    point_block block;
    HELIO_TRY(estimate_resolve(pools, given, &desc));
    if (given_point == NULL)
        return fail(HELIO_ERR_ARGUMENT, "an estimate needs a shading point");
    HELIO_TRY(resolve_points(1, given_point, &point));
    prepare_points(pools, 1, &point, &desc, desc.visibility == NULL && desc.is_free, &block);
    begin(g, pools, &point, &desc, &block, 0);
    if (control == NULL)
        return HELIO_OK;
    memset(control, 0, 3 * sizeof *control);
    find_control(pools, &point, &desc, &block, 0, control);
    if (g->has_tiles)
        find_tile_control(g, &desc, control);
    return HELIO_OK;
}

static uint32_t pool_of(const gathering *g, uint32_t technique)
{
    if (g->has_tiles)
        return HELIO_POOL_OF_TILES;
    return g->pools->bins != NULL ? g->pool : technique;
}

/* In its pool. */
static uint32_t first_of(const gathering *g, uint32_t technique)
{
    return g->has_tiles ? 0 : g->windows[technique] - pool_of(g, technique) * g->pools->pool_length;
}

helio_status helio_count(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                         helio_counts *counts)
{
    gathering g;
    float control[3];
    if (counts == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_count needs a place for the counts");
    HELIO_TRY(begin_checked(pools, point, desc, &g, control));
    *counts = g.counts;
    memcpy(counts->control, control, sizeof counts->control);
    memset(counts->pool, 0, sizeof counts->pool);
    memset(counts->first, 0, sizeof counts->first);
    for (uint32_t k = 0; k < pools->techniques; k++) {
        counts->pool[k] = pool_of(&g, k);
        if (counts->realised[k] > 0)
            counts->first[k] = first_of(&g, k);
    }
    return HELIO_OK;
}

/* taken: how many samples of the technique came before. */
static uint32_t number_of(const gathering *g, const sample_block *block, uint32_t i, uint32_t technique, uint32_t taken)
{
    if (technique == TECHNIQUE_SURFACE)
        return 0;
    return g->has_tiles ? block->draws[i].element : first_of(g, technique) + taken;
}

static void write_sample(const gathering *g, const sample_block *block, uint32_t i, uint32_t technique, uint32_t taken,
                         helio_sample *sample)
{
    vec3_to(block_direction(g, block, i), sample->direction);
    sample->contribution[0] = block->red[i];
    sample->contribution[1] = block->green[i];
    sample->contribution[2] = block->blue[i];
    sample->density = block->density[i];
    sample->technique = technique;
    sample->number = number_of(g, block, i, technique, taken);
}

helio_status helio_gather(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                          helio_sample *samples, uint32_t *count)
{
    gathering g;
    sample_block block;
    uint32_t taken = 0, technique = 0, start = 0, end = 0; /* of the samples of technique - 1 */
    if (samples == NULL || count == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_gather needs places for samples and their count");
    HELIO_TRY(begin_checked(pools, point, desc, &g, NULL));
    const kernel_set *kernels = kernels_of(context_isa(g.environment->context));
    block_plan plan;
    for (sample_cursor cursor = {0}; choose_block(&g, kernels, &cursor, &plan, &block);) {
        take_block(&g, kernels, &plan, &block);
        for (uint32_t i = 0; i < block.count; i++, taken++) {
            while (taken == end) {
                start = end;
                end += g.counts.realised[technique++];
            }
            write_sample(&g, &block, i, technique - 1, taken - start, &samples[taken]);
        }
    }
    *count = taken;
    return HELIO_OK;
}
