/* SPDX-License-Identifier: MIT
 * Differences of pictures against published values and closed forms. */
#include "support.h"

#include "eval/flip.h"
#include "eval/lab.h"

#include <heliostat/comparison.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT };

typedef struct fixture {
    helio_context *context;
    float picture[PIXELS][3], reference[PIXELS][3], mask[PIXELS];
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    f->context = make_context(2, NULL);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    helio_context_destroy(f->context);
    free(f);
    return 0;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.12g in place of %.12g, within %g", value, wanted, tolerance);
}

static helio_comparison_desc usual_desc(void)
{
    return (helio_comparison_desc){.width = WIDTH, .height = HEIGHT, .without_lab = !helio_comparison_has_lab()};
}

static helio_comparison *make_comparison(fixture *f, const helio_comparison_desc *desc)
{
    helio_comparison *comparison;
    assert_ok(helio_comparison_create(f->context, desc, &comparison));
    return comparison;
}

static helio_comparison *make_flicker_comparison(fixture *f)
{
    helio_comparison_desc desc = usual_desc();
    desc.flicker = true;
    return make_comparison(f, &desc);
}

static helio_comparison_pair pair_of(const fixture *f)
{
    return (helio_comparison_pair){.picture = f->picture[0], .reference = f->reference[0]};
}

static helio_comparison_info measure(helio_comparison *comparison, const helio_comparison_pair *pair)
{
    helio_comparison_info info;
    assert_ok(helio_comparison_measure(comparison, pair, &info));
    return info;
}

/* One pair by a comparison of its own. */
static helio_comparison_info compare(fixture *f, const helio_comparison_pair *pair)
{
    helio_comparison_desc desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    helio_comparison_info info = measure(comparison, pair);
    helio_comparison_destroy(comparison);
    return info;
}

static void fill(float (*pixels)[3], float r, float g, float b)
{
    const float rgb[3] = {r, g, b};
    for (size_t i = 0; i < PIXELS; i++)
        memcpy(pixels[i], rgb, sizeof rgb);
}

/* Smooth and coloured, 0.1..0.9; moved to the left by some pixels. */
static void fill_moved_scene(float (*pixels)[3], float moved)
{
    for (size_t i = 0; i < PIXELS; i++)
        for (size_t c = 0; c < 3; c++) {
            float x = (float)(i % WIDTH) + moved, y = (float)(i / WIDTH);
            pixels[i][c] = 0.5f + 0.4f * sinf(0.21f * x + 0.13f * y * (float)(c + 1));
        }
}

static void fill_scene(float (*pixels)[3])
{
    fill_moved_scene(pixels, 0);
}

/* The reference with noise between -amplitude and amplitude. */
static void add_noise(fixture *f, double amplitude, uint64_t seed)
{
    for (size_t i = 0; i < PIXELS; i++)
        for (size_t c = 0; c < 3; c++)
            f->picture[i][c] = f->reference[i][c] + (float)(amplitude * (2 * random_unit(&seed) - 1));
}

static void skip_without_lab(void)
{
    if (helio_comparison_has_lab())
        return;
    print_message("skipped: this build has no lcms2\n");
    skip();
}

/* ---- Lab ----------------------------------------------------------------------------------- */

typedef struct published_pair {
    lab_colour first, second;
    double difference;
} published_pair;

/* G. Sharma, W. Wu, E. N. Dalal: "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test
 * Data, and Mathematical Observations", Color Research and Application 30(1), 2005, table 1. */
static const published_pair SHARMA[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

/* Published to four decimals. */
static void ciede2000_is_as_published(void **state)
{
    (void)state;
    skip_without_lab();
    assert_int_equal(sizeof SHARMA / sizeof SHARMA[0], 34);
    for (size_t i = 0; i < sizeof SHARMA / sizeof SHARMA[0]; i++) {
        const published_pair *pair = &SHARMA[i];
        assert_near(lab_difference_2000(&pair->first, &pair->second), pair->difference, 0.5001e-4);
        assert_near(lab_difference_2000(&pair->second, &pair->first), pair->difference, 0.5001e-4);
    }
}

static double lab_curve(double t)
{
    const double edge = 6.0 / 29;
    return t > edge * edge * edge ? cbrt(t) : t / (3 * edge * edge) + 4.0 / 29;
}

/* The textbook's formulas with the matrix of IEC 61966-2-1 in seven digits; white is what that makes of (1, 1, 1). */
static lab_colour closed_form(const float rgb[3])
{
    static const double to_xyz[3][3] = {
        {0.4123908, 0.3575843, 0.1804808}, {0.2126390, 0.7151687, 0.0721923}, {0.0193308, 0.1191948, 0.9505322}};
    double f[3];
    for (int row = 0; row < 3; row++) {
        double sum = 0, white = 0;
        for (int c = 0; c < 3; c++) {
            sum += to_xyz[row][c] * (double)rgb[c];
            white += to_xyz[row][c];
        }
        f[row] = lab_curve(sum / white);
    }
    return (lab_colour){116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

static void assert_same_lab(const lab_colour *a, const lab_colour *b, double tolerance)
{
    assert_near(a->lightness, b->lightness, tolerance);
    assert_near(a->a, b->a, tolerance);
    assert_near(a->b, b->b, tolerance);
}

/* Tolerances: the matrix above has seven digits, and FLIP computes in floats. */
static void lab_is_the_closed_form(void **state)
{
    (void)state;
    skip_without_lab();
    lab_space space;
    flip_viewer viewer;
    uint64_t seed = 1;
    lab_space_make(&space);
    flip_viewer_make(&viewer, 67);
    for (int i = 0; i < 2000; i++) {
        float rgb[3], flip[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = (float)(random_unit(&seed) * (i % 2 == 0 ? 1 : 0.01)); /* also where the curve is a line */
        lab_colour lab = lab_from_rec709(&space, rgb), wanted = closed_form(rgb);
        assert_same_lab(&lab, &wanted, 2e-4);
        flip_lab(&viewer, rgb, flip);
        const lab_colour seen = {(double)flip[0], (double)flip[1], (double)flip[2]};
        assert_same_lab(&seen, &lab, 5e-4);
    }
}

static void white_is_100_from_black(void **state)
{
    fixture *f = *state;
    skip_without_lab();
    fill(f->picture, 1, 1, 1);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = compare(f, &pair);
    assert_near(info.lab_mean, 100, 1e-9);
    assert_near(info.de2000_mean, 100, 1e-9);
}

/* Red and green by their published Lab: (53.2408, 80.0925, 67.2032) and (87.7347, -86.1827, 83.1793), in D65 with
 * white rounded to five digits. */
static void lab_mean_is_the_mean_of_distances(void **state)
{
    fixture *f = *state;
    skip_without_lab();
    double distance = sqrt(pow(87.7347 - 53.2408, 2) + pow(86.1827 + 80.0925, 2) + pow(83.1793 - 67.2032, 2));
    fill(f->reference, 1, 0, 0);
    fill(f->picture, 1, 0, 0);
    for (size_t i = 0; i < PIXELS / 4; i++)
        memcpy(f->picture[i], (const float[3]){0, 1, 0}, sizeof f->picture[i]);
    helio_comparison_pair pair = pair_of(f);
    assert_near(compare(f, &pair).lab_mean, distance / 4, 0.01);
}

/* A screen shows half of twice the light: exposure goes first. */
static void exposure_and_tone_map_decide_what_is_shown(void **state)
{
    fixture *f = *state;
    fill_scene(f->reference);
    add_noise(f, 0.1, 3);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info usual = compare(f, &pair);
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            f->picture[i][c] *= 2;
            f->reference[i][c] *= 2;
        }
    pair.exposure = -1;
    helio_comparison_info darker = compare(f, &pair);
    assert_near(darker.psnr, usual.psnr, 1e-5);
    assert_near(darker.flip, usual.flip, 1e-6);
    assert_near(darker.relmse, usual.relmse, 1e-6);
    assert_near(darker.rmse, 2 * usual.rmse, 1e-6);
    if (helio_comparison_has_lab())
        assert_near(darker.lab_mean, usual.lab_mean, 1e-4);
    pair.tonemap = HELIO_TONEMAP_REINHARD;
    assert_true(fabs(compare(f, &pair).psnr - usual.psnr) > 0.1);
    pair.tonemap = HELIO_TONEMAP_CLIP;
    pair.exposure = 100; /* all is white */
    helio_comparison_info white = compare(f, &pair);
    assert_true(isinf(white.psnr) && white.flip == 0 && white.rmse == darker.rmse);
}

/* ---- squares ------------------------------------------------------------------------------- */

/* a = b (1 + x) everywhere, b constant: (b x)^2 / (b^2 + 0.01 b^2) = x^2 / 1.01. */
static void relative_error_has_its_closed_form(void **state)
{
    fixture *f = *state;
    const double part = 0.25, b = 3;
    fill(f->reference, 3, 3, 3);
    fill(f->picture, 3.75f, 3.75f, 3.75f);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = compare(f, &pair);
    assert_near(info.relmse, part * part / 1.01, 1e-12);
    assert_near(info.rmse, part * b, 1e-12);
    assert_int_equal(info.pixels, PIXELS);
    assert_true(info.skipped == 0 && info.flicker_pixels == 0 && isnan(info.flicker));

    /* Half of the reference black: e = 0.01 b^2 / 2, and the picture is off by d in both halves. */
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            f->reference[i][c] = i % 2 == 0 ? 0 : 3;
            f->picture[i][c] = f->reference[i][c] + 0.5f;
        }
    double e = 0.01 * b * b / 2;
    info = compare(f, &pair);
    assert_near(info.relmse, 0.25 / 2 * (1 / e + 1 / (b * b + e)), 1e-9);
    assert_near(info.rmse, 0.5, 1e-12);
}

/* Of what is shown, encoded: a step in sRGB is a step. */
static void psnr_has_its_closed_form(void **state)
{
    fixture *f = *state;
    const float low = 0.21404114f, high = 0.25415802f; /* 0.5 and 0.541196 in sRGB */
    fill(f->reference, low, low, low);
    fill(f->picture, high, low, low);
    double encoded = 1.055 * pow((double)high, 1 / 2.4) - 1.055 * pow((double)low, 1 / 2.4);
    helio_comparison_pair pair = pair_of(f);
    assert_near(compare(f, &pair).psnr, -10 * log10(encoded * encoded / 3), 1e-4); /* the curve is in floats */
}

static void equal_pictures_have_no_error(void **state)
{
    fixture *f = *state;
    fill_scene(f->reference);
    memcpy(f->picture, f->reference, sizeof f->picture);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = compare(f, &pair);
    assert_true(info.rmse == 0 && info.relmse == 0 && info.flip == 0 && isinf(info.psnr) && info.psnr > 0);
    if (helio_comparison_has_lab())
        assert_true(info.lab_mean == 0 && info.de2000_mean == 0);
    fill(f->picture, 0, 0, 0);
    fill(f->reference, 0, 0, 0);
    info = compare(f, &pair);
    assert_true(info.rmse == 0 && info.relmse == 0);
    f->picture[5][0] = 1; /* in relation to nothing */
    assert_true(isinf(compare(f, &pair).relmse));
}

/* ---- FLIP ---------------------------------------------------------------------------------- */

static void flip_of_opposites_is_near_one(void **state)
{
    fixture *f = *state;
    fill(f->picture, 1, 1, 1);
    helio_comparison_pair pair = pair_of(f);
    /* What the authors' own evaluator (1.7) gives for black and white, and for blue and green. */
    assert_near(compare(f, &pair).flip, 0.96738, 2e-4);
    fill(f->picture, 0, 0, 1);
    fill(f->reference, 0, 1, 0);
    assert_near(compare(f, &pair).flip, 1, 1e-6);
}

/* Means by the authors' own evaluator (1.7) of the same pictures. It computes in floats, in another order. */
static void flip_is_that_of_its_authors(void **state)
{
    static const struct {
        float moved, pixels_per_degree;
        double flip;
    } known[] = {{1, 67, 0.298660}, {1, 20, 0.311543}, {4, 67, 0.700214}, {4, 20, 0.738878}};
    fixture *f = *state;
    fill_scene(f->reference);
    helio_comparison_pair pair = pair_of(f);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        helio_comparison_desc desc = usual_desc();
        desc.pixels_per_degree = known[i].pixels_per_degree;
        helio_comparison *comparison = make_comparison(f, &desc);
        fill_moved_scene(f->picture, known[i].moved);
        assert_near(measure(comparison, &pair).flip, known[i].flip, 5e-5);
        helio_comparison_destroy(comparison);
    }
}

static void flip_is_symmetric(void **state)
{
    fixture *f = *state;
    fill_scene(f->reference);
    add_noise(f, 0.2, 11);
    helio_comparison_pair pair = pair_of(f), swapped = pair;
    swapped.picture = pair.reference;
    swapped.reference = pair.picture;
    helio_comparison_info info = compare(f, &pair), other = compare(f, &swapped);
    assert_true(info.flip > 0.05 && info.flip == other.flip);
    assert_near(info.psnr, other.psnr, 1e-12);
}

static void errors_grow_with_noise(void **state)
{
    fixture *f = *state;
    helio_comparison_info before = {0};
    helio_comparison_pair pair = pair_of(f);
    before.psnr = (double)INFINITY;
    fill_scene(f->reference);
    for (double amplitude = 0.01; amplitude < 0.2; amplitude *= 1.5) {
        add_noise(f, amplitude, 7);
        helio_comparison_info info = compare(f, &pair);
        assert_true(info.flip > before.flip && info.rmse > before.rmse && info.relmse > before.relmse);
        assert_true(info.psnr < before.psnr && info.flip < 1);
        if (helio_comparison_has_lab())
            assert_true(info.lab_mean > before.lab_mean && info.de2000_mean > before.de2000_mean);
        before = info;
    }
}

/* Detail that is too fine for an eye counts less the further away it is. */
static void flip_does_not_see_what_is_far(void **state)
{
    fixture *f = *state;
    double before = 1;
    helio_comparison_pair pair = pair_of(f);
    fill_scene(f->reference);
    add_noise(f, 0.1, 5);
    for (float pixels_per_degree = 1; pixels_per_degree <= 200; pixels_per_degree *= 5) {
        helio_comparison_desc desc = usual_desc();
        desc.pixels_per_degree = pixels_per_degree;
        helio_comparison *comparison = make_comparison(f, &desc);
        double flip = measure(comparison, &pair).flip;
        helio_comparison_destroy(comparison);
        assert_true(flip > 0 && flip < before);
        before = flip;
    }
}

/* ---- masks and bad pixels ------------------------------------------------------------------ */

static void only_the_mask_counts(void **state)
{
    fixture *f = *state;
    fill(f->reference, 0.5f, 0.5f, 0.5f);
    fill(f->picture, 1, 1, 1);
    for (size_t i = 0; i < PIXELS; i++)
        f->mask[i] = i < 100 ? 0.5f : i < 200 ? 0.49f : i < 300 ? NAN : -1;
    for (size_t i = 0; i < 100; i++)
        memcpy(f->picture[i], (const float[3]){0.75f, 0.75f, 0.75f}, sizeof f->picture[i]);
    f->picture[150][0] = NAN; /* beside the mask: nobody's business */
    helio_comparison_desc desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    helio_comparison_pair pair = pair_of(f);
    pair.mask = f->mask;
    helio_comparison_info info = measure(comparison, &pair);
    assert_int_equal(info.pixels, 100);
    assert_true(info.skipped == 0 && info.picture_bad.nan == 0);
    assert_near(info.rmse, 0.25, 1e-12);
    assert_near(info.relmse, 0.25 / 1.01, 1e-12);
    const float *map = helio_comparison_map(comparison, HELIO_ERROR_MAP_RELATIVE);
    assert_near((double)map[99], 0.25 / 1.01, 1e-7);
    assert_true(isnan(map[100]) && isnan(map[PIXELS - 1]));
    memset(f->mask, 0, sizeof f->mask);
    info = measure(comparison, &pair);
    assert_int_equal(info.pixels, 0);
    assert_true(isnan(info.rmse) && isnan(info.relmse) && isnan(info.psnr) && isnan(info.flip) && isnan(info.lab_mean));
    helio_comparison_destroy(comparison);
}

static void bad_pixels_are_counted_and_left_out(void **state)
{
    fixture *f = *state;
    fill(f->reference, 0.5f, 0.5f, 0.5f);
    fill(f->picture, 0.75f, 0.75f, 0.75f);
    f->picture[3][1] = NAN;
    f->picture[4][2] = INFINITY;
    f->picture[5][0] = 2e30f;
    f->reference[5][0] = -INFINITY;
    f->reference[6][0] = NAN;
    f->picture[7][0] = -0.25f; /* a number as others: off by 0.75 */
    helio_comparison_desc desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = measure(comparison, &pair);
    assert_int_equal(info.pixels, PIXELS - 4);
    assert_int_equal(info.skipped, 4);
    assert_true(info.picture_bad.nan == 1 && info.picture_bad.infinite == 2 && info.picture_bad.negative == 1);
    assert_true(info.reference_bad.nan == 1 && info.reference_bad.infinite == 1 && info.reference_bad.negative == 0);
    double count = 3.0 * (PIXELS - 4);
    assert_near(info.rmse, sqrt(((count - 1) * 0.0625 + 0.5625) / count), 1e-12);
    assert_true(isfinite(info.relmse) && isfinite(info.psnr) && info.flip > 0 && info.flip < 1);
    for (int map = HELIO_ERROR_MAP_LAB; map <= HELIO_ERROR_MAP_FLIP; map++) {
        const float *errors = helio_comparison_map(comparison, (helio_error_map)map);
        for (size_t i = 0; i < PIXELS && errors != NULL; i++)
            assert_true(i >= 3 && i <= 6 ? isnan(errors[i]) : errors[i] > 0);
    }
    helio_comparison_destroy(comparison);
}

/* ---- maps ---------------------------------------------------------------------------------- */

static double mean_of(const float *map)
{
    double sum = 0;
    assert_non_null(map);
    for (size_t i = 0; i < PIXELS; i++)
        sum += (double)map[i];
    return sum / PIXELS;
}

static void maps_have_the_means(void **state)
{
    fixture *f = *state;
    fill_scene(f->reference);
    add_noise(f, 0.1, 19);
    helio_comparison_desc desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    assert_null(helio_comparison_map(comparison, HELIO_ERROR_MAP_FLIP));
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = measure(comparison, &pair);
    assert_near(mean_of(helio_comparison_map(comparison, HELIO_ERROR_MAP_RELATIVE)) / info.relmse, 1, 1e-6);
    assert_near(mean_of(helio_comparison_map(comparison, HELIO_ERROR_MAP_FLIP)) / info.flip, 1, 1e-6);
    if (helio_comparison_has_lab()) {
        assert_near(mean_of(helio_comparison_map(comparison, HELIO_ERROR_MAP_LAB)) / info.lab_mean, 1, 1e-6);
        assert_near(mean_of(helio_comparison_map(comparison, HELIO_ERROR_MAP_DE2000)) / info.de2000_mean, 1, 1e-6);
    }
    assert_null(helio_comparison_map(comparison, (helio_error_map)17));
    helio_comparison_destroy(comparison);
    desc.without_lab = desc.without_flip = true;
    comparison = make_comparison(f, &desc);
    info = measure(comparison, &pair);
    assert_true(isnan(info.lab_mean) && isnan(info.de2000_mean) && isnan(info.flip) && info.rmse > 0);
    assert_null(helio_comparison_map(comparison, HELIO_ERROR_MAP_LAB));
    assert_null(helio_comparison_map(comparison, HELIO_ERROR_MAP_FLIP));
    assert_non_null(helio_comparison_map(comparison, HELIO_ERROR_MAP_RELATIVE));
    helio_comparison_destroy(comparison);
}

static void alpha_is_not_looked_at(void **state)
{
    fixture *f = *state;
    float(*rgba)[4] = calloc(PIXELS, sizeof *rgba);
    assert_non_null(rgba);
    fill_scene(f->reference);
    add_noise(f, 0.1, 23);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = compare(f, &pair);
    for (size_t i = 0; i < PIXELS; i++) {
        memcpy(rgba[i], f->picture[i], sizeof f->picture[i]);
        rgba[i][3] = i % 3 == 0 ? NAN : 0;
    }
    pair.picture = rgba[0];
    pair.picture_channels = 4;
    helio_comparison_info other = compare(f, &pair);
    assert_memory_equal(&info, &other, sizeof info);
    free(rgba);
}

static void threads_change_no_bit(void **state)
{
    fixture *f = *state;
    fill_scene(f->reference);
    add_noise(f, 0.3, 29);
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = compare(f, &pair), other;
    for (uint32_t threads = 1; threads <= 5; threads += 2) {
        helio_context *context = make_context(threads, NULL);
        helio_comparison_desc desc = usual_desc();
        helio_comparison *comparison;
        assert_ok(helio_comparison_create(context, &desc, &comparison));
        other = measure(comparison, &pair);
        assert_memory_equal(&info, &other, sizeof info);
        helio_comparison_destroy(comparison);
        helio_context_destroy(context);
    }
}

/* ---- flicker ------------------------------------------------------------------------------- */

/* b = 2, a = b + d, b - d, b + d ...: the error changes by 2 d each time. */
static void flicker_of_an_alternating_error_is_known(void **state)
{
    fixture *f = *state;
    const double d = 0.5, b = 2;
    helio_comparison *comparison = make_flicker_comparison(f);
    helio_comparison_pair pair = pair_of(f);
    fill(f->reference, 2, 2, 2);
    for (int frame = 0; frame < 4; frame++) {
        float level = frame % 2 == 0 ? 2.5f : 1.5f;
        fill(f->picture, level, level, level);
        helio_comparison_info info = measure(comparison, &pair);
        assert_near(info.relmse, d * d / (1.01 * b * b), 1e-12);
        if (frame == 0) {
            assert_true(isnan(info.flicker) && isnan(info.flicker_rmse) && info.flicker_pixels == 0);
            continue;
        }
        assert_near(info.flicker, 2 * info.relmse, 1e-12); /* (2 d)^2 / 2 */
        assert_near(info.flicker_rmse, 2 * d, 1e-12);
        assert_int_equal(info.flicker_pixels, PIXELS);
    }
    helio_comparison_restart(comparison);
    assert_true(isnan(measure(comparison, &pair).flicker));
    assert_true(measure(comparison, &pair).flicker == 0); /* the same again: an error that stands still */
    helio_comparison_destroy(comparison);
}

/* The light changes, the error does not; b^2 is the mean of both frames'. */
static void flicker_is_of_the_error_not_of_the_light(void **state)
{
    fixture *f = *state;
    helio_comparison *comparison = make_flicker_comparison(f);
    helio_comparison_pair pair = pair_of(f);
    fill(f->reference, 1, 1, 1);
    fill(f->picture, 1.25f, 1.25f, 1.25f);
    measure(comparison, &pair);
    fill(f->reference, 3, 3, 3);
    fill(f->picture, 3.25f, 3.25f, 3.25f);
    assert_true(measure(comparison, &pair).flicker == 0);
    fill(f->picture, 3, 3, 3);
    fill(f->reference, 1, 1, 1);
    fill(f->picture, 1, 1, 1); /* from an error of 0.25 to none */
    assert_near(measure(comparison, &pair).flicker, 0.25 * 0.25 / 2 / (1.01 * 5), 1e-12);
    helio_comparison_destroy(comparison);
}

/* Noise that is new in each frame flickers as much as it is wrong: within three standard deviations of the mean of
 * 5760 channels, whose squares of even noise have a relative deviation of about 1.3. */
static void flicker_of_new_noise_is_its_relative_error(void **state)
{
    fixture *f = *state;
    helio_comparison *comparison = make_flicker_comparison(f);
    helio_comparison_pair pair = pair_of(f);
    fill(f->reference, 1, 1, 1);
    add_noise(f, 0.3, 31);
    measure(comparison, &pair);
    add_noise(f, 0.3, 37);
    helio_comparison_info info = measure(comparison, &pair);
    assert_near(info.flicker / info.relmse, 1, 0.06);
    helio_comparison_destroy(comparison);
}

static void flicker_is_where_both_frames_are_compared(void **state)
{
    fixture *f = *state;
    helio_comparison *comparison = make_flicker_comparison(f);
    helio_comparison_pair pair = pair_of(f);
    fill(f->reference, 1, 1, 1);
    fill(f->picture, 1, 1, 1);
    pair.mask = f->mask;
    for (size_t i = 0; i < PIXELS; i++)
        f->mask[i] = i < 300;
    f->picture[299][0] = NAN;
    measure(comparison, &pair);
    fill(f->picture, 2, 2, 2);
    for (size_t i = 0; i < PIXELS; i++)
        f->mask[i] = i >= 200;
    helio_comparison_info info = measure(comparison, &pair);
    assert_int_equal(info.flicker_pixels, 99);
    assert_near(info.flicker_rmse, 1, 1e-12);
    helio_comparison_destroy(comparison);
}

/* ---- exposure ------------------------------------------------------------------------------ */

static void exposure_shows_95_of_100_lit_pixels(void **state)
{
    fixture *f = *state;
    helio_comparison_desc desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    helio_comparison_pair pair = pair_of(f);
    float stops = 5;
    assert_ok(helio_comparison_auto_exposure(comparison, &pair, &stops));
    assert_true(stops == 0);            /* black */
    for (size_t i = 0; i < 1000; i++) { /* luminances 1 ... 1000 in any order; the others are black */
        float level = (float)((i * 7) % 1000 + 1);
        memcpy(f->reference[i], (const float[3]){level, level, level}, sizeof f->reference[i]);
    }
    f->reference[1500][1] = NAN;
    f->reference[1501][1] = INFINITY;
    assert_ok(helio_comparison_auto_exposure(comparison, &pair, &stops));
    assert_near((double)stops, log2(0.8 / 950), 1e-5);
    for (size_t i = 0; i < PIXELS; i++)
        f->mask[i] = f->reference[i][0] > 980;
    pair.mask = f->mask;
    assert_ok(helio_comparison_auto_exposure(comparison, &pair, &stops));
    assert_near((double)stops, log2(0.8 / 999), 1e-5); /* the 19th of 20 */
    helio_comparison_destroy(comparison);
}

/* ---- refusals and memory ------------------------------------------------------------------- */

static void refuses(fixture *f, const helio_comparison_desc *desc, helio_status expected, const char *word)
{
    helio_comparison *comparison = (helio_comparison *)f;
    assert_int_equal(helio_comparison_create(f->context, desc, &comparison), expected);
    assert_null(comparison);
    assert_non_null(strstr(helio_last_error(), word));
}

static void refuses_pair(helio_comparison *comparison, const helio_comparison_pair *pair, const char *word)
{
    helio_comparison_info info;
    assert_int_equal(helio_comparison_measure(comparison, pair, &info), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), word));
}

static void mistakes_are_told(void **state)
{
    fixture *f = *state;
    helio_comparison_desc desc = usual_desc();
    desc.width = 0;
    refuses(f, &desc, HELIO_ERR_ARGUMENT, "0 x 40");
    desc.width = 65537;
    refuses(f, &desc, HELIO_ERR_ARGUMENT, "65537 x 40");
    desc = usual_desc();
    desc.pixels_per_degree = 500;
    refuses(f, &desc, HELIO_ERR_ARGUMENT, "500 pixels per degree");
    if (!helio_comparison_has_lab()) {
        desc = (helio_comparison_desc){.width = 8, .height = 8};
        refuses(f, &desc, HELIO_ERR_UNSUPPORTED, "lcms2");
    }
    desc = usual_desc();
    helio_comparison *comparison = make_comparison(f, &desc);
    helio_comparison_pair pair = pair_of(f);
    pair.picture = NULL;
    refuses_pair(comparison, &pair, "needs a picture");
    pair = pair_of(f);
    pair.reference_channels = 1;
    refuses_pair(comparison, &pair, "reference of 1 channels");
    pair = pair_of(f);
    pair.exposure = NAN;
    refuses_pair(comparison, &pair, "exposure");
    pair = pair_of(f);
    pair.tonemap = (helio_tonemap)99;
    refuses_pair(comparison, &pair, "tone map");
    helio_comparison_destroy(comparison);
    helio_comparison_destroy(NULL);
    helio_error_map map;
    assert_ok(helio_error_map_parse("flip", &map));
    assert_true(map == HELIO_ERROR_MAP_FLIP && strcmp(helio_error_map_name(HELIO_ERROR_MAP_LAB), "lab") == 0);
    assert_int_equal(helio_error_map_parse("fip", &map), HELIO_ERR_ARGUMENT);
}

/* All memory is taken in create; where it runs out there, nothing stays. */
static void memory_is_taken_at_creation_alone(void **state)
{
    fixture *f = *state;
    memory_count count = {0};
    helio_context *context = make_context(2, &count);
    size_t before = count.live, first = count.taken;
    helio_comparison_desc desc = usual_desc();
    desc.flicker = true;
    helio_comparison *comparison;
    assert_ok(helio_comparison_create(context, &desc, &comparison));
    size_t taken = count.taken;
    helio_comparison_pair pair = pair_of(f);
    measure(comparison, &pair);
    measure(comparison, &pair);
    float stops;
    assert_ok(helio_comparison_auto_exposure(comparison, &pair, &stops));
    assert_int_equal(count.taken, taken);
    helio_comparison_destroy(comparison);
    assert_int_equal(count.live, before);
    for (size_t i = 0; i < taken - first; i++) {
        count.refuse_after = count.taken + i;
        assert_int_equal(helio_comparison_create(context, &desc, &comparison), HELIO_ERR_MEMORY);
        assert_null(comparison);
        assert_int_equal(count.live, before);
    }
    count.refuse_after = 0;
    helio_context_destroy(context);
}

/* Smaller than any kernel of FLIP. */
static void pictures_of_one_pixel_can_be_compared(void **state)
{
    fixture *f = *state;
    helio_comparison_desc desc = usual_desc();
    desc.width = desc.height = 1;
    helio_comparison *comparison = make_comparison(f, &desc);
    f->picture[0][1] = 1;
    helio_comparison_pair pair = pair_of(f);
    helio_comparison_info info = measure(comparison, &pair);
    assert_near(info.rmse, sqrt(1 / 3.0), 1e-12);
    assert_true(info.pixels == 1 && info.flip > 0.5 && info.flip <= 1);
    helio_comparison_destroy(comparison);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(ciede2000_is_as_published),
        TEST(lab_is_the_closed_form),
        TEST(white_is_100_from_black),
        TEST(lab_mean_is_the_mean_of_distances),
        TEST(exposure_and_tone_map_decide_what_is_shown),
        TEST(relative_error_has_its_closed_form),
        TEST(psnr_has_its_closed_form),
        TEST(equal_pictures_have_no_error),
        TEST(flip_of_opposites_is_near_one),
        TEST(flip_is_that_of_its_authors),
        TEST(flip_is_symmetric),
        TEST(errors_grow_with_noise),
        TEST(flip_does_not_see_what_is_far),
        TEST(only_the_mask_counts),
        TEST(bad_pixels_are_counted_and_left_out),
        TEST(maps_have_the_means),
        TEST(alpha_is_not_looked_at),
        TEST(threads_change_no_bit),
        TEST(flicker_of_an_alternating_error_is_known),
        TEST(flicker_is_of_the_error_not_of_the_light),
        TEST(flicker_of_new_noise_is_its_relative_error),
        TEST(flicker_is_where_both_frames_are_compared),
        TEST(exposure_shows_95_of_100_lit_pixels),
        TEST(mistakes_are_told),
        TEST(memory_is_taken_at_creation_alone),
        TEST(pictures_of_one_pixel_can_be_compared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
