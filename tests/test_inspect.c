/* SPDX-License-Identifier: MIT
 * inspect: what it finds in maps that are known, as JSON, as text and as a picture. */
#include "program.h"

#include <heliostat/image.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- maps ---------------------------------------------------------------------------------- */

enum { WIDTH = 512, HEIGHT = 256 };

static const double PI = 3.14159265358979323846;
static const double NOWHERE = 1e30; /* to clip at */

static float *even_map(float radiance)
{
    float *rgb = malloc(3 * WIDTH * HEIGHT * sizeof *rgb);
    assert_non_null(rgb);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        rgb[i] = radiance;
    return rgb;
}

static void set_grey(float *rgb, uint32_t row, uint32_t column, float radiance)
{
    for (size_t c = 0; c < 3; c++)
        rgb[3 * ((size_t)row * WIDTH + column) + c] = radiance;
}

static void write_latlong(const char *path, uint32_t width, uint32_t height, const float *rgb)
{
    helio_context *context = make_context(1, NULL);
    const helio_map map = {.width = width, .height = height, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    assert_ok(helio_map_write(context, path, &map, NULL));
    helio_context_destroy(context);
}

/* Solid angle of a pixel of a lat-long map of WIDTH x HEIGHT pixels. */
static double pixel_area(uint32_t row)
{
    return 2 * PI / WIDTH * (cos(PI * row / HEIGHT) - cos(PI * (row + 1) / HEIGHT));
}

/* ---- findings ------------------------------------------------------------------------------ */

/* To be given to json_decref(). */
static json_t *inspect(const char *source_and_options)
{
    char line[TEST_PATH_SIZE + 64];
    assert_true(snprintf(line, sizeof line, "inspect %s -q --json seen.json", source_and_options) < (int)sizeof line);
    succeeds(line);
    return load_json("seen.json");
}

static bool is_clipped(const json_t *seen)
{
    return json_is_true(member(member(seen, "clipping"), "is_clipped"));
}

static const char *clipping_of(const json_t *seen)
{
    return text_of(member(seen, "clipping"), "reason");
}

static void assert_close(double value, double wanted, double part)
{
    if (!(fabs(value - wanted) <= part * fabs(wanted)))
        fail_msg("%.9g in place of %.9g", value, wanted);
}

static void even_light_has_no_range_and_no_spot(void **state)
{
    (void)state;
    json_t *seen = inspect("constant:2,2,2");
    assert_close(number_of(seen, "flux"), 2 * 4 * PI, 1e-5);
    assert_true(number_of(seen, "dynamic_range_stops") == 0);
    assert_close(number_of(member(seen, "luminance"), "max"), 2, 1e-6);
    assert_close(number_of(member(seen, "luminance"), "min"), 2, 1e-6);
    assert_close(number_of(member(seen, "luminance"), "mean"), 2, 1e-5);
    assert_close(number_of(seen, "irradiance"), 2 * PI, 1e-3); /* cosines are taken at the middle of 64 x 64 texels */
    assert_close(number_of(member(seen, "face_flux"), "-Z"), 2 * 4 * PI / 6, 1e-5);
    assert_true(json_is_null(member(seen, "brightest")));
    assert_false(is_clipped(seen));
    assert_string_equal(text_of(member(seen, "file"), "kind"), "constant light");
    json_decref(seen);
}

static void no_light_is_no_error(void **state)
{
    (void)state;
    json_t *seen = inspect("constant:0,0,0");
    assert_true(number_of(seen, "flux") == 0 && number_of(seen, "dynamic_range_stops") == 0);
    assert_true(number_of(seen, "dark_pixels") == 1);
    assert_string_equal(text_of(seen, "advice"), "the map gives no light");
    json_decref(seen);
}

static void bad_pixels_are_counted_by_kind(void **state)
{
    (void)state;
    float *rgb = even_map(1);
    rgb[0] = NAN;
    rgb[300] = NAN;
    rgb[601] = INFINITY;
    rgb[902] = -1;
    rgb[1200] = -1;
    rgb[1501] = -1;
    write_latlong("bad.pfm", WIDTH, HEIGHT, rgb);
    json_t *seen = inspect("bad.pfm"), *bad = member(seen, "bad_pixels");
    assert_true(number_of(bad, "nan") == 2 && number_of(bad, "inf") == 1);
    assert_true(number_of(bad, "negative") == 3 && number_of(bad, "out_of_gamut") == 0);
    assert_true(number_of(seen, "pixels") == WIDTH * HEIGHT && number_of(seen, "dark_pixels") == 3);
    json_decref(seen);
    succeeds("inspect bad.pfm");
    assert_non_null(strstr(program_out, "2 NaN, 1 infinite, 3 negative, 0 out of gamut"));
    free(rgb);
}

/* One pixel above the horizon: +X is a quarter from the left, so azimuth 90 from -Z. */
static void the_brightest_spot_is_found(void **state)
{
    (void)state;
    enum { ROW = 80, COLUMN = WIDTH / 4 };
    float *rgb = even_map(1);
    set_grey(rgb, ROW, COLUMN, 50000);
    write_latlong("sun.pfm", WIDTH, HEIGHT, rgb);
    json_t *seen = inspect("sun.pfm"), *spot = member(seen, "brightest");
    double flux = 50000 * pixel_area(ROW), elevation = 90 - 180 * (ROW + 0.5) / HEIGHT;
    assert_true(fabs(number_of(spot, "azimuth") - 90) < 1 && fabs(number_of(spot, "elevation") - elevation) < 1);
    assert_true(json_number_value(json_array_get(member(spot, "direction"), 0)) > 0.8);
    assert_close(number_of(spot, "flux_share"), flux / (flux + 4 * PI), 0.02);
    double up = flux * sin(elevation * PI / 180);
    assert_close(number_of(spot, "irradiance_share"), up / (up + PI), 0.02);
    assert_close(number_of(member(seen, "luminance"), "max"), 50000, 1e-6);
    assert_close(number_of(seen, "dynamic_range_stops"), log2(50000), 1e-6);
    assert_close(number_of(seen, "flux"), flux + 4 * PI, 1e-3);
    assert_false(is_clipped(seen));
    json_decref(seen);
    free(rgb);
}

/* Nothing but this pixel gives light, so that all of it is the spot's, however the texels of the cube divide it. */
static void a_single_lit_pixel_gives_all_light(void **state)
{
    (void)state;
    float *rgb = even_map(0);
    set_grey(rgb, 77, 311, 26432);
    write_latlong("one.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    json_t *seen = inspect("one.pfm"), *spot = member(seen, "brightest");
    assert_true(number_of(spot, "flux_share") > 0.99999 && number_of(spot, "irradiance_share") > 0.9999);
    assert_true(number_of(spot, "max_luminance") <= number_of(member(seen, "luminance"), "max"));
    assert_close(number_of(spot, "edge"), 0.1, 1e-9);
    json_decref(seen);
    succeeds("inspect one.pfm");
    assert_non_null(strstr(program_out, "luminance of pixels 0 to 26432"));
    assert_non_null(strstr(program_out, "averaged over a texel of a cube"));
    assert_non_null(strstr(program_out, "gives 100.0 % of all light"));
}

/* Most of the sphere has a tenth of the greatest luminance or more, here below the horizon. */
static void the_spot_of_a_smooth_map_is_where_it_is_brightest(void **state)
{
    (void)state;
    float *rgb = even_map(0);
    for (uint32_t row = 0; row < HEIGHT; row++)
        for (uint32_t column = 0; column < WIDTH; column++) {
            double polar = PI * (row + 0.5) / HEIGHT, around = 2 * PI * (column + 0.5) / WIDTH;
            double apart = sin(polar) * cos(around - PI / 2); /* cosine of the angle to azimuth 90 on the horizon */
            set_grey(rgb, row, column, (float)exp(1.2 * apart));
        }
    write_latlong("smooth.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    json_t *seen = inspect("smooth.pfm"), *spot = member(seen, "brightest");
    assert_true(fabs(number_of(spot, "azimuth") - 90) < 1 && fabs(number_of(spot, "elevation")) < 1);
    assert_true(number_of(spot, "solid_angle") < 0.9);
    assert_close(number_of(spot, "edge"), 0.9, 1e-9);
    json_decref(seen);
    seen = inspect("sky:day"); /* dawn: the brightest part is low, and no half of the sky */
    spot = member(seen, "brightest");
    assert_true(number_of(spot, "elevation") < 10 && number_of(spot, "solid_angle") < 0.2);
    json_decref(seen);
    succeeds("inspect smooth.pfm");
    const char *disc = strstr(program_out, "as a disc of ");
    assert_non_null(disc);
    double degrees = strtod(disc + strlen("as a disc of "), NULL);
    char plain[48];
    snprintf(plain, sizeof plain, "as a disc of %.0f degrees", degrees); /* no exponent */
    assert_true(degrees >= 10 && degrees < 60 && strstr(program_out, plain) != NULL);
}

/* At the azimuths where it may go wrong: both ends of the map, and a corner of the cube. */
static void spots_across_edges_are_one(void **state)
{
    (void)state;
    static const uint32_t columns[] = {0, WIDTH - 2, WIDTH / 8 - 1};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        float *rgb = even_map(0.1f);
        for (uint32_t row = 76; row < 78; row++)
            for (uint32_t column = columns[i]; column < columns[i] + 2; column++)
                set_grey(rgb, row, column, (float)(900 + 10 * row + column)); /* no plateau */
        write_latlong("edge.pfm", WIDTH, HEIGHT, rgb);
        json_t *seen = inspect("edge.pfm"), *spot = member(seen, "brightest");
        double area = 2 * (pixel_area(76) + pixel_area(77)), azimuth = 360.0 * (columns[i] + 1) / WIDTH;
        assert_true(fabs(remainder(number_of(spot, "azimuth") - azimuth, 360)) < 1.5);
        double found = number_of(spot, "solid_angle");
        assert_true(found > area && found < 4 * area); /* texels that it covers in part count whole */
        json_decref(seen);
        free(rgb);
    }
}

/* ---- clipping ------------------------------------------------------------------------------ */

/* A sky with a round glow and a sun in it whose middle is this bright; no two pixels are equal. */
static float *sky_with_sun(double sun, double clip)
{
    float *rgb = even_map(0);
    for (uint32_t row = 0; row < HEIGHT; row++)
        for (uint32_t column = 0; column < WIDTH; column++) {
            double x = column - 200.3, y = row - 60.2, apart = x * x + y * y;
            double sky = row < HEIGHT / 2 ? 1 + 0.001 * column : 0.2;
            set_grey(rgb, row, column, (float)fmin(sky + 20 * exp(-apart / 20) + sun * exp(-apart), clip));
        }
    return rgb;
}

static void check_clipping(const float *rgb, const char *reason)
{
    write_latlong("sky.pfm", WIDTH, HEIGHT, rgb);
    json_t *seen = inspect("sky.pfm");
    if (strcmp(clipping_of(seen), reason) != 0)
        fail_msg("\"%s\" in place of \"%s\"", clipping_of(seen), reason);
    assert_int_equal(is_clipped(seen), strcmp(reason, "none") != 0);
    json_decref(seen);
}

static void clipped_suns_are_recognised(void **state)
{
    (void)state;
    float *whole = sky_with_sun(20000, NOWHERE), *clipped = sky_with_sun(20000, 300);
    check_clipping(whole, "none");
    check_clipping(clipped, "plateau");
    free(whole);
    free(clipped);
}

static void suns_with_too_little_light_are_recognised(void **state)
{
    (void)state;
    float *weak = sky_with_sun(300, NOWHERE), *glow = sky_with_sun(0, NOWHERE);
    check_clipping(weak, "weak");
    check_clipping(glow, "none"); /* a bright part of the sky, but nothing of the sun's size */
    free(weak);
    free(glow);
}

/* Some pixels at 65504, as programs write what half floats cannot hold. */
static void the_end_of_half_floats_is_recognised(void **state)
{
    (void)state;
    float *rgb = sky_with_sun(200000, 65504);
    check_clipping(rgb, "half");
    free(rgb);
}

static void white_is_clipped_in_eight_bits(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    float *rgb = sky_with_sun(20000, NOWHERE);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        rgb[i] *= 0.3f;
    write_latlong("sky.png", WIDTH, HEIGHT, rgb);
    json_t *seen = inspect("sky.png");
    assert_string_equal(clipping_of(seen), "white");
    assert_string_equal(text_of(member(seen, "file"), "kind"), "PNG");
    json_decref(seen);
    free(rgb);
}

static void check_captured(const char *name, double irradiance_share)
{
    char path[TEST_PATH_SIZE];
    find_test_data(name, path);
    json_t *seen = inspect(path);
    assert_string_equal(clipping_of(seen), "none");
    assert_close(number_of(member(seen, "brightest"), "irradiance_share"), irradiance_share, 0.05);
    json_decref(seen);
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    for (size_t i = 0; i < 3 * (size_t)image->width * image->height; i++)
        image->rgb[i] = fminf(image->rgb[i], 1000);
    write_latlong("clipped.hdr", image->width, image->height, image->rgb);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
    seen = inspect("clipped.hdr");
    assert_string_equal(clipping_of(seen), "plateau");
    assert_non_null(strstr(text_of(seen, "advice"), "is clipped"));
    json_decref(seen);
}

/* The shares that the data set's own list gives, within 2.5 degrees of the brightest pixel: 0.825, 0.715, 0.594. */
static void captured_suns_are_whole_and_their_clipped_copies_are_not(void **state)
{
    (void)state;
    check_captured("environments/latlong/kloppenheim_05_1k.hdr", 0.825);
    check_captured("environments/latlong/spiaggia_di_mondello_1k.hdr", 0.715);
    check_captured("environments/latlong/pmndrs_park.hdr", 0.594);
}

/* ---- layouts ------------------------------------------------------------------------------- */

static void layouts_are_told_with_the_reason(void **state)
{
    (void)state;
    static const struct {
        const char *options, *path, *name, *found;
    } cases[] = {
        {"--to latlong", "a.pfm", "latlong", "by its shape"},
        {"--to cross-v", "b.pfm", "cross-v", "by its shape"},
        {"--to cross-h", "c.pfm", "cross-h", "by its shape"},
        {"--to angular", "d.hdr", "angular", "as its files say"},
        {"--to octahedral", "e.pfm --layout octahedral", "octahedral", "as --layout says"},
    };
    const float grey = 1 + 1 / 256.0f; /* which RGBE holds */
    float *rgb = even_map(grey);
    write_latlong("map.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char line[128], file[32];
        snprintf(file, sizeof file, "%.5s", cases[i].path);
        snprintf(line, sizeof line, "convert map.pfm -q %s --out %s", cases[i].options, file);
        succeeds(line);
        json_t *seen = inspect(cases[i].path), *layout = member(seen, "layout");
        assert_string_equal(text_of(layout, "name"), cases[i].name);
        assert_string_equal(text_of(layout, "found"), cases[i].found);
        /* What crosses and discs leave empty is no dark part of the map; discs have some grey at their rims. */
        assert_true(number_of(seen, "dark_pixels") == 0);
        assert_close(number_of(seen, "flux"), (double)grey * 4 * PI, 1e-4);
        json_decref(seen);
    }
}

static void six_files_are_called_faces(void **state)
{
    (void)state;
    succeeds("convert constant:1,2,3 --to faces --env-size 2 --out cube_%s.hdr");
    json_t *seen = inspect("cube_%s.hdr");
    assert_string_equal(text_of(member(seen, "file"), "kind"), "six files");
    assert_string_equal(text_of(member(seen, "layout"), "name"), "faces");
    assert_string_equal(text_of(member(seen, "layout"), "found"), "as its files say");
    json_decref(seen);
}

static void skies_and_sequences_can_be_inspected(void **state)
{
    (void)state;
    json_t *seen = inspect("sky:azimuth=120,elevation=50"), *spot = member(seen, "brightest");
    assert_true(fabs(number_of(spot, "azimuth") - 120) < 0.5 && fabs(number_of(spot, "elevation") - 50) < 0.5);
    assert_false(is_clipped(seen));
    assert_true(json_is_null(member(member(seen, "layout"), "name")));
    json_decref(seen);
    for (int i = 3; i < 6; i++) {
        char line[96];
        snprintf(line, sizeof line, "convert constant:%d,%d,%d -q --out frame_%d.pfm", i, i, i, i);
        succeeds(line);
    }
    seen = inspect("frame_%d.pfm");
    assert_true(number_of(member(seen, "file"), "frame") == 3);
    assert_true(json_is_true(member(member(seen, "file"), "is_one_of_several")));
    assert_close(number_of(seen, "flux"), 3 * 4 * PI, 1e-5);
    json_decref(seen);
    seen = inspect("frame_%d.pfm --frames 5..5");
    assert_close(number_of(seen, "flux"), 5 * 4 * PI, 1e-5);
    json_decref(seen);
    succeeds("inspect frame_%d.pfm");
    assert_non_null(strstr(program_out, "this is frame 3 of several"));
}

/* ---- outputs ------------------------------------------------------------------------------- */

static void json_goes_to_standard_output_for_a_dash(void **state)
{
    (void)state;
    succeeds("inspect constant:1,1,1 --json -");
    json_t *seen = json_loads(program_out, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(seen);
    assert_close(number_of(seen, "flux"), 4 * PI, 1e-5);
    json_decref(seen);
}

static void text_tells_what_json_tells(void **state)
{
    (void)state;
    static const char *const words[] = {"layout",     "range",          "dynamic range", "mean",    "flux",  "+Z",
                                        "bad pixels", "brightest spot", "elevation",     "clipped", "advice"};
    float *rgb = sky_with_sun(20000, 300);
    write_latlong("sky.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    succeeds("inspect sky.pfm --verbose --threads 1");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(program_out, words[i]) == NULL)
            fail_msg("no \"%s\" in: %s", words[i], program_out);
    assert_non_null(strstr(program_out, "PFM, 512 x 256 pixels"));
    assert_non_null(strstr(program_out, "pixels share the greatest value, 300"));
}

#ifdef HELIO_WITH_CAIRO
static void starts_with(const char *path, const char *bytes, size_t count)
{
    char start[16];
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_int_equal(fread(start, 1, count, stream), count);
    fclose(stream);
    assert_memory_equal(start, bytes, count);
}

static void pictures_are_drawn(void **state)
{
    (void)state;
    float *rgb = sky_with_sun(20000, NOWHERE);
    write_latlong("sky.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    succeeds("inspect sky.pfm -q --out a.png");
    succeeds("inspect sky.pfm -q --out a.svg");
    succeeds("inspect sky.pfm -q --out a.pdf --json a.json");
    starts_with("a.png", "\x89PNG", 4);
    starts_with("a.svg", "<?xml", 5);
    starts_with("a.pdf", "%PDF", 4);
    succeeds("inspect constant:0,0,0 -q --out black.png");
    succeeds("inspect constant:1e9,1e-9,0 -q --out bright.png");
    assert_int_equal(count_files("."), 8); /* with sky.pfm and tetrahedron.obj, and nothing temporary */
}

/* The mark is where the spot is: its colour is nowhere else on the face. */
static void the_spot_is_marked(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    float *rgb = even_map(1);
    set_grey(rgb, HEIGHT / 2, WIDTH / 2, 50000); /* in the middle of +Z, which is the second face of the second row */
    write_latlong("sun.pfm", WIDTH, HEIGHT, rgb);
    free(rgb);
    succeeds("inspect sun.pfm -q --out a.png");
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, "a.png", NULL, &image));
    uint32_t edge = (image->width - 48) / 4, left = 24 + edge, top = 24 + edge;
    double x = 0, y = 0, count = 0;
    for (uint32_t row = top; row < top + edge; row++)
        for (uint32_t column = left; column < left + edge; column++) {
            const float *pixel = image->rgb + 3 * ((size_t)row * image->width + column);
            if (pixel[1] > 0.7f && pixel[2] > 0.8f && pixel[0] < 0.3f) {
                x += column - left;
                y += row - top;
                count++;
            }
        }
    assert_true(count > 20);
    assert_true(fabs(x / count - edge / 2.0) < 5 && fabs(y / count - edge / 2.0) < 5);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

static void a_full_disk_leaves_the_old_picture(void **state)
{
    (void)state;
    write_text("a.png", "old");
    program_limits.file_size = 500;
    fails("inspect constant:1,1,1 -q --out a.png", 1, "a.png cannot be written: File too large");
    fails("inspect constant:1,1,1 -q --out b.pdf", 1, "b.pdf cannot be written: File too large");
    program_limits.file_size = 0;
    char text[16];
    read_text("a.png", text, sizeof text);
    assert_string_equal(text, "old");
    assert_int_equal(count_files("."), 2);
}
#endif

static void mistakes_are_one_sentence(void **state)
{
    (void)state;
    fails("inspect", 2, "inspect needs an environment map");
    fails("inspect a.pfm b.pfm", 2, "takes one input");
    fails("inspect none.pfm", 1, "none.pfm");
    fails("inspect tetrahedron.obj", 1, "tetrahedron.obj");
    fails("inspect constant:1,1,1 --out a.jpeg", 2, "--out");
    fails("inspect constant:1,1,1 --jsn a.json", 2, "did you mean --json?");
    fails("inspect constant:1,1,1 --to latlong", 2, "no option --to");
    fails("inspect constant:1,1,1 -q -v", 2, "exclude each other");
    fails("inspect constant:1,1,1 -q", 2, "would tell nothing; give --json");
    fails("inspect constant:1,1,1 --json none/a.json", 1, "none/");
    succeeds("convert constant:1,1,1 -q --out a.pfm");
    fails("inspect a.pfm --json a.pfm", 1, "would replace an input");
    fails("inspect a.pfm --layout cross-v --max-pixels 0", 2, "--max-pixels");
#ifdef HELIO_WITH_CAIRO
    fails("inspect a.pfm --json b.png --out b.png", 2, "give two files");
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(even_light_has_no_range_and_no_spot),
        program_test(no_light_is_no_error),
        program_test(bad_pixels_are_counted_by_kind),
        program_test(the_brightest_spot_is_found),
        program_test(a_single_lit_pixel_gives_all_light),
        program_test(the_spot_of_a_smooth_map_is_where_it_is_brightest),
        program_test(spots_across_edges_are_one),
        program_test(clipped_suns_are_recognised),
        program_test(suns_with_too_little_light_are_recognised),
        program_test(the_end_of_half_floats_is_recognised),
        program_test(white_is_clipped_in_eight_bits),
        program_test(captured_suns_are_whole_and_their_clipped_copies_are_not),
        program_test(layouts_are_told_with_the_reason),
        program_test(six_files_are_called_faces),
        program_test(skies_and_sequences_can_be_inspected),
        program_test(json_goes_to_standard_output_for_a_dash),
        program_test(text_tells_what_json_tells),
#ifdef HELIO_WITH_CAIRO
        program_test(pictures_are_drawn),
        program_test(the_spot_is_marked),
        program_test(a_full_disk_leaves_the_old_picture),
#endif
        program_test(mistakes_are_one_sentence),
    };
    return cmocka_run_group_tests_name("inspect", tests, set_up_program, tear_down_program);
}
