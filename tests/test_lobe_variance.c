/* SPDX-License-Identifier: MIT
 *
 * How uneven the light is in specular lobes, and which points weigh tiles because of it. */
#include "support.h"

#include "sampling/kernels.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdlib.h>

enum { R = 64, SEEDS = 200, SAMPLES = 64 };

typedef light_world world;

static world make_world(const float *rgb)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF, .length = 256};
    return make_light_world(make_context(1, NULL), rgb, R, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
}

static void destroy_world(world *w)
{
    destroy_light_world(w);
    helio_context_destroy(w->context);
}

static size_t texel(uint32_t face, uint32_t row, uint32_t column)
{
    return ((size_t)(face * R + row) * R + column) * 3;
}

/* Radiances between low and 1. */
static float *make_sky(float low)
{
    uint64_t seed = 4;
    float *rgb = calloc(texel(6, 0, 0), sizeof *rgb);
    assert_non_null(rgb);
    for (size_t i = 0; i < texel(6, 0, 0); i++)
        rgb[i] = low + (1 - low) * (float)random_unit(&seed);
    return rgb;
}

/* Of 4 x 4 texels in the middle of the face that looks along +X. */
static void add_lamp(float *rgb, float radiance)
{
    for (uint32_t y = 0; y < 4; y++)
        for (uint32_t x = 0; x < 12; x++)
            rgb[texel(0, R / 2 - 2 + y, R / 2 - 2) + x] = radiance;
}

/* ---- the variance ---- */

/* Over all tiles, none taken together. */
static double plain_variance(const tiles *t, vec3 axis, uint32_t class)
{
    const double width = (double)lobe_class_width(class) * (double)t->edge * (double)t->edge;
    double all = 0, angle = 0, light = 0, square = 0;
    for (uint32_t i = 0; i < t->count; i++)
        all += (double)t->light[i];
    for (uint32_t i = 0; i < t->count; i++) {
        const double cosine = (double)dot(axis, (vec3){t->x[i], t->y[i], t->z[i]});
        const double half2 = (1 + cosine) / 2, lobe = width / pow(half2 * (width - 1) + 1, 2);
        const double peak = (double)t->peak[i], lit = lobe * (double)t->light[i];
        angle += lobe * (double)t->angle[i];
        light += lit;
        const double of_lobe = 15.0 / 16 * lobe / (4 * PI), of_pool = 1.0 / 16 * peak / (all / 2);
        square += lit * peak * lobe * (of_lobe + of_pool / 2) / pow(of_lobe + of_pool, 2);
    }
    return square * angle / (4 * PI * light * light) - 1;
}

/* Groups that are far count as one direction with one brightness. Beside a lamp that is more than there is, so that
 * points weigh tiles rather too often. */
static void variances_are_those_of_sums_over_all_tiles(void **state)
{
    (void)state;
    double greatest = 0, least = 0;
    for (int m = 0; m < 3; m++) {
        float *rgb = make_sky(m == 0 ? 0.9f : 0.0f);
        if (m == 2)
            add_lamp(rgb, 300);
        world w = make_world(rgb);
        const normal_bins *bins = w.pools->bins;
        for (uint32_t bin = 0; bin < bins->count; bin++)
            for (uint32_t class = 0; class < LOBE_CLASSES; class ++) {
                const double found = (double)bins->lobe_variances[bin * LOBE_CLASSES + class];
                const double expected = plain_variance(bins->tiles, bins->bins[bin].centre, class);
                const double off = (found - expected) / (1 + fabs(expected));
                greatest = fmax(greatest, off);
                least = fmin(least, off);
                if (off < -0.1 || off > (m == 2 ? 0.4 : 0.1))
                    fail_msg("map %d, bin %u, class %u: %g in place of %g", m, bin, class, found, expected);
            }
        destroy_world(&w);
        free(rgb);
    }
    print_message("differences: %.3g to %.3g\n", least, greatest);
}

static void all_instruction_sets_find_the_same_variances(void **state)
{
    (void)state;
    float *rgb = make_sky(0.2f);
    add_lamp(rgb, 1000);
    world w = make_world(rgb);
    const normal_bins *bins = w.pools->bins;
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++) {
        isa set;
        assert_ok(isa_choose(helio_isa_name(i), &set));
        for (uint32_t bin = 0; bin < bins->count; bin++) {
            float found[LOBE_CLASSES];
            kernels_of(set)->find_lobe_variances(bins->tiles, bins->bins[bin].centre, found);
            assert_memory_equal(found, bins->lobe_variances + bin * LOBE_CLASSES, sizeof found);
        }
    }
    destroy_world(&w);
    free(rgb);
}

static void even_light_is_calm_and_black_light_too(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++) {
        float *rgb = make_sky(1.0f);
        for (size_t i = 0; m == 1 && i < texel(6, 0, 0); i++)
            rgb[i] = 0.0f;
        world w = make_world(rgb);
        for (uint32_t i = 0; i < w.pools->bins->count * LOBE_CLASSES; i++)
            assert_true(fabsf(w.pools->bins->lobe_variances[i]) < 0.25f);
        destroy_world(&w);
        free(rgb);
    }
}

/* ---- points ---- */

static const helio_material metal = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {1, 0.8f, 0.3f}, .metallic = 1, .roughness = 0.3f};

static bool is_free = true;

/* Seen from above, so that the lobe points along the normal. Returns of SEEDS points those that weigh tiles. */
static uint32_t count_weighing(const world *w, const helio_material *material, vec3 normal, float brdf_share)
{
    uint32_t weighing = 0;
    helio_shading_point point = {.material = *material};
    vec3_to(normal, point.normal);
    vec3_to(normal, point.view);
    for (point.seed = 0; point.seed < SEEDS; point.seed++) {
        const helio_estimate_desc desc = {.samples = SAMPLES, .brdf_share = brdf_share, .is_free = is_free};
        helio_counts counts;
        assert_ok(helio_count(w->pools, &point, &desc, &counts));
        weighing += counts.pool[0] == HELIO_POOL_OF_TILES;
        assert_int_equal(counts.realised[0] + counts.realised[6], SAMPLES);
        if (counts.pool[0] != HELIO_POOL_OF_TILES && brdf_share == 0.0f)
            assert_int_equal(counts.realised[0], SAMPLES / LOBE_SAMPLES_PER_POOL);
    }
    return weighing;
}

static void points_weigh_tiles_where_light_in_their_lobe_is_uneven(void **state)
{
    (void)state;
    const vec3 to_lamp = {1, 0, 0}, beside = normalize((vec3){1, 0.35f, 0}), away = {-1, 0, 0};
    float *rgb = make_sky(0.8f);
    add_lamp(rgb, 2000);
    world w = make_world(rgb);
    assert_int_equal(count_weighing(&w, &metal, to_lamp, 0), SEEDS);
    assert_int_equal(count_weighing(&w, &metal, beside, 0), SEEDS);
    assert_int_equal(count_weighing(&w, &metal, away, 0), 0);
    destroy_world(&w);
    free(rgb);
}

/* Where rays are to be traced more points weigh tiles. */
static void more_points_weigh_tiles_where_something_may_be_in_the_way(void **state)
{
    (void)state;
    float *rgb = make_sky(0.0f);
    add_lamp(rgb, 300);
    world w = make_world(rgb);
    uint32_t weighing[2] = {0, 0};
    for (int i = 0; i < 60; i++) {
        const float angle = (float)(PI * i / 60);
        for (int k = 0; k < 2; k++) {
            is_free = k == 0;
            weighing[k] += count_weighing(&w, &metal, (vec3){cosf(angle), sinf(angle), 0}, 0);
        }
    }
    is_free = true;
    print_message("of %d points %u weigh tiles, with rays %u\n", 60 * SEEDS, weighing[0], weighing[1]);
    assert_true(weighing[0] > 0 && weighing[1] > weighing[0] && weighing[1] < 60 * SEEDS);
    destroy_world(&w);
    free(rgb);
}

/* Other lobes are not asked about. */
static void wide_lobes_and_those_beside_a_diffuse_one_weigh_tiles(void **state)
{
    (void)state;
    float *rgb = make_sky(0.8f);
    world w = make_world(rgb);
    helio_material wide = metal, mixed = metal;
    const helio_material phong = {.kind = HELIO_MATERIAL_PHONG, .specular = {1, 1, 1}, .exponent = 120};
    helio_material glossy = phong;
    wide.roughness = 0.8f;
    mixed.metallic = 0.9f;
    glossy.specular[1] = 0.9f;
    glossy.diffuse[1] = 0.1f;
    const vec3 up = {0, 1, 0};
    assert_int_equal(count_weighing(&w, &metal, up, 0), 0);
    assert_int_equal(count_weighing(&w, &metal, up, 0.3f), 0);
    assert_int_equal(count_weighing(&w, &phong, up, 0), 0);
    assert_int_equal(count_weighing(&w, &wide, up, 0), SEEDS);
    assert_int_equal(count_weighing(&w, &mixed, up, 0), SEEDS);
    assert_int_equal(count_weighing(&w, &glossy, up, 0), SEEDS);
    destroy_world(&w);
    free(rgb);
}

/* From where light is uneven to where it is calm all kinds of mixtures come, so that no edge shows. */
static void what_points_do_changes_little_by_little(void **state)
{
    (void)state;
    uint32_t last = 0, steepest = 0, mixed = 0;
    float *rgb = make_sky(0.8f);
    add_lamp(rgb, 2000);
    world w = make_world(rgb);
    for (int i = 0; i <= 90; i++) {
        const float angle = (float)(PI * i / 180);
        const uint32_t weighing = count_weighing(&w, &metal, (vec3){cosf(angle), sinf(angle), 0}, 0);
        mixed += weighing > SEEDS / 10 && weighing < SEEDS - SEEDS / 10;
        if (i > 0)
            steepest = (uint32_t)abs((int)weighing - (int)last) > steepest ? (uint32_t)abs((int)weighing - (int)last)
                                                                           : steepest;
        last = weighing;
    }
    print_message("%u of 91 directions are mixed, by 1 degree the part changes by %u of %u at most\n", mixed, steepest,
                  SEEDS);
    assert_true(mixed >= 3 && steepest < SEEDS / 2);
    destroy_world(&w);
    free(rgb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variances_are_those_of_sums_over_all_tiles),
        cmocka_unit_test(all_instruction_sets_find_the_same_variances),
        cmocka_unit_test(even_light_is_calm_and_black_light_too),
        cmocka_unit_test(points_weigh_tiles_where_light_in_their_lobe_is_uneven),
        cmocka_unit_test(more_points_weigh_tiles_where_something_may_be_in_the_way),
        cmocka_unit_test(wide_lobes_and_those_beside_a_diffuse_one_weigh_tiles),
        cmocka_unit_test(what_points_do_changes_little_by_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
