/* SPDX-License-Identifier: MIT
 *
 * Pools drawn on a device hold the CPU's samples: the same texels, directions and densities up to rounding. */
#include "vulkan_support.h"

#include "env/environment.h"
#include "sampling/normal_bins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Divisions and roots, of which a density has six, may be off by 2.5 units in the last place each, and a direction
 * towards the edge of a face by as much as its u and v. */
static const float TOLERANCE = 1e-5f;

static bool is_near(float found, float expected, float scale)
{
    return fabsf(found - expected) <= TOLERANCE * scale;
}

static void compare_sample(const vulkan_world *w, uint32_t pool, uint32_t index, const float direction[4],
                           const float light[4])
{
    helio_pool_sample expected;
    assert_ok(helio_pools_read(w->pools, pool, index, 1, &expected));
    bool same = is_near(direction[3], expected.density, expected.density);
    for (int c = 0; c < 3; c++) {
        const float ratio = expected.density > 0.0f ? expected.radiance[c] / expected.density : 0.0f;
        same = same && is_near(direction[c], expected.direction[c], 1.0f) && is_near(light[c], ratio, ratio);
    }
    if (!same)
        fail_msg("sample %u of pool %u: (%g %g %g) with density %g in place of (%g %g %g) with %g", index, pool,
                 (double)direction[0], (double)direction[1], (double)direction[2], (double)direction[3],
                 (double)expected.direction[0], (double)expected.direction[1], (double)expected.direction[2],
                 (double)expected.density);
}

static void compare_pools(vulkan_world *w)
{
    const size_t length = helio_pools_length(w->pools), samples = helio_pools_count(w->pools) * length;
    float(*found)[4] = read_buffer(&w->commands, &w->light.pools, 2 * samples * sizeof *found);
    for (size_t i = 0; i < samples; i++)
        compare_sample(w, (uint32_t)(i / length), (uint32_t)(i % length), found[i], found[samples + i]);
    free(found);
}

/* All that is made of integers has the same bits, or a sample would come from another tile. */
static void compare_bins(vulkan_world *w)
{
    const normal_bins *bins = w->pools->bins;
    const tiles *t = bins->tiles;
    const size_t sums = bins->count * ((size_t)t->count + 1);
    world_compare_bits(w, &w->light.tile_totals, t->totals, t->count * sizeof *t->totals, "sums of tiles");
    world_compare_bits(w, &w->light.tile_spreads, t->spread, t->count * sizeof *t->spread, "spreads of tiles");
    world_compare_bits(w, &w->light.bin_sums, bins->sums, sums * sizeof *bins->sums, "sums of bins");
    world_compare_bits(w, &w->light.list_starts, bins->list_starts, (t->count + 1) * sizeof *bins->list_starts,
                       "starts of lists");
}

static void compare_lobes(vulkan_world *w)
{
    const normal_bins *bins = w->pools->bins;
    const size_t count = (size_t)bins->count * LOBE_CLASSES;
    float *found = read_buffer(&w->commands, &w->light.lobe_variances, count * sizeof *found);
    for (size_t i = 0; i < count; i++)
        if (!is_near(found[i], bins->lobe_variances[i], 4.0f + fabsf(bins->lobe_variances[i])))
            fail_msg("lobes of bin %zu, class %zu: %g in place of %g", i / LOBE_CLASSES, i % LOBE_CLASSES,
                     (double)found[i], (double)bins->lobe_variances[i]);
    free(found);
}

/* Sums of light in another order: in relation to the largest, as matrices hold differences of much larger numbers. */
static void compare_matrices(vulkan_world *w, const vulkan_buffer *buffer, const control_matrix *expected, size_t count,
                             const char *what)
{
    float(*found)[4] = read_buffer(&w->commands, buffer, count * sizeof *expected);
    float greatest = 0;
    for (size_t i = 0; i < 16 * count; i++)
        greatest = fmaxf(greatest, fabsf(expected[i / 16].rows[i / 4 % 4][i % 4]));
    for (size_t i = 0; i < 16 * count; i++)
        if (!is_near(found[i / 4][i % 4], expected[i / 16].rows[i / 4 % 4][i % 4], greatest))
            fail_msg("%s: number %zu is %g in place of %g", what, i, (double)found[i / 4][i % 4],
                     (double)expected[i / 16].rows[i / 4 % 4][i % 4]);
    free(found);
}

static void compare_control(vulkan_world *w)
{
    const light_control *control = w->pools->control;
    compare_matrices(w, &w->light.known, control->known, control->bins, "known light of bins");
    compare_matrices(w, &w->light.control_sums, control->sums, control->bins * ((size_t)control->chunks + 1),
                     "sums of pools");
}

static void compare_light(vulkan_world *w, uint32_t size, helio_weighting weighting, const helio_pools_desc *desc)
{
    world_make_light(w, size, weighting, desc);
    for (int kind = 0; kind < MAP_KINDS; kind++) {
        print_message("%s, R = %u, %s\n", helio_strategy_name(desc->strategy), size, map_kind_name((map_kind)kind));
        fill_cube(w->environment, (map_kind)kind, size + (uint64_t)kind);
        world_update(w, 5 + (uint32_t)kind, size % 3);
        if (w->pools->bins != NULL) {
            compare_bins(w);
            if (w->pools->bins->lobe_variances != NULL)
                compare_lobes(w);
            compare_control(w);
        }
        compare_pools(w);
    }
    world_destroy_light(w);
}

static void pools_of_faces_hold_the_same_samples(void **state)
{
    static const uint32_t sizes[] = {1, 3, 64, 101};
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_FACE_BRDF};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_light(&w, sizes[i], i % 2 ? HELIO_WEIGHTING_PAPER : HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

static void the_pool_of_the_map_holds_the_same_samples(void **state)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_LIGHT, .length = 512};
    vulkan_world w = world_make();
    (void)state;
    compare_light(&w, 2, HELIO_WEIGHTING_PAPER, &desc);
    compare_light(&w, 77, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

static void pools_of_bins_hold_the_same_samples(void **state)
{
    static const uint32_t sizes[] = {1, 5, 16, 33};
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF, .length = 64, .bins = 4};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_light(&w, sizes[i], i % 2 ? HELIO_WEIGHTING_PAPER : HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    compare_light(&w, 48, HELIO_WEIGHTING_SOLID_ANGLE, &(helio_pools_desc){.strategy = HELIO_STRATEGY_PRODUCT});
    world_destroy(&w);
}

/* ---- evenness ---- */

enum { EVEN_SIZE = 40 };

/* Noise of this standard deviation, where the light is 1 on average; of 0.016 is its variance to be less where light is
 * even. An odd kind has steps between tiles as well. */
static void fill_uneven(helio_environment *environment, float deviation, float brightness, int kind)
{
    uint64_t seed = 3;
    for (size_t i = 0; i < 6 * EVEN_SIZE * EVEN_SIZE; i++) {
        const float noise = deviation * 3.4641f * ((float)random_unit(&seed) - 0.5f);
        const float slope = kind % 2 ? 0.1f * ((float)(i % EVEN_SIZE) / EVEN_SIZE - 0.5f) : 0.0f;
        for (size_t c = 0; c < 3; c++)
            environment->cube[3 * i + c] = brightness * (1.0f + noise + slope);
    }
    environment->frame++;
}

/* Whatever its brightness. */
static void light_is_as_even_as_on_the_cpu(void **state)
{
    static const float deviations[] = {0.0f, 0.05f, 0.12f, 0.13f, 0.2f}; /* 0.126 is in the middle */
    static const float brightnesses[] = {1e-36f, 1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f, 1e38f};
    vulkan_world w = world_make();
    (void)state;
    world_make_light(&w, EVEN_SIZE, HELIO_WEIGHTING_SOLID_ANGLE, &(helio_pools_desc){.length = 64, .bins = 2});
    assert_true(w.pools->is_automatic);
    for (size_t b = 0; b < sizeof brightnesses / sizeof *brightnesses; b++)
        for (size_t d = 0; d < sizeof deviations / sizeof *deviations; d++) {
            fill_uneven(w.environment, deviations[d], brightnesses[b], (int)b);
            world_update(&w, 1, 0);
            struct layout_sums *found = read_buffer(&w.commands, &w.light.sums, sizeof *found);
            assert_true(w.pools->is_even == (deviations[d] < 0.125f));
            if (w.pools->is_even != (found->uneven_faces == 0))
                fail_msg("noise of %g x %g: %u faces are uneven", (double)deviations[d], (double)brightnesses[b],
                         found->uneven_faces);
            free(found);
        }
    fill_cube(w.environment, MAP_BLACK, 0);
    world_update(&w, 1, 0);
    struct layout_sums *found = read_buffer(&w.commands, &w.light.sums, sizeof *found);
    assert_true(w.pools->is_even && found->uneven_faces == 0);
    free(found);
    world_destroy_light(&w);
    world_destroy(&w);
}

/* ---- chi-square ---- */

enum { CHI_SIZE = 8, CHI_TEXELS = 6 * CHI_SIZE * CHI_SIZE, CHI_TESTS = 64 };

/* One chance in a million that any of all tests, of which there are no more than this, fails without a reason. */
static const double LEAST_P = 1e-6 / CHI_TESTS;

/* All brightnesses up to a hundredfold, and a third of the texels black. */
static void fill_noise(helio_environment *environment, uint64_t seed)
{
    for (size_t i = 0; i < CHI_TEXELS; i++) {
        const float radiance = random_bits(&seed) % 3 == 0 ? 0.0f : expf(4.6f * (float)random_unit(&seed));
        for (size_t c = 0; c < 3; c++)
            environment->cube[3 * i + c] = radiance;
    }
    environment->frame++;
}

/* Adds the directions that the device drew to counts of texels [pools][CHI_TEXELS]. */
static void count_texels(vulkan_world *w, double *drawn)
{
    const size_t length = helio_pools_length(w->pools), samples = helio_pools_count(w->pools) * length;
    float(*found)[4] = read_buffer(&w->commands, &w->light.pools, samples * sizeof *found);
    for (size_t i = 0; i < samples; i++) {
        const cube_position at = cube_project((vec3){found[i][0], found[i][1], found[i][2]});
        const size_t row = at.face * CHI_SIZE + cube_texel(at.v, CHI_SIZE);
        drawn[i / length * CHI_TEXELS + row * CHI_SIZE + cube_texel(at.u, CHI_SIZE)]++;
    }
    free(found);
}

/* Do counts of texels follow the densities of a pool? These are even in (u, v) over a texel. */
static double pool_tail(const vulkan_world *w, uint32_t pool, double draws, const double *drawn)
{
    double expected[CHI_TEXELS];
    for (uint32_t i = 0; i < CHI_TEXELS; i++) {
        const uint32_t column = i % CHI_SIZE, row = i / CHI_SIZE % CHI_SIZE, face = i / (CHI_SIZE * CHI_SIZE);
        const double u = (column + 0.5) * 2 / CHI_SIZE - 1, v = (row + 0.5) * 2 / CHI_SIZE - 1;
        const face_place at = {face, row, column, (float)u, (float)v};
        const bool is_here = w->pools->parts.light != STRATEGY_LIGHT_FACES || face == pool;
        const double density = is_here ? (double)pools_density(w->pools, pool, &at) : 0;
        /* 1e-3: samples within rounding of a border may lead to the neighbour. */
        expected[i] = draws * density * pow(1 + u * u + v * v, -1.5) * 4 / (CHI_SIZE * CHI_SIZE) + 1e-3;
    }
    return chi_square_tail(drawn, expected, CHI_TEXELS, 1);
}

/* Returns how many pools were tested. Against the densities of another map all must fail. */
static uint32_t test_draws(vulkan_world *w, helio_weighting weighting, const helio_pools_desc *desc, uint32_t passes)
{
    world_make_light(w, CHI_SIZE, weighting, desc);
    const uint32_t pools = helio_pools_count(w->pools);
    const double draws = (double)helio_pools_length(w->pools) * passes;
    double *drawn = calloc((size_t)pools * CHI_TEXELS, sizeof *drawn), least = 1;
    assert_non_null(drawn);
    fill_noise(w->environment, 4);
    for (uint32_t pass = 0; pass < passes; pass++) {
        world_update(w, 5, pass);
        count_texels(w, drawn);
    }
    for (uint32_t pool = 0; pool < pools; pool++)
        least = fmin(least, pool_tail(w, pool, draws, drawn + (size_t)pool * CHI_TEXELS));
    print_message("%s, %u pools: least p %.3g\n", helio_strategy_name(desc->strategy), pools, least);
    assert_true(least > LEAST_P);
    fill_noise(w->environment, 6);
    world_update(w, 5, 0);
    for (uint32_t pool = 0; pool < pools; pool++)
        assert_true(pool_tail(w, pool, draws, drawn + (size_t)pool * CHI_TEXELS) < LEAST_P);
    free(drawn);
    world_destroy_light(w);
    return pools;
}

static void samples_of_the_device_follow_the_densities(void **state)
{
    static const helio_pools_desc descs[] = {{.strategy = HELIO_STRATEGY_FACE},
                                             {.strategy = HELIO_STRATEGY_LIGHT},
                                             {.strategy = HELIO_STRATEGY_PRODUCT, .length = 256, .bins = 2}};
    static const uint32_t passes[] = {10, 2, 60};
    vulkan_world w = world_make();
    uint32_t tests = 0;
    (void)state;
    for (int i = 0; i < 3; i++) {
        tests += test_draws(&w, HELIO_WEIGHTING_SOLID_ANGLE, &descs[i], passes[i]);
        if (i == 0)
            tests += test_draws(&w, HELIO_WEIGHTING_PAPER, &descs[i], passes[i]);
    }
    assert_true(tests <= CHI_TESTS);
    world_destroy(&w);
}

/* With the work groups that hardware gets. */
static void groups_of_many_threads_draw_the_same(void **state)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF, .length = 64, .bins = 3};
    vulkan_world w = world_make();
    (void)state;
    w.device->info.kind = HELIO_DEVICE_DISCRETE;
    compare_light(&w, 1, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    compare_light(&w, 65, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pools_of_faces_hold_the_same_samples),
        cmocka_unit_test(the_pool_of_the_map_holds_the_same_samples),
        cmocka_unit_test(pools_of_bins_hold_the_same_samples),
        cmocka_unit_test(light_is_as_even_as_on_the_cpu),
        cmocka_unit_test(samples_of_the_device_follow_the_densities),
        cmocka_unit_test(groups_of_many_threads_draw_the_same),
    };
    return cmocka_run_group_tests_name("vulkan_pools", tests, NULL, NULL);
}
