/* SPDX-License-Identifier: MIT
 *
 * How far estimates of 64 samples are from the truth: the figures of docs/method.md. relMSE of random points, with
 * random normals and views and nothing in the way, under captured maps reduced to 128 x 128 x 6. */
#include "support.h"

#include "core/random.h"
#include "core/vector.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 160, DRAWS = 24, CUBE = 128, SAMPLES = 64 };

static const char *const maps[] = {"kloppenheim_05_1k.hdr",        "pmndrs_sunrise.hdr",
                                   "circus_arena_1k.hdr",          "st_peters_square_night_1k.hdr",
                                   "aristea_wreck_puresky_1k.hdr", "sepulchral_chapel_rotunda_1k.hdr"};
enum { MAPS = sizeof maps / sizeof maps[0] };

typedef struct subject {
    const char *name;
    helio_material material;
} subject;

static const subject subjects[] = {
    {"diffuse", {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}}},
    {"phong 120",
     {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.5f, 0.5f}, .specular = {0.5f, 0.5f, 0.5f}, .exponent = 120}},
    {"ggx 0.3", {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 1, 1}, .metallic = 1, .roughness = 0.3f}},
    {"ggx 0.1", {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 1, 1}, .metallic = 1, .roughness = 0.1f}},
};
enum { SUBJECTS = sizeof subjects / sizeof subjects[0] };

static const helio_strategy strategies[] = {HELIO_STRATEGY_LIGHT_BRDF, HELIO_STRATEGY_FACE, HELIO_STRATEGY_FACE_BRDF,
                                            HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
enum { STRATEGIES = sizeof strategies / sizeof strategies[0] };

static vec3 random_direction(uint64_t *state)
{
    float z = (float)(2 * random_unit(state) - 1), angle = (float)(2 * PI * random_unit(state));
    float sine = sqrtf(fmaxf(0.0f, 1 - z * z));
    return (vec3){sine * cosf(angle), sine * sinf(angle), z};
}

/* Views are spread evenly over the hemisphere above the normal. */
static void make_points(const helio_material *material, helio_shading_point points[POINTS])
{
    uint64_t random = 2026;
    for (int i = 0; i < POINTS; i++) {
        vec3 normal = random_direction(&random), view = random_direction(&random);
        if (dot(normal, view) < 0.0f)
            view = scale(view, -1.0f);
        points[i] = (helio_shading_point){.material = *material};
        vec3_to(normal, points[i].normal);
        vec3_to(normal, points[i].geometric_normal);
        vec3_to(view, points[i].view);
    }
}

/* ---- one map ---- */

typedef struct light {
    helio_context *context;
    helio_environment *environment;
    helio_tables *tables;
} light;

static light make_light(const char *name)
{
    char file[256], path[TEST_PATH_SIZE];
    light l = {.context = make_context(0, NULL)};
    helio_image *image;
    snprintf(file, sizeof file, "environments/latlong/%s", name);
    find_test_data(file, path);
    assert_ok(helio_image_read(l.context, path, NULL, &image));
    l.environment =
        make_environment(l.context, HELIO_LAYOUT_LATLONG, image->width, image->height, CUBE, image->rgb, NULL);
    helio_image_destroy(l.context, image);
    assert_ok(helio_tables_create(l.environment, HELIO_WEIGHTING_SOLID_ANGLE, &l.tables));
    assert_ok(helio_tables_update(l.tables));
    return l;
}

static void destroy_light(light *l)
{
    helio_tables_destroy(l->tables);
    helio_environment_destroy(l->environment);
    helio_context_destroy(l->context);
}

/* ---- one strategy ---- */

enum { CHANNELS = 4 }; /* red, green, blue and luminance */

typedef struct moments {
    double mean[CHANNELS], variance[CHANNELS]; /* of one estimate */
} moments;

/* Welford's update. */
static void add_estimate(const float radiance[3], uint32_t draw, moments *m)
{
    const float values[CHANNELS] = {radiance[0], radiance[1], radiance[2], luminance(radiance)};
    for (int c = 0; c < CHANNELS; c++) {
        double from_mean = (double)values[c] - m->mean[c];
        m->mean[c] += from_mean / (draw + 1);
        m->variance[c] += from_mean * ((double)values[c] - m->mean[c]) / (DRAWS - 1);
    }
}

static void estimate_all(const light *l, helio_strategy strategy, helio_shading_point points[POINTS],
                         moments results[POINTS])
{
    static float radiance[POINTS][3];
    helio_pools *pools;
    assert_ok(helio_pools_create(l->tables, &(helio_pools_desc){.strategy = strategy}, &pools));
    memset(results, 0, POINTS * sizeof *results);
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        assert_ok(helio_pools_draw(pools, 1, draw));
        for (uint32_t i = 0; i < POINTS; i++)
            points[i].seed = hash_combine(draw, i);
        const helio_estimate_desc desc = {.samples = SAMPLES};
        assert_ok(helio_estimate_points(pools, POINTS, points, &desc, radiance, NULL));
        for (int i = 0; i < POINTS; i++)
            add_estimate(radiance[i], draw, &results[i]);
    }
    helio_pools_destroy(pools);
}

/* Estimates are unbiased, so that their variance is their mean square error; what is known best of the truth is the
 * mean of the best strategy. */
static double relative_error(const moments results[POINTS], const moments best[POINTS], int channel, int channels)
{
    double sum = 0;
    for (int i = 0; i < POINTS; i++)
        for (int c = channel; c < channel + channels; c++)
            sum += results[i].variance[c] / (best[i].mean[c] * best[i].mean[c]) / (channels * POINTS);
    return sum;
}

/* The mean over colour channels, and the error of the luminance alone. */
typedef struct errors {
    double colour[STRATEGIES], luminance[STRATEGIES];
} errors;

static void measure(const light *l, const subject *s, errors *e)
{
    static moments results[STRATEGIES][POINTS];
    helio_shading_point points[POINTS];
    make_points(&s->material, points);
    for (int k = 0; k < STRATEGIES; k++)
        estimate_all(l, strategies[k], points, results[k]);
    for (int k = 0; k < STRATEGIES; k++) {
        e->colour[k] = relative_error(results[k], results[STRATEGIES - 1], 0, 3);
        e->luminance[k] = relative_error(results[k], results[STRATEGIES - 1], 3, 1);
    }
}

static void print_line(const char *material, const char *map, const double values[STRATEGIES])
{
    print_message("%-10s %-23.23s", material, map);
    for (int k = 0; k < STRATEGIES; k++)
        print_message("%14.1f", values[k] * 1e6);
    print_message("\n");
}

static double better(double a, double b)
{
    return a < b ? a : b;
}

/* Geometric means over the maps. */
static errors measure_subject(const subject *s)
{
    errors means = {{0}, {0}};
    for (int m = 0; m < MAPS; m++) {
        errors e;
        light l = make_light(maps[m]);
        measure(&l, s, &e);
        destroy_light(&l);
        print_line(s->name, maps[m], e.colour);
        for (int k = 0; k < STRATEGIES; k++) {
            means.colour[k] += log(e.colour[k]) / MAPS;
            means.luminance[k] += log(e.luminance[k]) / MAPS;
        }
    }
    for (int k = 0; k < STRATEGIES; k++) {
        means.colour[k] = exp(means.colour[k]);
        means.luminance[k] = exp(means.luminance[k]);
    }
    print_line(s->name, "geometric mean", means.colour);
    print_line(s->name, "... of luminance alone", means.luminance);
    return means;
}

/* What is asserted is a little less than what is found, as all seeds are fixed but machines differ. */
static void errors_of_64_samples(void **state)
{
    (void)state;
    static const double required[SUBJECTS] = {0.2, 0.6, 1.0, 1.1}; /* of the better of FACE and FACE_BRDF */
    print_message("%-34s", "relMSE x 1e6");
    for (int k = 0; k < STRATEGIES; k++)
        print_message("%14s", helio_strategy_name(strategies[k]));
    print_message("\n");
    for (int s = 0; s < SUBJECTS; s++) {
        errors means = measure_subject(&subjects[s]);
        double by_face = better(means.colour[1], means.colour[2]),
               by_product = better(means.colour[3], means.colour[4]);
        assert_true(by_product < required[s] * by_face);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_of_64_samples)};
    return cmocka_run_group_tests_name("variance", tests, NULL, NULL);
}
