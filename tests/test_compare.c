/* SPDX-License-Identifier: MIT
 * compare: what it says of pictures whose differences are known. */
#include "program.h"

#include <heliostat/comparison.h>
#include <heliostat/image.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH = 24, HEIGHT = 16, PIXELS = WIDTH * HEIGHT };

/* ---- pictures ------------------------------------------------------------------------------ */

typedef struct test_picture {
    float rgba[PIXELS][4];
    float object[PIXELS];
} test_picture;

static void fill(test_picture *picture, float grey)
{
    for (size_t i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++)
            picture->rgba[i][c] = grey;
        picture->rgba[i][3] = 1;
    }
}

static void write_sized(const char *path, uint32_t width, uint32_t height, const test_picture *picture, bool has_object)
{
    helio_context *context = make_context(1, NULL);
    const helio_picture written = {
        .width = width, .height = height, .rgba = picture->rgba[0], .object = has_object ? picture->object : NULL};
    const helio_picture_write_desc desc = {.alpha = true};
    assert_ok(helio_picture_write(context, path, &written, &desc));
    helio_context_destroy(context);
}

static void write_picture(const char *path, const test_picture *picture)
{
    write_sized(path, WIDTH, HEIGHT, picture, false);
}

static void write_grey(const char *path, float grey)
{
    test_picture picture;
    fill(&picture, grey);
    write_picture(path, &picture);
}

/* Grey, with an object in the first pixels. */
static void write_object(const char *path, float grey, size_t covered, float coverage)
{
    test_picture picture;
    fill(&picture, grey);
    for (size_t i = 0; i < PIXELS; i++)
        picture.object[i] = i < covered ? coverage : 0;
    write_sized(path, WIDTH, HEIGHT, &picture, true);
}

/* To be given to helio_image_destroy() with the context. */
static helio_image *read_picture(helio_context *context, const char *path)
{
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    return image;
}

/* ---- findings ------------------------------------------------------------------------------ */

/* To be given to json_decref(). */
static json_t *compare(const char *words)
{
    char line[1024];
    assert_true(snprintf(line, sizeof line, "compare %s -q --json seen.json", words) < (int)sizeof line);
    succeeds(line);
    return load_json("seen.json");
}

static void assert_number(const json_t *object, const char *key, double wanted)
{
    double value = number_of(object, key);
    if (!(fabs(value - wanted) <= 1e-6 * fmax(1, fabs(wanted)))) /* JSON has nine digits, pictures are floats */
        fail_msg("%s is %.9g in place of %.9g", key, value, wanted);
}

static bool has_lab(void)
{
    return helio_comparison_has_lab();
}

/* ---- numbers ------------------------------------------------------------------------------- */

static void numbers_of_known_pictures(void **state)
{
    (void)state;
    write_grey("a.pfm", 0.75f);
    write_grey("b.pfm", 0.5f);
    json_t *seen = compare("a.pfm b.pfm --exposure 0");
    double encoded = 1.055 * (pow(0.75, 1 / 2.4) - pow(0.5, 1 / 2.4));
    assert_number(seen, "rmse", 0.25);
    assert_number(seen, "relmse", 0.0625 / (0.25 * 1.01));
    assert_number(seen, "psnr", -20 * log10(encoded));
    assert_number(seen, "pixels", PIXELS);
    assert_number(seen, "skipped", 0);
    if (has_lab()) /* greys have lightness alone */
        assert_number(seen, "lab_mean", 116 * (cbrt(0.75) - cbrt(0.5)));
    assert_true(number_of(seen, "flip") > 0.1 && number_of(seen, "flip") < 0.5);
    assert_null(json_object_get(seen, "flicker"));
    assert_string_equal(text_of(member(seen, "mask"), "from"), "all pixels");
    assert_true(json_is_null(member(member(seen, "mask"), "file")));
    assert_string_equal(text_of(member(seen, "viewing"), "white"), "D65");
    json_decref(seen);
    seen = compare("b.pfm b.pfm");
    assert_true(number_of(seen, "rmse") == 0 && number_of(seen, "flip") == 0 && json_is_null(member(seen, "psnr")));
    json_decref(seen);
}

static void text_tells_each_number_and_how_it_was_seen(void **state)
{
    (void)state;
    static const char *const words[] = {
        "a.pfm against b.pfm",     "rmse          0.25 ", "relmse        0.24752", "psnr ",     "flip ",
        "384 of 384 (all pixels)", "at +0.50 stops",      "tone map reinhard",     "white D65", "67 pixels per degree"};
    write_grey("a.pfm", 0.75f);
    write_grey("b.pfm", 0.5f);
    succeeds("compare a.pfm b.pfm --exposure 0.5 --tonemap reinhard");
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strstr(program_out, words[i]) == NULL)
            fail_msg("no \"%s\" in: %s", words[i], program_out);
    assert_null(strstr(program_out, "flicker"));
    if (has_lab())
        assert_true(strstr(program_out, "lab_mean") != NULL && strstr(program_out, "de2000_mean") != NULL);
    else
        assert_true(strstr(program_err, "no lcms2") != NULL && strstr(program_out, "lab_mean") == NULL);
}

/* In builds without lcms2 it is null, and cannot be drawn. */
static void lab_is_there_or_null(void **state)
{
    (void)state;
    write_grey("a.pfm", 0.75f);
    json_t *seen = compare("a.pfm a.pfm");
    assert_int_equal(json_is_null(member(seen, "lab_mean")), !has_lab());
    assert_int_equal(json_is_null(member(seen, "de2000_mean")), !has_lab());
    json_decref(seen);
    if (has_lab())
        succeeds("compare a.pfm a.pfm --out error.pfm");
    else
        fails("compare a.pfm a.pfm --out error.pfm", 2, "needs lcms2");
    succeeds("compare a.pfm a.pfm --out error.pfm --metric-map flip");
}

static void json_goes_to_standard_output(void **state)
{
    (void)state;
    write_grey("a.pfm", 0.75f);
    write_grey("b.pfm", 0.5f);
    succeeds("compare a.pfm b.pfm --json -");
    json_error_t error;
    json_t *seen = json_loads(program_out, JSON_REJECT_DUPLICATES, &error);
    assert_non_null(seen);
    assert_number(seen, "rmse", 0.25);
    json_decref(seen);
    static char first[sizeof program_out];
    strcpy(first, program_out);
    succeeds("compare a.pfm b.pfm --json --threads 3");
    assert_string_equal(program_out, first);
}

static double exposure_of(const char *words)
{
    json_t *seen = compare(words);
    double exposure = number_of(member(seen, "viewing"), "exposure");
    json_decref(seen);
    return exposure;
}

static void exposure_follows_the_reference(void **state)
{
    (void)state;
    write_grey("a.pfm", 3);
    write_grey("b.pfm", 0.2f);
    assert_true(fabs(exposure_of("a.pfm b.pfm") - 2) < 1e-5); /* 0.2 becomes 0.8 */
    assert_true(exposure_of("a.pfm b.pfm --exposure -1.5") == -1.5);
}

/* ---- masks --------------------------------------------------------------------------------- */

static void the_object_is_the_mask(void **state)
{
    (void)state;
    skip_without(NEEDS_EXR);
    write_object("a.exr", 0.75f, 40, 0.5f);
    write_object("other.exr", 0.5f, 60, 1);
    write_grey("plain.exr", 0.25f);
    json_t *seen = compare("a.exr other.exr");
    assert_number(seen, "pixels", 40);
    assert_string_equal(text_of(member(seen, "mask"), "from"), "object.A of the picture");
    assert_string_equal(text_of(member(seen, "mask"), "file"), "a.exr");
    json_decref(seen);
    seen = compare("plain.exr other.exr");
    assert_number(seen, "pixels", 60);
    assert_number(seen, "rmse", 0.25);
    assert_string_equal(text_of(member(seen, "mask"), "from"), "object.A of the reference");
    json_decref(seen);
    seen = compare("a.exr plain.exr --mask other.exr");
    assert_number(seen, "pixels", 60);
    assert_string_equal(text_of(member(seen, "mask"), "from"), "--mask");
    json_decref(seen);
}

static void masks_are_bright_or_opaque(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    test_picture mask;
    write_grey("a.pfm", 0.75f);
    write_grey("b.pfm", 0.5f);
    fill(&mask, 0);
    for (size_t i = 0; i < 30; i++)
        for (int c = 0; c < 3; c++)
            mask.rgba[i][c] = i < 20 ? 0.2158605f : 0.2086f; /* codes 128 and 126 of 255 */
    write_picture("bright.png", &mask);
    json_t *seen = compare("a.pfm b.pfm --mask bright.png");
    assert_number(seen, "pixels", 20);
    json_decref(seen);
    for (size_t i = 0; i < PIXELS; i++)
        mask.rgba[i][3] = i < 50 ? 1 : 0;
    write_picture("opaque.png", &mask);
    seen = compare("a.pfm b.pfm --mask opaque.png");
    assert_number(seen, "pixels", 50);
    json_decref(seen);
}

static void masks_without_pixels_are_told(void **state)
{
    (void)state;
    write_grey("a.pfm", 0.75f);
    write_grey("black.pfm", 0);
    fails("compare a.pfm a.pfm --mask black.pfm", 1, "black.pfm has no pixel");
    fails("compare a.pfm a.pfm --mask absent.pfm", 1, "absent.pfm");
    write_grey("nothing.pfm", NAN);
    assert_int_equal(run_program("compare a.pfm nothing.pfm"), 1);
    assert_true(strstr(program_err, "have no pixel to compare: all 384") != NULL && program_out[0] == 0);
}

/* ---- what cannot be compared --------------------------------------------------------------- */

static void bad_pixels_are_told_and_left_out(void **state)
{
    (void)state;
    test_picture picture;
    fill(&picture, 0.75f);
    picture.rgba[5][1] = NAN;
    picture.rgba[6][2] = INFINITY;
    picture.rgba[7][0] = -0.25f;
    write_picture("a.pfm", &picture);
    write_grey("b.pfm", 0.5f);
    succeeds("compare a.pfm b.pfm --json seen.json");
    assert_non_null(strstr(program_err, "2 pixels are NaN or infinite"));
    assert_non_null(strstr(program_out, "2 more are NaN or infinite"));
    json_t *seen = load_json("seen.json"), *bad = member(member(seen, "bad_pixels"), "picture");
    assert_number(seen, "pixels", PIXELS - 2);
    assert_number(seen, "skipped", 2);
    assert_true(number_of(bad, "nan") == 1 && number_of(bad, "inf") == 1 && number_of(bad, "negative") == 1);
    double count = 3.0 * (PIXELS - 2);
    assert_number(seen, "rmse", sqrt(((count - 1) * 0.0625 + 0.5625) / count));
    json_decref(seen);
}

static void pictures_of_two_kinds_are_told(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    write_grey("a.png", 0.5f);
    write_grey("b.pfm", 0.5f);
    succeeds("compare a.png b.pfm");
    assert_non_null(strstr(program_err, "a.png holds what a screen shows, and b.pfm radiance"));
    json_t *seen = compare("a.png a.png");
    assert_true(strstr(program_err, "a.png holds") == NULL && number_of(member(seen, "viewing"), "exposure") == 0);
    json_decref(seen);
}

static void mistakes_end_in_one_sentence(void **state)
{
    (void)state;
    test_picture small;
    fill(&small, 1);
    write_grey("a.pfm", 0.75f);
    write_sized("small.pfm", WIDTH, HEIGHT / 2, &small, false);
    fails("compare a.pfm small.pfm", 1, "24x16 pixels, and small.pfm has 24x8");
    fails("compare a.pfm a.pfm --mask small.pfm", 1, "the mask small.pfm has 24x8");
    fails("compare a.pfm absent.pfm", 1, "absent.pfm cannot be read");
    fails("compare absent.pfm a.pfm", 1, "absent.pfm cannot be read");
    write_text("broken.pfm", "PF\n24 16\n-1\nfew");
    fails("compare a.pfm broken.pfm", 1, "broken.pfm");
    fails("compare a.pfm", 2, "needs a picture and its reference");
    fails("compare a.pfm a.pfm a.pfm", 2, "takes a picture and its reference");
    fails("compare a.pfm a.pfm -q", 2, "would tell nothing");
    fails("compare a.pfm a.pfm -q -v", 2, "exclude each other");
    fails("compare a.pfm a.pfm --out error.bmp --metric-map flip", 2, "--out error.bmp");
    fails("compare a.pfm a.pfm --json x --out x", 2, "both name x");
    fails("compare a.pfm a.pfm --metric-map rmse", 2, "--metric-map takes lab, de2000, relative or flip");
    fails("compare a.pfm a.pfm --pixels-per-degree 0.5", 2, "--pixels-per-degree");
    fails("compare a.pfm small.pfm --max-pixels 9", 1, "a.pfm is too large");
}

static void inputs_are_never_replaced(void **state)
{
    (void)state;
    char before[1 << 13], after[1 << 13];
    write_grey("a.pfm", 0.75f);
    size_t length = read_text("a.pfm", before, sizeof before);
    assert_int_equal(link("a.pfm", "linked.pfm"), 0);
    fails("compare a.pfm a.pfm --out a.pfm --metric-map flip", 1, "would replace an input");
    fails("compare a.pfm a.pfm --out ./linked.pfm --metric-map flip", 1, "would replace an input");
    fails("compare a.pfm a.pfm --json a.pfm", 1, "would replace an input");
    write_grey("f_1.pfm", 0.75f);
    write_grey("f_2.pfm", 0.75f);
    fails("compare f_%d.pfm a.pfm --out f_%d.pfm --metric-map flip", 1, "makes names such as that of f_");
    assert_int_equal(read_text("a.pfm", after, sizeof after), length);
    assert_memory_equal(before, after, length);
    fails("compare a.pfm a.pfm --json nowhere/seen.json", 1, "nowhere");
}

/* ---- error maps ---------------------------------------------------------------------------- */

/* The left half is wrong by 0.5 in each channel. */
static void write_halves(void)
{
    test_picture picture, mask;
    fill(&picture, 1);
    fill(&mask, 1);
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            picture.rgba[i][c] = i % WIDTH < WIDTH / 2 ? 1.5f : 1;
            mask.rgba[i][c] = i < 2 * WIDTH ? 0 : 1;
        }
    write_picture("a.pfm", &picture);
    write_picture("mask.pfm", &mask);
    write_grey("b.pfm", 1);
}

static void errors_are_written_as_they_are(void **state)
{
    (void)state;
    write_halves();
    succeeds("compare a.pfm b.pfm --mask mask.pfm --out error.pfm --metric-map relative");
    helio_context *context = make_context(1, NULL);
    helio_image *image = read_picture(context, "error.pfm");
    assert_true(image->width == WIDTH && image->height == HEIGHT);
    for (size_t i = 0; i < PIXELS; i++) {
        float error = image->rgb[3 * i];
        double wanted = i % WIDTH < WIDTH / 2 ? 0.25 / 1.01 : 0;
        assert_true(i < 2 * WIDTH ? isnan(error) : fabs((double)error - wanted) < 1e-6);
    }
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

#ifdef HELIO_WITH_CAIRO
/* The map is drawn 20 times as large, from (20, 20) on; 12 pixels under it lies the scale of the same width. */
static const float *map_colour(const helio_image *image, uint32_t column, uint32_t row)
{
    return image->rgb + 3 * ((size_t)(20 + 20 * row + 10) * image->width + 20 + 20 * column + 10);
}

static const float *scale_colour(const helio_image *image, double position)
{
    size_t row = 20 + 20 * HEIGHT + 12 + 7, column = 20 + (size_t)fmin(position * 20 * WIDTH, 20 * WIDTH - 1);
    return image->rgb + 3 * (row * image->width + column);
}

static void assert_same_colour(const float *colour, const float *wanted)
{
    for (int c = 0; c < 3; c++)
        if (!(fabsf(colour[c] - wanted[c]) < 0.02f)) /* the scale has steps */
            fail_msg("channel %d is %g in place of %g", c, (double)colour[c], (double)wanted[c]);
}

static void check_figure(const char *words, double range)
{
    char line[256];
    snprintf(line, sizeof line, "compare a.pfm b.pfm --mask mask.pfm --out error.png --metric-map relative %s", words);
    succeeds(line);
    helio_context *context = make_context(1, NULL);
    helio_image *image = read_picture(context, "error.png");
    const float grey = (float)pow((0.3 + 0.055) / 1.055, 2.4), greys[3] = {grey, grey, grey};
    assert_true(image->width == 20 * WIDTH + 40 && image->height > 20 * HEIGHT + 40);
    assert_same_colour(map_colour(image, 3, 0), greys); /* not in the mask */
    assert_same_colour(map_colour(image, 20, 10), scale_colour(image, 0));
    assert_same_colour(map_colour(image, 3, 10), scale_colour(image, 0.25 / 1.01 / range));
    assert_true(scale_colour(image, 0)[0] < 0.05f && scale_colour(image, 1)[0] > 0.9f);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}
#endif

static void errors_are_drawn(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
#ifndef HELIO_WITH_CAIRO
    write_halves();
    fails("compare a.pfm b.pfm --out error.png --metric-map relative", 2, "no cairo");
#else
    write_halves();
    check_figure("--range 100", 100);
    check_figure("--range 0.2", 0.2); /* which the error exceeds */
    check_figure("--range 0.4", 0.4);
    check_figure("", 0.5); /* the round number above 0.2475 */
    succeeds("compare a.pfm b.pfm --out error.svg --metric-map flip");
    succeeds("compare a.pfm b.pfm --out error.pdf --metric-map flip");
    char start[1 << 18];
    read_text("error.pdf", start, sizeof start);
    assert_memory_equal(start, "%PDF", 4);
    read_text("error.svg", start, sizeof start);
    assert_non_null(strstr(start, "<svg"));
#endif
}

/* ---- sequences ----------------------------------------------------------------------------- */

/* References of 2, pictures off by 0.5 in turn: numbered 8 ... 11. */
static void write_sequence(void)
{
    assert_int_equal(mkdir("a", 0777), 0);
    assert_int_equal(mkdir("b", 0777), 0);
    for (int i = 8; i < 12; i++) {
        char path[32];
        snprintf(path, sizeof path, "a/f_%d.pfm", i);
        write_grey(path, i % 2 == 0 ? 2.5f : 1.5f);
        snprintf(path, sizeof path, "b/f_%d.pfm", i);
        write_grey(path, 2);
    }
}

static void check_sequence(const char *words, size_t count, double first)
{
    double relmse = 0.25 / (4 * 1.01);
    json_t *seen = compare(words), *frames = member(seen, "frames");
    assert_int_equal(json_array_size(frames), count);
    assert_number(seen, "relmse", relmse);
    assert_number(seen, "flicker", 2 * relmse);
    assert_number(seen, "flicker_rmse", 1);
    assert_number(seen, "pixels", (double)(count * PIXELS));
    for (size_t i = 0; i < count; i++) {
        json_t *frame = json_array_get(frames, i);
        assert_number(frame, "index", first + (double)i);
        assert_number(frame, "rmse", 0.5);
        assert_true(i == 0 ? json_is_null(member(frame, "flicker")) : number_of(frame, "flicker") > relmse);
    }
    json_decref(seen);
}

static void flicker_of_a_known_sequence(void **state)
{
    (void)state;
    write_sequence();
    check_sequence("a/f_%d.pfm b/f_%d.pfm", 4, 8);
    check_sequence("a/f_%d.pfm b/f_%d.pfm --frames 9..11", 3, 9);
    check_sequence("a/f_*.pfm b/f_*.pfm", 4, 0); /* 8 comes before 10: else the error would not alternate */
    check_sequence("a b/", 4, 0);
    check_sequence("a/ b --frames 1..2", 2, 1);
    check_sequence("a/f_%d.pfm b/f_8.pfm", 4, 8); /* one reference for all */
    succeeds("compare a b");
    assert_true(strstr(program_out, "4 frames") != NULL && strstr(program_out, "flicker ") != NULL);
}

static void errors_of_sequences_are_written_one_by_one(void **state)
{
    (void)state;
    write_sequence();
    fails("compare a b --out error.pfm --metric-map relative", 2, "error_%04d.pfm");
    succeeds("compare a/f_%d.pfm b/f_%d.pfm --out error_%03d.pfm --metric-map relative");
    assert_true(exists("error_008.pfm") && exists("error_009.pfm") && exists("error_010.pfm") &&
                exists("error_011.pfm"));
}

static void sequences_that_do_not_fit_are_told(void **state)
{
    (void)state;
    test_picture small;
    fill(&small, 1);
    write_sequence();
    fails("compare a/f_%d.pfm b/f_%d.pfm --frames 20..30", 1, "no frame from 20 to 30");
    fails("compare a/f_%d.pfm b/g_*.pfm", 1, "fits b/g_*.pfm");
    fails("compare a/f_8.pfm b", 1, "has 1 picture, but b has 4");
    write_grey("a/f_12.pfm", 1);
    fails("compare a/f_%d.pfm b/f_%d.pfm", 1, "b/f_%d.pfm has no frame 12");
    fails("compare a b", 1, "a has 5 pictures, but b has 4");
    write_grey("b/g_1.pfm", 1);
    fails("compare a b", 1, "different names");
    write_sized("a/f_9.pfm", WIDTH, HEIGHT / 2, &small, false);
    write_sized("b/f_9.pfm", WIDTH, HEIGHT / 2, &small, false);
    assert_int_equal(run_program("compare a/f_%d.pfm b/f_%d.pfm --frames 8..11 --exposure 0"), 1);
    assert_non_null(strstr(program_err, "f_9.pfm has 24x8 pixels, where other frames have 24x16"));
    assert_int_equal(mkdir("empty", 0777), 0);
    fails("compare empty b", 1, "the folder empty holds no pictures");
}

/* Without regard to the darkness in which the sequence begins. */
static void exposure_of_a_sequence_is_that_of_its_middle(void **state)
{
    (void)state;
    static const float greys[] = {0.001f, 0.01f, 0.2f, 0.002f};
    for (int i = 0; i < 4; i++) {
        char path[32];
        snprintf(path, sizeof path, "m_%d.pfm", i);
        write_grey(path, greys[i]);
    }
    assert_true(fabs(exposure_of("m_%d.pfm m_%d.pfm") - 2) < 1e-5);
}

/* ---- render --reference -------------------------------------------------------------------- */

#define SMALL "render --mesh tetrahedron.obj --size 32x24 --env-size 8 "

/* A map of two lights, so that few samples are noisy. */
static void write_map(const char *path, float light)
{
    test_picture map;
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            map.rgba[i][c] = i % 7 == 0 ? light : 0.1f;
    write_sized(path, 16, 8, &map, false);
}

/* The same numbers as compare has. */
static void assert_same_errors(const json_t *stats, size_t i, const char *picture, const char *reference)
{
    char words[256];
    json_t *error = member(json_array_get(member(stats, "frames"), i), "error");
    double exposure = number_of(member(stats, "summary"), "ev");
    snprintf(words, sizeof words, "%s %s --exposure=%.9g", picture, reference, exposure);
    json_t *seen = compare(words);
    assert_true(number_of(error, "relmse") > 0);
    assert_number(seen, "relmse", number_of(error, "relmse"));
    if (has_lab())
        assert_number(seen, "lab_mean", number_of(error, "lab_mean"));
    else
        assert_true(json_is_null(member(error, "lab_mean")));
    assert_string_equal(text_of(member(seen, "mask"), "from"), "object.A of the picture");
    json_decref(seen);
}

static void render_measures_its_error(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    write_map("map.pfm", 5);
    succeeds(SMALL "--env map.pfm --spp 256 --seed 3 --out truth.exr");
    succeeds(SMALL "--env map.pfm --spp 2 --out noisy.exr --reference truth.exr --stats stats.json -v");
    assert_non_null(strstr(program_err, "mean error against truth.exr: relmse "));
    json_t *stats = load_json("stats.json");
    assert_same_errors(stats, 0, "noisy.exr", "truth.exr");
    json_decref(stats);
    succeeds(SMALL "--env map.pfm --spp 2 --out noisy.exr --stats stats.json");
    stats = load_json("stats.json");
    assert_null(json_object_get(json_array_get(member(stats, "frames"), 0), "error"));
    json_decref(stats);
}

static void render_measures_sequences_frame_by_frame(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    write_map("map_3.pfm", 5);
    write_map("map_4.pfm", 20);
    succeeds(SMALL "--env map_%d.pfm --spp 256 --seed 3 --out truth_%d.exr");
    succeeds(SMALL "--env map_%d.pfm --spp 2 --out noisy_%d.exr --reference truth_%d.exr --stats stats.json -v");
    assert_non_null(strstr(program_err, "mean error against truth_%d.exr: relmse "));
    json_t *stats = load_json("stats.json");
    assert_same_errors(stats, 0, "noisy_3.exr", "truth_3.exr");
    assert_same_errors(stats, 1, "noisy_4.exr", "truth_4.exr");
    json_decref(stats);
    assert_int_equal(unlink("truth_4.exr"), 0);
    assert_int_equal(run_program(SMALL "--env map_%d.pfm --spp 2 --out noisy_%d.exr --reference truth_%d.exr -v"), 1);
    assert_true(strstr(program_err, "truth_4.exr cannot be opened") && strstr(program_err, "1 of 2 frames written"));
    assert_int_equal(run_program(SMALL "--env map_%d.pfm --spp 2 --out truth_%d.exr --reference truth_%d.exr -v"), 1);
    assert_non_null(strstr(program_err, "truth_3.exr would replace an input"));
}

static void references_that_cannot_be_used_are_told(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm", 5);
    write_grey("small.pfm", 1);
    fails(SMALL "--env map.pfm --out a.pfm --stats s.json --reference small.pfm", 1,
          "small.pfm has 24x16 pixels, and what is rendered 32x24");
    fails(SMALL "--env map.pfm --out a.pfm --stats s.json --reference absent.pfm", 1, "absent.pfm");
    fails(SMALL "--env map.pfm --out small.pfm --stats s.json --reference small.pfm", 1, "would replace an input");
    fails(SMALL "--env map.pfm --out a.pfm --stats small.pfm --reference small.pfm", 1, "would replace an input");
    assert_false(exists("a.pfm"));
    succeeds(SMALL "--env map.pfm --spp 1 --size 24x16 --out a.pfm --reference small.pfm");
    assert_non_null(strstr(program_err, "--reference changes nothing"));
}

#define TEST(name) cmocka_unit_test_setup(name, set_up_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(numbers_of_known_pictures),
        TEST(text_tells_each_number_and_how_it_was_seen),
        TEST(lab_is_there_or_null),
        TEST(json_goes_to_standard_output),
        TEST(exposure_follows_the_reference),
        TEST(the_object_is_the_mask),
        TEST(masks_are_bright_or_opaque),
        TEST(masks_without_pixels_are_told),
        TEST(bad_pixels_are_told_and_left_out),
        TEST(pictures_of_two_kinds_are_told),
        TEST(mistakes_end_in_one_sentence),
        TEST(inputs_are_never_replaced),
        TEST(errors_are_written_as_they_are),
        TEST(errors_are_drawn),
        TEST(flicker_of_a_known_sequence),
        TEST(errors_of_sequences_are_written_one_by_one),
        TEST(sequences_that_do_not_fit_are_told),
        TEST(exposure_of_a_sequence_is_that_of_its_middle),
        TEST(render_measures_its_error),
        TEST(render_measures_sequences_frame_by_frame),
        TEST(references_that_cannot_be_used_are_told),
    };
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
