/* SPDX-License-Identifier: MIT
 *
 * Cubes that a device makes of maps are those of the CPU, and so are the counts of pixels that are no light. */
#include "vulkan_support.h"

#include "env/environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounding: the CPU adds up to 64 products as floats and more of them in double, the device up to 32 as floats and
 * such sums as floats, or for large texels with what rounding loses carried along. The worst that was found is
 * 3.3e-7. */
static const double BOUND = 2e-6;

typedef struct map_case {
    helio_layout layout;
    uint32_t width, height, size; /* size: R */
} map_case;

/* A map in memory, with numbers in any format. */
typedef struct test_map {
    float *rgb;
    void *numbers;
    helio_pixels pixels;
} test_map;

static const helio_pools_desc by_face = {.strategy = HELIO_STRATEGY_FACE, .length = 64};

/* ---- maps ---- */

/* Halves of these are exact: 11 bits, exponents from -14 to 9. */
static float random_number(uint64_t *seed)
{
    const uint32_t bits = random_bits(seed);
    return bits % 5 == 0 ? 0.0f : ldexpf((float)(1024 + bits % 1024), (int)(bits / 1024 % 24) - 24);
}

static uint16_t to_half(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000, exponent = bits >> 23 & 255, mantissa = bits >> 13 & 0x3ff;
    if (exponent == 255)
        return (uint16_t)(sign | 0x7c00 | mantissa);
    if (exponent < 113) /* 0, or a subnormal half, made of a float's leading bits */
        return (uint16_t)(sign | (exponent < 103 ? 0 : (0x400 | mantissa) >> (113 - exponent)));
    return (uint16_t)(sign | (exponent - 112) << 10 | mantissa);
}

/* Any words are light: see HELIO_PIXELS_RGB9E5. */
static void make_words(test_map *map, uint32_t width, uint32_t height, bool from_below)
{
    const ptrdiff_t row = (ptrdiff_t)width + 3;
    uint64_t seed = height;
    uint32_t *words = malloc((size_t)row * height * sizeof *words);
    assert_non_null(words);
    for (size_t i = 0; i < (size_t)row * height; i++)
        words[i] = random_bits(&seed);
    map->numbers = words;
    map->pixels = (helio_pixels){.data = from_below ? words + (height - 1) * row : words,
                                 .format = HELIO_PIXELS_RGB9E5,
                                 .row_bytes = (from_below ? -row : row) * (ptrdiff_t)sizeof *words};
}

/* Numbers with some padding behind each row, from below if asked for. */
static void make_numbers(test_map *map, uint32_t width, uint32_t height, helio_pixel_format format, bool from_below)
{
    const bool half = format >= HELIO_PIXELS_RGB_HALF;
    const size_t channels = format % 2 == 0 ? 3 : 4, number = half ? 2 : 4;
    const size_t row_bytes = (width * channels + 5) * number;
    if (format == HELIO_PIXELS_RGB9E5) {
        make_words(map, width, height, from_below);
        return;
    }
    unsigned char *numbers = malloc(height * row_bytes);
    assert_non_null(numbers);
    memset(numbers, 0xff, height * row_bytes); /* padding and alpha are not numbers: nobody may look */
    for (size_t i = 0; i < (size_t)width * height * 3; i++) {
        const size_t row = from_below ? height - 1 - i / 3 / width : i / 3 / width;
        unsigned char *at = numbers + row * row_bytes + (i / 3 % width * channels + i % 3) * number;
        const uint16_t as_half = to_half(map->rgb[i]);
        memcpy(at, half ? (const void *)&as_half : &map->rgb[i], number);
    }
    map->numbers = numbers;
    map->pixels = (helio_pixels){.data = from_below ? numbers + (height - 1) * row_bytes : numbers,
                                 .format = format,
                                 .row_bytes = from_below ? -(ptrdiff_t)row_bytes : (ptrdiff_t)row_bytes};
}

static test_map make_map(uint32_t width, uint32_t height, uint64_t seed)
{
    test_map map = {.rgb = malloc((size_t)width * height * 3 * sizeof(float))};
    assert_non_null(map.rgb);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        map.rgb[i] = random_number(&seed);
    map.pixels.data = map.rgb;
    return map;
}

static void spoil_map(test_map *map, uint32_t width, uint32_t height, uint64_t seed)
{
    const float bad[] = {NAN, -NAN, INFINITY, -INFINITY, -1.0f, -0.0f, 1.5e30f, -2e30f, 1e30f, 0x1p-149f};
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        if (random_bits(&seed) % 20 == 0)
            map->rgb[i] = bad[random_bits(&seed) % (sizeof bad / sizeof *bad)];
}

static void destroy_map(test_map *map)
{
    free(map->numbers);
    free(map->rgb);
}

/* ---- both cubes ---- */

static void make_light(vulkan_world *w, const map_case *c)
{
    world_make_light(w, c->size, HELIO_WEIGHTING_SOLID_ANGLE, &by_face);
    assert_ok(helio_environment_reshape(w->environment, c->width, c->height, c->layout));
    assert_ok(light_take_maps(&w->light, w->environment));
}

/* The device's cube of the environment's frame; to be freed. */
static float *read_cube(vulkan_world *w)
{
    const uint32_t slot = 1 - w->light.slot;
    assert_ok(light_send(&w->light, slot));
    assert_ok(commands_begin(&w->commands));
    light_record_resampling(&w->light, &w->commands);
    assert_ok(commands_submit_between(&w->commands, light_sent(&w->light), VK_NULL_HANDLE));
    assert_ok(commands_wait(&w->commands));
    return read_buffer(&w->commands, &w->light.slots[slot].cube, light_cube_bytes(&w->light));
}

/* Sends the map, so that the CPU has not made its cube yet. */
static void update(vulkan_world *w, const helio_pixels *pixels)
{
    assert_ok(helio_environment_update_pixels(w->environment, pixels, NULL));
    assert_true(w->environment->is_late);
    assert_true(map_is_here(&w->light.map));
}

/* The largest relative difference of channels. */
static double compare_cubes(vulkan_world *w, const float *found)
{
    const float *expected = helio_environment_cube(w->environment);
    const size_t numbers = light_cube_bytes(&w->light) / sizeof *found;
    double worst = 0;
    assert_false(w->environment->is_late);
    for (size_t i = 0; i < numbers; i++) {
        const double a = (double)found[i], b = (double)expected[i];
        assert_true(a >= 0 && isfinite(a));
        /* Devices may take the smallest floats for 0. */
        worst = fmax(worst, fabs(a - b) <= 0x1p-120 ? 0 : fabs(a - b) / fmax(b, 0x1p-126));
    }
    return worst;
}

static double compare_case(vulkan_world *w, const map_case *c, uint64_t seed)
{
    double worst = 0;
    make_light(w, c);
    for (uint32_t i = 0; i <= HELIO_PIXELS_RGB9E5; i++) {
        test_map map = make_map(c->width, c->height, seed + i);
        make_numbers(&map, c->width, c->height, (helio_pixel_format)i, i % 2);
        update(w, &map.pixels);
        float *found = read_cube(w);
        worst = fmax(worst, compare_cubes(w, found));
        free(found);
        destroy_map(&map);
    }
    world_destroy_light(w);
    print_message("%s %ux%u, cube %u: %.1e\n", helio_layout_name(c->layout), c->width, c->height, c->size, worst);
    return worst;
}

static const map_case cases[] = {
    {HELIO_LAYOUT_LATLONG, 1, 1, 1},       {HELIO_LAYOUT_LATLONG, 2, 1, 3},
    {HELIO_LAYOUT_LATLONG, 5, 3, 2},       {HELIO_LAYOUT_LATLONG, 64, 32, 33},
    {HELIO_LAYOUT_LATLONG, 62, 31, 16},    {HELIO_LAYOUT_LATLONG, 257, 129, 5},
    {HELIO_LAYOUT_LATLONG, 256, 128, 64},  {HELIO_LAYOUT_LATLONG, 512, 256, 1},
    {HELIO_LAYOUT_STRIP, 1, 6, 4},         {HELIO_LAYOUT_STRIP, 90, 15, 16},
    {HELIO_LAYOUT_STRIP, 33, 198, 8},      {HELIO_LAYOUT_STRIP_OPENEXR, 17, 102, 9},
    {HELIO_LAYOUT_CROSS_V, 36, 48, 20},    {HELIO_LAYOUT_CROSS_H, 44, 33, 7},
    {HELIO_LAYOUT_OCTAHEDRAL, 63, 63, 32}, {HELIO_LAYOUT_EQUAL_AREA, 40, 40, 15},
    {HELIO_LAYOUT_ANGULAR, 65, 65, 24},    {HELIO_LAYOUT_MIRRORBALL, 64, 64, 13},
};

static void cubes_are_those_of_the_cpu(void **state)
{
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_true(compare_case(&w, &cases[i], 100 * i) <= BOUND);
    if (is_thorough())
        assert_true(compare_case(&w, &(map_case){HELIO_LAYOUT_LATLONG, 1024, 512, 512}, 7) <= BOUND);
    world_destroy(&w);
}

/* ---- light is neither lost nor gained ---- */

static double flux_of(const vulkan_world *w, const float *cube)
{
    const size_t size = w->environment->size, texels = size * size;
    double flux = 0;
    for (size_t i = 0; i < 6 * texels; i++)
        flux += (double)cube[3 * i] * (double)w->environment->solid_angle[i % texels];
    return flux;
}

static double pixel_solid_angle(uint32_t width, uint32_t height, uint32_t row)
{
    const double pi = acos(-1.0), step = pi / height;
    return 2.0 * pi / width * (cos(row * step) - cos((row + 1) * step));
}

/* At poles, at edges of faces, beside them, and within. */
static void a_sun_of_one_pixel_keeps_its_flux(void **state)
{
    enum { W = 128, H = 64 };
    static const uint32_t places[][2] = {{0, 0},   {17, 0},  {127, 63}, {64, 32}, {63, 31}, {16, 32},
                                         {15, 31}, {48, 16}, {47, 47},  {80, 20}, {100, 9}, {3, 54}};
    static const uint32_t sizes[] = {1, 15, 64, 100};
    vulkan_world w = world_make();
    double worst = 0;
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        make_light(&w, &(map_case){HELIO_LAYOUT_LATLONG, W, H, sizes[s]});
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            test_map map = {.rgb = calloc((size_t)W * H * 3, sizeof(float))};
            assert_non_null(map.rgb);
            map.pixels.data = map.rgb;
            for (size_t c = 0; c < 3; c++)
                map.rgb[((size_t)places[i][1] * W + places[i][0]) * 3 + c] = 1e6f;
            update(&w, &map.pixels);
            float *found = read_cube(&w);
            worst = fmax(worst, fabs(flux_of(&w, found) / (1e6 * pixel_solid_angle(W, H, places[i][1])) - 1));
            free(found);
            destroy_map(&map);
        }
        world_destroy_light(&w);
    }
    print_message("a sun's flux is off by %.1e\n", worst);
    assert_true(worst <= 1e-6);
    world_destroy(&w);
}

/* ---- pixels that are no light ---- */

static void expect_counts(vulkan_world *w, const map_case *c, const test_map *map)
{
    helio_environment *other;
    helio_environment_info info;
    const helio_environment_desc desc = {c->size, c->width, c->height, c->layout};
    update(w, &map->pixels);
    float *found = read_cube(w);
    assert_true(compare_cubes(w, found) <= BOUND);
    free(found);
    assert_ok(helio_environment_create(w->context, &desc, &other));
    assert_ok(helio_environment_update_pixels(other, &map->pixels, &info));
    const helio_bad_pixels bad = map_bad_pixels(&w->light.map, w->light.slot);
    assert_int_equal(bad.nan, info.bad.nan);
    assert_int_equal(bad.infinite, info.bad.infinite);
    assert_int_equal(bad.negative, info.bad.negative);
    assert_true(bad.nan > 0 && bad.infinite > 0 && bad.negative > 0);
    helio_environment_destroy(other);
}

static void bad_pixels_are_cleaned_and_counted(void **state)
{
    static const map_case spoilt[] = {{HELIO_LAYOUT_LATLONG, 61, 40, 16},
                                      {HELIO_LAYOUT_CROSS_H, 40, 30, 10}, /* its corners count, too */
                                      {HELIO_LAYOUT_MIRRORBALL, 50, 50, 16}};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof spoilt / sizeof *spoilt; i++) {
        const map_case *c = &spoilt[i];
        make_light(&w, c);
        for (uint32_t format = 0; format < 4; format++) {
            test_map map = make_map(c->width, c->height, i);
            spoil_map(&map, c->width, c->height, 10 * i + format);
            make_numbers(&map, c->width, c->height, (helio_pixel_format)format, false);
            expect_counts(&w, c, &map);
            destroy_map(&map);
        }
        world_destroy_light(&w);
    }
    world_destroy(&w);
}

static void a_map_of_nothing_but_nan_is_black(void **state)
{
    const map_case c = {HELIO_LAYOUT_LATLONG, 48, 24, 12};
    vulkan_world w = world_make();
    test_map map = make_map(c.width, c.height, 1);
    (void)state;
    for (size_t i = 0; i < (size_t)c.width * c.height * 3; i++)
        map.rgb[i] = NAN;
    make_light(&w, &c);
    update(&w, &map.pixels);
    float *found = read_cube(&w);
    assert_true(flux_of(&w, found) == 0);
    assert_int_equal(map_bad_pixels(&w.light.map, w.light.slot).nan, c.width * c.height);
    free(found);
    destroy_map(&map);
    world_destroy_light(&w);
    world_destroy(&w);
}

/* ---- skies ---- */

/* In relation to a texel's brightest channel. Both compute in float: the worst that was found is 1.6e-6. */
static const double SKY_BOUND = 1e-5;

static const helio_sky_desc skies[] = {
    {.sun = {.azimuth = 130, .elevation = 40}, .turbidity = 2, .albedo = 0.3f},
    {.sun = {.azimuth = -45, .elevation = 35.2644}, .turbidity = 10},       /* in a corner of the cube */
    {.sun = {.azimuth = 90, .elevation = 45}, .turbidity = 1, .albedo = 1}, /* on an edge */
    {.sun = {.azimuth = 200, .elevation = 90}, .turbidity = 3.5f},
    {.sun = {.azimuth = 271, .elevation = 0.1}, .turbidity = 5, .albedo = 0.2f}, /* half set */
    {.sun = {.azimuth = 10, .elevation = -4}},
    {.sun = {.azimuth = 10, .elevation = -25}},
    {.sun = {.azimuth = 33, .elevation = 61, .distance = 0.9}, .no_disc = true},
};

static void update_sky(vulkan_world *w, helio_sky *sky, const helio_sky_desc *desc)
{
    assert_ok(helio_sky_update(sky, desc, w->environment, NULL));
    assert_true(w->environment->is_late == map_is_sky(&w->light.map));
    assert_false(map_is_here(&w->light.map));
}

/* The largest difference of channels, in relation to the brightest of the texel. */
static double compare_texels(const vulkan_world *w, const float *found)
{
    const float *expected = helio_environment_cube(w->environment);
    double worst = 0;
    for (size_t i = 0; i < light_cube_bytes(&w->light) / sizeof *found; i += 3) {
        const double brightest = fmax((double)expected[i], fmax((double)expected[i + 1], (double)expected[i + 2]));
        for (size_t c = i; c < i + 3; c++) {
            assert_true(found[c] >= 0 && isfinite(found[c]));
            worst = fmax(worst, fabs((double)found[c] - (double)expected[c]) / fmax(brightest, 0x1p-126));
        }
    }
    return worst;
}

/* The cube that the CPU makes when it is asked late is that which it makes at once. */
static void expect_same_bits(const vulkan_world *w, helio_sky *sky, const helio_sky_desc *desc)
{
    helio_environment *other;
    helio_environment_info info;
    assert_ok(
        helio_environment_create(w->context, &(helio_environment_desc){.cube_size = w->environment->size}, &other));
    assert_ok(helio_sky_update(sky, desc, other, &info));
    assert_memory_equal(other->cube, w->environment->cube,
                        (size_t)CUBE_FACES * other->size * other->size * 3 * sizeof(float));
    helio_environment_destroy(other);
}

static double compare_sky(vulkan_world *w, helio_sky *sky, const helio_sky_desc *desc)
{
    update_sky(w, sky, desc);
    float *found = read_cube(w);
    assert_true(w->light.slots[w->light.slot].is_sky == (w->environment->size >= 64));
    const double worst = compare_texels(w, found);
    expect_same_bits(w, sky, desc);
    assert_true(fabs(flux_of(w, found) / flux_of(w, w->environment->cube) - 1) <= 1e-6);
    free(found);
    return worst;
}

/* Even sizes have one place in each texel, odd ones four; the cubes of the least are sent. */
static void skies_are_those_of_the_cpu(void **state)
{
    static const uint32_t sizes[] = {1, 63, 64, 65, 128, 129};
    vulkan_world w = world_make();
    helio_sky *sky;
    (void)state;
    assert_ok(helio_sky_create(w.context, 512, &sky));
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes + is_thorough(); s++) {
        double worst = 0;
        const uint32_t size = s < sizeof sizes / sizeof *sizes ? sizes[s] : 512;
        make_light(&w, &(map_case){HELIO_LAYOUT_LATLONG, 8, 4, size});
        for (size_t i = 0; i < sizeof skies / sizeof *skies; i++)
            worst = fmax(worst, compare_sky(&w, sky, &skies[i]));
        world_destroy_light(&w);
        print_message("skies, cube %u: %.1e\n", size, worst);
        assert_true(worst <= (size < 64 ? 0.0 : SKY_BOUND));
    }
    helio_sky_destroy(sky);
    world_destroy(&w);
}

/* Also when the light, and the copy of the sky with it, is gone, or the sky itself. */
static void a_cube_outlives_its_sky(void **state)
{
    vulkan_world w = world_make();
    (void)state;
    for (int round = 0; round < 3; round++) {
        helio_sky *sky;
        make_light(&w, &(map_case){HELIO_LAYOUT_LATLONG, 8, 4, 64});
        assert_ok(helio_sky_create(w.context, 64, &sky));
        update_sky(&w, sky, &skies[round]);
        if (round == 1)
            light_destroy(&w.light);
        if (round == 2) {
            helio_sky_destroy(sky);
            assert_ok(helio_sky_create(w.context, 64, &sky));
        }
        helio_environment_cube(w.environment);
        expect_same_bits(&w, sky, &skies[round]);
        helio_sky_destroy(sky);
        world_destroy_light(&w);
    }
    world_destroy(&w);
}

/* ---- what a caller may do between frames ---- */

static void expect_same(vulkan_world *w)
{
    float *found = read_cube(w);
    if (map_is_sky(&w->light.map))
        assert_true(compare_texels(w, found) <= SKY_BOUND);
    else
        assert_true(compare_cubes(w, found) <= BOUND);
    free(found);
}

/* Another shape, numbers of another size, the same frame again, an update that wants to know, a sky. */
static void maps_may_change_from_frame_to_frame(void **state)
{
    vulkan_world w = world_make();
    helio_environment_info info;
    helio_sky *sky;
    (void)state;
    make_light(&w, &(map_case){HELIO_LAYOUT_LATLONG, 8, 4, 66});
    assert_ok(helio_sky_create(w.context, 66, &sky));
    for (uint32_t i = 0; i < 30; i++) {
        const map_case *c = &cases[i / 2 % 8 + 2];
        test_map map = make_map(c->width, c->height, i);
        make_numbers(&map, c->width, c->height, (helio_pixel_format)(i / 3 % 5), i % 2);
        if (i % 5 != 4)
            assert_ok(helio_environment_reshape(w.environment, c->width, c->height, c->layout));
        if (i % 7 >= 5)
            update_sky(&w, sky, &(helio_sky_desc){.sun = {.elevation = 2.0 * i, .azimuth = 3.0 * i}});
        else if (w.environment->map.width == c->width && w.environment->map.height == c->height)
            assert_ok(helio_environment_update_pixels(w.environment, &map.pixels, i % 3 == 2 ? &info : NULL));
        expect_same(&w);
        if (i % 4 == 0)
            expect_same(&w);
        destroy_map(&map);
    }
    helio_sky_destroy(sky);
    world_destroy_light(&w);
    world_destroy(&w);
}

/* The cube is still to be had when the light, and the map with it, is gone; and after another shape was announced. */
static void a_cube_outlives_its_map(void **state)
{
    const map_case c = {HELIO_LAYOUT_LATLONG, 64, 32, 16};
    vulkan_world w = world_make();
    test_map map = make_map(c.width, c.height, 5);
    (void)state;
    float *expected = NULL;
    for (int round = 0; round < 3; round++) {
        make_light(&w, &c);
        const size_t bytes = light_cube_bytes(&w.light);
        update(&w, &map.pixels);
        if (round == 1)
            light_destroy(&w.light);
        if (round == 2)
            assert_ok(helio_environment_reshape(w.environment, 12, 6, HELIO_LAYOUT_LATLONG));
        const float *cube = helio_environment_cube(w.environment);
        if (round == 0) {
            expected = malloc(bytes);
            assert_non_null(expected);
            memcpy(expected, cube, bytes);
        }
        assert_memory_equal(cube, expected, bytes);
        world_destroy_light(&w);
    }
    free(expected);
    destroy_map(&map);
    world_destroy(&w);
}

/* Readers of all kinds see the frame's light, not the last one's. */
static void readers_find_the_cube_of_the_frame(void **state)
{
    const map_case c = {HELIO_LAYOUT_LATLONG, 32, 16, 8};
    const float up[3] = {0, 1, 0};
    vulkan_world w = world_make();
    float radiance[3], unfolded[8 * 4 * 3];
    (void)state;
    make_light(&w, &c);
    for (int i = 1; i < 10; i++) {
        test_map map = make_map(c.width, c.height, 0);
        for (size_t k = 0; k < (size_t)c.width * c.height * 3; k++)
            map.rgb[k] = (float)i;
        update(&w, &map.pixels);
        if (i % 4 == 0)
            helio_environment_radiance(w.environment, up, radiance);
        else if (i % 4 == 1)
            helio_environment_filtered(w.environment, up, radiance);
        else if (i % 4 == 2)
            assert_ok(helio_environment_unfold(w.environment, HELIO_LAYOUT_LATLONG, 8, 4, unfolded));
        else
            assert_ok(helio_tables_update(w.tables));
        assert_false(w.environment->is_late);
        const double seen = i % 4 < 2    ? (double)radiance[0]
                            : i % 4 == 2 ? (double)unfolded[0]
                                         : tables_flux(c.size, w.tables->face_fluxes[0]) / (4 * acos(-1.0) / 6);
        assert_true(fabs(seen / i - 1) < 1e-5);
        destroy_map(&map);
    }
    world_destroy_light(&w);
    world_destroy(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_are_those_of_the_cpu),          cmocka_unit_test(a_sun_of_one_pixel_keeps_its_flux),
        cmocka_unit_test(bad_pixels_are_cleaned_and_counted),  cmocka_unit_test(a_map_of_nothing_but_nan_is_black),
        cmocka_unit_test(maps_may_change_from_frame_to_frame), cmocka_unit_test(a_cube_outlives_its_map),
        cmocka_unit_test(skies_are_those_of_the_cpu),          cmocka_unit_test(a_cube_outlives_its_sky),
        cmocka_unit_test(readers_find_the_cube_of_the_frame),
    };
    return cmocka_run_group_tests_name("vulkan_cube", tests, NULL, NULL);
}
