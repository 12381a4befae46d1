/* SPDX-License-Identifier: MIT
 * convert: between all layouts and formats; what is kept of light, directions and pixels; sequences; mistakes. */
#include "program.h"

#include <heliostat/image.h>
#include <heliostat/sky.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const LAYOUTS[] = {"latlong",       "cross-v",    "cross-h",    "faces",   "strip",
                                      "strip-openexr", "octahedral", "equal-area", "angular", "mirrorball"};
enum { LAYOUT_COUNT = sizeof LAYOUTS / sizeof *LAYOUTS, FACE_SIZE = 16, SIZE = 4 * FACE_SIZE };

/* How far a smooth map is off after two changes of layout, root mean square as a part of the mean; measured: 0.0072
 * from mirror ball to light probe. A wrong turn of a face makes a tenth or more. */
static const double PAIR_BOUND = 0.01;

/* The same at the worst of a thousand directions where it was turned too, absolute; measured: 0.0133. */
static const double TURN_BOUND = 0.02;

/* ---- maps ---------------------------------------------------------------------------------- */

typedef struct map {
    uint32_t width, height;
    float *rgb;
    helio_layout layout;
} map;

static map make_map(helio_layout layout, uint32_t width, uint32_t height)
{
    map made = {width, height, calloc((size_t)width * height, 3 * sizeof(float)), layout};
    assert_non_null(made.rgb);
    return made;
}

static void write_map(const char *path, const map *from)
{
    helio_context *context = make_context(1, NULL);
    const helio_map out = {.width = from->width, .height = from->height, .rgb = from->rgb, .layout = from->layout};
    assert_ok(helio_map_write(context, path, &out, NULL));
    helio_context_destroy(context);
}

static map read_map(const char *path)
{
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    map read = make_map(image->layout, image->width, image->height);
    memcpy(read.rgb, image->rgb, (size_t)read.width * read.height * 3 * sizeof(float));
    helio_image_destroy(context, image);
    helio_context_destroy(context);
    return read;
}

/* The direction of a pixel's middle in a lat-long map. */
static void latlong_direction(const map *of, uint32_t row, uint32_t column, double d[3])
{
    const double pi = acos(-1);
    double polar = pi * (row + 0.5) / of->height, around = 2 * pi * (0.5 - (column + 0.5) / of->width);
    d[0] = sin(polar) * sin(around);
    d[1] = cos(polar);
    d[2] = sin(polar) * cos(around);
}

/* Smooth, without any symmetry, different in each channel. */
static map make_smooth(void)
{
    map smooth = make_map(HELIO_LAYOUT_LATLONG, SIZE, SIZE / 2);
    for (uint32_t row = 0; row < smooth.height; row++)
        for (uint32_t column = 0; column < smooth.width; column++) {
            double d[3];
            latlong_direction(&smooth, row, column, d);
            float *rgb = smooth.rgb + 3 * ((size_t)row * smooth.width + column);
            rgb[0] = (float)(1 + 0.5 * d[0] + 0.2 * d[1] * d[2]);
            rgb[1] = (float)(1 - 0.3 * d[1] + 0.4 * d[0] * d[2]);
            rgb[2] = (float)(0.8 + 0.6 * d[2] + 0.1 * d[0] * d[1]);
        }
    return smooth;
}

/* ---- comparison ---------------------------------------------------------------------------- */

static helio_environment *environment_of(helio_context *context, const map *of, helio_environment_info *info)
{
    return make_environment(context, of->layout, of->width, of->height, FACE_SIZE, of->rgb, info);
}

/* Root of the mean squared difference of the two maps as cubes, as a part of the mean of one. */
static double difference(const map *a, const map *b)
{
    helio_context *context = make_context(1, NULL);
    helio_environment *first = environment_of(context, a, NULL), *second = environment_of(context, b, NULL);
    const float *x = helio_environment_cube(first), *y = helio_environment_cube(second);
    size_t numbers = 6 * FACE_SIZE * FACE_SIZE * 3;
    double sum = 0, mean = 0;
    for (size_t i = 0; i < numbers; i++) {
        sum += (double)(x[i] - y[i]) * (double)(x[i] - y[i]);
        mean += (double)y[i];
    }
    helio_environment_destroy(second);
    helio_environment_destroy(first);
    helio_context_destroy(context);
    return sqrt(sum / (double)numbers) / (mean / (double)numbers);
}

static double flux_of(const map *of)
{
    helio_context *context = make_context(1, NULL);
    helio_environment_info info;
    helio_environment_destroy(environment_of(context, of, &info));
    helio_context_destroy(context);
    double flux = 0;
    for (int face = 0; face < 6; face++)
        flux += info.flux[face];
    return flux;
}

static void assert_close(double value, double wanted, double part, const char *what)
{
    if (!(fabs(value - wanted) <= part * fabs(wanted)))
        fail_msg("%s: %.9g in place of %.9g", what, value, wanted);
}

/* What inspect says of a source. To be given to json_decref(). */
static json_t *inspect(const char *source_and_options)
{
    char line[256];
    assert_true(snprintf(line, sizeof line, "inspect %s --quiet --json seen.json", source_and_options) <
                (int)sizeof line);
    succeeds(line);
    return load_json("seen.json");
}

static double inspected_flux(const char *source_and_options)
{
    json_t *seen = inspect(source_and_options);
    double flux = number_of(seen, "flux");
    json_decref(seen);
    return flux;
}

static void convert(const char *from, const char *options, const char *to)
{
    char line[512];
    assert_true(snprintf(line, sizeof line, "convert %s %s --out %s", from, options, to) < (int)sizeof line);
    succeeds(line);
}

/* ---- layouts ------------------------------------------------------------------------------- */

static bool is_faces(const char *layout)
{
    return strcmp(layout, "faces") == 0;
}

/* Six files one below the other. */
static map read_faces(const char *before, const char *after)
{
    static const char *const names[] = {"px", "nx", "py", "ny", "pz", "nz"};
    map all = {0};
    for (size_t i = 0; i < 6; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s%s%s", before, names[i], after);
        map face = read_map(path);
        assert_int_equal(face.width, face.height);
        if (i == 0)
            all = make_map(HELIO_LAYOUT_STRIP, face.width, 6 * face.width);
        assert_int_equal(face.width, all.width);
        size_t numbers = 3 * (size_t)face.width * face.width;
        memcpy(all.rgb + i * numbers, face.rgb, numbers * sizeof(float));
        free(face.rgb);
    }
    return all;
}

static map read_layout(const char *layout, const char *name)
{
    char path[64];
    snprintf(path, sizeof path, "%s.pfm", name);
    map read = read_map(path);
    assert_ok(helio_layout_parse(layout, &read.layout));
    return read;
}

/* What a frame of a sequence became. */
static map read_frame(const char *layout, int frame)
{
    char name[32];
    snprintf(name, sizeof name, is_faces(layout) ? "out_%d_" : "out_%d", frame);
    return is_faces(layout) ? read_faces(name, ".pfm") : read_layout(layout, name);
}

static void check_pair(const char *from, const char *to, const map *original, const map *source, const map *result)
{
    assert_close(flux_of(result), flux_of(source), 1e-4, to);
    double error = difference(result, original);
    if (!(error < PAIR_BOUND))
        fail_msg("from %s to %s: a difference of %g", from, to, error);
}

/* The maps are a sequence, so that one run of the program makes one layout from all others. Radiance files tell their
 * layouts; six faces are the strip, bit for bit, as the next test shows. */
static void light_stays_where_it_is_between_all_pairs_of_layouts(void **state)
{
    (void)state;
    map smooth = make_smooth(), sources[LAYOUT_COUNT];
    double flux = flux_of(&smooth);
    write_map("smooth.pfm", &smooth);
    for (int i = 0; i < LAYOUT_COUNT; i++) {
        char options[64], path[32];
        snprintf(options, sizeof options, "--quiet --to %s", is_faces(LAYOUTS[i]) ? "strip" : LAYOUTS[i]);
        snprintf(path, sizeof path, "in_%d.hdr", i);
        convert("smooth.pfm", options, path);
        sources[i] = read_map(path);
        assert_close(flux_of(&sources[i]), flux, 1.0 / 256, LAYOUTS[i]);
    }
    for (int k = 0; k < LAYOUT_COUNT; k++) {
        char options[64];
        if (!is_thorough() && k % 2 != 0) /* test_layouts has all pairs, too */
            continue;
        snprintf(options, sizeof options, "--quiet --to %s", LAYOUTS[k]);
        convert("in_%d.hdr", options, is_faces(LAYOUTS[k]) ? "out_%d_%s.pfm" : "out_%d.pfm");
        for (int i = 0; i < LAYOUT_COUNT; i++) {
            map result = read_frame(LAYOUTS[k], i);
            check_pair(LAYOUTS[i], LAYOUTS[k], &smooth, &sources[i], &result);
            free(result.rgb);
        }
    }
    for (int i = 0; i < LAYOUT_COUNT; i++)
        free(sources[i].rgb);
    free(smooth.rgb);
}

/* Cubes in another order of faces, or in other files: the same numbers. */
static void layouts_of_a_cube_keep_every_bit(void **state)
{
    (void)state;
    static const char *const cubes[] = {"cross-v", "cross-h", "faces", "strip"};
    map smooth = make_smooth();
    write_map("smooth.pfm", &smooth);
    convert("smooth.pfm", "--quiet --to strip", "strip.pfm");
    map strip = read_map("strip.pfm");
    assert_int_equal(strip.width, FACE_SIZE);
    for (size_t i = 0; i < sizeof cubes / sizeof *cubes; i++) {
        char options[64];
        snprintf(options, sizeof options, "--quiet --to %s", cubes[i]);
        convert("strip.pfm", options, is_faces(cubes[i]) ? "to_%s.pfm" : "to.pfm");
        convert(is_faces(cubes[i]) ? "to_%s.pfm" : "to.pfm", "--quiet --to strip", "back.pfm");
        map back = read_map("back.pfm");
        assert_int_equal(back.height, strip.height);
        assert_memory_equal(back.rgb, strip.rgb, 6 * FACE_SIZE * FACE_SIZE * 3 * sizeof(float));
        free(back.rgb);
    }
    free(strip.rgb);
    free(smooth.rgb);
}

/* The radiance from there, and the flux. */
static float radiance_from(const map *of, const double direction[3], double *flux)
{
    helio_context *context = make_context(1, NULL);
    helio_environment_info info;
    helio_environment *environment = environment_of(context, of, &info);
    float d[3] = {(float)direction[0], (float)direction[1], (float)direction[2]}, rgb[3];
    helio_environment_filtered(environment, d, rgb);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
    *flux = 0;
    for (int face = 0; face < 6; face++)
        *flux += info.flux[face];
    return rgb[0];
}

/* A sun of one pixel beside which there is nothing, and somewhere between the texels of the small map. */
static void a_sun_of_one_pixel_keeps_its_flux_when_the_map_shrinks(void **state)
{
    (void)state;
    const uint32_t width = is_thorough() ? 1024 : 256, row = 83 * width / 1024, column = 429 * width / 1024;
    const double texel = 4 * acos(-1) / (6.0 * FACE_SIZE * FACE_SIZE);
    map sun = make_map(HELIO_LAYOUT_LATLONG, width, width / 2);
    for (size_t c = 0; c < 3; c++)
        sun.rgb[3 * ((size_t)row * sun.width + column) + c] = 60000;
    write_map("sun.hdr", &sun);
    double direction[3], flux = flux_of(&sun), kept;
    latlong_direction(&sun, row, column, direction);
    free(sun.rgb);
    json_t *before = inspect("sun.hdr");
    assert_close(number_of(before, "flux"), flux, 1e-3, "the flux"); /* RGBE holds 60000 to 1/256 */
    flux = number_of(before, "flux");
    json_decref(before);
    for (int i = 0; i < LAYOUT_COUNT; i++) {
        char options[64];
        if (!is_thorough() && (i % 3 != 0)) /* one of each kind */
            continue;
        snprintf(options, sizeof options, "--quiet --env-size 16 --to %s", LAYOUTS[i]);
        convert("sun.hdr", options, is_faces(LAYOUTS[i]) ? "small_%s.pfm" : "small.pfm");
        map small = is_faces(LAYOUTS[i]) ? read_faces("small_", ".pfm") : read_layout(LAYOUTS[i], "small");
        float radiance = radiance_from(&small, direction, &kept);
        assert_close(kept, flux, 1e-4, LAYOUTS[i]);
        if (!((double)radiance > flux / (16 * texel)))
            fail_msg("%s: the sun is no longer where it was: %g", LAYOUTS[i], (double)radiance);
        free(small.rgb);
    }
}

/* ---- sizes --------------------------------------------------------------------------------- */

static void has_size(const char *path, uint32_t width, uint32_t height)
{
    map read = read_map(path);
    if (read.width != width || read.height != height)
        fail_msg("%s has %ux%u pixels, not %ux%u", path, read.width, read.height, width, height);
    free(read.rgb);
}

static void the_size_follows_from_the_input_or_from_options(void **state)
{
    (void)state;
    map smooth = make_smooth();
    write_map("smooth.pfm", &smooth);
    free(smooth.rgb);
    convert("smooth.pfm", "", "same.pfm");
    has_size("same.pfm", 64, 32);
    assert_non_null(strstr(program_out, "same.pfm: 64x32 latlong"));
    convert("smooth.pfm", "--to cross-h", "cross.pfm");
    has_size("cross.pfm", 64, 48);
    convert("cross.pfm", "--to latlong", "back.pfm");
    has_size("back.pfm", 64, 32);
    convert("smooth.pfm", "--to octahedral", "square.pfm");
    has_size("square.pfm", 46, 46); /* 2 sqrt(2) 16, rounded up to even */
    convert("square.pfm", "--layout octahedral --to strip", "strip.pfm");
    has_size("strip.pfm", 16, 96);
    convert("smooth.pfm", "--to angular --env-size 5", "small.pfm");
    has_size("small.pfm", 16, 16);
    convert("smooth.pfm", "--size 30x10", "odd.pfm");
    has_size("odd.pfm", 30, 10);
    convert("smooth.pfm", "--to strip --size 24x4", "flat.pfm");
    has_size("flat.pfm", 24, 4);
    convert("smooth.pfm", "--size 3x3", "face_%s.pfm");
    has_size("face_nz.pfm", 3, 3);
    convert("constant:1,2,3", "", "constant.pfm");
    has_size("constant.pfm", 1, 1);
}

/* ---- formats ------------------------------------------------------------------------------- */

static void write_frames(int count)
{
    for (int i = 0; i < count; i++) {
        char line[96];
        snprintf(line, sizeof line, "convert constant:%d,1,1 -q --size 4x2 --out in_%02d.pfm", i + 1, i);
        succeeds(line);
    }
}

static void same_bits(const char *path, const map *wanted)
{
    map read = read_map(path);
    assert_int_equal(read.width, wanted->width);
    assert_memory_equal(read.rgb, wanted->rgb, (size_t)wanted->width * wanted->height * 3 * sizeof(float));
    free(read.rgb);
}

static void other_formats_change_no_pixel(void **state)
{
    (void)state;
    map smooth = make_smooth();
    write_map("a.pfm", &smooth);
    convert("a.pfm", "", "b.hdr");
    convert("b.hdr", "", "c.pfm");
    map quantised = read_map("c.pfm");
    for (size_t i = 0; i < (size_t)3 * SIZE * SIZE / 2;
         i++) /* half a step is at most 1/256 of the greatest channel, here below 2 */
        assert_true(fabsf(quantised.rgb[i] - smooth.rgb[i]) <= 2.0f / 256);
    convert("c.pfm", "", "d.hdr");
    same_bits("d.hdr", &quantised);
    free(quantised.rgb);
    if (helio_map_check_path("a.exr", HELIO_LAYOUT_LATLONG) == HELIO_OK) {
        convert("a.pfm", "", "e.exr");
        convert("e.exr", "", "f.pfm");
        same_bits("e.exr", &smooth);
        same_bits("f.pfm", &smooth);
        convert("a.pfm", "--half", "h.exr");
        map half = read_map("h.exr");
        for (size_t i = 0; i < (size_t)3 * SIZE * SIZE / 2; i++)
            assert_true(fabsf(half.rgb[i] - smooth.rgb[i]) <= 0x1p-11f * smooth.rgb[i]);
        free(half.rgb);
    }
    free(smooth.rgb);
}

static void half_floats_that_lose_light_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_EXR);
    fails("convert constant:1e6,1,1 --half --out a.exr", 1, "half floats");
    assert_false(exists("a.exr"));
    succeeds("convert constant:1e6,1,1 --half --intensity 0.01 --out a.exr");
}

static void a_png_loses_range_with_a_warning(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    succeeds("convert constant:0.5,0.5,0.5 --out a.png");
    assert_string_equal(program_err, "");
    map grey = read_map("a.png");
    assert_true(fabsf(grey.rgb[0] - 0.5f) < 0.005f);
    free(grey.rgb);
    succeeds("convert constant:4,1,0.5 --out b.png");
    assert_non_null(strstr(program_err, "warning"));
    assert_non_null(strstr(program_err, "100 %"));
    succeeds("convert constant:4,1,0.5 --exposure -2 --out c.png");
    assert_string_equal(program_err, "");
    map darker = read_map("c.png");
    assert_true(fabsf(darker.rgb[0] - 1) < 0.005f && fabsf(darker.rgb[1] - 0.25f) < 0.005f);
    free(darker.rgb);
    /* A white surface is lit by pi times this radiance, and reflects it: 0.8. */
    succeeds("convert constant:7,7,7 --exposure auto --out d.png");
    map automatic = read_map("d.png");
    assert_true(fabsf(automatic.rgb[0] - 0.8f) < 0.01f);
    free(automatic.rgb);
    succeeds("convert constant:1,1,1 --tonemap reinhard --out e.png");
    map mapped = read_map("e.png");
    assert_true(fabsf(mapped.rgb[0] - 0.5f) < 0.005f);
    free(mapped.rgb);
}

static void a_sequence_of_png_keeps_the_exposure_of_its_first_frame(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    write_frames(2); /* red is 1 in the first, 2 in the second; the others are 1 */
    succeeds("convert in_%02d.pfm --exposure auto --out shown_%d.png");
    map first = read_map("shown_0.png"), second = read_map("shown_1.png");
    assert_true(fabsf(first.rgb[1] - second.rgb[1]) < 0.005f);
    assert_true(fabsf(first.rgb[0] - 0.8f) < 0.01f && second.rgb[0] > 0.99f);
    free(first.rgb);
    free(second.rgb);
}

static void options_without_effect_are_told(void **state)
{
    (void)state;
    succeeds("convert constant:1,1,1 --half --out a.hdr");
    assert_non_null(strstr(program_err, "--half changes nothing"));
    succeeds("convert constant:1,1,1 --exposure 1 --out a.hdr");
    assert_non_null(strstr(program_err, "change nothing"));
    succeeds("convert constant:1,1,1 --quiet --out a.hdr");
    assert_string_equal(program_err, "");
    assert_string_equal(program_out, "");
    succeeds("convert constant:1,1,1 --verbose --threads 2 --out a.hdr");
    assert_non_null(strstr(program_err, "pixel by pixel"));
}

static void bad_pixels_become_dark_and_are_told(void **state)
{
    (void)state;
    map bad = make_map(HELIO_LAYOUT_LATLONG, 8, 4);
    for (size_t i = 0; i < 3 * 8 * 4; i++)
        bad.rgb[i] = 1;
    bad.rgb[0] = NAN;
    bad.rgb[3] = INFINITY;
    bad.rgb[6] = -2;
    write_map("bad.pfm", &bad);
    static const char *const options[] = {"", "--to strip", "--rotate 90", "--rotate 12"};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        convert("bad.pfm", options[i], "good.pfm");
        assert_non_null(strstr(program_err, "3 bad pixels: 1 NaN and 1 infinite"));
        map good = read_map("good.pfm");
        for (size_t k = 0; k < (size_t)3 * good.width * good.height; k++)
            assert_true(good.rgb[k] >= 0 && good.rgb[k] <= 1.001f);
        free(good.rgb);
    }
    convert("bad.pfm", "", "good.pfm");
    map good = read_map("good.pfm");
    assert_true(good.rgb[0] == 0 && good.rgb[1] == 0 && good.rgb[3] == 0 && good.rgb[4] == 0);
    assert_true(good.rgb[6] == 0 && good.rgb[7] == 1);
    free(good.rgb);
    free(bad.rgb);
}

/* ---- orientation --------------------------------------------------------------------------- */

/* The radiance that comes from a direction, once the options are baked in, is that of the map turned when it is looked
 * up. */
static double turned_difference(const map *original, const map *baked, float degrees, bool flip)
{
    helio_context *context = make_context(1, NULL);
    helio_environment *wanted = environment_of(context, original, NULL), *got = environment_of(context, baked, NULL);
    const helio_orientation turn = {.rotate = degrees, .flip = flip};
    assert_ok(helio_environment_orient(wanted, &turn));
    uint64_t seed = 7;
    double worst = 0;
    for (int i = 0; i < 1000; i++) {
        float d[3], a[3], b[3];
        double z = 2 * random_unit(&seed) - 1, around = 2 * acos(-1) * random_unit(&seed);
        d[0] = (float)(sqrt(1 - z * z) * cos(around));
        d[1] = (float)z;
        d[2] = (float)(sqrt(1 - z * z) * sin(around));
        helio_environment_filtered(wanted, d, a);
        helio_environment_filtered(got, d, b);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(a[c] - b[c])));
    }
    helio_environment_destroy(got);
    helio_environment_destroy(wanted);
    helio_context_destroy(context);
    return worst;
}

static void check_turn(const char *const from[3], const char *to, const map *original, double degrees, bool flip)
{
    char options[128];
    snprintf(options, sizeof options, "--quiet --to %s --rotate %g%s", to, degrees, flip ? " --flip" : "");
    convert("in_%d.hdr", options, "out_%d.pfm");
    for (int i = 0; i < 3; i++) {
        map turned = read_frame(to, i);
        assert_close(flux_of(&turned), flux_of(original), 1.0 / 256, to);
        double worst = turned_difference(original, &turned, (float)degrees, flip);
        if (!(worst < TURN_BOUND))
            fail_msg("%s to %s, %g degrees%s: a difference of %g", from[i], to, degrees, flip ? ", flipped" : "",
                     worst);
        free(turned.rgb);
    }
}

static void turns_are_baked_in(void **state)
{
    (void)state;
    static const char *const layouts[] = {"latlong", "strip", "octahedral"};
    static const double angles[] = {630, -180, 33.3};
    const size_t least = is_thorough() ? 0 : 1; /* a quarter turn is in square_turns_keep_every_bit() */
    map smooth = make_smooth();
    write_map("in_0.hdr", &smooth);
    convert("in_0.hdr", "-q --to strip", "in_1.hdr");
    convert("in_0.hdr", "-q --to octahedral", "in_2.hdr");
    for (size_t to = 0; to < 3; to++)
        for (size_t angle = least; angle < 3; angle++)
            check_turn(layouts, layouts[to], &smooth, angles[angle], (to + angle) % 2 == 0);
    free(smooth.rgb);
}

/* Whole columns of a lat-long map and whole faces of a cube move as they are. */
static void square_turns_keep_every_bit(void **state)
{
    (void)state;
    map smooth = make_smooth();
    write_map("a.pfm", &smooth);
    convert("a.pfm", "--rotate 90 --flip", "b.pfm");
    convert("b.pfm", "--flip", "c.pfm");
    convert("c.pfm", "--rotate 90", "d.pfm"); /* mirrored, the other way round */
    same_bits("d.pfm", &smooth);
    convert("a.pfm", "--to strip", "s.pfm");
    map strip = read_map("s.pfm");
    convert("s.pfm", "--rotate 90", "t.pfm");
    convert("t.pfm", "--rotate 180 --flip", "u.pfm");
    convert("u.pfm", "--rotate 270 --flip", "v.pfm");
    convert("v.pfm", "--rotate -180", "w.pfm");
    same_bits("w.pfm", &strip);
    free(strip.rgb);
    free(smooth.rgb);
}

static void intensity_is_baked_in(void **state)
{
    (void)state;
    succeeds("convert constant:1,2,3 --intensity 2.5 --out a.pfm");
    map bright = read_map("a.pfm");
    assert_true(bright.rgb[0] == 2.5f && bright.rgb[1] == 5 && bright.rgb[2] == 7.5f);
    free(bright.rgb);
    succeeds("convert constant:1,2,3 --intensity 2 --to strip --env-size 1 --out b.pfm");
    assert_close(inspected_flux("b.pfm"), 2 * inspected_flux("constant:1,2,3"), 1e-6, "twice the light");
}

/* ---- six files ----------------------------------------------------------------------------- */

static void six_files_come_back(void **state)
{
    (void)state;
    map smooth = make_smooth();
    write_map("smooth.pfm", &smooth);
    free(smooth.rgb);
    convert("smooth.pfm", "--to strip", "strip.hdr");
    map strip = read_map("strip.hdr");
    convert("strip.hdr", "", "pattern_%s.hdr"); /* the name alone tells that it is faces */
    convert("strip.hdr", "--to faces", "folder/");
    assert_int_equal(count_files("folder"), 6);
    convert("pattern_%s.hdr", "--to strip", "a.pfm");
    convert("folder", "--to strip", "b.pfm");
    convert("folder", "", "c.pfm"); /* one file: a strip */
    fails("convert pattern_%s.hdr --out pattern_%s.hdr", 2, "would replace the input");
    fails("convert folder --to faces --out folder/", 2, "would replace the input");
    same_bits("a.pfm", &strip);
    if (exists("folder/px.hdr")) /* RGBE twice is RGBE once; EXR changes nothing */
        same_bits("b.pfm", &strip);
    map from_folder = read_map("b.pfm");
    same_bits("c.pfm", &from_folder);
    free(from_folder.rgb);
    free(strip.rgb);
}

/* ---- sequences ----------------------------------------------------------------------------- */

static float first_of(const char *path)
{
    map read = read_map(path);
    float first = read.rgb[0];
    free(read.rgb);
    return first;
}

static void sequences_are_converted_frame_by_frame(void **state)
{
    (void)state;
    write_frames(4);
    succeeds("convert in_%02d.pfm --out out_%03d.pfm");
    assert_non_null(strstr(program_out, "4 frames"));
    for (int i = 0; i < 4; i++) {
        char path[32];
        snprintf(path, sizeof path, "out_%03d.pfm", i);
        assert_true(first_of(path) == (float)(i + 1));
    }
    succeeds("convert in_%02d.pfm --frames 2..3 --to strip --out strip_%d.pfm");
    assert_true(exists("strip_2.pfm") && exists("strip_3.pfm") && !exists("strip_1.pfm"));
    succeeds("convert in_%02d.pfm --frames 1..1 --out one.pfm");
    assert_true(first_of("one.pfm") == 2);
    unlink("in_01.pfm");
    succeeds("convert in_%02d.pfm --frames 0..3 --on-missing hold --out held_%d.pfm");
    assert_true(first_of("held_1.pfm") == 1);
}

static void a_sequence_has_its_folder_made(void **state)
{
    (void)state;
    write_frames(3);
    succeeds("convert in_%02d.pfm --out small/frame_%04d.pfm");
    assert_int_equal(count_files("small"), 3);
    succeeds("convert in_%02d.pfm --out small/frame_%04d.pfm");
    succeeds("convert in_%02d.pfm --to faces --out six/map_%d_%s.pfm");
    assert_int_equal(count_files("six"), 18);
    fails("convert in_%02d.pfm --out no/small/frame_%04d.pfm", 1, "no/small/frame_%04d.pfm");
    assert_false(exists("no"));
    write_text("in_00.pfm", "damaged");
    fails("convert in_%02d.pfm --out new/frame_%04d.pfm", 1, "in_00.pfm");
    assert_false(exists("new"));
    fails("convert in_%02d.pfm --out new/frame_%04d.tiff", 2, "frame_0000.tiff");
}

#ifdef HELIO_WITH_FFMPEG
/* Full range grey: code 128 of 255. */
static void video_is_converted_by_its_transfer(void **state)
{
    (void)state;
    succeeds("convert lavfi:color=c=gray:size=8x4:rate=4:duration=1,format=gbrp --layout latlong --transfer linear "
             "--out a_%d.pfm");
    assert_non_null(strstr(program_out, "4 frames"));
    assert_true(fabsf(first_of("a_3.pfm") - 128 / 255.0f) < 0.01f);
    succeeds("convert lavfi:color=c=gray:size=8x4:rate=4,format=gbrp --layout latlong --transfer sdr --frames 2..2 "
             "--out b.pfm");
    assert_true(fabsf(first_of("b.pfm") - powf(128 / 255.0f, 2.4f)) < 0.01f);
}
#endif

static void mistakes_about_sequences_are_told(void **state)
{
    (void)state;
    write_frames(3);
    fails("convert in_%02d.pfm --out one.pfm", 2, "one_%04d.pfm");
    fails("convert in_%02d.pfm --out in_%02d.pfm", 2, "inputs might be replaced");
    fails("convert in_*.pfm --out in_x%d.pfm", 2, "inputs might be replaced");
    fails("convert in_%02d.pfm --out six/", 2, "six_%04d_%s.hdr");
    fails("convert in_%02d.pfm --to faces --out six_%s.pfm", 2, "six_%04d_%s.pfm");
    fails("convert in_%02d.pfm --to faces --out six_%d.pfm", 2, "one number and one %s");
    fails("convert in_%02d.pfm --to faces --out six_%d_%s_%d.pfm", 2, "one number and one %s");
    fails("convert in_%02d.pfm --out out_%d_%d.pfm", 2, "one number");
    fails("convert in_%02d.pfm --frames 7..9 --out out_%d.pfm", 1, "in_");
    assert_int_equal(count_files("."), 4);
}

/* Each is told of the frame where it is so. */
static void what_is_odd_about_frames_is_told_with_their_names(void **state)
{
    (void)state;
    write_frames(2);
    map odd = make_map(HELIO_LAYOUT_LATLONG, 8, 4);
    odd.rgb[5] = NAN;
    write_map("in_02.pfm", &odd);
    free(odd.rgb);
    write_text("in_03.pfm", "no map");
    succeeds("convert in_%02d.pfm --frames 0..2 --out out_%d.pfm");
    assert_non_null(strstr(program_err, "in_02.pfm is 8x4 pixels, where the frame before it was 4x2"));
    assert_non_null(strstr(program_err, "in_02.pfm has 1 bad pixel"));
    assert_non_null(strstr(program_out, "3 frames of different sizes or layouts, the last of 8x4 latlong"));
    assert_int_equal(run_program("convert in_%02d.pfm --out out_%d.pfm"), 1);
    assert_non_null(strstr(program_err, "3 maps before it are written and stay, out_2.pfm is the last"));
    assert_non_null(strstr(program_err, "--on-missing"));
}

static void six_files_are_written_for_each_frame(void **state)
{
    (void)state;
    write_frames(2);
    succeeds("convert in_%02d.pfm --to faces --env-size 3 --out six_%03d_%s.pfm");
    assert_non_null(strstr(program_out, "2 frames of six files of 3x3, the faces of a cube"));
    assert_true(first_of("six_000_px.pfm") == 1 && first_of("six_001_px.pfm") == 2);
    assert_int_equal(count_files("."), 3 + 12);
    succeeds("convert in_00.pfm --env-size 3 --out folder/");
    assert_non_null(strstr(program_out, "folder/: six files of 3x3, the faces of a cube"));
}

/* PFM and PNG hold no layout, and squares may be any. */
static void a_layout_that_the_file_cannot_tell_is_warned_of(void **state)
{
    (void)state;
    succeeds("convert constant:1,1,1 --to octahedral --env-size 4 --out a.pfm");
    assert_non_null(strstr(program_err, "a.pfm cannot tell that its layout is octahedral: read it with --layout"));
    succeeds("convert constant:1,1,1 --to octahedral --env-size 4 --out a.hdr");
    assert_string_equal(program_err, "");
    succeeds("convert constant:1,1,1 --to cross-v --env-size 4 --out b.pfm");
    assert_string_equal(program_err, "");
}

static void a_sky_is_converted(void **state)
{
    (void)state;
    succeeds("convert sky:azimuth=250,elevation=40 --env-size 64 --out sky.pfm");
    has_size("sky.pfm", 256, 128);
    json_t *seen = inspect("sky.pfm");
    const json_t *sun = json_object_get(seen, "brightest");
    assert_true(fabs(number_of(sun, "azimuth") - 250) < 1 && fabs(number_of(sun, "elevation") - 40) < 1);
    json_decref(seen);
    succeeds("convert sky:day --day-frames 3 --env-size 8 --rotate 45 --out day_%d.pfm");
    assert_true(exists("day_0.pfm") && exists("day_2.pfm") && !exists("day_3.pfm"));
    has_size("day_2.pfm", 32, 16);
}

/* ---- failures ------------------------------------------------------------------------------ */

static void mistakes_on_the_command_line_are_one_sentence(void **state)
{
    (void)state;
    map smooth = make_smooth();
    write_map("a.pfm", &smooth);
    free(smooth.rgb);
    fails("convert", 2, "convert needs an environment map");
    fails("convert a.pfm", 2, "--out PATH");
    fails("convert a.pfm --out b.tiff", 2, ".hdr");
    fails("convert a.pfm b.pfm --out c.pfm", 2, "takes one input");
    fails("convert a.pfm --to sphere --out b.pfm", 2, "octahedral");
    fails("convert a.pfm --env-size 0 --out b.pfm", 2, "1 to 4096");
    fails("convert a.pfm --env-size 8 --size 8x4 --out b.pfm", 2, "give one of them");
    fails("convert a.pfm --to strip --size 8x4 --out b.pfm", 2, "6:1 or 1:6");
    fails("convert a.pfm --to faces --size 8x4 --out b_%s.pfm", 2, "square");
    fails("convert a.pfm --to faces --out b.pfm", 2, "%s");
    fails("convert a.pfm --to strip --out b_%s.pfm", 2, "--to faces");
    fails("convert a.pfm --size 65536x65536 --out b.pfm", 2, "2^28");
    fails("convert constant:1,1 --out b.pfm", 2, "constant");
    fails("convert a.pfm --out a.pfm", 1, "would replace an input");
    fails("convert none.pfm --out b.pfm", 1, "none.pfm");
    fails("convert a.pfm --out none/b.pfm", 1, "none/");
    fails("convert a.pfm --max-pixels 100 --out b.pfm", 1, "a.pfm");
    fails("convert tetrahedron.obj --out b.pfm", 1, "tetrahedron.obj");
    convert("a.pfm", "--to octahedral", "square.pfm");
    fails("convert square.pfm --to latlong --out b.pfm", 1, "octahedral");
    fails("convert square.pfm --layout cross-v --out b.pfm", 1, "3:4");
    assert_false(exists("b.pfm"));
}

static void a_full_disk_leaves_the_old_file(void **state)
{
    (void)state;
    write_text("old.pfm", "old");
    program_limits.file_size = 1000;
    fails("convert constant:1,1,1 --size 64x32 --out old.pfm", 1, "old.pfm cannot be written");
    fails("convert constant:1,1,1 --to faces --size 32x32 --out f_%s.pfm", 1, "cannot be written");
    program_limits.file_size = 0;
    char text[16];
    read_text("old.pfm", text, sizeof text);
    assert_string_equal(text, "old");
    assert_int_equal(count_files("."), 2); /* and tetrahedron.obj */
}

static void ctrl_c_keeps_the_frames_that_are_done(void **state)
{
    (void)state;
    pid_t child = start_program("convert sky:day --day-frames 100000 --env-size 32 --verbose --out day_%06d.pfm");
    assert_true(program_says("day_000002.pfm"));
    kill(child, SIGINT);
    assert_int_equal(finish_program(child, NULL), 130);
    assert_non_null(strstr(program_err, "stopped after"));
    has_size("day_000002.pfm", 128, 64);
    assert_false(exists("day_099999.pfm"));
}

static void help_tells_all_options(void **state)
{
    (void)state;
    static const char *const words[] = {"--to L",     "--out PATH",    "--env-size R", "--size WxH", "--half",
                                        "--exposure", "--tonemap",     "--rotate",     "--flip",     "--intensity",
                                        "--layout L", "--frames A..B", "--max-pixels", "mirrorball", "Examples"};
    succeeds("convert --help");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(program_out, words[i]) == NULL)
            fail_msg("convert --help does not tell of %s", words[i]);
}

/* A pattern as the first argument picks tests. */
int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        program_test(light_stays_where_it_is_between_all_pairs_of_layouts),
        program_test(layouts_of_a_cube_keep_every_bit),
        program_test(a_sun_of_one_pixel_keeps_its_flux_when_the_map_shrinks),
        program_test(the_size_follows_from_the_input_or_from_options),
        program_test(other_formats_change_no_pixel),
        program_test(half_floats_that_lose_light_are_refused),
        program_test(a_png_loses_range_with_a_warning),
        program_test(a_sequence_of_png_keeps_the_exposure_of_its_first_frame),
        program_test(options_without_effect_are_told),
        program_test(bad_pixels_become_dark_and_are_told),
        program_test(turns_are_baked_in),
        program_test(square_turns_keep_every_bit),
        program_test(intensity_is_baked_in),
        program_test(six_files_come_back),
        program_test(sequences_are_converted_frame_by_frame),
        program_test(a_sequence_has_its_folder_made),
#ifdef HELIO_WITH_FFMPEG
        program_test(video_is_converted_by_its_transfer),
#endif
        program_test(mistakes_about_sequences_are_told),
        program_test(what_is_odd_about_frames_is_told_with_their_names),
        program_test(six_files_are_written_for_each_frame),
        program_test(a_layout_that_the_file_cannot_tell_is_warned_of),
        program_test(a_sky_is_converted),
        program_test(mistakes_on_the_command_line_are_one_sentence),
        program_test(a_full_disk_leaves_the_old_file),
        program_test(ctrl_c_keeps_the_frames_that_are_done),
        program_test(help_tells_all_options),
    };
    if (count > 1)
        cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests_name("convert", tests, set_up_program, tear_down_program);
}
