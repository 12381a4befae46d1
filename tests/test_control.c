/* SPDX-License-Identifier: MIT
 *
 * The control variate: the known light is the integral that it should be, samples stand for it without bias, and it
 * takes error away. */
#include "support.h"

#include "core/random.h"
#include "sampling/pools.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- worlds ---- */

typedef light_world world;

/* A random strip as large as the cube, coloured, with a sun and some black texels. */
static world make_world(uint32_t size, float sun, const char *isa)
{
    const helio_context_desc context = {.threads = 1, .isa = isa};
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF, .bins = 4};
    const size_t count = (size_t)18 * size * size;
    float *rgb = calloc(count, sizeof *rgb);
    uint64_t random = size;
    helio_context *own;
    assert_non_null(rgb);
    for (size_t i = 0; i < count; i++)
        rgb[i] = random_bits(&random) % 8 == 0 ? 0.0f : (float)random_unit(&random) * (float)(1 + i % 3);
    for (size_t c = 0; c < 3; c++)
        rgb[count / 18 * 3 + (count / 36 / 3 * 3) + c] = sun;
    assert_ok(helio_context_create(&context, &own));
    world w = make_light_world(own, rgb, size, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    free(rgb);
    return w;
}

static void destroy_world(world *w)
{
    destroy_light_world(w);
    helio_context_destroy(w->context);
}

static const helio_material materials[] = {
    {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.9f, 0.6f, 0.3f}},
    {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.3f, 0.4f, 0.5f}, .exponent = 50},
    {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 0.8f, 0.3f}, .metallic = 0.5f, .roughness = 0.3f},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

static helio_shading_point make_point(uint64_t *random, uint32_t seed)
{
    helio_shading_point point = {.material = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.9f, 0.6f, 0.3f}},
                                 .seed = hash(seed)};
    float z = (float)(2 * random_unit(random) - 1), angle = (float)(2 * PI * random_unit(random));
    float sine = sqrtf(fmaxf(0.0f, 1 - z * z));
    vec3_to((vec3){sine * cosf(angle), z, sine * sinf(angle)}, point.normal);
    memcpy(point.view, point.normal, sizeof point.view);
    return point;
}

/* ---- the known light ---- */

static const uint32_t sizes[] = {1, 3, 16, 17, 64};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* For one bin, over cells so small that their centres do. */
static void integrate(const world *w, const normal_bin *bin, double known[4][3])
{
    const uint32_t size = w->environment->size, parts = 128 / size;
    const tiles *t = w->pools->bins->tiles;
    const double cell = 2.0 / (size * parts);
    memset(known, 0, 12 * sizeof(double));
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < size * parts; y++)
            for (uint32_t x = 0; x < size * parts; x++) {
                const double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1, radius2 = 1 + u * u + v * v;
                const vec3 direction = cube_direction(face, (float)u, (float)v);
                const uint32_t at = tiles_position(t, face, y / parts, x / parts);
                const control_line line = control_line_of(bin, dot(bin->centre, (vec3){t->x[at], t->y[at], t->z[at]}));
                const float *rgb = environment_texel(w->environment, face, y / parts, x / parts);
                const double solid_angle = cell * cell / (radius2 * sqrt(radius2));
                const float towards = dot(direction, (vec3){t->x[at], t->y[at], t->z[at]});
                const float factors[4] = {line.slope * direction.x, line.slope * direction.y, line.slope * direction.z,
                                          line.offset * towards};
                for (int row = 0; row < 4; row++)
                    for (int c = 0; c < 3; c++)
                        known[row][c] += solid_angle * (double)factors[row] * (double)rgb[c];
            }
}

static void known_light_is_an_integral(void **state)
{
    (void)state;
    double largest = 0;
    for (int s = 0; s < SIZES; s++) {
        world w = make_world(sizes[s], 3.0f, NULL);
        for (uint32_t bin = 5; bin < w.pools->count; bin += 41) {
            double known[4][3], greatest = 0;
            integrate(&w, &w.pools->bins->bins[bin], known);
            for (int i = 0; i < 12; i++)
                greatest = fmax(greatest, fabs(known[i / 3][i % 3]));
            for (int i = 0; i < 12; i++) {
                const double found = (double)w.pools->control->known[bin].rows[i / 3][i % 3];
                largest = fmax(largest, fabs(found - known[i / 3][i % 3]) / greatest);
            }
        }
        destroy_world(&w);
    }
    print_message("known light is off by at most %.2g\n", largest);
    assert_true(largest < 1e-4); /* by the cells here: halving them quarters it */
}

/* A line fits what it stands for: exact in front and behind, and never far off between. */
static void lines_are_those_of_a_clamped_cosine(void **state)
{
    (void)state;
    const normal_bin bin = {.centre = {0, 0, 1}, .reach = 0.3f};
    for (int i = -100; i <= 100; i++) {
        const float cosine = (float)i * 0.01f;
        const control_line line = control_line_of(&bin, cosine);
        const float value = line.slope * cosine + line.offset, clamped = fmaxf(0.0f, cosine);
        if (fabsf(cosine) >= bin.reach)
            assert_float_equal(value, clamped, 1e-7f);
        assert_true(fabsf(value - clamped) <= 0.1f * bin.reach + 1e-7f);
        assert_true(line.slope >= 0.0f && line.slope <= 1.0f);
    }
}

/* ---- what it adds ---- */

enum { DRAWS = 120, POINTS = 40 };

typedef struct moments {
    double sum, square;
} moments;

static void add_value(moments *m, double value)
{
    m->sum += value;
    m->square += value * value;
}

static double variance(const moments *m, int count)
{
    const double mean = m->sum / count;
    return fmax(0.0, m->square / count - mean * mean);
}

/* A pool has as many samples as there may be at once, so that every window is met; windows of 4 and of any length. */
static void it_adds_nothing_on_average(void **state)
{
    (void)state;
    static const uint32_t counts[] = {4, 64, 37};
    for (int s = 0; s < SIZES; s += 2)
        for (int k = 0; k < 3; k++) {
            static moments sums[POINTS];
            const helio_estimate_desc desc = {.samples = counts[k]};
            world w = make_world(sizes[s], 3.0f, NULL);
            memset(sums, 0, sizeof sums);
            for (uint32_t draw = 0; draw < DRAWS; draw++) {
                uint64_t random = 4;
                assert_ok(helio_pools_draw(w.pools, draw, 7));
                for (uint32_t i = 0; i < POINTS; i++) {
                    helio_shading_point point = make_point(&random, draw);
                    helio_counts divided;
                    point.material = materials[i % MATERIALS];
                    assert_ok(helio_count(w.pools, &point, &desc, &divided));
                    add_value(&sums[i], (double)divided.control[1]);
                }
            }
            for (int i = 0; i < POINTS; i++) {
                const double z = fabs(sums[i].sum / DRAWS) / sqrt(variance(&sums[i], DRAWS) / DRAWS + 1e-14);
                assert_true(z < 6.0); /* all together p < 1e-6 */
            }
            destroy_world(&w);
        }
}

/* A wall hides what is on one side of it. */
static void half_is_hidden(void *user, const helio_shading_point *point, uint32_t count, const float *x, const float *y,
                           const float *z, bool *visible)
{
    (void)user;
    (void)point;
    (void)y;
    (void)z;
    for (uint32_t i = 0; i < count; i++)
        visible[i] = x[i] > 0.1f;
}

/* Variance of points in relation to the squares of their means, summed over all. */
static double error_of(world *w, const helio_material *material, const helio_estimate_desc *desc)
{
    static moments sums[POINTS];
    double error = 0, light = 0;
    memset(sums, 0, sizeof sums);
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        uint64_t random = 4;
        assert_ok(helio_pools_draw(w->pools, draw, 9));
        for (uint32_t i = 0; i < POINTS; i++) {
            helio_shading_point point = make_point(&random, draw + 77);
            point.material = *material;
            float radiance[3];
            assert_ok(helio_estimate(w->pools, &point, desc, radiance, NULL));
            add_value(&sums[i], (double)radiance[0]);
        }
    }
    for (int i = 0; i < POINTS; i++) {
        error += variance(&sums[i], DRAWS);
        light += sums[i].sum / DRAWS * sums[i].sum / DRAWS;
    }
    return error / light;
}

/* Deterministic: the bounds are far from what is found. What shines keeps its noise but for colour. */
static void it_takes_error_away(void **state)
{
    (void)state;
    static const double most[MATERIALS] = {0.3, 0.9, 0.9};
    world w = make_world(32, 30.0f, NULL);
    for (int m = 0; m < MATERIALS; m++) {
        const double without = error_of(&w, &materials[m], &(helio_estimate_desc){.no_control = true});
        const double with = error_of(&w, &materials[m], &(helio_estimate_desc){0});
        const helio_estimate_desc hidden_desc = {.visibility = half_is_hidden};
        const helio_estimate_desc plain_desc = {.no_control = true, .visibility = half_is_hidden};
        const double hidden_without = error_of(&w, &materials[m], &plain_desc);
        const double hidden_with = error_of(&w, &materials[m], &hidden_desc);
        print_message(
            "material %d: error with the control in relation to without %.3f, where a wall hides light %.3f\n", m,
            with / without, hidden_with / hidden_without);
        assert_true(with < most[m] * without);
        assert_true(hidden_with < 0.98 * hidden_without);
    }
    destroy_world(&w);
}

static void it_is_for_pools_of_bins(void **state)
{
    (void)state;
    world w = make_world(16, 3.0f, NULL);
    uint64_t random = 1;
    helio_counts counts;
    helio_pools *faces;
    helio_shading_point point = make_point(&random, 1);
    assert_ok(helio_count(w.pools, &point, NULL, &counts));
    assert_true(counts.control[0] != 0.0f);
    assert_ok(helio_count(w.pools, &point, &(helio_estimate_desc){.no_control = true}, &counts));
    assert_true(counts.control[0] == 0.0f);
    assert_ok(helio_count(w.pools, &point, &(helio_estimate_desc){.samples = 3}, &counts));
    assert_true(counts.control[0] == 0.0f); /* fewer than a chunk */
    assert_ok(helio_pools_create(w.tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_FACE}, &faces));
    assert_ok(helio_pools_draw(faces, 1, 1));
    assert_ok(helio_count(faces, &point, NULL, &counts));
    assert_true(counts.control[0] == 0.0f);
    helio_pools_destroy(faces);
    destroy_world(&w);
}

static void it_is_a_number_whatever_the_light(void **state)
{
    (void)state;
    static const float suns[] = {0.0f, 1e-38f, 1e20f, 3e38f};
    for (int s = 0; s < 4; s++) {
        world w = make_world(17, suns[s], NULL);
        uint64_t random = 2;
        for (uint32_t i = 0; i < POINTS; i++) {
            helio_counts counts;
            helio_shading_point point = make_point(&random, i);
            assert_ok(helio_count(w.pools, &point, NULL, &counts));
            for (int c = 0; c < 3; c++)
                assert_true(isfinite(counts.control[c]));
        }
        destroy_world(&w);
    }
}

/* ---- instruction sets ---- */

/* In relation to the brightest of all bins: where a sun stands at the edge of what a bin may see, its part is a
 * difference of much larger numbers. */
static void compare_known(const light_control *a, const light_control *b)
{
    float greatest = 0;
    for (uint32_t i = 0; i < 16 * a->bins; i++)
        greatest = fmaxf(greatest, fabsf(a->known[i / 16].rows[i / 4 % 4][i % 4]));
    for (uint32_t i = 0; i < 16 * a->bins; i++)
        assert_float_equal(a->known[i / 16].rows[i / 4 % 4][i % 4], b->known[i / 16].rows[i / 4 % 4][i % 4],
                           2e-6f * greatest);
}

static void every_instruction_set_knows_the_same_light(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        world plain = make_world(sizes[s], 1e4f, "scalar");
        for (uint32_t i = 1; helio_isa_name(i) != NULL; i++) {
            world other = make_world(sizes[s], 1e4f, helio_isa_name(i));
            const light_control *a = plain.pools->control, *b = other.pools->control;
            compare_known(a, b);
            assert_memory_equal(a->sums, b->sums, a->bins * (a->chunks + (size_t)1) * sizeof *a->sums);
            destroy_world(&other);
        }
        destroy_world(&plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_light_is_an_integral),
        cmocka_unit_test(lines_are_those_of_a_clamped_cosine),
        cmocka_unit_test(it_adds_nothing_on_average),
        cmocka_unit_test(it_takes_error_away),
        cmocka_unit_test(it_is_for_pools_of_bins),
        cmocka_unit_test(it_is_a_number_whatever_the_light),
        cmocka_unit_test(every_instruction_set_knows_the_same_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
