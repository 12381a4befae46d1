/* SPDX-License-Identifier: MIT
 *
 * The kernels of every instruction set that this machine has, against the scalar ones, which are the definition: the
 * same bits in tables, pools and drawn directions, the same estimates within a stated bound, for any number of threads.
 * The same runs are timed, and the times printed; nothing depends on them. */
#include "support.h"

#include "core/context.h"
#include "core/random.h"
#include "sampling/estimate.h"
#include "sampling/kernels.h"

#include <heliostat/heliostat.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Images and estimates of different instruction sets differ by no more than this, relative to the brighter one. Fused
 * multiply-adds and the order of sums are all that differs. (docs/method.md) */
static const double LARGEST_DIFFERENCE = 1e-4;
/* Sharper lobes than roughness 0.1 or exponent 1000 magnify the rounding of directions. */
static const double LARGEST_DIFFERENCE_SHARP = 1e-3;

enum { MOST_SETS = 4, POINTS = 40, BINS_PER_EDGE = 3 };

/* ---- maps ---- */

typedef struct isa_map {
    const char *name;
    uint32_t size; /* R; a strip of six faces, so that the cube holds these very numbers */
    float *pixels; /* [6 R][R][3] */
} isa_map;

static size_t numbers(uint32_t size)
{
    return (size_t)CUBE_FACES * size * size * 3;
}

static isa_map make_map(const char *name, uint32_t size, uint64_t seed)
{
    isa_map map = {name, size, calloc(numbers(size), sizeof(float))};
    assert_non_null(map.pixels);
    for (size_t i = 0; i < numbers(size) && seed != 0; i++)
        map.pixels[i] = (float)exp(8 * random_unit(&seed) - 4);
    return map;
}

enum { MAPS = 10 };

/* Random ones of sizes that fill registers and that do not, and those where something degenerates. */
static void make_maps(isa_map maps[MAPS])
{
    maps[0] = make_map("random, R = 64", 64, 1);
    maps[1] = make_map("random, R = 1", 1, 2);
    maps[2] = make_map("random, R = 3", 3, 3);
    maps[3] = make_map("random, R = 17", 17, 4);
    maps[4] = make_map("random, R = 300", 300, 5);
    maps[5] = make_map("a sun of 10^7", 33, 6);
    for (int c = 0; c < 3; c++)
        maps[5].pixels[(33 * 33 * 2 + 33 * 16 + 20) * 3 + c] = 1e7f;
    maps[6] = make_map("one lit texel", 40, 0);
    maps[6].pixels[(40 * 40 * 4 + 40 * 7 + 9) * 3 + 2] = 3.0f;
    maps[7] = make_map("black", 8, 0);
    maps[8] = make_map("lit by less than a normal float", 24, 0);
    for (size_t i = 0; i < numbers(24); i += 5)
        maps[8].pixels[i] = (float)(i % 7) * FLT_MIN / 16;
    maps[9] = make_map("the largest floats beside black rows", 21, 7);
    for (size_t i = 0; i < numbers(21); i++)
        maps[9].pixels[i] = i / 63 % 3 == 0 ? 0.0f : i % 4 == 0 ? 3e38f : maps[9].pixels[i];
}

static void free_maps(isa_map maps[MAPS])
{
    for (int i = 0; i < MAPS; i++)
        free(maps[i].pixels);
}

/* ---- the pipeline with one instruction set ---- */

typedef light_world pipeline;

static void run_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    while (count-- > 0)
        body(data, count);
}

/* threads 0: a parallel_for that runs loops backwards. */
static pipeline make_pipeline(const char *set, uint32_t threads, const isa_map *map, helio_weighting weighting,
                              helio_strategy strategy)
{
    const helio_context_desc desc = {
        .isa = set, .threads = threads, .parallel_for = threads == 0 ? run_backwards : NULL};
    const helio_pools_desc pools = {.strategy = strategy, .length = 512, .bins = BINS_PER_EDGE};
    helio_context *context;
    assert_ok(helio_context_create(&desc, &context));
    assert_string_equal(helio_context_isa(context), set);
    pipeline p = make_light_world(context, map->pixels, map->size, weighting, &pools);
    assert_ok(helio_environment_orient(p.environment, &(helio_orientation){.rotate = 33, .intensity = 1.5f}));
    return p;
}

static void destroy_pipeline(pipeline *p)
{
    destroy_light_world(p);
    helio_context_destroy(p->context);
}

/* ---- equal bits ---- */

static void compare_tables(const helio_tables *a, const helio_tables *b)
{
    size_t rows = (size_t)CUBE_FACES * a->size;
    assert_memory_equal(a->rows, b->rows, rows * (a->size + 1) * sizeof *a->rows);
    assert_memory_equal(a->marginals, b->marginals, CUBE_FACES * ((size_t)a->size + 1) * sizeof *a->marginals);
    assert_memory_equal(a->row_densities, b->row_densities, rows * sizeof *a->row_densities);
    assert_memory_equal(a->row_sums, b->row_sums, rows * sizeof *a->row_sums);
    assert_memory_equal(a->row_fluxes, b->row_fluxes, rows * sizeof *a->row_fluxes);
    assert_memory_equal(a->faces, b->faces, sizeof a->faces);
    assert_memory_equal(a->face_fluxes, b->face_fluxes, sizeof a->face_fluxes);
}

/* Both may be NULL. */
static void compare_bins(const normal_bins *a, const normal_bins *b)
{
    if (a == NULL)
        return;
    assert_memory_equal(a->tiles->light, b->tiles->light, sizeof a->tiles->light);
    assert_memory_equal(a->tiles->sums, b->tiles->sums,
                        (size_t)a->tiles->count * a->tiles->stride * sizeof *a->tiles->sums);
    assert_memory_equal(a->sums, b->sums, (size_t)a->count * (a->tiles->count + 1) * sizeof *a->sums);
    assert_memory_equal(a->shares, b->shares, a->count * sizeof *a->shares);
    assert_memory_equal(a->list_starts, b->list_starts, sizeof a->list_starts);
    assert_true((a->lobe_variances == NULL) == (b->lobe_variances == NULL));
    if (a->lobe_variances != NULL)
        assert_memory_equal(a->lobe_variances, b->lobe_variances, a->count * LOBE_CLASSES * sizeof *a->lobe_variances);
}

static const helio_strategy strategies[] = {
    HELIO_STRATEGY_COSINE, HELIO_STRATEGY_BRDF,      HELIO_STRATEGY_LIGHT,   HELIO_STRATEGY_LIGHT_BRDF,
    HELIO_STRATEGY_FACE,   HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
enum { STRATEGIES = sizeof strategies / sizeof strategies[0] };

static void tables_and_pools_have_the_same_bits(void **state)
{
    (void)state;
    isa_map maps[MAPS];
    make_maps(maps);
    for (int m = 0; m < MAPS; m++)
        for (int k = 0; k < 3; k++) {
            static const helio_strategy drawn[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT, HELIO_STRATEGY_PRODUCT};
            helio_strategy strategy = drawn[k];
            int weighting = k == 1;
            pipeline plain = make_pipeline("scalar", 1, &maps[m], (helio_weighting)weighting, strategy);
            for (uint32_t i = 0; helio_isa_name(i) != NULL; i++)
                for (uint32_t threads = 0; threads < 4; threads++) {
                    pipeline other =
                        make_pipeline(helio_isa_name(i), threads, &maps[m], (helio_weighting)weighting, strategy);
                    compare_tables(plain.tables, other.tables);
                    compare_bins(plain.pools->bins, other.pools->bins);
                    assert_memory_equal(plain.pools->samples, other.pools->samples,
                                        plain.pools->stride * POOL_ARRAYS * sizeof(float));
                    destroy_pipeline(&other);
                }
            destroy_pipeline(&plain);
        }
    free_maps(maps);
}

/* ---- estimates ---- */

typedef struct isa_material {
    const char *name;
    helio_material material;
    bool sharp;
} isa_material;

static const isa_material materials[] = {
    {"diffuse", {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.5f, 0.2f}}, false},
    {"phong 120",
     {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.5f, 0.4f, 0.5f}, .exponent = 120},
     false},
    {"phong 0", {.kind = HELIO_MATERIAL_PHONG, .specular = {1, 1, 1}, .exponent = 0}, false},
    {"phong 1000", {.kind = HELIO_MATERIAL_PHONG, .specular = {0.9f, 0.9f, 0.9f}, .exponent = 1000}, false},
    {"phong 100000", {.kind = HELIO_MATERIAL_PHONG, .specular = {0.9f, 0.9f, 0.9f}, .exponent = 1e5f}, true},
    {"ggx 0.4", {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 0.8f, 0.3f}, .metallic = 0.5f, .roughness = 0.4f}, false},
    {"ggx 0.1", {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 0.8f, 0.3f}, .metallic = 1, .roughness = 0.1f}, false},
    {"ggx 0", {.kind = HELIO_MATERIAL_GGX, .diffuse = {0.9f, 0.8f, 0.3f}, .metallic = 0, .roughness = 0}, true},
    {"phong 500", /* nearly the sharpest of the lobes that the fast way takes for wide */
     {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.1f, 0.1f, 0.2f}, .specular = {0.9f, 0.8f, 0.8f}, .exponent = 500},
     false},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

static vec3 random_direction(uint64_t *state)
{
    double z = 2 * random_unit(state) - 1, angle = 2 * PI * random_unit(state), r = sqrt(1 - z * z);
    return (vec3){(float)(r * cos(angle)), (float)(r * sin(angle)), (float)z};
}

/* Any normal and view, also views from behind, and a geometric normal that leans away a little. */
static helio_shading_point make_point(uint64_t *state, const helio_material *material)
{
    helio_shading_point point = {.material = *material, .seed = random_bits(state)};
    vec3 normal = random_direction(state);
    vec3_to(normal, point.normal);
    vec3_to(normalize(add_scaled(normal, random_direction(state), 0.2f)), point.geometric_normal);
    vec3_to(random_direction(state), point.view);
    return point;
}

static double difference(const float a[3], const float b[3])
{
    double brighter = 0, apart = 0;
    for (int c = 0; c < 3; c++) {
        brighter = fmax(brighter, fmax((double)a[c], (double)b[c]));
        apart = fmax(apart, fabs((double)a[c] - (double)b[c]));
    }
    return brighter > (double)FLT_MIN ? apart / brighter : 0;
}

/* Half of the sky is hidden, in pieces. */
static void some_reach(void *user, const helio_shading_point *point, uint32_t count, const float *x, const float *y,
                       const float *z, bool *visible)
{
    (void)user;
    (void)point;
    for (uint32_t i = 0; i < count; i++)
        visible[i] = ((int)(x[i] * 8 + 8.5f) + (int)(y[i] * 8 + 8.5f) + (int)(z[i] * 8 + 8.5f)) % 2 == 0;
}

/* Compares estimates of random points; returns the largest difference. Numbers of samples that fill registers and that
 * do not, one, and more than a block holds. */
static double compare_estimates(const pipeline *plain, const pipeline *other, const isa_material *material,
                                const char *what)
{
    static const uint32_t counts[] = {64, 1, 7, 16, 33, 61};
    double largest = 0;
    uint64_t random = 5;
    for (int i = 0; i < POINTS; i++) {
        helio_shading_point point = make_point(&random, &material->material);
        helio_estimate_desc desc = {
            .samples = counts[i % 6], .no_control = true, .visibility = i % 4 == 1 ? some_reach : NULL};
        float a[3], b[3];
        helio_estimate_info info_a, info_b;
        assert_ok(helio_estimate(plain->pools, &point, &desc, a, &info_a));
        assert_ok(helio_estimate(other->pools, &point, &desc, b, &info_b));
        assert_int_equal(info_a.samples, info_b.samples);
        /* Right at the horizon rounding decides, and where light underflows. */
        assert_true(labs((long)info_a.useful - (long)info_b.useful) <= 1);
        double apart = difference(a, b);
        if (!(apart <= (material->sharp ? LARGEST_DIFFERENCE_SHARP : LARGEST_DIFFERENCE)))
            fail_msg("%s, %s: %.9g %.9g %.9g differs from the scalar %.9g %.9g %.9g", what, material->name,
                     (double)b[0], (double)b[1], (double)b[2], (double)a[0], (double)a[1], (double)a[2]);
        largest = fmax(largest, apart);
    }
    return largest;
}

static void estimates_agree_within_the_bound(void **state)
{
    (void)state;
    static const int chosen[] = {0, 3, 5, 6, 7, 8}; /* maps whose light is not infinite when summed */
    isa_map maps[MAPS];
    make_maps(maps);
    for (uint32_t i = 1; helio_isa_name(i) != NULL; i++) {
        double largest[2] = {0, 0}; /* sharp lobes apart */
        for (size_t m = 0; m < sizeof chosen / sizeof chosen[0]; m++)
            for (int s = 0; s < STRATEGIES; s++) {
                const isa_map *map = &maps[chosen[m]];
                char what[200];
                snprintf(what, sizeof what, "%s, %s, %s", helio_isa_name(i), map->name,
                         helio_strategy_name(strategies[s]));
                pipeline plain = make_pipeline("scalar", 1, map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
                pipeline other = make_pipeline(helio_isa_name(i), 1, map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
                for (int k = 0; k < MATERIALS; k++) {
                    double apart = compare_estimates(&plain, &other, &materials[k], what);
                    largest[materials[k].sharp] = fmax(largest[materials[k].sharp], apart);
                }
                destroy_pipeline(&plain);
                destroy_pipeline(&other);
            }
        print_message("%s: estimates differ by at most %.2g, with sharp lobes %.2g\n", helio_isa_name(i), largest[0],
                      largest[1]);
    }
    free_maps(maps);
}

/* Directions of the surface technique decide which texel is seen, so they must not depend on rounding. */
static void gathered_directions_have_the_same_bits(void **state)
{
    (void)state;
    isa_map map = make_map("random", 64, 9);
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++)
        for (int s = 0; s < STRATEGIES; s++) {
            pipeline plain = make_pipeline("scalar", 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
            pipeline other = make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
            uint64_t random = 5;
            for (int k = 0; k < POINTS; k++) {
                helio_shading_point point = make_point(&random, &materials[k % MATERIALS].material);
                helio_sample a[64], b[64];
                uint32_t count_a, count_b;
                assert_ok(helio_gather(plain.pools, &point, NULL, a, &count_a));
                assert_ok(helio_gather(other.pools, &point, NULL, b, &count_b));
                assert_int_equal(count_a, count_b);
                for (uint32_t j = 0; j < count_a; j++) {
                    assert_memory_equal(a[j].direction, b[j].direction, sizeof a[j].direction);
                    assert_int_equal(a[j].technique, b[j].technique);
                    if (!materials[k % MATERIALS].sharp)
                        assert_true(fabsf(a[j].density - b[j].density) <= 1e-4f * a[j].density);
                }
            }
            destroy_pipeline(&plain);
            destroy_pipeline(&other);
        }
    free(map.pixels);
}

static void many_samples_are_cut_into_blocks(void **state)
{
    (void)state;
    isa_map map = make_map("random", 16, 10);
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++) {
        pipeline p = make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE_BRDF);
        const helio_pools_desc large = {.strategy = HELIO_STRATEGY_FACE_BRDF, .length = 16384};
        helio_pools_destroy(p.pools);
        assert_ok(helio_pools_create(p.tables, &large, &p.pools));
        assert_ok(helio_pools_draw(p.pools, 1, 1));
        uint64_t random = 6;
        for (uint32_t samples = 1; samples <= 2048; samples = samples * 3 + 1) {
            static helio_sample gathered[2048];
            helio_shading_point point = make_point(&random, &materials[1].material);
            const helio_estimate_desc desc = {.samples = samples};
            uint32_t count;
            float radiance[3];
            double sum = 0;
            assert_ok(helio_gather(p.pools, &point, &desc, gathered, &count));
            assert_int_equal(count, samples);
            for (uint32_t k = 0; k < count; k++)
                sum += (double)gathered[k].contribution[1];
            assert_ok(helio_estimate(p.pools, &point, &desc, radiance, NULL));
            assert_true(fabs((double)radiance[1] - sum) <= 1e-5 * sum);
        }
        destroy_pipeline(&p);
    }
    free(map.pixels);
}

/* The fast way of points without visibility, whose light is summed in the pools, against the samples one by one; and
 * many points together against each alone. */
static void light_summed_in_the_pools_is_that_of_the_samples(void **state)
{
    (void)state;
    enum { TOGETHER = 77 }; /* two blocks and a part */
    static const uint32_t counts[] = {64, 1, 7, 16, 33, 61};
    static helio_shading_point points[TOGETHER];
    static float together[TOGETHER][3];
    static helio_estimate_info infos[TOGETHER];
    isa_map map = make_map("a sun of 10^7", 33, 6);
    for (int c = 0; c < 3; c++)
        map.pixels[(33 * 33 * 2 + 33 * 16 + 20) * 3 + c] = 1e7f;
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++) {
        double largest = 0;
        for (int s = 0; s < STRATEGIES; s++)
            for (int k = 0; k < MATERIALS; k++) {
                pipeline p = make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
                const helio_estimate_desc desc = {.samples = counts[k % 6], .is_free = true};
                uint64_t random = 7;
                for (int n = 0; n < TOGETHER; n++)
                    points[n] = make_point(&random, &materials[(k + n % 2) % MATERIALS].material);
                assert_ok(helio_estimate_points(p.pools, TOGETHER, points, &desc, together, infos));
                for (int n = 0; n < TOGETHER; n++) {
                    helio_sample samples[64];
                    helio_estimate_info info;
                    helio_counts divided;
                    float alone[3], sum[3] = {0};
                    uint32_t count, useful = 0;
                    assert_ok(helio_estimate(p.pools, &points[n], &desc, alone, &info));
                    assert_memory_equal(alone, together[n], sizeof alone);
                    assert_memory_equal(&info, &infos[n], sizeof info);
                    assert_ok(helio_gather(p.pools, &points[n], &desc, samples, &count));
                    for (uint32_t j = 0; j < count; j++) {
                        const float *light = samples[j].contribution;
                        for (int c = 0; c < 3; c++)
                            sum[c] += light[c];
                        useful += light[0] + light[1] + light[2] > 0;
                    }
                    assert_ok(helio_count(p.pools, &points[n], &desc, &divided));
                    for (int c = 0; c < 3; c++)
                        sum[c] += divided.control[c];
                    assert_int_equal(info.samples, count);
                    assert_true(labs((long)info.useful - (long)useful) <= 1);
                    if (!materials[(k + n % 2) % MATERIALS].sharp)
                        largest = fmax(largest, difference(sum, alone));
                }
                destroy_pipeline(&p);
            }
        print_message("%s: light summed in the pools differs from that of the samples by at most %.2g\n",
                      helio_isa_name(i), largest);
        assert_true(largest <= LARGEST_DIFFERENCE);
    }
    free(map.pixels);
}

/* Light that no normal float holds is light all the same: it gets samples, and their contributions are numbers. */
static void the_darkest_maps_get_samples(void **state)
{
    (void)state;
    isa_map map = make_map("one pixel of 10^-38", 64, 0);
    map.pixels[(64 * 64 * 2 + 64 * 30 + 30) * 3] = 1e-38f;
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++)
        for (int s = 0; s < STRATEGIES; s++) {
            pipeline p = make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, strategies[s]);
            const helio_shading_point point = {
                .normal = {0, 1, 0}, .view = {0, 1, 0}, .material = materials[0].material};
            helio_counts counts;
            float radiance[3], sum = 0;
            assert_ok(helio_count(p.pools, &point, NULL, &counts));
            for (int k = 0; k < TECHNIQUES; k++)
                sum += counts.expected[k];
            assert_true(fabsf(sum - 64) < 1e-3f);
            assert_ok(helio_estimate(p.pools, &point, NULL, radiance, NULL));
            assert_true(isfinite(radiance[0]) && radiance[0] >= 0.0f);
            destroy_pipeline(&p);
        }
    free(map.pixels);
}

/* ---- elementary functions ---- */

static double relative_error(float value, double truth)
{
    return truth != 0 ? fabs((double)value - truth) / fabs(truth) : fabs((double)value);
}

static void elementary_functions_keep_their_bounds(void **state)
{
    (void)state;
    double log_error = 0, log2_error = 0, exp_error = 0, less_error = 0, sine_error = 0, cosine_error = 0;
    for (int32_t bits = 0; bits < bits_of_float(1.0f); bits += 37) {
        float x = float_of_bits(bits);
        if (x >= FLT_MIN)
            log_error = fmax(log_error, relative_error(log2_one_minus(x), log1p(-(double)x) / log(2)));
    }
    for (int32_t bits = bits_of_float(0x1p-24f); bits <= bits_of_float(126.0f); bits += 13) {
        float x = float_of_bits(bits);
        exp_error = fmax(exp_error, relative_error(exp2_fast(x), exp2((double)x)));
        if (x <= 100.0f)
            exp_error = fmax(exp_error, relative_error(exp2_fast(-x), exp2(-(double)x)));
    }
    for (int32_t bits = bits_of_float(FLT_MIN); bits <= bits_of_float(2.0f); bits += 33) {
        float x = float_of_bits(bits);
        double error = fabs((double)log2_fast(x) - log2((double)x)), size = fabs(log2((double)x));
        log2_error = fmax(log2_error, size > 1 ? error / size : error);
    }
    for (int32_t bits = bits_of_float(FLT_MIN); bits <= bits_of_float(200.0f); bits += 41) {
        float x = -float_of_bits(bits);
        less_error = fmax(less_error, relative_error(one_minus_exp2(x), -expm1((double)x * log(2))));
    }
    for (int32_t i = 0; i < 1 << 24; i += 3) {
        float turn = (float)i * 0x1p-24f;
        sine_error = fmax(sine_error, fabs((double)sine_of_turn(turn) - sin(2 * PI * (double)turn)));
        cosine_error = fmax(cosine_error, fabs((double)cosine_of_turn(turn) - cos(2 * PI * (double)turn)));
    }
    print_message("largest errors: log2(1 - x) %.2g, log2(x) %.2g, 2^x %.2g, 1 - 2^x %.2g, sine %.2g, cosine %.2g\n",
                  log_error, log2_error, exp_error, less_error, sine_error, cosine_error);
    assert_true(log_error < 6e-7);
    assert_true(log2_error < 3e-7);
    assert_true(exp_error < 2.5e-7);
    assert_true(less_error < 3e-7);
    assert_true(sine_error < 2.5e-7);
    assert_true(cosine_error < 2.5e-7);
    assert_true(log2_one_minus(0.0f) == 0.0f);
    assert_true(one_minus_exp2(0.0f) == 0.0f);
    assert_true(exp2_fast(0.0f) == 1.0f);
    assert_true(exp2_fast(-1e30f) == 0x1p-100f);
    assert_true(exp2_fast(-INFINITY) == 0x1p-100f);
}

/* ---- choosing ---- */

static void an_instruction_set_can_be_forced(void **state)
{
    (void)state;
    helio_context *context;
    assert_string_equal(helio_isa_name(0), "scalar");
    uint32_t sets = 0;
    while (helio_isa_name(sets) != NULL)
        sets++;
    assert_in_range(sets, 2, MOST_SETS);
    const char *before = getenv("HELIOSTAT_ISA");
    char *saved = before != NULL ? strdup(before) : NULL;
    for (uint32_t i = 0; i < sets; i++) {
        assert_int_equal(setenv("HELIOSTAT_ISA", helio_isa_name(i), 1), 0);
        assert_ok(helio_context_create(NULL, &context));
        assert_string_equal(helio_context_isa(context), helio_isa_name(i));
        helio_context_destroy(context);
        assert_ok(helio_context_create(&(helio_context_desc){.isa = "scalar"}, &context));
        assert_string_equal(helio_context_isa(context), "scalar");
        helio_context_destroy(context);
    }
    assert_int_equal(setenv("HELIOSTAT_ISA", "mmx", 1), 0);
    assert_int_equal(helio_context_create(NULL, &context), HELIO_ERR_ARGUMENT);
    assert_null(context);
    assert_non_null(strstr(helio_last_error(), "mmx"));
    assert_non_null(strstr(helio_last_error(), "scalar"));
    unsetenv("HELIOSTAT_ISA");
    assert_ok(helio_context_create(NULL, &context));
    assert_string_equal(helio_context_isa(context), helio_isa_name(sets - 1));
    helio_context_destroy(context);
    assert_int_equal(helio_context_create(&(helio_context_desc){.isa = "altivec"}, &context), HELIO_ERR_ARGUMENT);
    for (isa set = ISA_SCALAR; set < ISA_COUNT; set = (isa)(set + 1))
        if (!isa_is_supported(set)) {
            print_message("%s: this machine does not have it, so nothing here tests it\n", isa_name(set));
            assert_int_equal(helio_context_create(&(helio_context_desc){.isa = isa_name(set)}, &context),
                             HELIO_ERR_UNSUPPORTED);
            assert_non_null(strstr(helio_last_error(), isa_name(set)));
        }
    if (saved != NULL)
        setenv("HELIOSTAT_ISA", saved, 1);
    free(saved);
}

/* ---- times ---- */

static double milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { REPEATS = 5 };

static double median(double times[REPEATS])
{
    qsort(times, REPEATS, sizeof times[0], compare_doubles);
    return times[REPEATS / 2];
}

static double time_estimates(const pipeline *p, const helio_material *material)
{
    enum { TIMED_POINTS = 500 };
    double times[REPEATS];
    for (int k = 0; k < REPEATS; k++) {
        uint64_t random = 8;
        float radiance[3];
        double start = milliseconds();
        for (int i = 0; i < TIMED_POINTS; i++) {
            helio_shading_point point = make_point(&random, material);
            assert_ok(helio_estimate(p->pools, &point, NULL, radiance, NULL));
        }
        times[k] = milliseconds() - start;
    }
    return TIMED_POINTS * 64 / median(times) * 1e-3;
}

static void times_of_each_instruction_set_are_printed(void **state)
{
    (void)state;
    isa_map map = make_map("random", 256, 12);
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++) {
        double tables[REPEATS], pools[REPEATS];
        pipeline face = make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE);
        pipeline both =
            make_pipeline(helio_isa_name(i), 1, &map, HELIO_WEIGHTING_SOLID_ANGLE, HELIO_STRATEGY_FACE_BRDF);
        for (int k = 0; k < REPEATS; k++) {
            double start = milliseconds();
            assert_ok(helio_tables_update(face.tables));
            tables[k] = milliseconds() - start;
            start = milliseconds();
            assert_ok(helio_pools_draw(face.pools, 1, (uint32_t)k));
            pools[k] = milliseconds() - start;
        }
        print_message("%-6s tables %.2f ms, pools %.2f ms, million samples a second by face and face+brdf:",
                      helio_isa_name(i), median(tables), median(pools));
        static const int timed[] = {0, 1, 5};
        for (size_t k = 0; k < sizeof timed / sizeof timed[0]; k++) {
            const isa_material *material = &materials[timed[k]];
            print_message(" %s %.0f %.0f", material->name, time_estimates(&face, &material->material),
                          time_estimates(&both, &material->material));
        }
        print_message("\n");
        destroy_pipeline(&face);
        destroy_pipeline(&both);
    }
    free(map.pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_instruction_set_can_be_forced),
        cmocka_unit_test(elementary_functions_keep_their_bounds),
        cmocka_unit_test(tables_and_pools_have_the_same_bits),
        cmocka_unit_test(gathered_directions_have_the_same_bits),
        cmocka_unit_test(estimates_agree_within_the_bound),
        cmocka_unit_test(many_samples_are_cut_into_blocks),
        cmocka_unit_test(light_summed_in_the_pools_is_that_of_the_samples),
        cmocka_unit_test(the_darkest_maps_get_samples),
        cmocka_unit_test(times_of_each_instruction_set_are_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
