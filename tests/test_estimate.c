/* SPDX-License-Identifier: MIT
 *
 * The estimator against exact quadrature: unbiased for every strategy, material and map. */
#include "support.h"

#include "core/random.h"
#include "env/environment.h"
#include "sampling/brdf.h"
#include "sampling/estimate.h"
#include "sampling/kernels.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POOL_LENGTH = 64, SAMPLES = 8, SEEDS = 1200, LARGEST_CUBE = 16, BINS_PER_EDGE = 2 };

/* False alarms: at most 8 strategies x 5 maps x 24 points x 2 tests of |z| < 6, p = 2e-9 each: below 1e-5 in all. */
static const double LARGEST_Z = 6.0;

static const helio_strategy strategies[] = {
    HELIO_STRATEGY_COSINE, HELIO_STRATEGY_BRDF,      HELIO_STRATEGY_LIGHT,   HELIO_STRATEGY_LIGHT_BRDF,
    HELIO_STRATEGY_FACE,   HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
enum { STRATEGIES = sizeof strategies / sizeof strategies[0] };

static const helio_material matte = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.5f, 0.2f}};
static const helio_material white = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};
static const helio_material glossy = {
    .kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.5f, 0.5f, 0.5f}, .exponent = 20};
static const helio_material metal = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 0.7f, .roughness = 0.5f};
static const helio_material gold = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 1.0f, .roughness = 0.4f};

/* ---- maps and points ---- */

/* Strips of six faces, N = R, so that the cube holds these very numbers. */
typedef struct test_map {
    const char *name;
    uint32_t size;
    float pixels[6 * LARGEST_CUBE * LARGEST_CUBE * 3];
    helio_orientation orientation;
} test_map;

static float *map_pixel(test_map *map, uint32_t face, uint32_t row, uint32_t column)
{
    return map->pixels + ((face * map->size + row) * map->size + column) * 3;
}

static void fill_random(test_map *map, uint64_t seed, float low, float high)
{
    for (size_t i = 0; i < (size_t)6 * map->size * map->size * 3; i++)
        map->pixels[i] = low + (high - low) * (float)random_unit(&seed);
}

static void set_pixel(test_map *map, uint32_t face, uint32_t row, uint32_t column, float value)
{
    float *pixel = map_pixel(map, face, row, column);
    pixel[0] = value;
    pixel[1] = 0.9f * value;
    pixel[2] = 0.7f * value;
}

enum { MAPS = 5 };

static void make_maps(test_map maps[MAPS])
{
    memset(maps, 0, MAPS * sizeof *maps);
    maps[0] = (test_map){.name = "even sky, R = 4", .size = 4};
    fill_random(&maps[0], 1, 0.2f, 1.5f);
    maps[1] = (test_map){.name = "sun of 1e6, R = 16", .size = 16};
    fill_random(&maps[1], 2, 0.5f, 1.5f);
    set_pixel(&maps[1], 4, 3, 12, 1e6f);
    maps[2] = (test_map){.name = "black faces and rows, R = 8", .size = 8};
    fill_random(&maps[2], 3, 0.0f, 2.0f);
    memset(map_pixel(&maps[2], 0, 0, 0), 0, 64 * 3 * sizeof(float));
    memset(map_pixel(&maps[2], 3, 0, 0), 0, 64 * 3 * sizeof(float));
    memset(map_pixel(&maps[2], 4, 2, 0), 0, 3 * 8 * 3 * sizeof(float));
    set_pixel(&maps[2], 2, 7, 0, 300.0f);
    maps[3] = (test_map){.name = "one texel a face, R = 1", .size = 1};
    fill_random(&maps[3], 4, 0.1f, 3.0f);
    maps[4] = (test_map){.name = "turned and mirrored, R = 8", .size = 8, .orientation = {37.0f, true, 2.5f}};
    fill_random(&maps[4], 5, 0.0f, 1.0f);
    set_pixel(&maps[4], 1, 4, 4, 500.0f);
}

enum { NORMALS = 6, MATERIALS = 4, POINTS = NORMALS * MATERIALS };

/* Normals along an axis, along an edge, along a corner and in between; views from above to grazing; one geometric
 * normal that differs from the shading normal. */
static void make_points(helio_shading_point points[POINTS])
{
    static const vec3 normals[NORMALS] = {{0, 1, 0},  {0.6f, 0.8f, 0},  {1, 1, 1},
                                          {0, 0, -1}, {-0.2f, 0.3f, 1}, {0.3f, -0.9f, -0.4f}};
    static const float tilts[NORMALS] = {0.0f, 0.5f, 1.0f, 2.0f, 30.0f, 0.3f};
    const helio_material *materials[MATERIALS] = {&matte, &glossy, &metal, &gold};
    for (int i = 0; i < POINTS; i++) {
        vec3 normal = normalize(normals[i / MATERIALS]), tangent, bitangent;
        tangent_frame(normal, &tangent, &bitangent);
        vec3 view = normalize(add_scaled(add_scaled(normal, tangent, tilts[i / MATERIALS]), bitangent, 0.1f));
        vec3 flat = i / MATERIALS == 2 ? normalize(add_scaled(normal, tangent, 0.4f)) : normal;
        points[i] = (helio_shading_point){.material = *materials[i % MATERIALS]};
        vec3_to(normal, points[i].normal);
        vec3_to(flat, points[i].geometric_normal);
        vec3_to(view, points[i].view);
    }
}

typedef light_world world;

static world make_world(helio_context *context, const test_map *map, helio_weighting weighting, helio_strategy strategy,
                        uint32_t length)
{
    const helio_pools_desc desc = {.strategy = strategy, .length = length, .bins = BINS_PER_EDGE};
    world w = make_light_world(context, map->pixels, map->size, weighting, &desc);
    assert_ok(helio_environment_orient(w.environment, &map->orientation));
    return w;
}

static void destroy_world(world *w)
{
    destroy_light_world(w);
}

/* ---- choices by chance ---- */

/* The counts of a point, its pool among them, with a seed or another, and how often. */
enum { MOST_CHOICES = 32 };
typedef struct count_choice {
    uint32_t count;
    helio_counts counts[MOST_CHOICES];
    double shares[MOST_CHOICES];
} count_choice;

static void add_choice(count_choice *choice, const helio_counts *counts, double share)
{
    uint32_t k = 0;
    while (k < choice->count &&
           (choice->counts[k].pool[0] != counts->pool[0] || choice->counts[k].expected[6] != counts->expected[6]))
        k++;
    assert_true(k < MOST_CHOICES);
    choice->count = k == choice->count ? k + 1 : choice->count;
    choice->counts[k] = *counts;
    choice->shares[k] += share;
}

/* With the seeds seed_of(0) ... seed_of(seeds - 1). */
static count_choice choices_of(const world *w, const helio_shading_point *given, const helio_estimate_desc *desc,
                               uint32_t (*seed_of)(uint32_t), uint32_t seeds)
{
    count_choice choice = {0};
    helio_shading_point point = *given;
    for (uint32_t i = 0; i < seeds; i++) {
        helio_counts counts;
        point.seed = seed_of(i);
        assert_ok(helio_count(w->pools, &point, desc, &counts));
        add_choice(&choice, &counts, 1.0 / seeds);
    }
    return choice;
}

/* ---- quadrature ---- */

typedef struct quadrature {
    double radiance;       /* red channel of what leaves the point */
    double variance_bound; /* of one estimate: integral of f^2 / sum_k m_k pdf_k, for independent samples */
} quadrature;

/* What techniques draw by, for one point. */
typedef struct drawing_surface {
    brdf surface; /* as the surface technique draws */
    bool has_tiles;
    point_tiles tiles;
} drawing_surface;

static double tiles_density_of(const world *w, const drawing_surface *s, const face_place *at)
{
    const tiles *t = w->pools->bins->tiles;
    return (double)point_tiles_probability(&s->tiles, tiles_position(t, at->face, at->row, at->column)) *
           (double)face_place_density(at->u, at->v, tables_texel_weight(w->tables, at), tiles_unit_density(t, at));
}

static double strategy_density(const world *w, const helio_counts *counts, const drawing_surface *s, vec3 map_direction)
{
    const brdf *surface = &s->surface;
    cube_position at = cube_project(map_direction);
    uint32_t size = w->tables->size;
    const face_place place = {at.face, cube_texel(at.v, size), cube_texel(at.u, size), at.u, at.v};
    double sum = 0;
    if (w->pools->parts.light == STRATEGY_LIGHT_FACES)
        sum = (double)counts->expected[at.face] * (double)pools_density(w->pools, at.face, &place);
    else if (counts->pool[0] == HELIO_POOL_OF_TILES)
        sum = (double)counts->expected[0] * tiles_density_of(w, s, &place);
    else if (w->pools->parts.light != STRATEGY_LIGHT_NONE)
        sum = (double)counts->expected[0] * (double)pools_density(w->pools, counts->pool[0], &place);
    if (w->pools->parts.surface == STRATEGY_SURFACE_COSINE)
        sum += (double)counts->expected[6] * fmax(0.0, (double)dot(surface->normal, map_direction)) / PI;
    else if (w->pools->parts.surface == STRATEGY_SURFACE_BRDF)
        sum += (double)counts->expected[6] * (double)brdf_density(surface, map_direction);
    return sum;
}

/* is_free: as in helio_estimate_desc. */
static void prepare(const world *w, const helio_shading_point *point, vec3 normal, vec3 view, bool is_free,
                    drawing_surface *s)
{
    s->surface = brdf_prepare(&point->material, normal, view);
    s->has_tiles = w->pools->bins != NULL && w->pools->parts.surface == STRATEGY_SURFACE_BRDF &&
                   s->surface.kind != HELIO_MATERIAL_DIFFUSE;
    if (!s->has_tiles)
        return;
    tile_lobe lobe;
    tile_lobe_prepare(&lobe, w->pools->bins->tiles, &s->surface);
    lobe.knows_diffuse = is_free && lobe.diffuse > 0.0f;
    lobe.geometric_normal = environment_to_map(w->environment, vec3_from(point->geometric_normal));
    kernels_of(ISA_SCALAR)->weigh_point(w->pools->bins->tiles, &lobe, &s->tiles);
    for (uint32_t group = 0; group < TILE_GROUPS; group++)
        kernels_of(ISA_SCALAR)->know_tiles(&s->tiles, group);
    s->surface.specular_share = 1.0f;
}

/* Midpoints of a fine grid in each texel; choice may be NULL if the bound is not wanted. */
static quadrature integrate(const world *w, const helio_shading_point *point, const count_choice *choice)
{
    const helio_environment *environment = w->environment;
    uint32_t size = environment->size, parts = size >= 16 ? 12 : size >= 8 ? 20 : size >= 4 ? 40 : 160;
    vec3 normal = environment_to_map(environment, vec3_from(point->normal));
    vec3 flat = environment_to_map(environment, vec3_from(point->geometric_normal));
    vec3 view = brdf_lift_view(normal, environment_to_map(environment, vec3_from(point->view)));
    static drawing_surface surface;
    prepare(w, point, normal, view, false, &surface);
    quadrature result = {0, 0};
    double cell = 2.0 / (size * parts);
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < size * parts; y++)
            for (uint32_t x = 0; x < size * parts; x++) {
                double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1;
                vec3 direction = cube_direction(face, (float)u, (float)v);
                double cosine = (double)dot(normal, direction), radius2 = 1 + u * u + v * v;
                float value[3], radiance = environment_texel(environment, face, y / parts, x / parts)[0];
                if (!(cosine > 0) || !(dot(flat, direction) > 0.0f) || !(radiance > 0.0f))
                    continue;
                brdf_value(&surface.surface, direction, value);
                double f = (double)radiance * (double)environment->intensity * (double)value[0] * cosine;
                double solid_angle = cell * cell / (radius2 * sqrt(radius2));
                result.radiance += f * solid_angle;
                for (uint32_t k = 0; choice != NULL && k < choice->count; k++)
                    result.variance_bound += choice->shares[k] * f * f * solid_angle /
                                             strategy_density(w, &choice->counts[k], &surface, direction);
            }
    return result;
}

/* ---- unbiased ---- */

typedef struct moments {
    double sum, sum2;
} moments;

static uint32_t seed_of_run(uint32_t seed)
{
    return hash_combine(seed, 99);
}

static void run_seeds(world *w, helio_shading_point points[POINTS], const helio_estimate_desc *desc,
                      moments sums[POINTS])
{
    const bool has_control = w->pools->control != NULL; /* what it takes away may be more than there is */
    memset(sums, 0, POINTS * sizeof *sums);
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        assert_ok(helio_pools_draw(w->pools, seed, 1));
        for (int i = 0; i < POINTS; i++) {
            float radiance[3];
            points[i].seed = seed_of_run(seed);
            assert_ok(helio_estimate(w->pools, &points[i], desc, radiance, NULL));
            assert_true(isfinite(radiance[0]) && (radiance[0] >= 0.0f || has_control));
            sums[i].sum += (double)radiance[0];
            sums[i].sum2 += (double)radiance[0] * (double)radiance[0];
        }
    }
}

/* Of all points that shine by a lobe alone: how often one read a pool, and how often one weighed tiles. */
static double calm_share, weighing_share;

static void add_shares(const helio_shading_point *point, const count_choice *choice)
{
    for (uint32_t k = 0; k < choice->count && point->material.metallic == 1.0f; k++)
        *(choice->counts[k].pool[0] == HELIO_POOL_OF_TILES ? &weighing_share : &calm_share) += choice->shares[k];
}

/* Two z-tests. The first takes its variance from quadrature, which sees a sun that no sample may have met; the second
 * takes the variance found, which is smaller because the samples are stratified, where the light is even enough to
 * trust it. */
static void check_point(const world *w, const helio_shading_point *point, const helio_estimate_desc *desc,
                        const moments *sums, bool even, const char *what)
{
    const count_choice choice = choices_of(w, point, desc, seed_of_run, SEEDS);
    add_shares(point, &choice);
    quadrature exact = integrate(w, point, &choice);
    double mean = sums->sum / SEEDS, slack = 5e-4 * exact.radiance;
    double found = fmax(0.0, sums->sum2 / SEEDS - mean * mean);
    double off = fmax(0.0, fabs(mean - exact.radiance) - slack);
    double z = off / sqrt(exact.variance_bound / SEEDS + 1e-30);
    if (z > LARGEST_Z)
        fail_msg("%s: mean %g, exact %g, z = %.1f by the variance of quadrature", what, mean, exact.radiance, z);
    z = off / sqrt(found / SEEDS + 1e-30);
    if (even && z > LARGEST_Z)
        fail_msg("%s: mean %g, exact %g, z = %.1f by the variance found", what, mean, exact.radiance, z);
}

static void check_unbiased(helio_strategy strategy, helio_weighting weighting, const helio_estimate_desc *desc)
{
    static test_map maps[MAPS];
    helio_shading_point points[POINTS];
    moments sums[POINTS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    make_points(points);
    for (int m = 0; m < MAPS; m++) {
        world w = make_world(context, &maps[m], weighting, strategy, POOL_LENGTH);
        run_seeds(&w, points, desc, sums);
        for (int i = 0; i < POINTS; i++) {
            char what[200];
            snprintf(what, sizeof what, "%s, %s, point %d", helio_strategy_name(strategy), maps[m].name, i);
            check_point(&w, &points[i], desc, &sums[i], m != 1, what);
        }
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

static void unbiased_cosine(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_COSINE, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_brdf(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_BRDF, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_light(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_LIGHT, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_light_brdf(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_LIGHT_BRDF, HELIO_WEIGHTING_PAPER, NULL);
}

static void unbiased_light_brdf_compensated(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_LIGHT_BRDF, HELIO_WEIGHTING_COMPENSATED, NULL);
}

static void unbiased_face_brdf_compensated(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_FACE_BRDF, HELIO_WEIGHTING_COMPENSATED, NULL);
}

/* Where nothing is above the mean, the BRDF gets all samples. */
static void compensation_of_even_light_is_brdf_sampling(void **state)
{
    (void)state;
    test_map map = {.name = "constant", .size = 8};
    fill_random(&map, 1, 0.7f, 0.7f);
    helio_context *context = make_context(1, NULL);
    world w = make_world(context, &map, HELIO_WEIGHTING_COMPENSATED, HELIO_STRATEGY_FACE_BRDF, POOL_LENGTH);
    world plain = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_BRDF, POOL_LENGTH);
    helio_shading_point points[POINTS];
    make_points(points);
    for (int i = 0; i < POINTS; i++) {
        float a[3], b[3];
        assert_ok(helio_estimate(w.pools, &points[i], NULL, a, NULL));
        assert_ok(helio_estimate(plain.pools, &points[i], NULL, b, NULL));
        assert_memory_equal(a, b, sizeof a);
        assert_true(a[0] > 0);
    }
    destroy_world(&plain);
    destroy_world(&w);
    helio_context_destroy(context);
}

/* Tables that leave light out serve none that has no BRDF samples everywhere. */
static void compensation_is_for_strategies_with_brdf_samples(void **state)
{
    (void)state;
    test_map map = {.name = "noise", .size = 8};
    fill_random(&map, 1, 0.1f, 0.7f);
    helio_context *context = make_context(1, NULL);
    world w = make_world(context, &map, HELIO_WEIGHTING_COMPENSATED, HELIO_STRATEGY_FACE_BRDF, POOL_LENGTH);
    for (helio_strategy strategy = HELIO_STRATEGY_AUTO; strategy <= HELIO_STRATEGY_PRODUCT_BRDF; strategy++) {
        const bool is_served = strategy == HELIO_STRATEGY_COSINE || strategy == HELIO_STRATEGY_BRDF ||
                               strategy == HELIO_STRATEGY_LIGHT_BRDF || strategy == HELIO_STRATEGY_FACE_BRDF;
        helio_pools *pools;
        helio_status status = helio_pools_create(w.tables, &(helio_pools_desc){.strategy = strategy}, &pools);
        assert_int_equal(status, is_served ? HELIO_OK : HELIO_ERR_ARGUMENT);
        if (!is_served)
            assert_non_null(strstr(helio_last_error(), "take light+brdf or face+brdf"));
        helio_pools_destroy(pools);
    }
    destroy_world(&w);
    helio_context_destroy(context);
}

static void unbiased_face(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_FACE, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_face_paper_weighting_without_beta(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_FACE, HELIO_WEIGHTING_PAPER, &(helio_estimate_desc){.no_beta = true, .samples = 5});
}

static void unbiased_face_brdf(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_FACE_BRDF, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_face_brdf_uneven_share(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_AUTO, HELIO_WEIGHTING_SOLID_ANGLE,
                   &(helio_estimate_desc){.brdf_share = 0.15f, .samples = 7});
}

static void unbiased_product(void **state)
{
    (void)state;
    check_unbiased(HELIO_STRATEGY_PRODUCT, HELIO_WEIGHTING_SOLID_ANGLE, NULL);
}

static void unbiased_product_brdf(void **state)
{
    (void)state;
    calm_share = weighing_share = 0;
    check_unbiased(HELIO_STRATEGY_PRODUCT_BRDF, HELIO_WEIGHTING_PAPER,
                   &(helio_estimate_desc){.brdf_share = 0.3f, .samples = 13});
    print_message("of the points of metal %.1f are calm, %.1f weigh tiles\n", calm_share, weighing_share);
    assert_true(calm_share > 1 && weighing_share > 1);
}

/* ---- drawn samples against their density ---- */

enum { BINS = 6 * 8 * 8, CELLS = 12 }; /* texels of a cube of size 8; quadrature cells along a texel's edge */

/* Samples that each texel should get from one estimate: integral of sum_k m_k pdf_k. */
static void expect_bins(const world *w, const helio_shading_point *point, const count_choice *choice,
                        double expected[BINS])
{
    const helio_environment *environment = w->environment;
    vec3 normal = environment_to_map(environment, vec3_from(point->normal));
    vec3 view = brdf_lift_view(normal, environment_to_map(environment, vec3_from(point->view)));
    static drawing_surface surface;
    prepare(w, point, normal, view, false, &surface);
    double cell = 2.0 / (8 * CELLS);
    memset(expected, 0, BINS * sizeof *expected);
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < 8 * CELLS; y++)
            for (uint32_t x = 0; x < 8 * CELLS; x++) {
                double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1, radius2 = 1 + u * u + v * v;
                vec3 direction = cube_direction(face, (float)u, (float)v);
                double *bin = &expected[(face * 8 + y / CELLS) * 8 + x / CELLS];
                for (uint32_t k = 0; k < choice->count; k++)
                    *bin += choice->shares[k] * strategy_density(w, &choice->counts[k], &surface, direction) * cell *
                            cell / (radius2 * sqrt(radius2));
            }
}

static uint32_t same_seed(uint32_t seed)
{
    return seed;
}

/* Everything together: pools, windows, rounding of counts, scrambled points, lobes. Stratified samples spread more
 * evenly than independent ones, so the statistic errs on the side of passing; a wrong density still stands out. */
static void samples_follow_their_density_for_every_strategy_and_material(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    const helio_material *materials[MATERIALS] = {&matte, &glossy, &metal, &gold};
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    for (int s = 0; s < STRATEGIES; s++)
        for (int m = 0; m < MATERIALS; m++) {
            world w = make_world(context, &maps[4], HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 256);
            helio_shading_point points[POINTS];
            make_points(points);
            helio_shading_point point = points[MATERIALS]; /* tilted, seen from the side */
            point.material = *materials[m];
            double observed[BINS] = {0}, expected[BINS];
            const uint32_t limit = helio_pools_sample_limit(w.pools), seeds = 2000 * 32 / limit;
            const count_choice choice = choices_of(&w, &point, NULL, same_seed, seeds);
            expect_bins(&w, &point, &choice, expected);
            for (uint32_t seed = 0; seed < seeds; seed++) {
                helio_sample samples[64];
                uint32_t count;
                point.seed = seed;
                assert_ok(helio_pools_draw(w.pools, seed, 0));
                assert_ok(helio_gather(w.pools, &point, NULL, samples, &count));
                assert_int_equal(count, limit);
                for (uint32_t i = 0; i < count; i++) {
                    cube_position at = cube_project(environment_to_map(w.environment, vec3_from(samples[i].direction)));
                    observed[(at.face * 8 + cube_texel(at.v, 8)) * 8 + cube_texel(at.u, 8)] += 1;
                }
            }
            double sum = 0;
            for (int i = 0; i < BINS; i++) {
                sum += expected[i];
                expected[i] *= seeds;
            }
            assert_true(fabs(sum / limit - 1) < 0.002); /* quadrature of lobes: a fraction of a per cent */
            double p = chi_square_tail(observed, expected, BINS, 1);
            if (p < 1e-9)
                fail_msg("%s, material %d: p = %g", helio_strategy_name(strategies[s]), m, p);
            destroy_world(&w);
        }
    helio_context_destroy(context);
}

/* ---- convergence ---- */

/* Means over more and more redrawn pools. All strategies go to the same value, at the rate of Monte Carlo or faster. */
static void all_strategies_converge_beyond_the_pools(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_shading_point points[POINTS];
    double exact[POINTS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    make_points(points);
    for (int s = 0; s < STRATEGIES; s++) {
        world w = make_world(context, &maps[2], HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], POOL_LENGTH);
        double sums[POINTS] = {0}, errors[3] = {0};
        for (int i = 0; i < POINTS; i++)
            exact[i] = integrate(&w, &points[i], NULL).radiance;
        const uint32_t stops[3] = {16, 256, 4096};
        int stop = 0;
        for (uint32_t pass = 0; pass < 4096; pass++) {
            assert_ok(helio_pools_draw(w.pools, 7, pass));
            for (int i = 0; i < POINTS; i++) {
                float radiance[3];
                points[i].seed = hash_combine(pass, (uint32_t)i);
                assert_ok(helio_estimate(w.pools, &points[i], NULL, radiance, NULL));
                sums[i] += (double)radiance[0];
            }
            if (pass + 1 < stops[stop])
                continue;
            for (int i = 0; i < POINTS; i++)
                errors[stop] += pow(sums[i] / stops[stop] / exact[i] - 1, 2) / POINTS;
            stop++;
        }
        print_message("%-10s relative error after 16, 256, 4096 passes: %.2e %.2e %.2e\n",
                      helio_strategy_name(strategies[s]), sqrt(errors[0]), sqrt(errors[1]), sqrt(errors[2]));
        /* Sixteen times as many passes: a quarter of the error. Over 18 points that is known to about a third. */
        assert_true(sqrt(errors[1]) < 0.5 * sqrt(errors[0]));
        assert_true(sqrt(errors[2]) < 0.5 * sqrt(errors[1]));
        assert_true(sqrt(errors[2]) < 0.05); /* cosine samples meet the brightest texel by chance only */
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

/* ---- closed forms ---- */

static void a_matte_furnace_returns_its_albedo(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    static test_map map = {.name = "furnace", .size = 16};
    for (size_t i = 0; i < 6 * 256 * 3; i++)
        map.pixels[i] = 1.0f;
    for (int s = 0; s < STRATEGIES; s++) {
        world w = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 256);
        helio_shading_point points[POINTS];
        make_points(points);
        for (int i = 0; i < POINTS; i += MATERIALS) {
            double sum = 0, sum2 = 0;
            const uint32_t passes = 256;
            points[i].material = white;
            memcpy(points[i].geometric_normal, points[i].normal, sizeof points[i].normal);
            for (uint32_t pass = 0; pass < passes; pass++) {
                float radiance[3];
                points[i].seed = pass;
                assert_ok(helio_pools_draw(w.pools, 3, pass));
                assert_ok(helio_estimate(w.pools, &points[i], NULL, radiance, NULL));
                /* Cosine samples of a matte surface in a furnace have no variance at all. */
                if (w.pools->parts.light == STRATEGY_LIGHT_NONE)
                    assert_float_equal(radiance[0], 1.0f, 2e-6f);
                sum += (double)radiance[0] / passes;
                sum2 += (double)radiance[0] * (double)radiance[0] / passes;
            }
            assert_true(fabs(sum - 1.0) < 6.0 * sqrt(fmax(0.0, sum2 - sum * sum) / passes) + 1e-5);
            assert_true(fabs(sum - 1.0) < 0.02);
        }
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

static void other_furnaces_return_their_quadrature_and_no_more_than_one(void **state)
{
    (void)state;
    enum { PASSES = 800 }; /* of which the mean varies by 8e-4 at most */
    helio_context *context = make_context(1, NULL);
    static test_map map = {.name = "furnace", .size = 16};
    for (size_t i = 0; i < 6 * 256 * 3; i++)
        map.pixels[i] = 1.0f;
    world w = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE_BRDF, 1024);
    helio_shading_point points[POINTS];
    make_points(points);
    for (int i = 0; i < POINTS; i++) {
        double sum = 0, exact = integrate(&w, &points[i], NULL).radiance;
        for (uint32_t pass = 0; pass < PASSES; pass++) {
            float radiance[3];
            points[i].seed = pass;
            assert_ok(helio_pools_draw(w.pools, 3, pass));
            assert_ok(helio_estimate(w.pools, &points[i], NULL, radiance, NULL));
            sum += (double)radiance[0] / PASSES;
        }
        assert_float_equal(sum, exact, 3e-3);
        assert_true(sum <= 1.0 + 3e-3);
    }
    destroy_world(&w);
    helio_context_destroy(context);
}

/* Irradiance from a spherical polygon of radiance 1 that lies above the horizon: Lambert's formula, half the sum over
 * edges of the edge's angle times the cosine between the normal and the edge's plane. */
static double lambert_irradiance(const vec3 corners[4], vec3 normal)
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        vec3 a = corners[i], b = corners[(i + 1) % 4], plane = cross(a, b);
        double angle = atan2((double)length(plane), (double)dot(a, b));
        sum += angle * (double)dot(normal, plane) / (double)length(plane);
    }
    return fabs(0.5 * sum);
}

static void one_lit_texel_gives_its_closed_form(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    for (int s = 0; s < STRATEGIES; s++)
        for (uint32_t face = 0; face < 6; face++) {
            static test_map map;
            map = (test_map){.name = "one texel", .size = 4};
            set_pixel(&map, face, 1, 2, 10.0f);
            world w = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 256);
            /* Texel (1, 2) of 4: u from 0 to 0.5, v from -0.5 to 0. */
            const vec3 corners[4] = {cube_direction(face, 0, -0.5f), cube_direction(face, 0.5f, -0.5f),
                                     cube_direction(face, 0.5f, 0), cube_direction(face, 0, 0)};
            vec3 normal = normalize(add_scaled(cube_faces[face].axis, cube_faces[face].right, 0.8f));
            helio_shading_point point = {.material = matte};
            vec3_to(normal, point.normal);
            vec3_to(normal, point.geometric_normal);
            vec3_to(normal, point.view);
            double expected = 10.0 * 0.8 / PI * lambert_irradiance(corners, normal), mean = 0;
            bool light = w.pools->count != 0;
            uint32_t passes = light ? 64 : 4096;
            for (uint32_t pass = 0; pass < passes; pass++) {
                float radiance[3];
                point.seed = pass;
                assert_ok(helio_pools_draw(w.pools, 11, pass));
                assert_ok(helio_estimate(w.pools, &point, NULL, radiance, NULL));
                mean += (double)radiance[0] / passes;
            }
            /* Surface samples find the texel by chance, alone or with a small share of its light. */
            bool surface = w.pools->parts.surface != STRATEGY_SURFACE_NONE;
            assert_true(fabs(mean / expected - 1.0) < (!light ? 2e-2 : surface ? 1e-2 : 2e-3));
            destroy_world(&w);
        }
    helio_context_destroy(context);
}

/* ---- counts ---- */

static helio_shading_point facing(vec3 normal)
{
    helio_shading_point point = {.material = matte};
    vec3_to(normal, point.normal);
    vec3_to(normal, point.geometric_normal);
    vec3_to(normal, point.view);
    return point;
}

static vec3 random_direction(uint64_t *state)
{
    float z = (float)(2 * random_unit(state) - 1), angle = (float)(2 * PI * random_unit(state));
    float sine = sqrtf(fmaxf(0.0f, 1 - z * z));
    return (vec3){sine * cosf(angle), sine * sinf(angle), z};
}

static void counts_sum_to_the_samples_and_spare_faces_below_the_horizon(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    world w = make_world(context, &maps[1], HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE, 1024);
    uint64_t random = 5;
    double realised[6] = {0}, expected[6] = {0};
    int spared = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        vec3 normal = random_direction(&random);
        helio_shading_point point = facing(normal);
        helio_counts counts;
        point.seed = i;
        uint32_t samples = 1 + i % 128, sum = 0;
        double expected_sum = 0;
        assert_ok(helio_count(w.pools, &point, &(helio_estimate_desc){.samples = samples}, &counts));
        for (uint32_t face = 0; face < 6; face++) {
            bool below = true; /* all corners, so the whole face */
            for (int corner = 0; corner < 4; corner++)
                below &= dot(normal, cube_direction(face, corner & 1 ? 1 : -1, corner & 2 ? 1 : -1)) < -1e-6f;
            if (below) {
                spared++;
                assert_int_equal(counts.realised[face], 0);
                assert_true(counts.expected[face] == 0.0f);
            }
            assert_true(fabs((double)counts.realised[face] - (double)counts.expected[face]) < 1.0 + 1e-4);
            sum += counts.realised[face];
            expected_sum += (double)counts.expected[face];
            realised[face] += counts.realised[face];
            expected[face] += (double)counts.expected[face];
        }
        assert_int_equal(counts.realised[6], 0);
        assert_int_equal(sum, samples);
        assert_float_equal(expected_sum, samples, 1e-3);
    }
    assert_true(spared > 1000);
    for (int face = 0; face < 6; face++) /* the rounding of 20,000 counts: each off by less than 1, sd at most 1/2 */
        assert_true(fabs(realised[face] - expected[face]) < 6 * 0.5 * sqrt(20000.0));
    destroy_world(&w);
    helio_context_destroy(context);
}

/* The supplement's Figure 3: a sun behind the point gets no samples. */
static void a_sun_behind_the_point_gets_no_samples(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps); /* the sun of map 1 is on face +Z */
    world w = make_world(context, &maps[1], HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE, 1024);
    helio_shading_point away = facing((vec3){0, 0, -1}), towards = facing((vec3){0, 0, 1});
    helio_counts counts;
    assert_ok(helio_count(w.pools, &away, NULL, &counts));
    assert_int_equal(counts.realised[4], 0);
    assert_ok(helio_count(w.pools, &towards, NULL, &counts));
    assert_true(counts.realised[4] >= 63);
    destroy_world(&w);
    helio_context_destroy(context);
}

/* Walking the normal over the sphere in small steps: beta gives no steps in the counts, its absence does (Figure 1). */
static void beta_makes_counts_continuous(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    world w = make_world(context, &maps[4], HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE, 1024);
    double largest[2] = {0, 0};
    for (int no_beta = 0; no_beta < 2; no_beta++) {
        helio_counts before = {0}, counts;
        for (int step = 0; step <= 20000; step++) {
            double angle = 2 * PI * step / 20000;
            helio_shading_point point = facing(normalize((vec3){(float)cos(angle), 0.1f, (float)sin(angle)}));
            assert_ok(helio_count(w.pools, &point, &(helio_estimate_desc){.no_beta = no_beta}, &counts));
            for (int face = 0; face < 6 && step > 0; face++)
                largest[no_beta] =
                    fmax(largest[no_beta], fabs((double)(counts.expected[face] - before.expected[face])));
            before = counts;
        }
    }
    print_message("largest change of a count from normal to normal: %.3f with beta, %.3f without\n", largest[0],
                  largest[1]);
    assert_true(largest[0] < 0.2);
    assert_true(largest[1] > 2.0);
    destroy_world(&w);
    helio_context_destroy(context);
}

static float beta_of(uint32_t face, vec3 normal)
{
    float betas[6];
    strategy_betas(normal, betas);
    return betas[face];
}

/* No fireflies: a matte point's light samples weigh at most sum beta flux / (pi N), whatever the sun. The factor 1.5 is
 * the rounding of the least texels of a row to whole numbers. */
static void sample_weights_are_bounded_under_a_sun(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    world w = make_world(context, &maps[1], HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE, 1024);
    uint64_t random = 17;
    for (uint32_t i = 0; i < 2000; i++) {
        helio_shading_point point = facing(random_direction(&random));
        helio_sample samples[64];
        double flux[6], bound = 0;
        uint32_t count;
        point.material = white;
        point.seed = i;
        helio_tables_flux(w.tables, flux);
        for (uint32_t face = 0; face < 6; face++)
            bound += (double)beta_of(face, vec3_from(point.normal)) * flux[face] / (PI * 64);
        assert_ok(helio_gather(w.pools, &point, NULL, samples, &count));
        for (uint32_t k = 0; k < count; k++)
            assert_true((double)luminance(samples[k].contribution) <= 1.5 * bound);
    }
    destroy_world(&w);
    helio_context_destroy(context);
}

/* ---- the interface ---- */

typedef struct seen_rays {
    uint32_t rays;
    bool answer;
} seen_rays;

static void answer_all(void *user, const helio_shading_point *point, uint32_t count, const float *x, const float *y,
                       const float *z, bool *visible)
{
    seen_rays *seen = user;
    assert_in_range(count, 1, 64);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(dot(vec3_from(point->normal), (vec3){x[i], y[i], z[i]}) > 0.0f);
        visible[i] = seen->answer;
    }
    seen->rays += count;
}

/* That of BRDF samples, which never look at the tables, by the tables. */
static void check_densities(const world *w, const helio_shading_point *point, bool is_free)
{
    const helio_estimate_desc desc = {.is_free = is_free};
    helio_sample samples[64];
    helio_counts counts;
    uint32_t count;
    static drawing_surface surface;
    const vec3 normal = vec3_from(point->normal);
    assert_ok(helio_gather(w->pools, point, &desc, samples, &count));
    assert_ok(helio_count(w->pools, point, &desc, &counts));
    prepare(w, point, normal, brdf_lift_view(normal, vec3_from(point->view)), is_free, &surface);
    for (uint32_t k = 0; k < count; k++)
        if (samples[k].technique == 6) {
            const double expected = strategy_density(w, &counts, &surface, vec3_from(samples[k].direction));
            assert_true(fabs((double)samples[k].density - expected) <= 2e-5 * expected);
        }
}

static void densities_of_gathered_samples_are_those_of_the_tables(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    for (int s = 0; s < STRATEGIES; s++)
        for (helio_weighting weighting = 0; weighting <= HELIO_WEIGHTING_COMPENSATED; weighting++)
            for (int m = 0; m < 4; m++) {
                const helio_strategy strategy = strategies[s];
                if (weighting == HELIO_WEIGHTING_COMPENSATED && strategy != HELIO_STRATEGY_LIGHT_BRDF &&
                    strategy != HELIO_STRATEGY_FACE_BRDF)
                    continue;
                world w = make_world(context, &maps[m], weighting, strategy, 512);
                helio_shading_point points[POINTS];
                make_points(points);
                for (int i = 0; i < 2 * POINTS; i++)
                    check_densities(&w, &points[i / 2], i % 2 == 1);
                destroy_world(&w);
            }
    helio_context_destroy(context);
}

static void gathered_samples_sum_to_the_estimate(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    for (int s = 0; s < STRATEGIES; s++) {
        world w = make_world(context, &maps[4], HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 1024);
        helio_shading_point points[POINTS];
        make_points(points);
        for (int i = 0; i < POINTS; i++) {
            helio_sample samples[100];
            float radiance[3];
            double sum = 0;
            uint32_t count, useful = 0;
            seen_rays seen = {0, true};
            helio_estimate_desc desc = {.samples = 100, .visibility = answer_all, .user = &seen};
            helio_estimate_info info;
            assert_ok(helio_gather(w.pools, &points[i], &desc, samples, &count));
            assert_int_equal(seen.rays, 0);
            assert_int_equal(count, 100);
            for (uint32_t k = 0; k < count; k++) {
                assert_true(samples[k].density >= 0.0f);
                assert_float_equal(length(vec3_from(samples[k].direction)), 1.0f, 1e-5f);
                sum += (double)samples[k].contribution[0];
                useful += samples[k].contribution[0] > 0.0f;
            }
            assert_ok(helio_estimate(w.pools, &points[i], &desc, radiance, &info));
            helio_counts counts;
            assert_ok(helio_count(w.pools, &points[i], &desc, &counts));
            assert_true(fabs((double)radiance[0] / (sum + (double)counts.control[0]) - 1.0) < 1e-5);
            assert_int_equal(info.samples, 100);
            assert_int_equal(info.useful, useful);
            assert_int_equal(info.rays, seen.rays);
            assert_int_equal(seen.rays, useful);
            seen.answer = false;
            assert_ok(helio_estimate(w.pools, &points[i], &desc, radiance, NULL));
            assert_memory_equal(radiance, counts.control, sizeof radiance);
            desc.no_control = true;
            assert_ok(helio_estimate(w.pools, &points[i], &desc, radiance, NULL));
            assert_true(radiance[0] == 0.0f && radiance[1] == 0.0f && radiance[2] == 0.0f);
        }
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

static void black_maps_give_black_and_no_light_samples(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    static test_map map = {.name = "black", .size = 4};
    for (int s = 0; s < STRATEGIES; s++) {
        world w = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 256);
        helio_shading_point point = facing((vec3){0, 1, 0});
        float radiance[3] = {1, 1, 1};
        helio_estimate_info info;
        assert_ok(helio_estimate(w.pools, &point, NULL, radiance, &info));
        assert_true(radiance[0] == 0.0f && radiance[1] == 0.0f && radiance[2] == 0.0f);
        assert_int_equal(info.samples, w.pools->count ? 0 : 32);
        assert_int_equal(info.useful, 0);
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

static void hostile_maps_give_finite_light(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    static test_map map = {.name = "hostile", .size = 8};
    uint64_t random = 23;
    for (size_t i = 0; i < 6 * 64 * 3; i++) {
        uint32_t bits = random_bits(&random);
        memcpy(&map.pixels[i], &bits, sizeof bits);
    }
    for (int s = 0; s < STRATEGIES; s++) {
        world w = make_world(context, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s], 256);
        helio_shading_point points[POINTS];
        make_points(points);
        for (int i = 0; i < POINTS; i++) {
            float radiance[3];
            assert_ok(helio_estimate(w.pools, &points[i], NULL, radiance, NULL));
            for (int c = 0; c < 3; c++)
                assert_true(isfinite(radiance[c]) && (radiance[c] >= 0.0f || w.pools->control != NULL));
        }
        destroy_world(&w);
    }
    helio_context_destroy(context);
}

static void wrong_use_is_refused_with_a_sentence(void **state)
{
    (void)state;
    static test_map maps[MAPS];
    helio_context *context = make_context(1, NULL);
    make_maps(maps);
    world w = make_world(context, &maps[0], HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE_BRDF, 64);
    helio_shading_point point = facing((vec3){0, 1, 0});
    float radiance[3] = {5, 5, 5};
    assert_int_equal(helio_estimate(w.pools, &point, &(helio_estimate_desc){.samples = 9}, radiance, NULL),
                     HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "at most 8"));
    assert_int_equal(helio_estimate(w.pools, &point, &(helio_estimate_desc){.brdf_share = 1.0f}, radiance, NULL),
                     HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_estimate(NULL, &point, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_estimate(w.pools, NULL, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    helio_shading_point wrong = point;
    wrong.normal[1] = 2.0f;
    assert_int_equal(helio_estimate(w.pools, &wrong, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "length 2"));
    wrong = point;
    wrong.view[0] = NAN;
    assert_int_equal(helio_estimate(w.pools, &wrong, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    wrong = point;
    wrong.material.diffuse[0] = 2.0f;
    assert_int_equal(helio_estimate(w.pools, &wrong, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    assert_true(radiance[0] == 5.0f);
    /* Without a geometric normal the normal stands for both. */
    float other[3];
    wrong = point;
    memset(wrong.geometric_normal, 0, sizeof wrong.geometric_normal);
    assert_ok(helio_estimate(w.pools, &point, NULL, radiance, NULL));
    assert_ok(helio_estimate(w.pools, &wrong, NULL, other, NULL));
    assert_memory_equal(radiance, other, sizeof other);
    /* A new frame makes tables and pools stale; light of one frame never comes from the tables of another. */
    assert_ok(helio_environment_update(w.environment, maps[0].pixels, NULL));
    assert_int_equal(helio_estimate(w.pools, &point, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "frame"));
    assert_int_equal(helio_pools_draw(w.pools, 0, 0), HELIO_ERR_ARGUMENT);
    assert_ok(helio_tables_update(w.tables));
    assert_int_equal(helio_estimate(w.pools, &point, NULL, radiance, NULL), HELIO_ERR_ARGUMENT);
    assert_ok(helio_pools_draw(w.pools, 0, 0));
    assert_ok(helio_estimate(w.pools, &point, NULL, radiance, NULL));
    destroy_world(&w);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unbiased_cosine),
        cmocka_unit_test(unbiased_brdf),
        cmocka_unit_test(unbiased_light),
        cmocka_unit_test(unbiased_light_brdf),
        cmocka_unit_test(unbiased_light_brdf_compensated),
        cmocka_unit_test(unbiased_face_brdf_compensated),
        cmocka_unit_test(compensation_of_even_light_is_brdf_sampling),
        cmocka_unit_test(compensation_is_for_strategies_with_brdf_samples),
        cmocka_unit_test(unbiased_face),
        cmocka_unit_test(unbiased_face_paper_weighting_without_beta),
        cmocka_unit_test(unbiased_face_brdf),
        cmocka_unit_test(unbiased_face_brdf_uneven_share),
        cmocka_unit_test(unbiased_product),
        cmocka_unit_test(unbiased_product_brdf),
        cmocka_unit_test(samples_follow_their_density_for_every_strategy_and_material),
        cmocka_unit_test(all_strategies_converge_beyond_the_pools),
        cmocka_unit_test(a_matte_furnace_returns_its_albedo),
        cmocka_unit_test(other_furnaces_return_their_quadrature_and_no_more_than_one),
        cmocka_unit_test(one_lit_texel_gives_its_closed_form),
        cmocka_unit_test(counts_sum_to_the_samples_and_spare_faces_below_the_horizon),
        cmocka_unit_test(a_sun_behind_the_point_gets_no_samples),
        cmocka_unit_test(beta_makes_counts_continuous),
        cmocka_unit_test(sample_weights_are_bounded_under_a_sun),
        cmocka_unit_test(densities_of_gathered_samples_are_those_of_the_tables),
        cmocka_unit_test(gathered_samples_sum_to_the_estimate),
        cmocka_unit_test(black_maps_give_black_and_no_light_samples),
        cmocka_unit_test(hostile_maps_give_finite_light),
        cmocka_unit_test(wrong_use_is_refused_with_a_sentence),
    };
    return cmocka_run_group_tests_name("estimate", tests, NULL, NULL);
}
