/* SPDX-License-Identifier: MIT
 *
 * The estimator: multi-sample MIS with the balance heuristic over the light techniques (a pool per face, or one) and
 * the surface technique (BRDF or cosine). Every sample contributes L rho cos / sum_k m_k pdf_k, with the expected
 * counts m_k. */
#include "sampling/estimate.h"

#include "core/error.h"
#include "core/random.h"
#include "sampling/brdf.h"
#include "sampling/pools.h"

#include <string.h>

enum { DEFAULT_SAMPLES = 64, BATCH = 64 };
static const float DEFAULT_BRDF_SHARE = 0.5f;

/* Streams of random numbers of a point. */
enum { STREAM_ROUNDING = 1, STREAM_SURFACE = 2, STREAM_WINDOW = 3 };

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
    if (desc->brdf_share == 0.0f)
        desc->brdf_share = DEFAULT_BRDF_SHARE;
    HELIO_TRY(estimate_check_share(desc->brdf_share));
    return HELIO_OK;
}

/* What is known about a point before its samples: all directions in the map's space. */
typedef struct gathering {
    const helio_pools *pools;
    const helio_environment *environment;
    brdf surface;  /* what reflects */
    brdf proposal; /* what draws surface samples: the surface, or a diffuse stand-in for COSINE */
    vec3 geometric_normal;
    helio_counts counts;
    uint32_t windows[CUBE_FACES];
    uint32_t surface_seed;
} gathering;

/* ---- counts ---- */

static float light_weight(const helio_pools *pools, uint32_t technique, vec3 normal, bool no_beta)
{
    const helio_tables *tables = pools->tables;
    if (pools->parts.light == STRATEGY_LIGHT_WHOLE)
        return tables->faces[CUBE_FACES] != 0 ? 1.0f : 0.0f;
    float beta = strategy_beta(technique, normal);
    if (no_beta)
        beta = beta > 0.0f ? 1.0f : 0.0f;
    return beta * (float)tables->flux[technique];
}

/* Expected counts m_k: samples in proportion to beta_f x flux_f, and a fixed share for the surface. All are 0 where no
 * light can come from above the horizon. */
static void expect_counts(const helio_pools *pools, const helio_estimate_desc *desc, vec3 normal,
                          float expected[TECHNIQUES])
{
    bool has_surface = pools->parts.surface != STRATEGY_SURFACE_NONE;
    float samples = (float)desc->samples, total = 0.0f;
    memset(expected, 0, TECHNIQUES * sizeof *expected);
    if (pools->count == 0) {
        expected[TECHNIQUE_SURFACE] = samples;
        return;
    }
    for (uint32_t k = 0; k < pools->count; k++)
        total += expected[k] = light_weight(pools, k, normal, desc->no_beta);
    if (!(total > 0.0f)) {
        memset(expected, 0, TECHNIQUES * sizeof *expected);
        return;
    }
    float surface_samples = has_surface ? samples * desc->brdf_share : 0.0f;
    for (uint32_t k = 0; k < pools->count; k++)
        expected[k] *= (samples - surface_samples) / total;
    expected[TECHNIQUE_SURFACE] = surface_samples;
}

/* ---- samples ---- */

static void begin(gathering *g, const helio_pools *pools, const helio_shading_point *point,
                  const helio_estimate_desc *desc)
{
    const helio_environment *environment = pools->tables->environment;
    vec3 normal = environment_to_map(environment, vec3_from(point->normal));
    vec3 view = brdf_lift_view(normal, environment_to_map(environment, vec3_from(point->view)));
    g->pools = pools;
    g->environment = environment;
    g->geometric_normal = environment_to_map(environment, vec3_from(point->geometric_normal));
    g->surface = brdf_prepare(&point->material, normal, view);
    g->proposal = g->surface;
    if (pools->parts.surface == STRATEGY_SURFACE_COSINE) {
        const helio_material matte = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};
        g->proposal = brdf_prepare(&matte, normal, view);
    }
    expect_counts(pools, desc, normal, g->counts.expected);
    strategy_round(g->counts.expected, desc->samples, unit_float(hash_combine(point->seed, STREAM_ROUNDING)),
                   g->counts.realised);
    g->surface_seed = hash_combine(point->seed, STREAM_SURFACE);
    uint32_t choice = hash_combine(point->seed, STREAM_WINDOW);
    for (uint32_t k = 0; k < pools->count; k++)
        g->windows[k] = pools_window(pools, g->counts.realised[k], hash_combine(choice, k));
}

static float surface_density(const gathering *g, vec3 direction)
{
    float expected = g->counts.expected[TECHNIQUE_SURFACE];
    return expected > 0.0f ? expected * brdf_density(&g->proposal, direction) : 0.0f;
}

/* Radiance x BRDF x cosine / density, where the direction is above both horizons. */
static void weigh(const gathering *g, vec3 direction, const float radiance[3], helio_sample *sample)
{
    float cosine = dot(g->surface.normal, direction), value[3];
    vec3_to(environment_to_world(g->environment, direction), sample->direction);
    sample->contribution[0] = sample->contribution[1] = sample->contribution[2] = 0.0f;
    if (!(cosine > 0.0f) || !(dot(g->geometric_normal, direction) > 0.0f) || !(sample->density > 0.0f))
        return;
    brdf_value(&g->surface, direction, value);
    float factor = cosine / sample->density * g->environment->intensity;
    for (int c = 0; c < 3; c++)
        sample->contribution[c] = radiance[c] * value[c] * factor;
}

static void take_light_sample(const gathering *g, uint32_t technique, uint32_t index, helio_sample *sample)
{
    const helio_pools *pools = g->pools;
    size_t i = (size_t)technique * pools->pool_length + g->windows[technique] + index;
    vec3 direction = {pools->direction_x[i], pools->direction_y[i], pools->direction_z[i]};
    const float radiance[3] = {pools->red[i], pools->green[i], pools->blue[i]};
    sample->technique = technique;
    sample->density = g->counts.expected[technique] * pools->density[i] + surface_density(g, direction);
    weigh(g, direction, radiance, sample);
}

/* sum m_k pdf_k of the light techniques: the density of the one face that holds the direction. */
static float light_density(const gathering *g, cube_position at, uint32_t row, uint32_t column)
{
    const helio_pools *pools = g->pools;
    if (pools->count == 0)
        return 0.0f;
    face_table table = tables_face(pools->tables, at.face);
    float density = face_table_density(&table, row, column, at.u, at.v);
    return pools->parts.light == STRATEGY_LIGHT_WHOLE
               ? g->counts.expected[0] * density * tables_face_probability(pools->tables, at.face)
               : g->counts.expected[at.face] * density;
}

static void take_surface_sample(const gathering *g, uint32_t index, helio_sample *sample)
{
    float u = unit_float(scrambled_sobol(index, 0, g->surface_seed));
    float v = unit_float(scrambled_sobol(index, 1, g->surface_seed));
    float lobe = unit_float(scrambled_sobol(index, 2, g->surface_seed));
    vec3 direction = brdf_sample(&g->proposal, lobe, u, v);
    cube_position at = cube_project(direction);
    uint32_t row = cube_texel(at.v, g->environment->size), column = cube_texel(at.u, g->environment->size);
    sample->technique = TECHNIQUE_SURFACE;
    sample->density = surface_density(g, direction) + light_density(g, at, row, column);
    weigh(g, direction, environment_texel(g->environment, at.face, row, column), sample);
}

/* Samples first ... first + count - 1 of a technique. */
static void take_samples(const gathering *g, uint32_t technique, uint32_t first, uint32_t count, helio_sample *samples)
{
    for (uint32_t i = 0; i < count; i++)
        if (technique == TECHNIQUE_SURFACE)
            take_surface_sample(g, first + i, &samples[i]);
        else
            take_light_sample(g, technique, first + i, &samples[i]);
}

/* ---- sums ---- */

static bool is_useful(const helio_sample *sample)
{
    return sample->contribution[0] > 0.0f || sample->contribution[1] > 0.0f || sample->contribution[2] > 0.0f;
}

static void add_contribution(float sum[3], const helio_sample *sample)
{
    for (int c = 0; c < 3; c++)
        sum[c] += sample->contribution[c];
}

/* Asks for all directions at once: ray tracers answer many faster than one by one. */
static void find_visible(const helio_shading_point *point, const helio_estimate_desc *desc, const helio_sample *samples,
                         const uint32_t *useful, uint32_t count, bool *visible)
{
    float x[BATCH], y[BATCH], z[BATCH];
    for (uint32_t i = 0; i < count; i++) {
        const float *direction = samples[useful[i]].direction;
        x[i] = direction[0];
        y[i] = direction[1];
        z[i] = direction[2];
    }
    desc->visibility(desc->user, point, count, x, y, z, visible);
}

static void add_samples(const helio_shading_point *point, const helio_estimate_desc *desc, const helio_sample *samples,
                        uint32_t count, estimate_result *result)
{
    uint32_t useful[BATCH], useful_count = 0;
    bool visible[BATCH];
    for (uint32_t i = 0; i < count; i++)
        if (is_useful(&samples[i]))
            useful[useful_count++] = i;
    if (desc->visibility != NULL && useful_count > 0)
        find_visible(point, desc, samples, useful, useful_count, visible);
    for (uint32_t i = 0; i < useful_count; i++) {
        add_contribution(result->unoccluded, &samples[useful[i]]);
        if (desc->visibility == NULL || visible[i])
            add_contribution(result->visible, &samples[useful[i]]);
    }
    result->info.samples += count;
    result->info.useful += useful_count;
    result->info.rays += desc->visibility != NULL ? useful_count : 0;
}

void estimate_point(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                    estimate_result *result)
{
    gathering g = {0};
    helio_sample samples[BATCH];
    begin(&g, pools, point, desc);
    *result = (estimate_result){0};
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++) {
        uint32_t count = g.counts.realised[technique];
        for (uint32_t first = 0; first < count; first += BATCH) {
            uint32_t part = count - first < BATCH ? count - first : BATCH;
            take_samples(&g, technique, first, part, samples);
            add_samples(point, desc, samples, part, result);
        }
    }
}

/* ---- the public functions ---- */

static helio_status check_unit(const char *name, const float direction[3])
{
    float size = length(vec3_from(direction));
    if (fabsf(size - 1.0f) <= 1e-3f)
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT, "the %s of a shading point has length %g; give a unit vector", name, (double)size);
}

/* Checks what a caller gives and fills in defaults; the renderer, which makes its points itself, does without. */
static helio_status resolve_point(const helio_shading_point *given, helio_shading_point *point)
{
    if (given == NULL)
        return fail(HELIO_ERR_ARGUMENT, "an estimate needs a shading point");
    *point = *given;
    const float *flat = point->geometric_normal;
    if (flat[0] == 0.0f && flat[1] == 0.0f && flat[2] == 0.0f)
        memcpy(point->geometric_normal, point->normal, sizeof point->normal);
    HELIO_TRY(check_unit("normal", point->normal));
    HELIO_TRY(check_unit("geometric normal", point->geometric_normal));
    HELIO_TRY(check_unit("view", point->view));
    return helio_material_check(&point->material);
}

helio_status helio_estimate(const helio_pools *pools, const helio_shading_point *given_point,
                            const helio_estimate_desc *given, float radiance[3], helio_estimate_info *info)
{
    helio_estimate_desc desc;
    helio_shading_point point;
    if (radiance == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_estimate needs a place for the radiance");
    HELIO_TRY(estimate_resolve(pools, given, &desc));
    HELIO_TRY(resolve_point(given_point, &point));
    estimate_result result;
    estimate_point(pools, &point, &desc, &result);
    memcpy(radiance, result.visible, sizeof result.visible);
    if (info != NULL)
        *info = result.info;
    return HELIO_OK;
}

static helio_status begin_checked(const helio_pools *pools, const helio_shading_point *given_point,
                                  const helio_estimate_desc *given, gathering *g)
{
    helio_estimate_desc desc;
    helio_shading_point point;
    HELIO_TRY(estimate_resolve(pools, given, &desc));
    HELIO_TRY(resolve_point(given_point, &point));
    begin(g, pools, &point, &desc);
    return HELIO_OK;
}

helio_status helio_count(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                         helio_counts *counts)
{
    gathering g = {0};
    if (counts == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_count needs a place for the counts");
    HELIO_TRY(begin_checked(pools, point, desc, &g));
    *counts = g.counts;
    return HELIO_OK;
}

helio_status helio_gather(const helio_pools *pools, const helio_shading_point *point, const helio_estimate_desc *desc,
                          helio_sample *samples, uint32_t *count)
{
    gathering g = {0};
    uint32_t taken = 0;
    if (samples == NULL || count == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_gather needs places for samples and their count");
    HELIO_TRY(begin_checked(pools, point, desc, &g));
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++) {
        take_samples(&g, technique, 0, g.counts.realised[technique], samples + taken);
        taken += g.counts.realised[technique];
    }
    *count = taken;
    return HELIO_OK;
}
