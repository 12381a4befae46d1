/* SPDX-License-Identifier: MIT
 * samples: where the samples of a pixel are, what becomes of them, and that the figures show it. */
#include "program.h"

#include <heliostat/heliostat.h>

#include <ctype.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- what is lit ------------------------------------------------------------------------------ */

enum { SIZE = 16, FACE_TEXELS = SIZE * SIZE, MAP_FLOATS = 6 * FACE_TEXELS * 3 };

/* A small picture of the tetrahedron in the light of map.pfm, a strip as fine as the cube. */
#define SCENE "--mesh tetrahedron.obj --size 64x48 --env map.pfm --layout strip --env-size 16"

static const char *const face_names[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

static void set_texel(float *map, int face, int row, int column, float radiance)
{
    for (int c = 0; c < 3; c++)
        map[3 * (face * FACE_TEXELS + row * SIZE + column) + c] = radiance;
}

static void fill_map(float *map, float radiance)
{
    for (int i = 0; i < MAP_FLOATS; i++)
        map[i] = radiance * (1 + 0.25f * (float)(i % 3));
}

/* A sky with a sun of one texel. */
static void fill_sunny(float *map, int face)
{
    fill_map(map, 0.5f);
    set_texel(map, face, 5, 9, 5000);
}

static void write_map(const float *rgb)
{
    helio_context *context = make_context(1, NULL);
    const helio_map map = {.width = SIZE, .height = 6 * SIZE, .rgb = rgb, .layout = HELIO_LAYOUT_STRIP};
    assert_ok(helio_map_write(context, "map.pfm", &map, NULL));
    helio_context_destroy(context);
}

static void write_sunny_map(int face)
{
    static float map[MAP_FLOATS];
    fill_sunny(map, face);
    write_map(map);
}

/* ---- JSON ------------------------------------------------------------------------------------- */

/* Runs samples with --json. To be given to json_decref(). */
static json_t *run_samples(const char *options)
{
    char line[TEST_PATH_SIZE];
    assert_true(snprintf(line, sizeof line, "samples %s -q --json seen.json", options) < (int)sizeof line);
    succeeds(line);
    return load_json("seen.json");
}

static json_t *frame_of(const json_t *seen, size_t index)
{
    json_t *frame = json_array_get(member(seen, "frames"), index);
    assert_non_null(frame);
    return frame;
}

static void read_vector(const json_t *object, const char *key, double vector[3])
{
    for (size_t c = 0; c < 3; c++)
        vector[c] = json_number_value(json_array_get(member(object, key), c));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool is_fate(const json_t *sample, const char *fate)
{
    return strcmp(text_of(sample, "fate"), fate) == 0;
}

static int face_of(const char *name)
{
    for (int face = 0; face < 6; face++)
        if (strcmp(face_names[face], name) == 0)
            return face;
    fail_msg("%s is no face", name);
    return -1;
}

/* ---- numbers ---------------------------------------------------------------------------------- */

static const char *const strategies[] = {"face", "face+brdf", "light",   "light+brdf",
                                         "brdf", "cosine",    "product", "product+brdf"};
enum { STRATEGIES = sizeof strategies / sizeof strategies[0] };

/* Of the list of samples: those of a technique, or of all where it is NULL, with this fate, or with any. */
static double count_listed(const json_t *frame, const char *technique, const char *fate)
{
    const json_t *samples = member(frame, "samples");
    double count = 0;
    for (size_t i = 0; i < json_array_size(samples); i++) {
        const json_t *sample = json_array_get(samples, i);
        count += (technique == NULL || strcmp(text_of(sample, "technique"), technique) == 0) &&
                 (fate == NULL || is_fate(sample, fate));
    }
    return count;
}

static void check_count(const json_t *frame, const char *technique, const json_t *count)
{
    static const char *const fates[] = {"used", "shadowed", "below", "dark"};
    double realised = number_of(count, "realised"), sum = 0;
    assert_true(realised == count_listed(frame, technique, NULL));
    for (size_t i = 0; i < 4; i++) {
        assert_true(number_of(count, fates[i]) == count_listed(frame, technique, fates[i]));
        sum += number_of(count, fates[i]);
    }
    assert_true(sum == realised);
}

static void check_counts(const json_t *frame, double spp)
{
    json_t *techniques = member(frame, "techniques"), *count;
    const char *technique;
    double expected = 0, realised = 0, fallen = 0;
    json_object_foreach(techniques, technique, count)
    {
        check_count(frame, technique, count);
        expected += number_of(count, "expected");
        realised += number_of(count, "realised");
    }
    for (int face = 0; face < 6; face++)
        fallen += number_of(member(member(frame, "faces"), face_names[face]), "samples");
    check_count(frame, NULL, member(frame, "counts"));
    assert_true(realised == spp && fallen == spp);
    assert_true(fabs(expected - spp) < 1e-4 * spp); /* sums of floats */
    assert_true(json_array_size(member(frame, "samples")) == (size_t)spp);
}

static void counts_sum_to_the_samples(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    for (int i = 0; i < STRATEGIES; i++) {
        char options[256];
        int spp = i == 1 ? 300 : 64;
        snprintf(options, sizeof options, SCENE " --strategy %s --spp %d", strategies[i], spp);
        json_t *seen = run_samples(options), *frame = frame_of(seen, 0);
        check_counts(frame, spp);
        assert_string_equal(text_of(seen, "strategy"), strategies[i]);
        bool is_product = i > 5;
        assert_true(number_of(frame, "pools") == (i < 2 ? 6 : i < 4 || is_product ? 1 : 0));
        assert_true(number_of(frame, "passes") == (spp == 300 ? 3 : 1));
        const uint32_t light = i < 2 ? 6 : i < 4 || is_product ? 1 : 0;
        assert_true(json_object_size(member(frame, "techniques")) == light + (i == 1 || (i > 2 && i != 6)));
        json_decref(seen);
    }
}

/* Of floats, in another order than the renderer's: some roundings. */
static const double ROUNDING = 2e-5;

static void the_used_samples_sum_to_the_pixel_of_the_render(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static const char *const variants[] = {
        "",
        "--visibility none",
        "--spp 300",
        "--rotate 50 --flip --intensity 2.5",
        "--strategy face+brdf --material ggx:base=1,0.8,0.3,metallic=1,roughness=0.2 --brdf-share 0.25",
        "--strategy light --material diffuse:0.8,0.5,0.2 --ground plane",
        "--strategy brdf --decorrelate none --seed 5",
        "--strategy product+brdf --spp 100",
        "--strategy product+brdf --material diffuse:0.8 --rotate 50",
        "--no-beta --weighting paper --seed-mode frame",
    };
    write_sunny_map(4);
    for (size_t i = 0; i < sizeof variants / sizeof variants[0]; i++) {
        char options[512];
        double sum[3] = {0}, control[3], radiance[3], picture[3], contribution[3];
        snprintf(options, sizeof options, SCENE " --pixel 30,20 %s", variants[i]);
        json_t *seen = run_samples(options), *frame = frame_of(seen, 0), *samples = member(frame, "samples");
        for (size_t k = 0; k < json_array_size(samples); k++) {
            const json_t *sample = json_array_get(samples, k);
            read_vector(sample, "contribution", contribution);
            for (int c = 0; c < 3 && is_fate(sample, "used"); c++)
                sum[c] += contribution[c];
        }
        read_vector(frame, "control", control);
        read_vector(frame, "radiance", radiance);
        read_vector(frame, "picture", picture);
        assert_true(picture[0] > 0);
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(sum[c] + control[c] - picture[c]) <= ROUNDING * picture[c]);
            assert_true(fabs(radiance[c] - picture[c]) <= ROUNDING * picture[c]);
        }
        json_decref(seen);
    }
}

/* A point that shines reads the lists of the tiles, a matte one the pool of a bin. */
static void a_point_of_product_names_what_it_reads(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static const char *const materials[] = {"phong:kd=0.5,ks=0.5,n=40", "diffuse:0.8"};
    static const char *const names[] = {"tiles", "bin"}, *const remarks[] = {"material and cosine", "for normals like"};
    write_sunny_map(4);
    for (size_t i = 0; i < 2; i++) {
        char options[512];
        snprintf(options, sizeof options,
                 "samples " SCENE " --pixel 30,20 --strategy product+brdf --material %s --out a.png", materials[i]);
        succeeds(options);
        assert_non_null(strstr(program_out, names[i]));
        assert_non_null(strstr(program_out, remarks[i]));
        assert_null(strstr(program_out, names[1 - i]));
    }
}

/* Metal may weigh tiles in one pass and, where the light is calm for it, read a bin in another. */
static void passes_of_metal_say_what_each_sample_is_of(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    bool is_mixed = false;
    write_sunny_map(4);
    for (int angle = 0; angle < 360 && !is_mixed; angle += 10) {
        char options[512];
        int of_pass[16], tiles = 0, bins = 0;
        snprintf(
            options, sizeof options,
            SCENE
            " --pixel 30,20 --rotate %d --strategy product+brdf --spp 1024 --material ggx:metallic=1,roughness=0.3",
            angle);
        json_t *seen = run_samples(options), *frame = frame_of(seen, 0), *samples = member(frame, "samples");
        memset(of_pass, -1, sizeof of_pass);
        for (size_t k = 0; k < json_array_size(samples); k++) {
            const json_t *sample = json_array_get(samples, k);
            const int of_tiles = json_is_true(member(sample, "of_tiles"));
            int *pass = &of_pass[(size_t)number_of(sample, "pass") % 16];
            if (strcmp(text_of(sample, "technique"), "BRDF") == 0)
                continue;
            assert_true(*pass == -1 || *pass == of_tiles);
            *pass = of_tiles;
        }
        for (size_t pass = 0; pass < 16; pass++) {
            tiles += of_pass[pass] == 1;
            bins += of_pass[pass] == 0;
        }
        print_message("turned by %d: %d passes of tiles, %d of bins\n", angle, tiles, bins);
        assert_int_equal(tiles + bins, (int)number_of(frame, "passes"));
        assert_non_null(json_object_get(member(frame, "techniques"), bins == 0    ? "tiles"
                                                                     : tiles == 0 ? "bin"
                                                                                  : "bin/tiles"));
        is_mixed = tiles > 0 && bins > 0;
        json_decref(seen);
    }
    assert_true(is_mixed);
}

static void check_fates(const json_t *frame, double counts[3])
{
    const json_t *point = member(frame, "point"), *samples = member(frame, "samples");
    double normal[3], flat[3], direction[3], contribution[3];
    read_vector(point, "normal", normal);
    read_vector(point, "geometric_normal", flat);
    for (size_t i = 0; i < json_array_size(samples); i++) {
        const json_t *sample = json_array_get(samples, i);
        read_vector(sample, "direction", direction);
        read_vector(sample, "contribution", contribution);
        bool is_above = dot(normal, direction) > 0 && dot(flat, direction) > 0;
        bool is_useful = is_fate(sample, "used") || is_fate(sample, "shadowed");
        assert_true(fabs(dot(direction, direction) - 1) < 1e-5);
        assert_true(number_of(sample, "density") > 0);
        assert_int_equal(contribution[0] + contribution[1] + contribution[2] > 0, is_useful);
        if (is_useful || is_fate(sample, "dark"))
            assert_true(is_above);
        else
            assert_false(is_above);
        counts[0] += is_useful;
        counts[1] += is_fate(sample, "below");
        counts[2] += is_fate(sample, "dark");
    }
}

static void useless_samples_give_nothing_and_used_ones_are_above_the_horizon(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static float map[MAP_FLOATS];
    double counts[3] = {0};
    fill_sunny(map, 2);
    for (int i = 4 * FACE_TEXELS; i < 6 * FACE_TEXELS; i++) /* two faces without light, for BRDF samples to find */
        set_texel(map, i / FACE_TEXELS, i / SIZE % SIZE, i % SIZE, 0);
    write_map(map);
    for (int i = 0; i < STRATEGIES; i++) {
        char options[256];
        snprintf(options, sizeof options, SCENE " --strategy %s", strategies[i]);
        json_t *seen = run_samples(options);
        check_fates(frame_of(seen, 0), counts);
        json_decref(seen);
    }
    assert_true(counts[0] > 20 && counts[1] > 20 && counts[2] > 5);
}

static void shadows_are_told_from_what_is_useless(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    /* Seen from below, the ground keeps the light of the lower half away. */
    json_t *seen = run_samples(SCENE " --ground plane --spp 128"), *without;
    double shadowed = number_of(member(frame_of(seen, 0), "counts"), "shadowed");
    double used = number_of(member(frame_of(seen, 0), "counts"), "used");
    without = run_samples(SCENE " --ground plane --spp 128 --visibility none");
    assert_true(shadowed > 0);
    assert_true(number_of(member(frame_of(without, 0), "counts"), "shadowed") == 0);
    assert_true(number_of(member(frame_of(without, 0), "counts"), "used") == used + shadowed);
    json_decref(seen);
    json_decref(without);
}

/* A wall that faces +X, seen from there: the whole face -X is behind it. */
#define WALL "--mesh wall.obj --camera orbit:azimuth=90 --size 64x48 --env map.pfm --layout strip --env-size 16"

/* The claim of the supplement's Figure 3. */
static void no_sample_is_spent_on_a_sun_behind_the_point(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    double normal[3];
    write_text("wall.obj", "v 0 -1 1\nv 0 -1 -1\nv 0 1 -1\nv 0 1 1\nf 1 2 3 4\n");
    write_sunny_map(1);
    json_t *seen = run_samples(WALL);
    const json_t *frame = frame_of(seen, 0), *count = member(member(frame, "techniques"), "-X");
    read_vector(member(frame, "point"), "normal", normal);
    assert_true(normal[0] > 0.999);
    assert_true(number_of(count, "expected") == 0 && number_of(count, "realised") == 0);
    assert_true(number_of(member(member(frame, "faces"), "-X"), "samples") == 0);
    assert_true(number_of(member(frame, "counts"), "realised") == 64);
    json_decref(seen);
    succeeds("samples " WALL " --json seen.json");
    assert_non_null(strstr(program_out, "no light sample is spent on it"));

    /* A table that does not know the surface spends most of them there. */
    seen = run_samples(WALL " --strategy light");
    frame = frame_of(seen, 0);
    assert_true(number_of(member(member(frame, "faces"), "-X"), "samples") > 40);
    assert_true(number_of(member(frame, "counts"), "below") > 40);
    json_decref(seen);

    /* Turned round, the sun gets most samples, and all of them are used. */
    seen = run_samples(WALL " --rotate 180");
    count = member(member(frame_of(seen, 0), "techniques"), "-X");
    assert_true(number_of(count, "realised") > 55 && number_of(count, "used") == number_of(count, "realised"));
    json_decref(seen);
}

/* The same pools made by the library: samples are theirs, bit for bit, each technique's one after the other. */
static void used_samples_are_members_of_the_pools(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static float map[MAP_FLOATS];
    fill_sunny(map, 4);
    write_map(map);
    helio_context *context = make_context(1, NULL);
    helio_environment *environment = make_environment(context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    helio_tables *tables;
    helio_pools *pools;
    assert_ok(helio_tables_create(environment, HELIO_WEIGHTING_SOLID_ANGLE, &tables));
    assert_ok(helio_tables_update(tables));
    assert_ok(helio_pools_create(tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_FACE}, &pools));
    json_t *seen = run_samples(SCENE " --spp 200 --seed 3"), *samples = member(frame_of(seen, 0), "samples");
    assert_true(number_of(frame_of(seen, 0), "pool_samples") == 2 * 6 * 1024);
    for (size_t i = 0; i < json_array_size(samples); i++) {
        const json_t *sample = json_array_get(samples, i), *before = i > 0 ? json_array_get(samples, i - 1) : NULL;
        const char *technique = text_of(sample, "technique");
        uint32_t number = (uint32_t)number_of(sample, "number"), pass = (uint32_t)number_of(sample, "pass");
        double direction[3];
        helio_pool_sample pooled;
        assert_ok(helio_pools_draw(pools, 3, pass));
        assert_ok(helio_pools_read(pools, (uint32_t)face_of(technique), number, 1, &pooled));
        assert_string_equal(text_of(sample, "face"), technique);
        read_vector(sample, "direction", direction);
        for (int c = 0; c < 3; c++)
            assert_true((float)direction[c] == pooled.direction[c]); /* nine digits tell a float from all others */
        if (before != NULL && strcmp(text_of(before, "technique"), technique) == 0 && number_of(before, "pass") == pass)
            assert_true(number == number_of(before, "number") + 1);
    }
    json_decref(seen);
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

/* However the map is turned, its texels are where they are in the cube. */
static void a_turned_map_keeps_its_texels(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    enum { ROW = 6, COLUMN = 7 };
    static float map[MAP_FLOATS];
    fill_map(map, 0);
    set_texel(map, 2, ROW, COLUMN, 100);
    write_map(map);
    static const char *const turns[] = {"", "--rotate 40", "--rotate -100 --flip"};
    double directions[3][3];
    for (int i = 0; i < 3; i++) {
        char options[256];
        snprintf(options, sizeof options, SCENE " %s", turns[i]);
        json_t *seen = run_samples(options), *samples = member(frame_of(seen, 0), "samples");
        assert_true(json_array_size(samples) == 64);
        for (size_t k = 0; k < 64; k++) {
            const json_t *sample = json_array_get(samples, k), *texel = member(sample, "texel");
            assert_string_equal(text_of(sample, "face"), "+Y");
            assert_int_equal(json_integer_value(json_array_get(texel, 0)), ROW);
            assert_int_equal(json_integer_value(json_array_get(texel, 1)), COLUMN);
        }
        read_vector(json_array_get(samples, 0), "direction", directions[i]);
        json_decref(seen);
    }
    assert_true(fabs(directions[0][0] - directions[1][0]) > 0.01 && fabs(directions[0][1] - directions[1][1]) < 0.1);
    assert_true(fabs(directions[0][0] - directions[2][0]) > 0.01 || fabs(directions[0][2] - directions[2][2]) > 0.01);
}

static void no_light_is_no_error(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    json_t *seen = run_samples("--mesh tetrahedron.obj --size 64x48 --env constant:0,0,0");
    assert_true(json_array_size(member(frame_of(seen, 0), "samples")) == 0);
    assert_true(number_of(member(frame_of(seen, 0), "counts"), "realised") == 0);
    assert_true(number_of(frame_of(seen, 0), "pool_samples") == 0);
    json_decref(seen);
}

/* ---- pixels ----------------------------------------------------------------------------------- */

static void pixels_off_the_object_are_told_with_one_that_shows_it(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    static const char *const grounds[] = {"none", "plane", "shadow"};
    static const char *const words[] = {"shows the background, not the object", "shows the ground, not the object",
                                        "shows the ground that catches shadows, not the object"};
    for (int i = 0; i < 3; i++) {
        char line[512];
        snprintf(line, sizeof line, "samples " SCENE " --ground %s --pixel 1,46 --json seen.json", grounds[i]);
        fails(line, 1, words[i]);
        const char *advice = strstr(program_err, "try --pixel ");
        assert_non_null(advice);
        snprintf(line, sizeof line, "samples " SCENE " --ground %s %.*s --json seen.json", grounds[i],
                 (int)strcspn(advice + 4, "\n"), advice + 4);
        succeeds(line);
    }
    fails("samples " SCENE " --camera lookat:eye=0,0,100,at=0,0,200 --json seen.json", 1, "another --camera");
    fails("samples " SCENE " --pixel 64,0 --json seen.json", 2, "outside of the picture of 64x48 pixels");
    fails("samples " SCENE " --pixel 0,48 --json seen.json", 2, "rows from 0 to 47");
}

static void without_a_pixel_one_of_the_object_is_chosen(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    /* The tetrahedron is far from the middle here. */
    json_t *seen = run_samples(SCENE " --camera lookat:eye=0,0,8,at=2,0.5,0,fov=40"), *pixel;
    pixel = member(frame_of(seen, 0), "pixel");
    double x = json_number_value(json_array_get(pixel, 0)), y = json_number_value(json_array_get(pixel, 1));
    assert_true(x < 32 && y > 0 && y < 48);
    json_decref(seen);
}

/* ---- figures ---------------------------------------------------------------------------------- */

#ifdef HELIO_WITH_CAIRO

enum { EDGE = 320, MARGIN = 24, FIGURE_WIDTH = 4 * EDGE + 2 * MARGIN, FIGURE_HEIGHT = 3 * EDGE + 2 * MARGIN };

/* axis, right and down of each face, as include/heliostat/environment.h has them. */
static const double frames[6][3][3] = {
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
};

/* Where each face is in the cross, in faces. */
static const int places[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};

/* Of a direction in the map's space. */
static void project(int face, const double direction[3], double *x, double *y)
{
    double distance = dot(direction, frames[face][0]);
    double u = dot(direction, frames[face][1]) / distance, v = dot(direction, frames[face][2]) / distance;
    *x = MARGIN + (places[face][0] + (u + 1) / 2) * EDGE;
    *y = MARGIN + (places[face][1] + (v + 1) / 2) * EDGE;
}

static int brightest_axis(const double direction[3])
{
    int best = 0;
    for (int face = 1; face < 6; face++)
        if (dot(direction, frames[face][0]) > dot(direction, frames[best][0]))
            best = face;
    return best;
}

static helio_image *read_picture(helio_context *context, const char *path)
{
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    return image;
}

static const float *pixel_at(const helio_image *image, double x, double y)
{
    assert_true(x >= 0 && y >= 0 && x < image->width && y < image->height);
    return image->rgb + 3 * ((size_t)y * image->width + (size_t)x);
}

/* Linear values of the marks. */
static bool is_green(const float *p)
{
    return p[1] > 0.4f && p[0] < 0.2f && p[2] < 0.25f;
}

static bool is_yellow(const float *p)
{
    return p[0] > 0.6f && p[1] > 0.4f && p[2] < 0.1f;
}

static bool is_violet(const float *p)
{
    return p[0] > 0.4f && p[1] < 0.35f && p[2] > 0.7f;
}

static bool is_blue(const float *p)
{
    return p[2] > 0.6f && p[0] < 0.2f && p[1] < 0.3f;
}

static bool is_red(const float *p)
{
    return p[0] > 0.3f && p[1] < 0.12f && p[2] < 0.12f;
}

typedef bool (*colour_test)(const float *pixel);

/* Which colour the middle of a sample's mark has; NULL where it is hollow. */
static colour_test colour_of(const json_t *sample)
{
    bool is_surface = strcmp(text_of(sample, "technique"), "BRDF") == 0;
    if (is_fate(sample, "shadowed"))
        return NULL;
    return !is_fate(sample, "used") ? is_yellow : is_surface ? is_violet : is_green;
}

/* Marks lie upon each other and under labels: nine of ten must be seen. */
static void check_marks(const helio_image *image, const json_t *frame, double least)
{
    const json_t *samples = member(frame, "samples");
    double asked = 0, seen = 0;
    for (size_t i = 0; i < json_array_size(samples); i++) {
        const json_t *sample = json_array_get(samples, i);
        colour_test test = colour_of(sample);
        double direction[3], x, y;
        if (test == NULL)
            continue;
        read_vector(sample, "direction", direction);
        project(face_of(text_of(sample, "face")), direction, &x, &y);
        asked++;
        seen += test(pixel_at(image, x, y));
    }
    assert_true(asked >= least);
    if (seen < 0.9 * asked)
        fail_msg("%.0f of %.0f samples have the colour of their mark where they should be", seen, asked);
}

static void marks_are_where_the_samples_are(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    static float map[MAP_FLOATS];
    fill_map(map, 0.5f); /* nothing draws the samples together */
    write_map(map);
    helio_context *context = make_context(1, NULL);
    static const char *const variants[] = {"face", "face+brdf", "light"};
    for (int i = 0; i < 3; i++) {
        char options[256];
        snprintf(options, sizeof options, SCENE " --spp 40 --strategy %s --out a.png", variants[i]);
        json_t *seen = run_samples(options), *frame = frame_of(seen, 0);
        helio_image *image = read_picture(context, "a.png");
        double normal[3], x, y;
        assert_int_equal(image->width, FIGURE_WIDTH);
        assert_int_equal(image->height, FIGURE_HEIGHT);
        check_marks(image, frame, 20);
        read_vector(member(frame, "point"), "normal", normal);
        project(brightest_axis(normal), normal, &x, &y);
        assert_true(is_blue(pixel_at(image, x, y)));
        helio_image_destroy(context, image);
        json_decref(seen);
    }
    helio_context_destroy(context);
}

/* Red dots for all samples of the pools, which are those that the library draws. */
static void pools_are_drawn_in_red(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    static float map[MAP_FLOATS];
    fill_map(map, 0.05f);
    write_map(map);
    succeeds("samples " SCENE " -q --exposure -6 --out a.png");
    helio_context *context = make_context(1, NULL);
    helio_image *image = read_picture(context, "a.png");
    helio_environment *environment = make_environment(context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    helio_tables *tables;
    helio_pools *pools;
    static helio_pool_sample samples[1024];
    assert_ok(helio_tables_create(environment, HELIO_WEIGHTING_SOLID_ANGLE, &tables));
    assert_ok(helio_tables_update(tables));
    assert_ok(helio_pools_create(tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_FACE}, &pools));
    assert_ok(helio_pools_draw(pools, 0, 0));
    for (uint32_t face = 0; face < 6; face++) {
        int red = 0;
        assert_ok(helio_pools_read(pools, face, 0, 1024, samples));
        for (int i = 0; i < 1024; i++) {
            const double direction[3] = {(double)samples[i].direction[0], (double)samples[i].direction[1],
                                         (double)samples[i].direction[2]};
            double x, y;
            project((int)face, direction, &x, &y);
            red += is_red(pixel_at(image, x, y));
        }
        if (red < 900) /* some are under labels and other marks */
            fail_msg("of the pool of face %s %d of 1024 samples are red", face_names[face], red);
    }
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
    helio_environment_destroy(environment);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* The crosshair is where the pixel is in the render, which fills the box of 624 x 304 to the upper right. */
static void the_pixel_is_marked_in_the_render(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_sunny_map(4);
    succeeds("samples " SCENE " --pixel 30,20 -q --out a.png");
    helio_context *context = make_context(1, NULL);
    helio_image *image = read_picture(context, "a.png");
    const double left = MARGIN + 2 * EDGE + 16, top = MARGIN, scale = 304.0 / 48;
    double x = 0, y = 0, count = 0;
    for (uint32_t row = MARGIN; row < MARGIN + 304; row++)
        for (uint32_t column = (uint32_t)left; column < FIGURE_WIDTH - MARGIN; column++) {
            const float *pixel = pixel_at(image, column, row);
            if (pixel[0] < 0.15f && pixel[1] > 0.8f && pixel[2] > 0.9f) {
                x += column + 0.5;
                y += row + 0.5;
                count++;
            }
        }
    assert_true(count > 50);
    assert_true(fabs(x / count - left - 30.5 * scale) < 1 && fabs(y / count - top - 20.5 * scale) < 1);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

static void starts_with(const char *path, const char *start)
{
    static char text[1 << 24];
    assert_true(read_text(path, text, sizeof text) > 1000);
    assert_memory_equal(text, start, strlen(start));
}

/* Skips the attributes of a tag; each is a name, = and a value in quotes. Returns what follows, '>' or '/'. */
static const char *skip_attributes(const char *text)
{
    for (;;) {
        text += strspn(text, " \n\t");
        if (*text == '>' || *text == '/' || *text == '?')
            return text;
        size_t name = strcspn(text, "= >/");
        assert_true(name > 0 && text[name] == '=' && text[name + 1] == '"');
        const char *end = strchr(text + name + 2, '"');
        assert_non_null(end);
        text = end + 1;
    }
}

/* Is every tag closed by one of its name, every ampersand an entity's? */
static void is_well_formed(const char *text)
{
    char names[64][32];
    size_t depth = 0, tags = 0;
    for (; *text != 0; text++) {
        if (*text == '&')
            assert_true(text[1] == '#' || isalpha((unsigned char)text[1]));
        if (*text != '<')
            continue;
        bool is_end = text[1] == '/', is_head = text[1] == '?';
        text += is_end || is_head ? 2 : 1;
        size_t length = strcspn(text, " \n\t/>");
        assert_in_range(length, 1, sizeof names[0] - 1);
        char name[32];
        snprintf(name, sizeof name, "%.*s", (int)length, text);
        text = skip_attributes(text + length);
        tags++;
        if (is_end) {
            assert_true(depth > 0);
            assert_string_equal(names[--depth], name);
        } else if (*text == '>') {
            assert_true(depth < 64);
            snprintf(names[depth++], sizeof names[0], "%s", name);
        }
        text = strchr(text, '>');
        assert_non_null(text);
    }
    assert_true(depth == 0 && tags > 100);
}

static void figures_of_all_kinds_are_written(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static char text[1 << 24];
    write_sunny_map(4);
    succeeds("samples " SCENE " -q --out a.png");
    succeeds("samples " SCENE " -q --out a.svg --strategy face+brdf");
    succeeds("samples " SCENE " -q --out a.pdf --strategy light");
    succeeds("samples " SCENE " -q");
    starts_with("a.png", "\x89PNG");
    starts_with("a.svg", "<?xml");
    starts_with("a.pdf", "%PDF");
    starts_with("samples.png", "\x89PNG");
    read_text("a.svg", text, sizeof text);
    is_well_formed(text);
    assert_int_equal(count_files("."), 6); /* with map.pfm and tetrahedron.obj, and nothing temporary */
    succeeds("samples --mesh tetrahedron.obj --size 64x48 --env constant:0,0,0 -q --out black.png");
    succeeds("samples " SCENE " --size 20x300 --visibility none --spp 1024 -q --out tall.png");
    succeeds("samples " SCENE " --strategy cosine --ground shadow -q --out cosine.pdf");
}

static void sequences_become_figures_and_a_sheet(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    static const char scene[] = "--mesh tetrahedron.obj --size 64x48 --env-size 32 --env sky:day";
    char options[512];
    snprintf(options, sizeof options, "%s --day-frames 3 --out day_%%d.png --contact-sheet sheet.png", scene);
    json_t *seen = run_samples(options);
    assert_int_equal(json_array_size(member(seen, "frames")), 3);
    for (size_t i = 0; i < 3; i++) {
        const json_t *frame = frame_of(seen, i);
        assert_true(number_of(frame, "index") == (double)i);
        assert_int_equal(text_of(frame, "label")[2], ':'); /* the time of day */
        assert_true(json_equal(member(frame, "pixel"), member(frame_of(seen, 0), "pixel")));
        check_counts(frame, 64);
    }
    assert_true(exists("day_0.png") && exists("day_1.png") && exists("day_2.png") && !exists("day_3.png"));
    assert_true(number_of(frame_of(seen, 1), "exposure") < number_of(frame_of(seen, 0), "exposure") - 2);
    json_decref(seen);

    /* Six of a day where nobody says how many, and of a longer sequence: three beside each other. */
    snprintf(options, sizeof options, "samples %s --contact-sheet six.png -q", scene);
    succeeds(options);
    snprintf(options, sizeof options, "samples %s --day-frames 11 --contact-sheet eleven.pdf", scene);
    succeeds(options);
    int tables = 0;
    for (const char *at = program_out; (at = strstr(at, "pixel ")) != NULL; at++)
        tables++;
    assert_int_equal(tables, 6); /* the other five are not rendered */
    helio_context *context = make_context(1, NULL);
    helio_image *one = read_picture(context, "sheet.png"), *two = read_picture(context, "six.png");
    assert_true(one->width == two->width && one->height < two->height);
    helio_image_destroy(context, one);
    helio_image_destroy(context, two);
    helio_context_destroy(context);
    starts_with("eleven.pdf", "%PDF");
    fails("samples --mesh tetrahedron.obj --env sky:day --out one.png", 2, "--contact-sheet FILE");
    assert_false(exists("one.png"));
}

static bool is_same_file(const char *a, const char *b)
{
    static char texts[2][1 << 22];
    size_t length = read_text(a, texts[0], sizeof texts[0]);
    return length == read_text(b, texts[1], sizeof texts[1]) && memcmp(texts[0], texts[1], length) == 0;
}

static void the_same_seed_gives_the_same_figure_on_any_number_of_threads(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_sunny_map(4);
    succeeds("samples " SCENE " -q --threads 1 --out a.png --json a.json");
    succeeds("samples " SCENE " -q --threads 3 --out b.png --json b.json");
    succeeds("samples " SCENE " -q --threads 1 --out c.png --json c.json --seed 1");
    assert_true(is_same_file("a.png", "b.png") && is_same_file("a.json", "b.json"));
    assert_false(is_same_file("a.png", "c.png") || is_same_file("a.json", "c.json"));
}

static void an_interrupted_sequence_keeps_its_figures(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    pid_t child = start_program("samples --mesh tetrahedron.obj --size 64x48 --env-size 16 --env sky:day --day-frames "
                                "100000 --out day_%d.png --contact-sheet sheet.png --json seen.json");
    for (int i = 0; i < 6000 && !exists("day_1.png"); i++) /* a minute at most */
        usleep(10000);
    assert_int_equal(kill(child, SIGINT), 0);
    assert_int_equal(finish_program(child, NULL), 128 + SIGINT);
    assert_non_null(strstr(program_err, " figures written to day_%d.png"));
    assert_true(exists("day_0.png") && exists("day_1.png") && !exists("sheet.png") && !exists("seen.json"));
    long figures = strtol(strstr(program_err, "stopped; ") + strlen("stopped; "), NULL, 10);
    assert_int_equal(count_files("."), figures + 1); /* with tetrahedron.obj, and nothing half-written */
}

static void a_full_disk_leaves_the_old_figure(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_text("a.png", "old");
    program_limits.file_size = 20000; /* more than the mesh needs on its way from its importer, less than a figure */
    fails("samples --mesh tetrahedron.obj --size 64x48 --env constant:1,1,1 -q --out a.png", 1,
          "a.png cannot be written: File too large; give --out");
    fails("samples --mesh tetrahedron.obj --size 64x48 --env constant:1,1,1 -q --contact-sheet b.pdf", 1,
          "b.pdf cannot be written: File too large; give --contact-sheet");
    program_limits.file_size = 0;
    char text[16];
    read_text("a.png", text, sizeof text);
    assert_string_equal(text, "old");
    assert_int_equal(count_files("."), 2);
}
#endif

/* ---- words ------------------------------------------------------------------------------------ */

static void text_tells_what_json_tells(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    json_t *seen = run_samples(SCENE " --pixel 30,20"), *counts = member(frame_of(seen, 0), "counts");
    char row[128];
    snprintf(row, sizeof row, "  %-8s %7s %8.2f %6.0f %6.0f %9.0f %8.0f\n", "all", "", 64.0, 64.0,
             number_of(counts, "used"), number_of(counts, "shadowed"),
             number_of(counts, "below") + number_of(counts, "dark"));
    succeeds("samples " SCENE " --pixel 30,20 --json seen.json");
    assert_non_null(strstr(program_out, row));
    assert_non_null(strstr(program_out, "map.pfm, pixel 30,20: normal "));
    succeeds("samples " SCENE " --pixel 30,20 --json -");
    json_t *printed = json_loads(program_out, 0, NULL);
    assert_non_null(printed);
    assert_true(json_equal(printed, seen));
    json_decref(printed);
    json_decref(seen);
}

static void mistakes_are_one_sentence(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_sunny_map(4);
    fails("samples --pixel 3x4", 2, "--pixel takes a column and a row, such as 640,360");
    fails("samples --pixel 3,-4", 2, "--pixel takes");
    fails("samples --pixel 3,4,5", 2, "--pixel takes");
    fails("samples --pixel 3", 2, "--pixel takes");
    fails("samples map.pfm", 2, "write --mesh or --env before a file's name");
    fails("samples --spp 1025", 2, "1 to 1024");
    fails("samples --aa 4", 2, "no option --aa");
    fails("samples --stats a.json", 2, "no option --stats");
    fails("samples --strategy best", 2, "--strategy takes");
    fails("samples --env sky:noon --json a.json", 2, "noon");
    fails("samples --mesh none.obj --json a.json", 1, "none.obj");
    fails("samples " SCENE " --json tetrahedron.obj", 1, "would replace an input");
    fails("samples " SCENE " --json none/a.json", 1, "none/");
#ifdef HELIO_WITH_CAIRO
    fails("samples --out a.jpeg", 2, "ends in none of .png, .svg and .pdf");
    fails("samples --contact-sheet a.jpeg", 2, "--contact-sheet a.jpeg ends in none of");
    fails("samples --out a_%d_%d.png", 2, "takes one number");
    fails("samples --out a.png --json a.png", 2, "give two files");
    fails("samples " SCENE " --out a.png --contact-sheet a.png", 2, "--contact-sheet");
    fails("samples " SCENE " --out a_%02d.svg --json a_07.svg", 2, "give --json another path");
    fails("samples " SCENE " --out none/a.png", 1, "none/");
#else
    fails("samples --out a.png", 2, "this build has no cairo");
#endif
    assert_int_equal(count_files("."), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(counts_sum_to_the_samples),
        program_test(the_used_samples_sum_to_the_pixel_of_the_render),
        program_test(a_point_of_product_names_what_it_reads),
        program_test(passes_of_metal_say_what_each_sample_is_of),
        program_test(useless_samples_give_nothing_and_used_ones_are_above_the_horizon),
        program_test(shadows_are_told_from_what_is_useless),
        program_test(no_sample_is_spent_on_a_sun_behind_the_point),
        program_test(used_samples_are_members_of_the_pools),
        program_test(a_turned_map_keeps_its_texels),
        program_test(no_light_is_no_error),
        program_test(pixels_off_the_object_are_told_with_one_that_shows_it),
        program_test(without_a_pixel_one_of_the_object_is_chosen),
#ifdef HELIO_WITH_CAIRO
        program_test(marks_are_where_the_samples_are),
        program_test(pools_are_drawn_in_red),
        program_test(the_pixel_is_marked_in_the_render),
        program_test(figures_of_all_kinds_are_written),
        program_test(sequences_become_figures_and_a_sheet),
        program_test(the_same_seed_gives_the_same_figure_on_any_number_of_threads),
        program_test(an_interrupted_sequence_keeps_its_figures),
        program_test(a_full_disk_leaves_the_old_figure),
#endif
        program_test(text_tells_what_json_tells),
        program_test(mistakes_are_one_sentence),
    };
    return cmocka_run_group_tests_name("samples", tests, set_up_program, tear_down_program);
}
