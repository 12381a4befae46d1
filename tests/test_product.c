/* SPDX-License-Identifier: MIT
 *
 * Tiles, bins of normals and their pools: densities that integrate to 1, are above 0 wherever a normal that may choose
 * the bin sees light, and are what samples follow; nothing happens at the edge of a bin. */
#include "support.h"

#include "core/random.h"
#include "sampling/kernels.h"

#include <heliostat/heliostat.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- worlds ---- */

typedef light_world world;

/* rgb: a strip, as large as the cube. */
static world make_world(const float *rgb, uint32_t size, uint32_t bins, uint32_t length, helio_weighting weighting)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT, .length = length, .bins = bins};
    return make_light_world(make_context(1, NULL), rgb, size, weighting, &desc);
}

static void destroy_world(world *w)
{
    destroy_light_world(w);
    helio_context_destroy(w->context);
}

static size_t numbers(uint32_t size)
{
    return (size_t)6 * size * size * 3;
}

static float *make_map(uint32_t size)
{
    float *rgb = calloc(numbers(size), sizeof *rgb);
    assert_non_null(rgb);
    return rgb;
}

/* Some texels, and a whole row, are black; one is a sun. */
static float *make_sky(uint32_t size, uint64_t seed)
{
    float *rgb = make_map(size);
    for (size_t i = 0; i < numbers(size); i++)
        rgb[i] = random_bits(&seed) % 8 == 0 ? 0.0f : (float)random_unit(&seed);
    memset(rgb + (size_t)(size / 2) * size * 3, 0, size * 3 * sizeof *rgb);
    for (size_t c = 0; c < 3; c++)
        rgb[numbers(size) / 2 + c] = 1e5f;
    return rgb;
}

static const uint32_t sizes[] = {1, 2, 3, 8, 16, 17, 40};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* ---- tiles ---- */

static void tiles_divide_each_face_and_follow_a_curve(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        float *map = make_sky(sizes[s], 1);
        world w = make_world(map, sizes[s], 1, 64, HELIO_WEIGHTING_SOLID_ANGLE);
        const tiles *t = w.pools->bins->tiles;
        uint32_t jumps = 0;
        bool met[TILES_MOST] = {false};
        assert_int_equal(t->per_edge, sizes[s] < 16 ? sizes[s] : 16);
        assert_int_equal(t->count, 6 * t->per_edge * t->per_edge);
        for (uint32_t i = 0; i < t->count; i++) {
            assert_false(met[t->grid[i]]);
            met[t->grid[i]] = true;
            assert_int_equal(t->positions[t->grid[i]], i);
            const vec3 centre = {t->x[i], t->y[i], t->z[i]};
            const vec3 before = i > 0 ? (vec3){t->x[i - 1], t->y[i - 1], t->z[i - 1]} : centre;
            /* Next to each other: two tiles in a row, or round an edge of the cube. */
            jumps += acosf(fminf(1.0f, dot(centre, before))) > 4.5f * t->radius;
            cube_position at = cube_project(centre);
            uint32_t column = cube_texel(at.u, t->size), row = cube_texel(at.v, t->size);
            assert_int_equal(tiles_position(t, at.face, row, column), i);
        }
        assert_true(jumps <= 5); /* from one face to the next, at most */
        destroy_world(&w);
        free(map);
    }
}

static void the_light_of_tiles_is_that_of_their_texels(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        float *map = make_sky(sizes[s], 2);
        world w = make_world(map, sizes[s], 1, 64, HELIO_WEIGHTING_SOLID_ANGLE);
        const tiles *t = w.pools->bins->tiles;
        double exact[TILES_MOST] = {0}, total = 0, sum = 0;
        for (uint32_t face = 0; face < 6; face++)
            for (uint32_t row = 0; row < t->size; row++)
                for (uint32_t column = 0; column < t->size; column++) {
                    double light = (double)luminance(environment_texel(w.environment, face, row, column)) *
                                   (double)w.environment->solid_angle[row * t->size + column];
                    exact[tiles_position(t, face, row, column)] += light;
                    total += light;
                }
        for (uint32_t i = 0; i < t->count; i++)
            sum += (double)t->light[i];
        for (uint32_t i = 0; i < t->count; i++) {
            double light = (double)t->light[i] / sum, expected = exact[i] / total;
            assert_int_equal(light > 0, expected > 0);
            /* A row's texels are rounded to 22 bits of the brightest beside them, which may be a sun of 10^5. */
            assert_true(fabs(light - expected) <= 1e-3 * expected + 1e-6);
        }
        destroy_world(&w);
        free(map);
    }
}

/* ---- densities ---- */

static face_place place_of(uint32_t size, uint32_t face, double u, double v)
{
    return (face_place){face, cube_texel((float)v, size), cube_texel((float)u, size), (float)u, (float)v};
}

/* By midpoints of a grid on each texel. */
static double integral_of_density(const world *w, uint32_t bin)
{
    const uint32_t size = w->tables->size, parts = size >= 8 ? 4 : size > 1 ? 32 : 128;
    const double cell = 2.0 / (size * parts);
    double sum = 0;
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < size * parts; y++)
            for (uint32_t x = 0; x < size * parts; x++) {
                double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1;
                face_place at = place_of(size, face, u, v);
                sum += (double)pools_density(w->pools, bin, &at) * cell * cell * pow(1 + u * u + v * v, -1.5);
            }
    return sum;
}

/* The factor (1 + u^2 + v^2)^(3/2) of the density cancels that of the solid angle: floats are all that is off. */
static void densities_integrate_to_one(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++)
        for (int weighting = 0; weighting < 2; weighting++) {
            float *map = make_sky(sizes[s], 3);
            world w = make_world(map, sizes[s], 3, 64, (helio_weighting)weighting);
            for (uint32_t bin = 0; bin < w.pools->count; bin += 5)
                assert_float_equal(integral_of_density(&w, bin), 1.0, 1e-5);
            destroy_world(&w);
            free(map);
        }
}

static vec3 random_direction(uint64_t *state)
{
    double z = 2 * random_unit(state) - 1, angle = 2 * PI * random_unit(state), r = sqrt(1 - z * z);
    return (vec3){(float)(r * cos(angle)), (float)(r * sin(angle)), (float)z};
}

/* Any normal, or one at a corner or edge of a cell or face, or next to it; up to 1e-3 off unit length. */
static vec3 trying_normal(uint64_t *state, uint32_t bins)
{
    vec3 n = random_direction(state);
    float *c[3] = {&n.x, &n.y, &n.z};
    uint32_t kind = random_bits(state) % 4;
    if (kind == 1) /* on the grid of uv, which is not that of the cells, but meets it in the middle and at the ends */
        for (int i = 0; i < 3; i++)
            *c[i] = (float)(random_bits(state) % (2 * bins + 1)) / (float)bins - 1.0f;
    else if (kind == 2)
        *c[random_bits(state) % 3] = 0.0f;
    else if (kind == 3)
        n.x = n.y;
    n = add_scaled(n, random_direction(state), random_bits(state) % 2 ? 1e-6f : 0.0f);
    float norm = length(n);
    return norm > 0.0f ? scale(n, (1.0f + 1e-3f * (float)(2 * random_unit(state) - 1)) / norm) : (vec3){0, 1, 0};
}

/* A direction in the hemisphere of the normal, often just above the horizon; (u, v) at a corner of its tile or not. */
static vec3 trying_direction(uint64_t *state, vec3 normal)
{
    vec3 d = random_direction(state);
    float height = dot(d, normal);
    if (random_bits(state) % 2)
        d = add_scaled(d, normal, (1e-4f - height) / dot(normal, normal));
    else if (height < 0.0f)
        d = scale(d, -1.0f);
    return normalize(d);
}

/* Where the map is lit everywhere, so must be all directions that the normal sees: or the estimate would be biased. And
 * no contribution is out of bounds. */
static void densities_are_positive_for_every_normal_that_may_choose_the_bin(void **state)
{
    (void)state;
    static const uint32_t per_edge[] = {1, 2, 3, 8, 32};
    for (int s = 0; s < SIZES; s++)
        for (int b = 0; b < 5; b++) {
            uint64_t random = 4;
            float *map = make_map(sizes[s]);
            double worst = 0;
            for (size_t i = 0; i < numbers(sizes[s]); i++)
                map[i] = 1.0f;
            world w = make_world(map, sizes[s], per_edge[b], 64, HELIO_WEIGHTING_SOLID_ANGLE);
            const normal_bins *bins = w.pools->bins;
            for (int i = 0; i < 20000; i++) {
                vec3 normal = trying_normal(&random, per_edge[b]);
                uint32_t shake = random_bits(&random), kind = i % 4;
                shake = kind == 0 ? 0u : kind == 1 ? UINT32_MAX : shake;
                uint32_t bin = normal_bins_cell(per_edge[b], normal_bins_shaken(bins, normal, shake));
                vec3 direction = trying_direction(&random, normal);
                cube_position to = cube_project(direction);
                face_place at = place_of(sizes[s], to.face, (double)to.u, (double)to.v);
                float density = pools_density(w.pools, bin, &at);
                if (dot(normal, direction) > 0.0f && !(density > 0.0f))
                    fail_msg("R %u, B %u: normal %g %g %g, direction %g %g %g has density 0 in bin %u", sizes[s],
                             per_edge[b], (double)normal.x, (double)normal.y, (double)normal.z, (double)direction.x,
                             (double)direction.y, (double)direction.z, bin);
                worst = fmax(worst, (double)(dot(normal, direction) / density) / PI);
            }
            /* In units of an even map's mean. What is found is half of it; coarse tiles or bins do not fit a horizon.
             */
            assert_true(worst < (sizes[s] >= 8 && per_edge[b] >= 8 ? 70 : 400));
            destroy_world(&w);
            free(map);
        }
}

/* ---- samples ---- */

/* A count for every texel, from the first samples of a pool that is drawn many times. */
static void check_follows(world *w, uint32_t bin, uint32_t length, uint32_t draws, const char *what)
{
    const uint32_t size = w->tables->size;
    const size_t texels = (size_t)6 * size * size;
    double *drawn = calloc(texels, sizeof *drawn), *expected = calloc(texels, sizeof *expected);
    assert_true(drawn != NULL && expected != NULL);
    for (uint32_t pass = 0; pass < draws; pass++) {
        assert_ok(helio_pools_draw(w->pools, 5, pass));
        for (uint32_t i = 0; i < length; i++) {
            const vec3 d = {pools_array(w->pools, bin, SAMPLE_X)[i], pools_array(w->pools, bin, SAMPLE_Y)[i],
                            pools_array(w->pools, bin, SAMPLE_Z)[i]};
            cube_position at = cube_project(d);
            drawn[((size_t)at.face * size + cube_texel(at.v, size)) * size + cube_texel(at.u, size)]++;
        }
    }
    for (size_t i = 0; i < texels; i++) {
        const uint32_t column = (uint32_t)i % size, row = (uint32_t)i / size % size;
        double u = (column + 0.5) * 2 / size - 1, v = (row + 0.5) * 2 / size - 1;
        face_place at = place_of(size, (uint32_t)i / (size * size), u, v);
        /* Even in (u, v) over a texel. 1e-3: samples within rounding of a border may lead to the neighbour. */
        double probability =
            (double)pools_density(w->pools, bin, &at) * pow(1 + u * u + v * v, -1.5) * 4 / (size * size);
        expected[i] = probability * draws * length + 1e-3;
    }
    double p = chi_square_tail(drawn, expected, texels, 1);
    if (!(p > 1e-9))
        fail_msg("%s: the pool of bin %u does not follow its density, p = %g", what, bin, p);
    free(drawn);
    free(expected);
}

static void pools_follow_their_densities(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        char what[32];
        float *map = make_sky(sizes[s], 6);
        snprintf(what, sizeof what, "R = %u", sizes[s]);
        world w = make_world(map, sizes[s], 2, 256, HELIO_WEIGHTING_SOLID_ANGLE);
        for (uint32_t bin = 0; bin < w.pools->count; bin += 7)
            check_follows(&w, bin, w.pools->pool_length, 60, what);
        destroy_world(&w);
        free(map);
    }
}

/* Any place of a pool, as points with few samples read only the first of a window. */
static void single_places_of_pools_follow_their_densities(void **state)
{
    (void)state;
    float *map = make_sky(8, 21);
    world w = make_world(map, 8, 1, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    for (uint32_t length = 1; length <= 3; length++)
        check_follows(&w, length, length, 1200, "first samples");
    destroy_world(&w);
    free(map);
}

static void count_faces(const helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t drawn[6])
{
    memset(drawn, 0, 6 * sizeof *drawn);
    for (uint32_t i = first; i < first + count; i++)
        drawn[cube_project((vec3){pools_array(pools, pool, SAMPLE_X)[i], pools_array(pools, pool, SAMPLE_Y)[i],
                                  pools_array(pools, pool, SAMPLE_Z)[i]})
                  .face]++;
}

/* What is shared out together is spread over its windows: each has its part of what a face got, rounded up or down. */
static void windows_are_spread_over_faces(void **state)
{
    (void)state;
    float *map = make_sky(16, 22);
    world w = make_world(map, 16, 2, 256, HELIO_WEIGHTING_SOLID_ANGLE);
    const uint32_t run = pools_run_of_bin(w.pools);
    assert_int_equal(run, 64);
    for (uint32_t pool = 0; pool < w.pools->count; pool++)
        for (uint32_t width = 4; width < run; width *= 2)
            for (uint32_t first = 0; first < 256; first += width) {
                uint32_t of_run[6], of_window[6];
                count_faces(w.pools, pool, first / run * run, run, of_run);
                count_faces(w.pools, pool, first, width, of_window);
                for (int face = 0; face < 6; face++)
                    assert_true(abs((int)(of_window[face] * run) - (int)(of_run[face] * width)) < (int)run);
            }
    destroy_world(&w);
    free(map);
}

/* Stored densities are those of the density function, to the bit; weighted colours are colours over densities. */
static void samples_carry_the_density_of_their_direction(void **state)
{
    (void)state;
    float *map = make_sky(17, 7);
    world w = make_world(map, 17, 3, 128, HELIO_WEIGHTING_SOLID_ANGLE);
    uint32_t equal = 0, all = w.pools->count * w.pools->pool_length;
    for (uint32_t i = 0; i < all; i++) {
        const vec3 d = {pools_array(w.pools, 0, SAMPLE_X)[i], pools_array(w.pools, 0, SAMPLE_Y)[i],
                        pools_array(w.pools, 0, SAMPLE_Z)[i]};
        cube_position to = cube_project(d);
        face_place at = place_of(17, to.face, (double)to.u, (double)to.v);
        float density = pools_density(w.pools, i / w.pools->pool_length, &at);
        float stored = pools_array(w.pools, 0, SAMPLE_DENSITY)[i], red = pools_array(w.pools, 0, SAMPLE_RED)[i];
        /* (u, v) come from the direction here: rounded, and rarely over the border of a texel. */
        equal += fabsf(density - stored) <= 2e-6f * stored;
        assert_true(fabsf(pools_array(w.pools, 0, SAMPLE_WEIGHTED_RED)[i] - red / stored) <= 1e-6f * red / stored);
    }
    assert_true(equal >= all - all / 1000);
    destroy_world(&w);
    free(map);
}

/* ---- bins ---- */

/* How often a normal chooses each bin, walking over the sphere in small steps: shares change by no more than the step
 * allows, at edges of cells and faces as elsewhere. */
static void no_edge_of_a_bin_shows(void **state)
{
    (void)state;
    enum { STEPS = 600, SHAKES = 4096 };
    static double before[6 * 64], now[6 * 64];
    float *map = make_sky(4, 8);
    world w = make_world(map, 4, 8, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    const double step = 2 * PI / STEPS;
    double largest = 0;
    for (int i = 0; i <= STEPS; i++) {
        const float a = (float)(i * step);
        vec3 normal = normalize((vec3){cosf(a), 0.9f * sinf(a), 0.55f * sinf(a + 0.3f)});
        memset(now, 0, sizeof now);
        for (uint32_t k = 0; k < SHAKES; k++) /* a net in the three numbers of ten bits */
            now[normal_bins_cell(8, normal_bins_shaken(w.pools->bins, normal,
                                                       (sobol(k, 0) >> 22) | (sobol(k, 1) >> 22) << 10 |
                                                           (k * 1024u / SHAKES) << 20))] += 1.0 / SHAKES;
        double apart = 0;
        for (uint32_t bin = 0; bin < w.pools->count; bin++)
            apart += fabs(now[bin] - before[bin]) / 2;
        largest = i > 0 ? fmax(largest, apart) : 0;
        memcpy(before, now, sizeof now);
    }
    /* A cell's edge crosses a box of width 0.1 at a speed of at most 1.4 x the step along each of two axes; plus what a
     * net of 4096 points is off by. Without the shaking the share of a bin jumps by 1. */
    print_message("largest share of samples that change their bin over %.3f rad: %.3f\n", step, largest);
    assert_true(largest < 2 * 1.4 * step / 0.1 + 0.03);
    destroy_world(&w);
    free(map);
}

static void bins_are_cells_around_their_centres(void **state)
{
    (void)state;
    for (uint32_t per_edge = 1; per_edge <= 32; per_edge += per_edge / 3 + 1) {
        normal_bins *bins;
        helio_context *context = make_context(1, NULL);
        assert_ok(normal_bins_create(context, per_edge, 8, 64, false, &bins));
        assert_int_equal(bins->count, 6 * per_edge * per_edge);
        for (uint32_t i = 0; i < bins->count; i++)
            assert_int_equal(normal_bins_cell(per_edge, bins->bins[i].centre), i);
        normal_bins_destroy(bins);
        helio_context_destroy(context);
    }
}

/* ---- what degenerates ---- */

static void black_maps_have_no_density_and_one_texel_has_it_all(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        float *map = make_map(sizes[s]);
        world w = make_world(map, sizes[s], 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
        for (uint32_t bin = 0; bin < w.pools->count; bin++)
            assert_true(w.pools->bins->shares[bin] == 0.0f && pools_array(w.pools, bin, SAMPLE_DENSITY)[0] == 0.0f);
        map[numbers(sizes[s]) / 2 + 1] = 1e-20f; /* one texel of face +-Y or so, in green */
        assert_ok(helio_environment_update(w.environment, map, NULL));
        assert_ok(helio_tables_update(w.tables));
        assert_ok(helio_pools_draw(w.pools, 1, 1));
        uint32_t lit = 0;
        for (uint32_t bin = 0; bin < w.pools->count; bin++) {
            if (w.pools->bins->shares[bin] == 0.0f)
                continue;
            lit++;
            for (uint32_t i = 0; i < w.pools->pool_length; i++)
                assert_true(pools_array(w.pools, bin, SAMPLE_GREEN)[i] == 1e-20f);
        }
        assert_true(lit > 0);
        destroy_world(&w);
        free(map);
    }
}

/* New frames weigh tiles anew; more passes of one frame do not. */
static void bins_follow_the_frame(void **state)
{
    (void)state;
    float *map = make_sky(8, 9), *other = make_sky(8, 10);
    world w = make_world(map, 8, 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    world fresh = make_world(other, 8, 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    assert_ok(helio_environment_update(w.environment, other, NULL));
    assert_ok(helio_tables_update(w.tables));
    for (uint32_t pass = 0; pass < 3; pass++) {
        assert_ok(helio_pools_draw(w.pools, 9, pass));
        assert_ok(helio_pools_draw(fresh.pools, 9, pass));
        assert_memory_equal(w.pools->samples, fresh.pools->samples, w.pools->stride * POOL_ARRAYS * sizeof(float));
    }
    destroy_world(&w);
    destroy_world(&fresh);
    free(map);
    free(other);
}

/* ---- points that weigh tiles themselves ---- */

static const helio_material shiny[] = {
    {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.5f, 0.4f, 0.2f}, .exponent = 120},
    {.kind = HELIO_MATERIAL_PHONG, .specular = {0.5f, 0.4f, 0.2f}, .exponent = 3},
    {.kind = HELIO_MATERIAL_GGX, .diffuse = {1, 0.8f, 0.3f}, .metallic = 1, .roughness = 0.3f},
    {.kind = HELIO_MATERIAL_GGX, .diffuse = {0.5f, 0.8f, 0.3f}, .roughness = 0.02f},
    {.kind = HELIO_MATERIAL_GGX, .diffuse = {0.5f, 0.8f, 0.3f}, .roughness = 1.0f},
};
enum { SHINY = sizeof shiny / sizeof shiny[0], TRIED = 24 };

static vec3 some_direction(uint64_t *seed)
{
    vec3 v = {0, 0, 0};
    while (!(dot(v, v) > 0.01f && dot(v, v) < 1.0f))
        v = (vec3){2 * (float)random_unit(seed) - 1, 2 * (float)random_unit(seed) - 1,
                   2 * (float)random_unit(seed) - 1};
    return normalize(v);
}

/* ---- groups of tiles ---- */

static void check_group(const tiles *t, uint32_t group, vec3 middle)
{
    const tile_groups *g = &t->groups;
    double light = 0;
    for (uint32_t i = group * TILE_GROUP; i < (group + 1) * TILE_GROUP && i < t->count; i++) {
        const double apart = acos(fmin(1, (double)dot(middle, (vec3){t->x[i], t->y[i], t->z[i]})));
        light += (double)t->light[i];
        assert_true(apart + (double)t->radius >= PI / 2 || (double)g->edge[group] >= sin(apart + (double)t->radius));
    }
    assert_true(fabs((double)g->light[group] - light) <= 1e-5 * light);
    assert_true(g->variance[group] >= 0 && g->variance[group] <= 1);
    assert_true(g->spread[group] >= 0 && (double)g->spread[group] <= (double)t->radius * (1 + 1e-5));
    assert_float_equal(length((vec3){g->light_x[group], g->light_y[group], g->light_z[group]}), 1, 1e-5);
}

/* Where all tiles are near enough, and the light of each is in one of them. */
static void groups_hold_the_light_of_their_tiles(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        float *map = make_sky(sizes[s], 5);
        world w = make_world(map, sizes[s], 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
        const tiles *t = w.pools->bins->tiles;
        const tile_groups *g = &t->groups;
        assert_int_equal(g->count, (t->count + TILE_GROUP - 1) / TILE_GROUP);
        for (uint32_t i = 0; i < g->count; i++)
            check_group(t, i, (vec3){g->x[i], g->y[i], g->z[i]});
        for (uint32_t i = g->count; i < TILE_GROUPS; i++)
            assert_true(g->light[i] == 0);
        destroy_world(&w);
        free(map);
    }
}

/* A group with one lit tile is where that is, and no wider. */
static void the_light_of_one_tile_is_its_groups(void **state)
{
    (void)state;
    enum { R = 32, FACE = 3, ROW = 20, COLUMN = 7 };
    float *map = make_map(R);
    map[((FACE * R + ROW) * R + COLUMN) * 3 + 1] = 7.0f;
    world w = make_world(map, R, 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    const tiles *t = w.pools->bins->tiles;
    const uint32_t position = tiles_position(t, FACE, ROW, COLUMN), group = position / TILE_GROUP;
    const vec3 towards = {t->groups.light_x[group], t->groups.light_y[group], t->groups.light_z[group]};
    assert_float_equal(dot(towards, (vec3){t->x[position], t->y[position], t->z[position]}), 1, 1e-5);
    assert_true(t->groups.variance[group] < 1e-5f && t->groups.spread[group] == t->spread[position]);
    for (uint32_t i = 0; i < t->groups.count; i++)
        assert_true((t->groups.light[i] > 0) == (i == group));
    destroy_world(&w);
    free(map);
}

/* A surface seen from above, or just so. */
static brdf some_surface(const helio_material *material, uint64_t *seed)
{
    vec3 normal = some_direction(seed), view = some_direction(seed);
    return brdf_prepare(material, normal, brdf_lift_view(normal, view));
}

/* Weighs all groups, and all tiles. */
static void weigh_all(isa set, const tiles *t, const tile_lobe *lobe, point_tiles *p)
{
    kernels_of(set)->weigh_point(t, lobe, p);
    for (uint32_t group = 0; group < TILE_GROUPS; group++)
        kernels_of(set)->know_tiles(p, group);
}

static uint32_t sum_of_group(const point_tiles *p, uint32_t group)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        sum += p->weights[group * TILE_GROUP + i];
    return sum;
}

/* Weights sum to what they are said to sum to; every tile that holds light above the horizon has one; the probabilities
 * are their shares; and all instruction sets find the same. */
static void points_weigh_every_tile_that_can_light_them(void **state)
{
    (void)state;
    static point_tiles p, other;
    for (int s = 0; s < SIZES; s++) {
        float *map = make_sky(sizes[s], 9);
        world w = make_world(map, sizes[s], 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
        const tiles *t = w.pools->bins->tiles;
        uint64_t seed = 12;
        for (int m = 0; m < SHINY * TRIED; m++) {
            brdf surface = some_surface(&shiny[m % SHINY], &seed);
            tile_lobe lobe;
            tile_lobe_prepare(&lobe, t, &surface);
            lobe.knows_diffuse = m % 2 == 1;
            weigh_all(ISA_SCALAR, t, &lobe, &p);
            for (uint32_t group = 0; group < TILE_GROUPS; group++)
                assert_int_equal(sum_of_group(&p, group), p.sums[group + 1] - p.sums[group]);
            uint64_t sum = 0;
            double probability = 0;
            for (uint32_t i = 0; i < t->count; i++) {
                sum += p.weights[i];
                probability += (double)point_tiles_probability(&p, i);
                assert_true(t->light[i] > 0 || p.weights[i] == 0);
            }
            assert_true(sum == p.total && sum < (uint64_t)1 << 31);
            assert_true(sum == 0 || fabs(probability - 1) < 1e-5);
            assert_true(p.left >= 0 && p.left <= 1 && p.brightness >= 0 && isfinite(p.brightness));
            for (int k = 0; k < 400; k++) {
                vec3 direction = some_direction(&seed);
                cube_position at = cube_project(direction);
                uint32_t row = cube_texel(at.v, t->size), column = cube_texel(at.u, t->size);
                uint32_t position = tiles_position(t, at.face, row, column);
                if (dot(surface.normal, direction) > 0 && t->light[position] > 0 && lobe.diffuse > 0 &&
                    !lobe.knows_diffuse)
                    assert_true(p.weights[position] > 0);
            }
            for (uint32_t i = 1; helio_isa_name(i) != NULL; i++) {
                isa set;
                assert_ok(isa_choose(helio_isa_name(i), &set));
                weigh_all(set, t, &lobe, &other);
                assert_int_equal(p.total, other.total);
                assert_true(p.left == other.left && p.share == other.share && p.brightness == other.brightness);
                assert_memory_equal(p.sums, other.sums, sizeof p.sums);
                assert_memory_equal(p.weights, other.weights, sizeof p.weights);
                assert_memory_equal(p.knows_diffuse, other.knows_diffuse, sizeof p.knows_diffuse);
                for (int c = 0; c < 3; c++) {
                    assert_float_equal(p.hue[c], other.hue[c], 1e-4f * fabsf(p.hue[c]));
                    assert_true(!lobe.knows_diffuse ||
                                fabsf(p.irradiance[c] - other.irradiance[c]) <= 1e-5f * p.irradiance[c]);
                }
            }
        }
        destroy_world(&w);
        free(map);
    }
}

/* In registers as in the table, for cubes of all sizes. */
static void lines_of_texels_are_in_their_tiles(void **state)
{
    (void)state;
    for (uint32_t size = 1; size <= CUBE_MAX_SIZE; size = size < 600 ? size + 1 : size * 9 / 8 + 1) {
        const uint32_t per_edge = size < TILES_PER_EDGE ? size : TILES_PER_EDGE;
        for (uint32_t k = 0; k < per_edge; k++)
            for (uint32_t line = k * size / per_edge; line < (k + 1) * size / per_edge; line++)
                if (tiles_of_line(per_edge, 1.0f / (float)size, line) != k)
                    fail_msg("R = %u: line %u is in tile %u, not %u", size, line, k,
                             tiles_of_line(per_edge, 1.0f / (float)size, line));
    }
}

/* Light x cosine of a tile that is above the horizon, as all are of a group that shares its lobe. */
static double light_above(const tiles *t, vec3 normal, uint32_t position)
{
    return (double)t->light[position] * (double)dot(normal, (vec3){t->x[position], t->y[position], t->z[position]});
}

/* Where tiles share the lobe of their group its weight and its mean hue come from sums of the frame, and tiles have
 * weights only when somebody asks: they are the same as if each had been weighed. */
static void groups_know_what_their_tiles_weigh(void **state)
{
    (void)state;
    enum { R = 64 };
    static point_tiles p;
    float *map = make_sky(R, 5);
    world w = make_world(map, R, 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    const tiles *t = w.pools->bins->tiles;
    uint64_t seed = 8;
    uint32_t shared = 0, looked_at = 0;
    for (int m = 0; m < SHINY * TRIED; m++) {
        brdf surface = some_surface(&shiny[m % SHINY], &seed);
        tile_lobe lobe;
        tile_lobe_prepare(&lobe, t, &surface);
        lobe.knows_diffuse = m % 2 == 1;
        weigh_all(ISA_SCALAR, t, &lobe, &p);
        double hue[3] = {0};
        for (uint32_t group = 0; group < TILE_GROUPS; group++) {
            const bool is_shared = p.is_shared[group];
            const uint32_t first = group * TILE_GROUP, whole = p.sums[group + 1] - p.sums[group];
            double sum = 0;
            for (uint32_t i = first; i < first + TILE_GROUP && whole > 0; i++)
                sum += is_shared ? light_above(t, surface.normal, i) * (double)p.value[group] : (double)p.looked_at[i];
            assert_true(whole == 0 || fabs(sum / (double)p.weight[group] - 1) < 1e-5);
            for (uint32_t i = first; i < first + TILE_GROUP && whole > 1 << 12; i++) {
                double part =
                    is_shared ? light_above(t, surface.normal, i) * (double)p.value[group] : (double)p.looked_at[i];
                assert_true(fabs((double)p.weights[i] / whole - part / sum) < TILE_GROUP / (double)whole + 1e-5);
            }
            shared += whole > 0 && is_shared;
            looked_at += whole > 0 && !is_shared;
        }
        for (uint32_t i = 0; i < t->count; i++)
            for (int c = 0; c < 3; c++)
                hue[c] += (double)(p.looked_at[i] / p.brightness) * (double)t->colours.hue[c][i] *
                          (p.sums[i / TILE_GROUP + 1] > p.sums[i / TILE_GROUP]);
        for (int c = 0; c < 3 && p.total > 0; c++)
            assert_true(fabs(hue[c] - (double)p.hue[c]) < 1e-5 * fabs(hue[c]) + 1e-6);
    }
    assert_true(shared > 100 && looked_at > 100);
    destroy_world(&w);
    free(map);
}

static helio_pools *make_pools(const world *w, helio_strategy strategy)
{
    helio_pools *pools;
    assert_ok(helio_pools_create(w->tables, &(helio_pools_desc){.strategy = strategy}, &pools));
    assert_ok(helio_pools_draw(pools, 3, 1));
    return pools;
}

/* Groups whose tiles are wholly above both horizons are those of which the diffuse light is known: what is known is its
 * integral, and samples are left the lobe that shines. */
static void diffuse_light_of_groups_above_both_horizons_is_known(void **state)
{
    (void)state;
    enum { R = 64 };
    static point_tiles p, other;
    float *map = make_sky(R, 5);
    world w = make_world(map, R, 2, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    const tiles *t = w.pools->bins->tiles;
    uint64_t seed = 8;
    uint32_t known = 0;
    for (int m = 0; m < SHINY * TRIED; m++) {
        brdf surface = some_surface(&shiny[m % SHINY], &seed);
        tile_lobe lobe;
        tile_lobe_prepare(&lobe, t, &surface);
        lobe.geometric_normal = normalize(add_scaled(surface.normal, some_direction(&seed), 0.3f));
        weigh_all(ISA_SCALAR, t, &lobe, &other);
        for (uint32_t group = 0; group < TILE_GROUPS; group++)
            assert_true(other.knows_diffuse[group] == 0.0f);
        lobe.knows_diffuse = true;
        weigh_all(ISA_SCALAR, t, &lobe, &p);
        double irradiance[3] = {0};
        for (uint32_t i = 0; i < t->count; i++) {
            if (p.knows_diffuse[i / TILE_GROUP] == 0.0f)
                continue;
            const vec3 centre = {t->x[i], t->y[i], t->z[i]};
            assert_true(dot(surface.normal, centre) > t->edge && dot(lobe.geometric_normal, centre) > t->edge);
            for (int c = 0; c < 3; c++)
                irradiance[c] += (double)t->colours.light[0][c][i] * (double)surface.normal.x +
                                 (double)t->colours.light[1][c][i] * (double)surface.normal.y +
                                 (double)t->colours.light[2][c][i] * (double)surface.normal.z;
            known++;
        }
        for (int c = 0; c < 3; c++)
            assert_true(fabs(irradiance[c] - (double)p.irradiance[c]) <= 1e-5 * irradiance[c]);
        assert_true(p.brightness <= other.brightness * 1.0001f);
    }
    assert_true(known > 1000);
    destroy_world(&w);
    free(map);
}

/* Where nothing shines and no light is near the horizon, nothing is left to chance. */
static void what_is_known_is_not_sampled(void **state)
{
    (void)state;
    enum { R = 64 };
    float *map = make_map(R);
    for (size_t i = 0; i < (size_t)R * R; i++)
        map[((size_t)2 * R * R + i) * 3] = map[((size_t)2 * R * R + i) * 3 + 1] = 1.0f + (float)(i % 7); /* up */
    world w = make_world(map, R, 8, 256, HELIO_WEIGHTING_SOLID_ANGLE);
    helio_pools *pools = make_pools(&w, HELIO_STRATEGY_PRODUCT_BRDF);
    helio_shading_point point = {
        .material = {.kind = HELIO_MATERIAL_PHONG,
                     .diffuse = {0.5f, 0.5f, 0.5f},
                     .specular = {1e-4f, 1e-4f, 1e-4f},
                     .exponent = 20},
        .normal = {0, 1, 0},
        .view = {0, 1, 0},
    };
    float least = FLT_MAX, most = 0;
    for (uint32_t i = 0; i < 100; i++) {
        float radiance[3];
        point.seed = i;
        assert_ok(helio_estimate(pools, &point, NULL, radiance, NULL));
        least = fminf(least, radiance[0]);
        most = fmaxf(most, radiance[0]);
    }
    assert_true(least > 0.1f && most < least * 1.001f);
    helio_pools_destroy(pools);
    destroy_world(&w);
    free(map);
}

/* ---- the strategy that chooses itself ---- */

static bool estimates_agree(const helio_pools *a, const helio_pools *b)
{
    uint64_t seed = 31;
    bool agree = true;
    for (uint32_t i = 0; i < 3 * TRIED; i++) {
        helio_shading_point point = {.material = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.8f, 0.8f}},
                                     .seed = i};
        if (i % 3 > 0)
            point.material = shiny[i % 3];
        vec3 normal = some_direction(&seed);
        vec3_to(normal, point.normal);
        vec3_to(brdf_lift_view(normal, some_direction(&seed)), point.view);
        float x[3], y[3];
        assert_ok(helio_estimate(a, &point, NULL, x, NULL));
        assert_ok(helio_estimate(b, &point, NULL, y, NULL));
        agree &= memcmp(x, y, sizeof x) == 0;
    }
    return agree;
}

/* Constant, a gradient, two halves, a little noise; then much noise, a lamp, a dark face with a small light, and halves
 * that differ so much that the border between them is enough, though no tile holds anything uneven. */
static float light_of(int kind, vec3 direction, size_t texel, uint64_t *seed)
{
    switch (kind) {
    case 0: return 1.0f;
    case 1: return 1.0f + 0.9f * direction.y;
    case 2: return direction.y > 0 ? 1.0f : 0.5f;
    case 3: return 1.0f + 0.1f * (float)random_unit(seed);
    case 4: return (float)random_unit(seed);
    case 5: return texel == 777 ? 100.0f : 1.0f;
    case 6: return direction.x > 0 ? 1.0f : 0.1f;
    default: return direction.y < -0.9f ? (texel % 97 == 0 ? 0.1f : 1e-3f) : 1.0f;
    }
}

/* The paper's weights do not tell the light of tiles, so that all texels are looked at. */
static void check_auto(int kind, float brightness, helio_weighting weighting, bool is_even)
{
    enum { SIZE = 64 };
    float *map = make_map(SIZE);
    uint64_t seed = 5;
    for (size_t i = 0; i < 6 * SIZE * SIZE; i++) {
        float u = ((float)(i % SIZE) + 0.5f) * 2 / SIZE - 1, v = ((float)(i / SIZE % SIZE) + 0.5f) * 2 / SIZE - 1;
        float light = light_of(kind, cube_direction((uint32_t)(i / SIZE / SIZE), u, v), i, &seed);
        for (int c = 0; c < 3; c++)
            map[3 * i + (size_t)c] = brightness * light;
    }
    world w = make_world(map, SIZE, 8, 256, weighting);
    helio_pools *chosen = make_pools(&w, HELIO_STRATEGY_AUTO);
    helio_pools *brdfs = make_pools(&w, HELIO_STRATEGY_BRDF);
    helio_pools *product = make_pools(&w, HELIO_STRATEGY_PRODUCT_BRDF);
    assert_int_equal(estimates_agree(chosen, brdfs), is_even);
    assert_int_equal(estimates_agree(chosen, product), !is_even);
    helio_pools_destroy(product);
    helio_pools_destroy(brdfs);
    helio_pools_destroy(chosen);
    destroy_world(&w);
    free(map);
}

static void auto_aims_only_where_that_pays(void **state)
{
    (void)state;
    enum { KINDS = 8, EVEN = 4 };
    for (int kind = 0; kind < KINDS; kind++) {
        check_auto(kind, 1.0f, HELIO_WEIGHTING_SOLID_ANGLE, kind < EVEN);
        check_auto(kind, 1e-15f, HELIO_WEIGHTING_SOLID_ANGLE, kind < EVEN);
        check_auto(kind, 1e15f, HELIO_WEIGHTING_SOLID_ANGLE, kind < EVEN);
        check_auto(kind, 1.0f, HELIO_WEIGHTING_PAPER, kind < EVEN);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_divide_each_face_and_follow_a_curve),
        cmocka_unit_test(lines_of_texels_are_in_their_tiles),
        cmocka_unit_test(the_light_of_tiles_is_that_of_their_texels),
        cmocka_unit_test(densities_integrate_to_one),
        cmocka_unit_test(densities_are_positive_for_every_normal_that_may_choose_the_bin),
        cmocka_unit_test(pools_follow_their_densities),
        cmocka_unit_test(single_places_of_pools_follow_their_densities),
        cmocka_unit_test(windows_are_spread_over_faces),
        cmocka_unit_test(samples_carry_the_density_of_their_direction),
        cmocka_unit_test(no_edge_of_a_bin_shows),
        cmocka_unit_test(bins_are_cells_around_their_centres),
        cmocka_unit_test(black_maps_have_no_density_and_one_texel_has_it_all),
        cmocka_unit_test(bins_follow_the_frame),
        cmocka_unit_test(groups_hold_the_light_of_their_tiles),
        cmocka_unit_test(the_light_of_one_tile_is_its_groups),
        cmocka_unit_test(points_weigh_every_tile_that_can_light_them),
        cmocka_unit_test(groups_know_what_their_tiles_weigh),
        cmocka_unit_test(diffuse_light_of_groups_above_both_horizons_is_known),
        cmocka_unit_test(what_is_known_is_not_sampled),
        cmocka_unit_test(auto_aims_only_where_that_pays),
    };
    return cmocka_run_group_tests_name("product", tests, NULL, NULL);
}
