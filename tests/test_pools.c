/* SPDX-License-Identifier: MIT
 * Pools: samples that follow the map of their frame, stratified; and how strategies divide samples among techniques. */
#include "support.h"

#include "core/random.h"
#include "core/vector.h"
#include "env/cube.h"
#include "sampling/kernels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 8, TEXELS = SIZE * SIZE, FLOATS = CUBE_FACES * TEXELS * 3 };

static const double LEAST_P = 1e-9;

/* ---- maps ------------------------------------------------------------------------------------ */

typedef struct texel_place {
    uint32_t face, row, column;
} texel_place;

static texel_place place_of(size_t index)
{
    return (texel_place){(uint32_t)(index / TEXELS), (uint32_t)(index / SIZE % SIZE), (uint32_t)(index % SIZE)};
}

static void fill_noise(float *map, uint64_t seed)
{
    for (size_t i = 0; i < FLOATS; i++)
        map[i] = random_bits(&seed) % 4 == 0 ? 0.0f : (float)random_unit(&seed);
}

static void fill_smooth(float *map)
{
    for (size_t i = 0; i < FLOATS / 3; i++) {
        texel_place at = place_of(i);
        map[i * 3] = map[i * 3 + 1] = map[i * 3 + 2] = 1.3f + sinf(0.3f * (float)at.row + 0.2f * (float)at.column);
    }
}

/* A sky with a sun that is somewhere else each frame. */
static void fill_sun(float *map, uint32_t frame)
{
    for (size_t i = 0; i < FLOATS; i++)
        map[i] = 0.5f;
    for (size_t c = 0; c < 3; c++)
        map[(frame * 37 + 11) % (FLOATS / 3) * 3 + c] = 300.0f;
}

static void blacken_face(float *map, size_t face)
{
    memset(map + face * TEXELS * 3, 0, TEXELS * 3 * sizeof *map);
}

typedef struct fixture {
    helio_context *context;
    helio_environment *environment;
    helio_tables *tables;
    helio_pools *pools;
} fixture;

/* Pools over a map (a strip as large as the cube), not yet drawn. Takes the context. */
static fixture make_fixture_in(helio_context *context, const float *map, helio_strategy strategy, uint32_t length)
{
    fixture f = {.context = context};
    f.environment = make_environment(context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    assert_ok(helio_tables_create(f.environment, HELIO_WEIGHTING_SOLID_ANGLE, &f.tables));
    assert_ok(helio_tables_update(f.tables));
    assert_ok(helio_pools_create(f.tables, &(helio_pools_desc){.strategy = strategy, .length = length}, &f.pools));
    return f;
}

static fixture make_fixture(const float *map, helio_strategy strategy, uint32_t length)
{
    return make_fixture_in(make_context(1, NULL), map, strategy, length);
}

static void destroy_fixture(fixture *f)
{
    helio_pools_destroy(f->pools);
    helio_tables_destroy(f->tables);
    helio_environment_destroy(f->environment);
    helio_context_destroy(f->context);
}

static size_t sample_count(const helio_pools *pools)
{
    return (size_t)pools->count * pools->pool_length;
}

static vec3 pooled_direction(const helio_pools *pools, size_t i)
{
    return (vec3){pools_array(pools, 0, SAMPLE_X)[i], pools_array(pools, 0, SAMPLE_Y)[i],
                  pools_array(pools, 0, SAMPLE_Z)[i]};
}

/* ---- what pools hold ---------------------------------------------------------------------------- */

static void assert_sample(const helio_pools *pools, size_t i, const helio_table_sample *sample)
{
    assert_true(pools_array(pools, 0, SAMPLE_X)[i] == sample->direction[0] &&
                pools_array(pools, 0, SAMPLE_Y)[i] == sample->direction[1] &&
                pools_array(pools, 0, SAMPLE_Z)[i] == sample->direction[2]);
    assert_true(pools_array(pools, 0, SAMPLE_RED)[i] == sample->radiance[0] &&
                pools_array(pools, 0, SAMPLE_GREEN)[i] == sample->radiance[1] &&
                pools_array(pools, 0, SAMPLE_BLUE)[i] == sample->radiance[2]);
    assert_true(pools_array(pools, 0, SAMPLE_DENSITY)[i] == sample->density);
}

static void pools_hold_what_tables_give_at_scrambled_sobol_points(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 1);
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT};
    for (int k = 0; k < 2; k++) {
        fixture f = make_fixture(map, strategies[k], 512);
        assert_int_equal(f.pools->count, k ? 1 : 6);
        assert_int_equal(f.pools->pool_length, k ? 6 * 512 : 512);
        assert_ok(helio_pools_draw(f.pools, 7, 3));
        for (size_t i = 0; i < sample_count(f.pools); i++) {
            uint32_t pool = (uint32_t)i / f.pools->pool_length, index = (uint32_t)i % f.pools->pool_length;
            uint32_t seed = hash_combine(hash_combine(7, 3), pool);
            uint32_t x = scrambled_sobol(index, 0, seed), y = scrambled_sobol(index, 1, seed);
            helio_table_sample sample;
            assert_true(k ? tables_sample_whole(f.tables, x, y, &sample)
                          : tables_sample(f.tables, pool, x, y, &sample));
            assert_sample(f.pools, i, &sample);
        }
        destroy_fixture(&f);
    }
}

static void loop_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    while (count-- > 0)
        body(data, count);
}

static size_t bytes(const helio_pools *pools)
{
    return pools->stride * POOL_ARRAYS * sizeof(float);
}

static void equal_seeds_give_equal_bits_on_any_threads(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 2);
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_LIGHT_BRDF,
                                                HELIO_STRATEGY_PRODUCT};
    for (int k = 0; k < 3; k++) {
        fixture one = make_fixture_in(make_context(1, NULL), map, strategies[k], 2048);
        assert_ok(helio_pools_draw(one.pools, 1, 2));
        for (uint32_t threads = 0; threads < 6; threads++) {
            helio_context *context;
            const helio_context_desc desc = {.threads = threads, .parallel_for = threads ? NULL : loop_backwards};
            assert_ok(helio_context_create(&desc, &context));
            fixture other = make_fixture_in(context, map, strategies[k], 2048);
            assert_ok(helio_pools_draw(other.pools, 9, 9));
            assert_ok(helio_pools_draw(other.pools, 1, 2));
            assert_memory_equal(one.pools->samples, other.pools->samples, bytes(one.pools));
            destroy_fixture(&other);
        }
        destroy_fixture(&one);
    }
}

static void other_seeds_and_passes_give_other_points(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 3);
    static const uint32_t seeds[][2] = {{0, 0}, {0, 1}, {1, 0},          {1, 1},
                                        {2, 0}, {0, 2}, {UINT32_MAX, 0}, {0, UINT32_MAX}};
    enum { SEEDS = sizeof seeds / sizeof seeds[0] };
    fixture f[SEEDS];
    for (int i = 0; i < SEEDS; i++) {
        f[i] = make_fixture(map, HELIO_STRATEGY_FACE, 256);
        assert_ok(helio_pools_draw(f[i].pools, seeds[i][0], seeds[i][1]));
    }
    size_t samples = sample_count(f[0].pools);
    for (int i = 0; i < SEEDS; i++)
        for (int j = 0; j < i; j++) {
            size_t same = 0;
            for (size_t k = 0; k < samples; k++)
                same += pools_array(f[i].pools, 0, SAMPLE_X)[k] == pools_array(f[j].pools, 0, SAMPLE_X)[k] &&
                        pools_array(f[i].pools, 0, SAMPLE_Y)[k] == pools_array(f[j].pools, 0, SAMPLE_Y)[k];
            assert_true(same <= 2);
        }
    /* Pools of one draw use points of their own, too. */
    size_t same = 0;
    for (size_t k = 0; k < 256; k++)
        same += pools_array(f[0].pools, 0, SAMPLE_DENSITY)[k] == pools_array(f[0].pools, 0, SAMPLE_DENSITY)[256 + k];
    assert_true(same < 128);
    for (int i = 0; i < SEEDS; i++)
        destroy_fixture(&f[i]);
}

/* ---- chi-square over texels ------------------------------------------------------------------------ */

/* The texel that a pooled direction leads to, CUBE_FACES * TEXELS in all. */
static size_t texel_of(vec3 direction)
{
    cube_position at = cube_project(direction);
    return (at.face * SIZE + cube_texel(at.v, SIZE)) * SIZE + cube_texel(at.u, SIZE);
}

static double texel_weight(const float *map, size_t index)
{
    texel_place at = place_of(index);
    double step = 2.0 / SIZE, u = at.column * step - 1, v = at.row * step - 1;
    const float *rgb = map + index * 3;
    return (0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2]) *
           cube_solid_angle(u, u + step, v, v + step);
}

/* Adds the pools' samples to texels [6][R][R]; says how many do not carry the radiance of the texel they lead to. */
static size_t count_texels(const helio_pools *pools, const float *map, double *drawn)
{
    size_t wrong = 0;
    for (size_t i = 0; i < sample_count(pools); i++) {
        size_t texel = texel_of(pooled_direction(pools, i));
        const float *rgb = map + texel * 3;
        wrong += pools_array(pools, 0, SAMPLE_RED)[i] != rgb[0] || pools_array(pools, 0, SAMPLE_GREEN)[i] != rgb[1] ||
                 pools_array(pools, 0, SAMPLE_BLUE)[i] != rgb[2];
        drawn[texel]++;
    }
    return wrong;
}

/* What count_texels() should have counted: each face of its own, or all faces by their weight. */
static void expect_texels(const helio_pools *pools, const float *map, double draws, double *expected)
{
    double sums[CUBE_FACES] = {0}, total = 0;
    for (size_t i = 0; i < CUBE_FACES * TEXELS; i++) {
        sums[i / TEXELS] += texel_weight(map, i);
        total += texel_weight(map, i);
    }
    for (size_t i = 0; i < CUBE_FACES * TEXELS; i++)
        expected[i] = draws * texel_weight(map, i) *
                      (pools->parts.light == STRATEGY_LIGHT_FACES ? 1 / (CUBE_FACES * sums[i / TEXELS]) : 1 / total);
}

static void check_follows(const fixture *f, const float *map, uint32_t passes)
{
    static double drawn[CUBE_FACES * TEXELS], expected[CUBE_FACES * TEXELS];
    double draws = (double)sample_count(f->pools) * passes;
    size_t wrong = 0;
    memset(drawn, 0, sizeof drawn);
    for (uint32_t pass = 0; pass < passes; pass++) {
        assert_ok(helio_pools_draw(f->pools, 5, pass));
        wrong += count_texels(f->pools, map, drawn);
    }
    expect_texels(f->pools, map, draws, expected);
    /* Faces of a FACE pool are fixed in number: five more degrees of freedom are lost. Samples within rounding of a
     * texel's border may lead to its neighbour. */
    size_t lost = f->pools->parts.light == STRATEGY_LIGHT_FACES ? CUBE_FACES : 1;
    assert_true((double)wrong <= 1e-3 * draws);
    for (size_t i = 0; i < CUBE_FACES * TEXELS; i++)
        expected[i] += 1e-3;
    double p = chi_square_tail(drawn, expected, CUBE_FACES * TEXELS, lost);
    if (!(p > LEAST_P))
        fail_msg("%s: pools do not follow the map, p = %g", helio_strategy_name(f->pools->strategy), p);
}

static void pools_follow_the_map(void **state)
{
    (void)state;
    float map[FLOATS];
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT};
    for (uint32_t k = 0; k < 6; k++) {
        if (k < 2)
            fill_noise(map, 4);
        else if (k < 4)
            fill_smooth(map);
        else
            fill_sun(map, k);
        fixture f = make_fixture(map, strategies[k % 2], 1024);
        check_follows(&f, map, 10);
        destroy_fixture(&f);
    }
}

static void pools_follow_a_changing_sequence_without_lag(void **state)
{
    (void)state;
    float map[FLOATS];
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT};
    for (int k = 0; k < 2; k++) {
        fill_noise(map, 5);
        fixture f = make_fixture(map, strategies[k], 512);
        for (uint32_t frame = 2; frame < 12; frame++) {
            if (frame % 3 == 0)
                fill_noise(map, frame);
            else
                fill_sun(map, frame);
            assert_ok(helio_environment_update(f.environment, map, NULL));
            assert_ok(helio_tables_update(f.tables));
            check_follows(&f, map, 2);
            assert_true(f.pools->frame == frame);
        }
        destroy_fixture(&f);
    }
}

/* ---- stratification ----------------------------------------------------------------------------------- */

/* Turns a direction back into the point that it was drawn at, by the exact weights of the face. */
static void point_of(const float *map, uint32_t face, vec3 direction, double point[2])
{
    cube_position at = cube_project(direction);
    double y = ((double)at.v + 1) / 2 * SIZE, x = ((double)at.u + 1) / 2 * SIZE, rows[SIZE] = {0}, total = 0, sum = 0;
    uint32_t row = cube_texel(at.v, SIZE), column = cube_texel(at.u, SIZE);
    for (size_t i = 0; i < TEXELS; i++) {
        double weight = texel_weight(map, face * TEXELS + i);
        rows[i / SIZE] += weight;
        total += weight;
        if (i / SIZE == row && i % SIZE < column)
            sum += weight;
    }
    point[0] = (sum + (x - column) * texel_weight(map, (face * SIZE + row) * SIZE + column)) / rows[row];
    sum = 0;
    for (size_t i = 0; i < row; i++)
        sum += rows[i];
    point[1] = (sum + (y - row) * rows[row]) / total;
}

/* In each aligned window of 64 samples, every 64th of the rows' CDF and every cell of 8 x 8 is hit once. */
static void aligned_windows_hit_every_stratum_once(void **state)
{
    (void)state;
    enum { WINDOW = 64, LENGTH = 1024 };
    float map[FLOATS];
    fill_smooth(map);
    fixture f = make_fixture(map, HELIO_STRATEGY_FACE, LENGTH);
    assert_ok(helio_pools_draw(f.pools, 1, 1));
    size_t missed = 0;
    for (uint32_t first = 0; first < CUBE_FACES * LENGTH; first += WINDOW) {
        bool rows[WINDOW] = {false}, cells[WINDOW] = {false};
        for (uint32_t i = first; i < first + WINDOW; i++) {
            double point[2];
            point_of(map, i / LENGTH, pooled_direction(f.pools, i), point);
            rows[(int)fmin(point[1] * WINDOW, WINDOW - 1)] = true;
            cells[(int)fmin(point[1] * 8, 7) * 8 + (int)fmin(point[0] * 8, 7)] = true;
        }
        for (int i = 0; i < WINDOW; i++)
            missed += (size_t)!rows[i] + (size_t)!cells[i];
    }
    /* Points next to a border of a stratum may be rounded over it. */
    assert_true(missed <= 10);
    destroy_fixture(&f);
}

/* An estimate of a smooth integral over one face by 64 samples. */
static double integrand(vec3 d, float radiance, float density)
{
    return (1 + 0.5 * (double)d.x + 0.3 * (double)d.y) * (2 + sin(3 * (double)d.z)) * (double)radiance /
           (double)density / 64;
}

static double variance(const double *values, size_t count)
{
    double mean = 0, sum = 0;
    for (size_t i = 0; i < count; i++)
        mean += values[i] / (double)count;
    for (size_t i = 0; i < count; i++)
        sum += (values[i] - mean) * (values[i] - mean) / (double)(count - 1);
    return sum;
}

static void windows_estimate_better_than_independent_samples(void **state)
{
    (void)state;
    enum { PASSES = 40, WINDOWS = 16, TRIALS = PASSES * WINDOWS };
    static double pooled[TRIALS], independent[TRIALS];
    float map[FLOATS];
    uint64_t random = 6;
    fill_smooth(map);
    fixture f = make_fixture(map, HELIO_STRATEGY_FACE, 1024);
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        if (trial % WINDOWS == 0)
            assert_ok(helio_pools_draw(f.pools, 3, trial / WINDOWS));
        pooled[trial] = independent[trial] = 0;
        for (uint32_t i = 0; i < 64; i++) {
            size_t k = (size_t)4 * 1024 + trial % WINDOWS * 64 + i;
            pooled[trial] += integrand(pooled_direction(f.pools, k), pools_array(f.pools, 0, SAMPLE_RED)[k],
                                       pools_array(f.pools, 0, SAMPLE_DENSITY)[k]);
            helio_table_sample sample;
            uint32_t x = random_bits(&random);
            assert_true(tables_sample(f.tables, 4, x, random_bits(&random), &sample));
            independent[trial] += integrand(vec3_from(sample.direction), sample.radiance[0], sample.density);
        }
    }
    assert_true(variance(pooled, TRIALS) * 10 < variance(independent, TRIALS));
    destroy_fixture(&f);
}

static void check_windows(uint32_t length, uint32_t pool_length)
{
    helio_pools pools = {.length = length, .pool_length = pool_length};
    for (uint32_t wanted = 1; wanted <= length / POOL_SHARE; wanted += 1 + wanted / 3) {
        uint32_t width = 1;
        while (width < wanted)
            width *= 2;
        uint32_t windows = pool_length / width, reached = 0, last = UINT32_MAX;
        for (uint32_t i = 0; i < 2 * windows; i++) {
            uint32_t first = pools_window(pools.pool_length, wanted, (uint32_t)(((uint64_t)i << 32) / (2 * windows)));
            assert_int_equal(first % width, 0);
            assert_true(first + wanted <= pool_length);
            reached += first != last;
            last = first;
        }
        assert_int_equal(reached, windows);
        assert_int_equal(pools_window(pools.pool_length, wanted, 0), 0);
        assert_int_equal(pools_window(pools.pool_length, wanted, UINT32_MAX), pool_length - width);
    }
}

static void windows_are_aligned_and_all_are_reached(void **state)
{
    (void)state;
    for (uint32_t length = 64; length <= 65536; length *= 4) {
        check_windows(length, length);
        check_windows(length, 6 * length);
    }
}

/* ---- black, stale, mistaken ------------------------------------------------------------------------------ */

static void black_faces_leave_their_pools_without_density(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_smooth(map);
    blacken_face(map, 3);
    fixture f = make_fixture(map, HELIO_STRATEGY_FACE, 64);
    assert_ok(helio_pools_draw(f.pools, 0, 0));
    for (size_t i = 0; i < sample_count(f.pools); i++)
        assert_int_equal(pools_array(f.pools, 0, SAMPLE_DENSITY)[i] > 0, i / 64 != 3);
    destroy_fixture(&f);

    memset(map, 0, sizeof map);
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT};
    for (int k = 0; k < 2; k++) {
        f = make_fixture(map, strategies[k], 64);
        assert_ok(helio_pools_draw(f.pools, 0, 0));
        for (size_t i = 0; i < sample_count(f.pools); i++)
            assert_true(pools_array(f.pools, 0, SAMPLE_DENSITY)[i] == 0 && pools_array(f.pools, 0, SAMPLE_RED)[i] == 0);
        destroy_fixture(&f);
    }
}

static void assert_refused(helio_status status)
{
    assert_int_equal(status, HELIO_ERR_ARGUMENT);
    assert_true(strlen(helio_last_error()) > 20);
}

static void stale_tables_are_refused(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 7);
    static const helio_strategy strategies[] = {HELIO_STRATEGY_FACE, HELIO_STRATEGY_LIGHT, HELIO_STRATEGY_COSINE,
                                                HELIO_STRATEGY_PRODUCT};
    for (int k = 0; k < 4; k++) {
        fixture f = make_fixture(map, strategies[k], 64);
        helio_tables *fresh;
        helio_pools *early;
        assert_ok(helio_tables_create(f.environment, HELIO_WEIGHTING_SOLID_ANGLE, &fresh));
        assert_ok(helio_pools_create(fresh, &(helio_pools_desc){.strategy = strategies[k]}, &early));
        assert_refused(helio_pools_draw(early, 0, 0)); /* no tables yet */
        helio_pools_destroy(early);
        helio_tables_destroy(fresh);
        assert_ok(helio_pools_draw(f.pools, 0, 0));
        assert_ok(helio_environment_update(f.environment, map, NULL));
        assert_refused(helio_pools_draw(f.pools, 0, 0));
        assert_non_null(strstr(helio_last_error(), "helio_tables_update"));
        assert_true(f.pools->frame == 1);
        assert_ok(helio_tables_update(f.tables));
        assert_ok(helio_pools_draw(f.pools, 0, 0));
        assert_true(f.pools->frame == 2);
        destroy_fixture(&f);
    }
}

static void lengths_are_powers_of_two_and_a_point_takes_an_eighth(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 8);
    fixture f = make_fixture(map, HELIO_STRATEGY_FACE_BRDF, 0);
    assert_int_equal(helio_pools_sample_limit(f.pools), 128);
    static const uint32_t good[] = {64, 128, 1024, 65536}, bad[] = {1, 8, 32, 63, 65, 100, 65535, 131072, UINT32_MAX};
    helio_pools *pools;
    for (int i = 0; i < 4; i++) {
        assert_ok(helio_pools_create(f.tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_FACE, .length = good[i]},
                                     &pools));
        assert_int_equal(helio_pools_sample_limit(pools), good[i] / 8);
        helio_pools_destroy(pools);
    }
    for (int i = 0; i < 9; i++) {
        pools = f.pools;
        assert_refused(helio_pools_create(f.tables, &(helio_pools_desc){.length = bad[i]}, &pools));
        assert_null(pools);
        char number[16];
        snprintf(number, sizeof number, "%u", bad[i]);
        assert_non_null(strstr(helio_last_error(), number));
    }
    assert_ok(helio_pools_create(f.tables, NULL, &pools));
    assert_int_equal(pools->strategy, HELIO_STRATEGY_PRODUCT_BRDF);
    helio_pools_destroy(pools);
    assert_ok(helio_pools_create(f.tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_PRODUCT}, &pools));
    assert_int_equal(helio_pools_sample_limit(pools), 64);
    helio_pools_destroy(pools);
    const helio_pools_desc too_fine = {.strategy = HELIO_STRATEGY_PRODUCT, .bins = 33};
    assert_refused(helio_pools_create(f.tables, &too_fine, &pools));
    assert_non_null(strstr(helio_last_error(), "33"));
    assert_refused(helio_pools_create(f.tables, &(helio_pools_desc){.strategy = (helio_strategy)9}, &pools));
    assert_refused(helio_pools_create(f.tables, &(helio_pools_desc){.strategy = (helio_strategy)-1}, &pools));
    assert_refused(helio_pools_create(NULL, NULL, &pools));
    assert_refused(helio_pools_create(f.tables, NULL, NULL));
    assert_refused(helio_pools_draw(NULL, 0, 0));
    helio_pools_destroy(NULL);
    destroy_fixture(&f);
}

/* ---- memory --------------------------------------------------------------------------------------------- */

static void drawing_takes_no_memory(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 9);
    for (helio_strategy strategy = HELIO_STRATEGY_AUTO; strategy <= HELIO_STRATEGY_PRODUCT_BRDF; strategy++) {
        memory_count count = {0};
        fixture f = make_fixture_in(make_context(2, &count), map, strategy, 64);
        size_t taken = count.taken;
        for (uint32_t pass = 0; pass < 3; pass++)
            assert_ok(helio_pools_draw(f.pools, 0, pass));
        assert_int_equal(count.taken, taken);
        destroy_fixture(&f);
        assert_int_equal(count.live, 0);
        assert_false(count.misaligned);
    }
}

static void creation_without_memory_fails_and_leaks_nothing(void **state)
{
    (void)state;
    float map[FLOATS];
    fill_noise(map, 10);
    memory_count count = {0};
    fixture f = make_fixture_in(make_context(1, &count), map, HELIO_STRATEGY_FACE, 64);
    size_t live = count.live;
    for (size_t granted = 0; granted < 2; granted++) {
        helio_pools *pools = f.pools;
        count.refuse_after = count.taken + granted;
        assert_int_equal(helio_pools_create(f.tables, NULL, &pools), HELIO_ERR_MEMORY);
        assert_null(pools);
        assert_int_equal(count.live, live);
    }
    destroy_fixture(&f);
}

/* ---- strategies ------------------------------------------------------------------------------------------- */

static void strategies_have_names(void **state)
{
    (void)state;
    static const char *const names[] = {"auto", "cosine",    "brdf",    "light",       "light+brdf",
                                        "face", "face+brdf", "product", "product+brdf"};
    for (int i = 0; i < 9; i++) {
        helio_strategy strategy = (helio_strategy)99;
        assert_string_equal(helio_strategy_name((helio_strategy)i), names[i]);
        assert_ok(helio_strategy_parse(names[i], &strategy));
        assert_int_equal(strategy, i);
        assert_int_equal(helio_strategy_resolve(strategy), i == 0 ? HELIO_STRATEGY_PRODUCT_BRDF : i);
    }
    static const char *const wrong[] = {"", "Face", "face+", "brdf+face", "products", NULL};
    for (int i = 0; i < 6; i++) {
        helio_strategy kept = HELIO_STRATEGY_LIGHT;
        assert_refused(helio_strategy_parse(wrong[i], &kept));
        assert_int_equal(kept, HELIO_STRATEGY_LIGHT);
    }
    assert_refused(helio_strategy_parse("face", NULL));
    assert_non_null(helio_strategy_name((helio_strategy)9));
    assert_non_null(helio_strategy_name((helio_strategy)-1));
}

/* ---- beta ---------------------------------------------------------------------------------------------------- */

static vec3 random_normal(uint64_t *state)
{
    double z = 2 * random_unit(state) - 1, azimuth = 2 * PI * random_unit(state), sine = sqrt(1 - z * z);
    return (vec3){(float)(sine * cos(azimuth)), (float)(sine * sin(azimuth)), (float)z};
}

/* A normal along an axis, a diagonal, in a coordinate plane, or any. */
static vec3 trying_normal(uint64_t *state)
{
    vec3 n = random_normal(state);
    float *c[3] = {&n.x, &n.y, &n.z};
    uint32_t kind = random_bits(state) % 4;
    for (int i = 0; i < 3 && kind < 2; i++)
        if (random_bits(state) % 2)
            *c[i] = kind == 0 ? 0.0f : 1.0f;
    return length(n) > 0.0f ? normalize(n) : (vec3){0, -1, 0};
}

static double greatest_corner_cosine(uint32_t face, vec3 normal)
{
    double greatest = -2;
    for (int i = 0; i < 4; i++)
        greatest = fmax(greatest, (double)dot(normal, cube_direction(face, i & 1 ? 1 : -1, i & 2 ? 1 : -1)));
    return greatest;
}

static float beta_of(uint32_t face, vec3 normal)
{
    float betas[6];
    strategy_betas(normal, betas);
    return betas[face];
}

static void beta_is_zero_exactly_where_the_whole_face_is_below_the_horizon(void **state)
{
    (void)state;
    uint64_t random = 11;
    for (int i = 0; i < 200000; i++) {
        vec3 normal = trying_normal(&random);
        uint32_t face = random_bits(&random) % CUBE_FACES;
        double cosine = greatest_corner_cosine(face, normal);
        if (fabs(cosine) > 1e-6)
            assert_int_equal(beta_of(face, normal) > 0, cosine > 0);
    }
    for (uint32_t face = 0; face < CUBE_FACES; face++) { /* seen from straight above and from straight behind */
        assert_true(beta_of(face, cube_faces[face].axis) == 1.0f);
        assert_true(beta_of(face, scale(cube_faces[face].axis, -1.0f)) == 0.0f);
    }
}

static void beta_bounds_the_cosine_anywhere_on_the_face(void **state)
{
    (void)state;
    uint64_t random = 12;
    for (int i = 0; i < 200000; i++) {
        vec3 normal = trying_normal(&random);
        uint32_t face = random_bits(&random) % CUBE_FACES;
        float u = (float)(2 * random_unit(&random) - 1), v = (float)(2 * random_unit(&random) - 1);
        assert_true(dot(normal, cube_direction(face, u, v)) <= beta_of(face, normal) + 1e-6f);
    }
}

static void beta_is_continuous(void **state)
{
    (void)state;
    uint64_t random = 13;
    for (int i = 0; i < 200000; i++) {
        vec3 a = trying_normal(&random), step = random_normal(&random);
        vec3 b = normalize(add_scaled(a, step, (float)pow(10, -5 * random_unit(&random))));
        uint32_t face = random_bits(&random) % CUBE_FACES;
        /* A corner is sqrt(3) away from the centre of the cube. */
        float apart = length(subtract(a, b));
        assert_true(fabsf(beta_of(face, a) - beta_of(face, b)) <= 1.7321f * apart + 1e-6f);
    }
}

/* ---- rounding ------------------------------------------------------------------------------------------------ */

/* Counts in proportion to weights, some of them zero, some tiny; as single precision makes them. */
static void random_expected(uint64_t *state, uint32_t samples, float expected[TECHNIQUES])
{
    float total = 0;
    for (int k = 0; k < TECHNIQUES; k++) {
        uint32_t kind = random_bits(state) % 4;
        expected[k] = kind == 0 ? 0.0f : (float)(random_unit(state) * (kind == 1 ? 1e-4 : 1));
        total += expected[k];
    }
    if (total == 0.0f)
        expected[2] = total = 1.0f;
    for (int k = 0; k < TECHNIQUES; k++)
        expected[k] *= (float)samples / total;
}

/* One point of a block; the lanes beside it must not matter. expected becomes what the counts stand for. */
static void round_counts(float expected[TECHNIQUES], uint32_t samples, float offset, uint32_t realised[TECHNIQUES])
{
    static point_block block;
    block.count = 1;
    block.rounding[0] = offset;
    for (int k = 0; k < TECHNIQUES; k++)
        block.expected[k][0] = expected[k];
    kernels_of(ISA_SCALAR)->round_counts(samples, &block);
    for (int k = 0; k < TECHNIQUES; k++) {
        realised[k] = block.realised[k][0];
        expected[k] = block.expected[k][0];
    }
}

static void realised_counts_sum_exactly_and_stay_next_to_the_expected(void **state)
{
    (void)state;
    uint64_t random = 14;
    for (int i = 0; i < 200000; i++) {
        uint32_t samples = i % 2 ? 1 + random_bits(&random) % 128 : 1 + random_bits(&random) % 8192;
        float given[TECHNIQUES], expected[TECHNIQUES], offset = (float)(random_bits(&random) >> 8) * 0x1p-24f;
        if (i % 8 == 0)
            offset = i % 16 ? 0.0f : 0x1.fffffep-1f;
        uint32_t realised[TECHNIQUES], sum = 0;
        random_expected(&random, samples, given);
        memcpy(expected, given, sizeof expected);
        round_counts(expected, samples, offset, realised);
        for (int k = 0; k < TECHNIQUES; k++) {
            sum += realised[k];
            if (expected[k] == 0.0f)
                assert_int_equal(realised[k], 0);
            if (given[k] == 0.0f)
                assert_true(expected[k] == 0.0f);
            assert_true(expected[k] >= 0.0f);
            assert_true(fabsf(expected[k] - given[k]) <= 1e-6f * (1.0f + (float)samples));
            assert_true(fabs((double)realised[k] - (double)expected[k]) < 1);
        }
        assert_int_equal(sum, samples);
    }
}

static void realised_counts_have_the_expected_mean(void **state)
{
    (void)state;
    enum { OFFSETS = 2048 };
    uint64_t random = 15;
    for (int i = 0; i < 300; i++) {
        uint32_t samples = i % 3 == 0 ? 8192 : 1 + random_bits(&random) % 256;
        float given[TECHNIQUES], expected[TECHNIQUES];
        double mean[TECHNIQUES] = {0};
        random_expected(&random, samples, given);
        for (int k = 0; k < OFFSETS; k++) {
            uint32_t realised[TECHNIQUES];
            memcpy(expected, given, sizeof expected);
            round_counts(expected, samples, ((float)k + 0.5f) / OFFSETS, realised);
            for (int t = 0; t < TECHNIQUES; t++)
                mean[t] += (double)realised[t] / OFFSETS;
        }
        for (int t = 0; t < TECHNIQUES; t++) /* the offsets are steps, and a count that is expected is a float */
            assert_true(fabs(mean[t] - (double)expected[t]) < 1.0 / OFFSETS + 1e-7 * samples);
    }
}

/* Over all offsets that there are. */
static void small_counts_have_the_expected_mean_exactly(void **state)
{
    const float given[TECHNIQUES] = {0x1.234p-20f, 0.0f, 1.3f, 0x1.8p-13f, 0.0f, 1.9f, 0x1.1p-18f};
    static point_block block;
    uint32_t sums[TECHNIQUES] = {0};
    (void)state;
    block.count = POINT_BLOCK;
    for (uint32_t first = 0; first < 1 << 24; first += POINT_BLOCK) {
        for (uint32_t i = 0; i < POINT_BLOCK; i++) {
            block.rounding[i] = (float)(first + i) * 0x1p-24f;
            for (int k = 0; k < TECHNIQUES; k++)
                block.expected[k][i] = given[k];
        }
        kernels_of(ISA_SCALAR)->round_counts(3, &block);
        for (uint32_t i = 0; i < POINT_BLOCK; i++)
            for (int k = 0; k < TECHNIQUES; k++)
                sums[k] += block.realised[k][i];
    }
    for (int k = 0; k < TECHNIQUES; k++)
        assert_true((double)sums[k] * 0x1p-24 == (double)block.expected[k][0]);
    assert_int_equal(sums[0], 9 << 1); /* in steps of 2^-23 the nearest, 9.1 of them */
}

static void no_light_means_no_samples(void **state)
{
    (void)state;
    float expected[TECHNIQUES] = {0};
    uint32_t realised[TECHNIQUES] = {1, 1, 1, 1, 1, 1, 1};
    round_counts(expected, 64, 0.999f, realised);
    for (int k = 0; k < TECHNIQUES; k++)
        assert_int_equal(realised[k], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pools_hold_what_tables_give_at_scrambled_sobol_points),
        cmocka_unit_test(equal_seeds_give_equal_bits_on_any_threads),
        cmocka_unit_test(other_seeds_and_passes_give_other_points),
        cmocka_unit_test(pools_follow_the_map),
        cmocka_unit_test(pools_follow_a_changing_sequence_without_lag),
        cmocka_unit_test(aligned_windows_hit_every_stratum_once),
        cmocka_unit_test(windows_estimate_better_than_independent_samples),
        cmocka_unit_test(windows_are_aligned_and_all_are_reached),
        cmocka_unit_test(black_faces_leave_their_pools_without_density),
        cmocka_unit_test(stale_tables_are_refused),
        cmocka_unit_test(lengths_are_powers_of_two_and_a_point_takes_an_eighth),
        cmocka_unit_test(drawing_takes_no_memory),
        cmocka_unit_test(creation_without_memory_fails_and_leaks_nothing),
        cmocka_unit_test(strategies_have_names),
        cmocka_unit_test(beta_is_zero_exactly_where_the_whole_face_is_below_the_horizon),
        cmocka_unit_test(beta_bounds_the_cosine_anywhere_on_the_face),
        cmocka_unit_test(beta_is_continuous),
        cmocka_unit_test(realised_counts_sum_exactly_and_stay_next_to_the_expected),
        cmocka_unit_test(realised_counts_have_the_expected_mean),
        cmocka_unit_test(small_counts_have_the_expected_mean_exactly),
        cmocka_unit_test(no_light_means_no_samples),
    };
    return cmocka_run_group_tests_name("pools", tests, NULL, NULL);
}
