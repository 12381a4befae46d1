/* SPDX-License-Identifier: MIT
 *
 * Skies: the radiance against the published model, evaluated here from the published tables in double precision; the
 * sun's light, which must not depend on the size of the texels; how much light there is; how a day goes by. Where the
 * sun stands is in test_sun. */
#include "support.h"

#include "core/vector.h"
#include "env/cube.h"
#include "env/sun_disc.h"
#include "sampling/elementary.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A sky over an environment without a map. */
typedef struct stage {
    helio_context *context;
    helio_environment *environment;
    helio_sky *sky;
    uint32_t size;
    double *solid_angles; /* [size][size] */
} stage;

static double *find_solid_angles(uint32_t size)
{
    double *corners = malloc((size_t)(size + 1) * (size + 1) * sizeof *corners);
    double *solid_angles = malloc((size_t)size * size * sizeof *solid_angles);
    assert_true(corners != NULL && solid_angles != NULL);
    for (uint32_t i = 0; i < (size + 1) * (size + 1); i++)
        corners[i] = cube_corner_solid_angle(2.0 * (i % (size + 1)) / size - 1, 2.0 * (i / (size + 1)) / size - 1);
    for (uint32_t i = 0; i < size * size; i++) {
        const double *above = corners + i / size * (size + 1) + i % size, *below = above + size + 1;
        solid_angles[i] = (below[1] - below[0]) - (above[1] - above[0]);
    }
    free(corners);
    return solid_angles;
}

static stage make_stage(helio_context *context, uint32_t size)
{
    stage s = {.context = context, .size = size, .solid_angles = find_solid_angles(size)};
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = size}, &s.environment));
    assert_ok(helio_sky_create(context, size, &s.sky));
    return s;
}

static void destroy_stage(stage *s)
{
    helio_sky_destroy(s->sky);
    helio_environment_destroy(s->environment);
    free(s->solid_angles);
}

static const float *update(const stage *s, helio_sky_desc desc)
{
    assert_ok(helio_sky_update(s->sky, &desc, s->environment, NULL));
    return helio_environment_cube(s->environment);
}

static helio_sky_desc describe(double azimuth, double elevation, float turbidity, float albedo)
{
    return (helio_sky_desc){
        .sun = {.azimuth = azimuth, .elevation = elevation}, .turbidity = turbidity, .albedo = albedo};
}

/* ---- the model ----------------------------------------------------------------------------- */

enum { CHANNELS = 3, TURBIDITIES = 10, POINTS = 6, COEFFICIENTS = 9 };

typedef struct published_tables {
    double coefficients[CHANNELS][2][TURBIDITIES][POINTS][COEFFICIENTS];
    double radiances[CHANNELS][2][TURBIDITIES][POINTS];
} published_tables;

/* Calls take for each line of a CSV file that begins with a channel's letter. */
static void read_csv(const char *name, published_tables *tables, void (*take)(published_tables *, const char *))
{
    char path[TEST_PATH_SIZE], line[1000];
    const char *folder = getenv("HELIOSTAT_SOURCE_DIR");
    assert_non_null(folder);
    assert_true(snprintf(path, sizeof path, "%s/assets/sky/%s", folder, name) < TEST_PATH_SIZE);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL)
        if (strchr("RGB", line[0]) != NULL && line[1] == ',')
            take(tables, line);
    fclose(file);
}

/* The indices at the beginning of a line; returns what follows. */
static const char *read_indices(const char *line, int count, int *indices)
{
    indices[0] = line[0] == 'R' ? 0 : line[0] == 'G' ? 1 : 2;
    char *end = (char *)line + 1;
    for (int i = 1; i <= count; i++)
        indices[i] = (int)strtol(end + 1, &end, 10);
    return end;
}

static void read_numbers(const char *text, int count, double *numbers)
{
    char *end = (char *)text;
    for (int i = 0; i < count; i++) {
        assert_int_equal(*end, ',');
        numbers[i] = strtod(end + 1, &end);
    }
}

static void take_coefficients(published_tables *tables, const char *line)
{
    int i[4];
    const char *numbers = read_indices(line, 3, i);
    read_numbers(numbers, COEFFICIENTS, tables->coefficients[i[0]][i[1]][i[2] - 1][i[3]]);
}

static void take_radiances(published_tables *tables, const char *line)
{
    int i[3];
    const char *numbers = read_indices(line, 2, i);
    read_numbers(numbers, POINTS, tables->radiances[i[0]][i[1]][i[2] - 1]);
}

static published_tables *read_tables(void)
{
    published_tables *tables = calloc(1, sizeof *tables);
    assert_non_null(tables);
    read_csv("hosek_wilkie_rgb_coeffs.csv", tables, take_coefficients);
    read_csv("hosek_wilkie_rgb_radiance.csv", tables, take_radiances);
    return tables;
}

/* A Bezier curve by de Casteljau's construction. */
static double bezier(const double *points, int stride, double x)
{
    double p[POINTS];
    for (int i = 0; i < POINTS; i++)
        p[i] = points[i * stride];
    for (int last = POINTS - 1; last > 0; last--)
        for (int i = 0; i < last; i++)
            p[i] += x * (p[i + 1] - p[i]);
    return p[0];
}

/* Between two table values for turbidity and two for albedo; k: which coefficient, -1: the mean radiance. */
static double interpolate(const published_tables *t, int channel, double turbidity, double albedo, double x, int k)
{
    int lower = turbidity >= TURBIDITIES ? TURBIDITIES - 1 : (int)turbidity;
    double sides[2][2];
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            sides[a][b] = k < 0 ? bezier(t->radiances[channel][a][lower - 1 + b], 1, x)
                                : bezier(&t->coefficients[channel][a][lower - 1 + b][0][k], COEFFICIENTS, x);
    double part = turbidity - lower;
    double black = sides[0][0] + part * (sides[0][1] - sides[0][0]);
    double white = sides[1][0] + part * (sides[1][1] - sides[1][0]);
    return black + albedo * (white - black);
}

/* Equation 11 of the paper, with the extended chi, for cos(theta) = up and gamma. */
static double published_radiance(const double c[COEFFICIENTS], double radiance, double up, double gamma)
{
    double cosine = cos(gamma), g = c[8];
    double chi = (1 + cosine * cosine) / pow(1 + g * g - 2 * g * cosine, 1.5);
    double f = (1 + c[0] * exp(c[1] / (up + 0.01))) *
               (c[2] + c[3] * exp(c[4] * gamma) + c[5] * cosine * cosine + c[6] * chi + c[7] * sqrt(up));
    return fmax(0.0, f * radiance) * 683.0 / 10000.0;
}

static const double TO_RADIANS = PI / 180.0;

/* The angle between two vectors, exact for small ones too. */
static double angle_between_vectors(const double a[3], const double b[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return atan2(sqrt(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

static void find_sun_vector(double azimuth, double elevation, double sun[3])
{
    sun[0] = sin(azimuth * TO_RADIANS) * cos(elevation * TO_RADIANS);
    sun[1] = sin(elevation * TO_RADIANS);
    sun[2] = -cos(azimuth * TO_RADIANS) * cos(elevation * TO_RADIANS);
}

static void texel_direction(uint32_t size, uint32_t face, uint32_t row, uint32_t column, double direction[3])
{
    const cube_face *f = &cube_faces[face];
    double u = (2.0 * column + 1) / size - 1, v = (2.0 * row + 1) / size - 1, length = sqrt(1 + u * u + v * v);
    direction[0] = ((double)f->axis.x + u * (double)f->right.x + v * (double)f->down.x) / length;
    direction[1] = ((double)f->axis.y + u * (double)f->right.y + v * (double)f->down.y) / length;
    direction[2] = ((double)f->axis.z + u * (double)f->right.z + v * (double)f->down.z) / length;
}

/* The largest error of the upper half of the cube, relative to the radiance or, where that is darker, to a tenth of the
 * sky's mean. */
static double compare_with_model(const published_tables *tables, const float *cube, uint32_t size,
                                 const helio_sky_desc *d)
{
    double sun[3], largest = 0, x = cbrt(d->sun.elevation / 90.0);
    find_sun_vector(d->sun.azimuth, d->sun.elevation, sun);
    for (int channel = 0; channel < CHANNELS; channel++) {
        double c[COEFFICIENTS], turbidity = (double)d->turbidity, albedo = (double)d->albedo;
        for (int k = 0; k < COEFFICIENTS; k++)
            c[k] = interpolate(tables, channel, turbidity, albedo, x, k);
        double mean = interpolate(tables, channel, turbidity, albedo, x, -1);
        for (uint32_t i = 0; i < 6 * size * size; i += 7) {
            double direction[3];
            texel_direction(size, i / (size * size), i / size % size, i % size, direction);
            if (direction[1] <= 0)
                continue;
            double expected = published_radiance(c, mean, direction[1], angle_between_vectors(direction, sun));
            double error = fabs((double)cube[3 * i + (uint32_t)channel] - expected);
            largest = fmax(largest, error / fmax(expected, mean * 0.00683));
        }
    }
    return largest;
}

static void radiance_is_that_of_the_published_model(void **state)
{
    (void)state;
    static const double elevations[] = {1.0, 2.5, 10, 33, 67, 90};
    static const float turbidities[] = {1, 1.7f, 3, 6.25f, 10}, albedos[] = {0, 0.2f, 1};
    published_tables *tables = read_tables();
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, 128);
    double largest = 0;
    for (int e = 0; e < 6; e++)
        for (int t = 0; t < 5; t++)
            for (int a = 0; a < 3; a++) {
                helio_sky_desc desc = describe(77.0 * e - 100, elevations[e], turbidities[t], albedos[a]);
                desc.no_disc = true;
                largest = fmax(largest, compare_with_model(tables, update(&s, desc), s.size, &desc));
            }
    print_message("largest error: %.2g\n", largest);
    assert_true(largest < 2e-5); /* the rounding of directions and coefficients to float */
    destroy_stage(&s);
    helio_context_destroy(context);
    free(tables);
}

/* What elementary.h states of it. */
static void angles_of_versines_are_exact(void **state)
{
    (void)state;
    double largest = 0;
    for (float h = 1e-14f; h < 2.0f; h = h * 1.0001f) {
        double exact = 2 * asin(sqrt(0.5 * (double)h));
        largest = fmax(largest, fabs((double)angle_of_versine(h) - exact) / exact);
    }
    print_message("largest error: %.2g\n", largest);
    assert_true(largest < 4e-7);
    assert_true(angle_of_versine(0.0f) == 0.0f);
    assert_true(fabs((double)angle_of_versine(2.0000005f) - PI) < 1e-6);
}

/* ---- the sun ------------------------------------------------------------------------------- */

/* Sum of texels x solid angle, per channel; of the part above the horizon, or of all. */
static void find_flux(const stage *s, const float *cube, bool is_upper, double flux[3])
{
    uint32_t size = s->size;
    flux[0] = flux[1] = flux[2] = 0;
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        uint32_t face = i / (size * size), row = i / size % size;
        if (is_upper && (face == 3 || (face != 2 && 2 * row + 1 >= size)))
            continue;
        for (uint32_t c = 0; c < 3; c++)
            flux[c] += s->solid_angles[i % (size * size)] * (double)cube[3 * i + c];
    }
}

/* Flux of the sun alone: of a sky with it less one without. */
static void find_sun_flux(helio_context *context, uint32_t size, helio_sky_desc desc, double flux[3])
{
    stage s = make_stage(context, size);
    double without[3];
    find_flux(&s, update(&s, desc), false, flux);
    desc.no_disc = true;
    find_flux(&s, update(&s, desc), false, without);
    for (int c = 0; c < 3; c++)
        flux[c] -= without[c];
    destroy_stage(&s);
}

static void flux_of_the_sun_does_not_depend_on_the_size_of_texels(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 3, 16, 17, 64, 256, 512, 1024};
    /* On a texel's corner, a face's middle, an edge, a corner of the cube, and beside the horizon. */
    static const double places[][2] = {{200, 40}, {90, 0.4}, {135, 20}, {45, 35.2643897}, {0, 45}, {180, 90}, {10, 3}};
    helio_context *context = make_context(2, NULL);
    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        double expected[3], flux[3];
        helio_sky_desc desc = describe(places[p][0], places[p][1], 2, 0.2f);
        find_sun_flux(context, 200, desc, expected);
        assert_true(expected[0] > 0);
        /* The large ones once beside the horizon, where most is to be cut. */
        size_t count = is_thorough() ? 9 : places[p][1] < 1 ? 8 : 6;
        for (size_t i = 0; i < count; i++) {
            find_sun_flux(context, sizes[i], desc, flux);
            for (int c = 0; c < 3; c++) /* skylight and sun are rounded to float together */
                if (fabs(flux[c] - expected[c]) > 2e-6 * expected[c] + 1e-5)
                    fail_msg("sun at %g, %g: flux %.9g with R = %u, %.9g with R = 200", places[p][0], places[p][1],
                             flux[c], sizes[i], expected[c]);
        }
    }
    helio_context_destroy(context);
}

typedef struct disc_stage {
    sun_disc disc;
    uint32_t size;
} disc_stage;

static disc_stage find_disc(double azimuth, double elevation, uint32_t size)
{
    disc_stage s = {.size = size};
    double sun[3];
    find_sun_vector(azimuth, elevation, sun);
    s.disc.shares = calloc(sun_disc_share_limit(size), sizeof *s.disc.shares);
    assert_non_null(s.disc.shares);
    sun_disc_find(sun, 1.0, size, &s.disc);
    assert_true(s.disc.share_count <= sun_disc_share_limit(size));
    return s;
}

static double sum_shares(const disc_stage *s, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < s->disc.share_count; i++)
        sum += s->disc.shares[i].part[channel];
    return sum;
}

/* Green light of the disc in a texel by brute force: points on a grid over the whole disc. */
static void share_out_by_points(const double sun[3], uint32_t size, double *texels)
{
    enum { GRID = 600 };
    double a[3] = {sun[2], 0, -sun[0]}, norm = hypot(a[0], a[2]), radius = 959.63 / 3600 * TO_RADIANS, total = 0;
    a[0] /= norm;
    a[2] /= norm;
    double b[3] = {sun[1] * a[2], sun[2] * a[0] - sun[0] * a[2], -sun[1] * a[0]};
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < GRID * GRID; i++) {
            double x = (2.0 * (i % GRID) + 1) / GRID - 1, y = (2.0 * (i / GRID) + 1) / GRID - 1; /* sines / sine */
            if (x * x + y * y >= 1)
                continue;
            double s = sin(radius), along = sqrt(1 - s * s * (x * x + y * y));
            double light = pow(1 - x * x - y * y, 0.5 * (-0.023 + 0.292 / 0.55)) / along;
            float d[3];
            for (int k = 0; k < 3; k++)
                d[k] = (float)(along * sun[k] + s * (x * a[k] + y * b[k]));
            total += pass == 0 ? light : 0;
            cube_position at = cube_project(vec3_from(d));
            if (pass == 1 && d[1] > 0)
                texels[(at.face * size + cube_texel(at.v, size)) * size + cube_texel(at.u, size)] += light / total;
        }
}

static void each_texel_gets_what_it_covers_of_the_disc(void **state)
{
    (void)state;
    static const double places[][2] = {{200, 40}, {225.1, 12}, {45, 35.2643897}, {90.05, 0.05}, {312, 45.1}};
    static const uint32_t sizes[] = {64, 512, 1500};
    const size_t count = is_thorough() ? 3 : 2;
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (size_t i = 0; i < count; i++) {
            uint32_t size = sizes[i];
            double sun[3], *texels = calloc((size_t)6 * size * size, sizeof *texels), difference = 0;
            assert_non_null(texels);
            find_sun_vector(places[p][0], places[p][1], sun);
            share_out_by_points(sun, size, texels);
            disc_stage s = find_disc(places[p][0], places[p][1], size);
            for (size_t k = 0; k < s.disc.share_count; k++) {
                const sun_share *share = &s.disc.shares[k];
                texels[(share->face * (size_t)size + share->row) * size + share->column] -= share->part[1];
            }
            for (size_t k = 0; k < (size_t)6 * size * size; k++)
                difference += fabs(texels[k]);
            assert_true(difference < 8e-3); /* of the grid of points, at the texels' borders */
            free(s.disc.shares);
            free(texels);
        }
}

static void setting_sun_is_cut_at_the_horizon(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 7, 512};
    for (int i = 0; i < 3; i++) {
        double before = 1;
        for (double elevation = 0.3; elevation > -0.3; elevation -= 0.01) {
            disc_stage s = find_disc(123, elevation, sizes[i]);
            double seen = sum_shares(&s, 0);
            assert_true(seen <= before + 1e-12 && before - seen < 0.035);
            if (elevation > 0.267)
                assert_true(fabs(seen - 1) < 1e-12);
            if (elevation < -0.267)
                assert_true(seen < 1e-12);
            before = seen;
            free(s.disc.shares);
        }
        disc_stage half = find_disc(123, 0, sizes[i]);
        assert_true(fabs(sum_shares(&half, 2) - 0.5) < 1e-4);
        free(half.disc.shares);
    }
}

/* ---- how much light there is --------------------------------------------------------------- */

static double luminance_of(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* Irradiance of the ground per channel. */
static void find_ground_irradiance(const stage *s, const float *cube, double irradiance[3])
{
    uint32_t size = s->size;
    irradiance[0] = irradiance[1] = irradiance[2] = 0;
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        double d[3];
        texel_direction(size, i / (size * size), i / size % size, i % size, d);
        for (uint32_t c = 0; c < 3 && d[1] > 0; c++)
            irradiance[c] += s->solid_angles[i % (size * size)] * d[1] * (double)cube[3 * i + c];
    }
}

/* The clear day of the IES, "Recommended Practice for the Calculation of Daylight Availability", J. Illuminating
 * Engineering Society 13(4), 1984: 127.5 exp(-0.21 / sin h) klx of sunlight across the beam, 0.8 + 15.5 sqrt(sin h) klx
 * of skylight on the ground. A turbidity of 2 is such a day. */
static void illuminances_are_those_of_a_clear_day(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, 128);
    for (double elevation = 20; elevation <= 90; elevation += 10) {
        helio_sky_desc desc = describe(180, elevation, 2, 0.2f);
        double total[3], sky[3], up = sin(elevation * TO_RADIANS);
        find_ground_irradiance(&s, update(&s, desc), total);
        desc.no_disc = true;
        find_ground_irradiance(&s, update(&s, desc), sky);
        double klx = HELIO_SKY_CANDELAS / 1000, skylight = klx * luminance_of(sky);
        double sunlight = (klx * luminance_of(total) - skylight) / up;
        print_message("%2.0f degrees: sun %.1f klx (%.1f), sky %.1f klx (%.1f)\n", elevation, sunlight,
                      127.5 * exp(-0.21 / up), skylight, 0.8 + 15.5 * sqrt(up));
        assert_true(fabs(sunlight / (127.5 * exp(-0.21 / up)) - 1) < 0.12);
        assert_true(fabs(skylight / (0.8 + 15.5 * sqrt(up)) - 1) < 0.2);
    }
    destroy_stage(&s);
    helio_context_destroy(context);
}

/* Janiczek and DeYoung's illuminances, see sky_twilight.c; 15 % for turbidities and albedos. */
static void twilight_has_published_illuminances(void **state)
{
    (void)state;
    static const double published[][2] = {{-6, 3.4}, {-12, 0.00805}, {-18, 0.000646}};
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, 128);
    for (int i = 0; i < 3; i++)
        for (float turbidity = 2; turbidity <= 6; turbidity += 2) {
            double irradiance[3];
            find_ground_irradiance(&s, update(&s, describe(10, published[i][0], turbidity, 0.2f)), irradiance);
            double lux = HELIO_SKY_CANDELAS * luminance_of(irradiance);
            assert_true(fabs(lux / published[i][1] - 1) < 0.15);
        }
    destroy_stage(&s);
    helio_context_destroy(context);
}

static void ground_is_lit_by_sun_and_sky(void **state)
{
    (void)state;
    static const double elevations[] = {90, 30, 5, 0.1, -4, -30};
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, 256);
    for (int e = 0; e < 6; e++) {
        double irradiance[3];
        const float *cube = update(&s, describe(70, elevations[e], 4, 0.6f));
        find_ground_irradiance(&s, cube, irradiance);
        for (int c = 0; c < 3; c++) /* texels of 1.4 degrees against those of 0.35 */
            assert_true(fabs((double)cube[3 * 3 * s.size * s.size + c] * PI / 0.6 / irradiance[c] - 1) < 2e-3);
        for (uint32_t i = 0; i < s.size * s.size; i++)
            assert_memory_equal(cube + 3 * (3 * s.size * s.size + i), cube + 3 * 3 * s.size * s.size, 12);
        assert_memory_equal(cube + 3 * (s.size / 2 * s.size), cube + 3 * 3 * s.size * s.size, 12); /* below on +X */
    }
    destroy_stage(&s);
    helio_context_destroy(context);
}

/* ---- a day --------------------------------------------------------------------------------- */

/* Solid angle x cosine to the zenith of all texels. */
static double *find_ground_weights(const stage *s)
{
    uint32_t size = s->size;
    double *weights = calloc((size_t)6 * size * size, sizeof *weights);
    assert_non_null(weights);
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        double d[3];
        texel_direction(size, i / (size * size), i / size % size, i % size, d);
        weights[i] = d[1] > 0 ? s->solid_angles[i % (size * size)] * d[1] : 0;
    }
    return weights;
}

/* Irradiance of the ground by sky and sun, each minute. Its logarithm has bounded steps, and bounded differences
 * between steps: it neither jumps nor has corners. Texels are smaller than the sun, which they would else move by
 * jerks.
 */
static void light_of_a_day_is_smooth(void **state)
{
    (void)state;
    const uint32_t size = is_thorough() ? 192 : 64;
    static const struct {
        helio_sky_place place;
        float turbidity;
        int first, last; /* minutes: a whole day; the steepest sunrise */
    } days[] = {{{44.8, 0, 2026, 6, 21, 0, 0}, 3, 0, 24 * 60}, {{0, 0, 2026, 3, 20, 0, 0}, 6, 270, 450}};
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, size);
    double *weights = find_ground_weights(&s);
    for (int i = 0; i < 2; i++) {
        double before[3] = {0}, step_before[3] = {0}, largest_step = 0, largest_bend = 0;
        for (int minute = days[i].first; minute <= days[i].last; minute++) {
            helio_sky_place place = days[i].place;
            place.hours = minute / 60.0;
            helio_sky_desc desc = {.turbidity = days[i].turbidity, .albedo = 0.2f};
            assert_ok(helio_sun_find(&place, &desc.sun));
            const float *cube = update(&s, desc);
            double irradiance[3] = {0};
            for (uint32_t k = 0; k < 6 * size * size; k++)
                for (uint32_t c = 0; c < 3; c++)
                    irradiance[c] += weights[k] * (double)cube[3 * k + c];
            for (int c = 0; c < 3; c++) {
                double value = log(irradiance[c]), step = value - before[c];
                largest_step = minute > days[i].first ? fmax(largest_step, fabs(step)) : 0;
                largest_bend = minute > days[i].first + 1 ? fmax(largest_bend, fabs(step - step_before[c])) : 0;
                before[c] = value;
                step_before[c] = step;
            }
        }
        print_message("largest step %.3f, largest difference of steps %.4f\n", largest_step, largest_bend);
        assert_true(largest_step < 0.42); /* twilight falls by a factor of up to 4 per degree, 3.7 minutes here */
        assert_true(largest_bend < 0.04);
    }
    free(weights);
    destroy_stage(&s);
    helio_context_destroy(context);
}

/* Not only the ground: every texel, from one minute to the next, compared with the brightest of its face. */
static void no_texel_of_the_sky_jumps_at_sunrise(void **state)
{
    (void)state;
    enum { SIZE = 16, NUMBERS = 6 * SIZE * SIZE * 3 };
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, SIZE);
    float *before = calloc(NUMBERS, sizeof *before);
    assert_non_null(before);
    for (double elevation = -20; elevation < 5; elevation += 0.05) {
        helio_sky_desc desc = describe(80, elevation, 3, 0.2f);
        desc.no_disc = true;
        const float *cube = update(&s, desc);
        for (int i = 0; i < NUMBERS && elevation > -20; i++)
            assert_true(fabs((double)cube[i] - (double)before[i]) < 0.15 * (double)cube[i]);
        memcpy(before, cube, NUMBERS * sizeof *before);
    }
    free(before);
    destroy_stage(&s);
    helio_context_destroy(context);
}

/* ---- sizes, extremes, machines ------------------------------------------------------------- */

static void small_cubes_have_the_light_of_large_ones(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 3, 8, 50, 127, 128, 129, 1024};
    helio_context *context = make_context(2, NULL);
    helio_sky_desc desc = describe(250, 25, 3, 0.3f);
    double expected[3], flux[3];
    stage fine = make_stage(context, 512);
    desc.no_disc = true;
    find_flux(&fine, update(&fine, desc), false, expected);
    destroy_stage(&fine);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        stage s = make_stage(context, sizes[i]);
        find_flux(&s, update(&s, desc), false, flux);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(flux[c] / expected[c] - 1) < 5e-4);
        destroy_stage(&s);
    }
    helio_context_destroy(context);
}

static void all_turbidities_albedos_and_elevations_give_light(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    stage s = make_stage(context, 20);
    const double step = is_thorough() ? 4 : 11;
    for (double elevation = -90; elevation <= 90; elevation += elevation > -1 && elevation < 2 ? 0.25 : step)
        for (float turbidity = 1; turbidity <= 10; turbidity += 1.5f)
            for (float albedo = 0; albedo <= 1; albedo += 0.5f) {
                const float *cube = update(&s, describe(300, elevation, turbidity, albedo));
                double upper[3];
                for (int i = 0; i < 6 * 20 * 20 * 3; i++)
                    assert_true(isfinite(cube[i]) && cube[i] >= 0);
                find_flux(&s, cube, true, upper);
                assert_true(upper[0] > 0 && upper[1] > 0 && upper[2] > 0);
            }
    destroy_stage(&s);
    helio_context_destroy(context);
}

static void run_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    while (count-- > 0)
        body(data, count);
}

static void machines_and_threads_give_the_same_bits(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 5, 64, 129, 300};
    static const double elevations[] = {60, 0.1, -5};
    for (int i = 0; i < (is_thorough() ? 5 : 4); i++)
        for (int e = 0; e < 3; e++) {
            uint32_t size = sizes[i];
            size_t bytes = (size_t)6 * size * size * 3 * sizeof(float);
            float *expected = malloc(bytes);
            assert_non_null(expected);
            for (uint32_t set = 0; helio_isa_name(set) != NULL; set++)
                for (uint32_t threads = 0; threads < 3; threads++) {
                    const helio_context_desc desc = {.isa = helio_isa_name(set),
                                                     .threads = threads,
                                                     .parallel_for = threads == 0 ? run_backwards : NULL};
                    helio_context *context;
                    assert_ok(helio_context_create(&desc, &context));
                    stage s = make_stage(context, size);
                    const float *cube = update(&s, describe(33, elevations[e], 2.5f, 0.25f));
                    if (set == 0 && threads == 0)
                        memcpy(expected, cube, bytes);
                    assert_memory_equal(cube, expected, bytes);
                    destroy_stage(&s);
                    helio_context_destroy(context);
                }
            free(expected);
        }
}

static void updates_take_no_memory_and_count_frames(void **state)
{
    (void)state;
    memory_count count = {0};
    helio_context *context = make_context(2, &count);
    stage s = make_stage(context, 100);
    size_t taken = atomic_load(&count.taken);
    for (int i = 0; i < 10; i++) {
        helio_environment_info info;
        helio_sky_desc desc = describe(36.0 * i, 10.0 * i - 20, 3, 0.2f);
        assert_ok(helio_sky_update(s.sky, &desc, s.environment, &info));
        assert_int_equal(helio_environment_frame(s.environment), i + 1);
        assert_true(info.mean_luminance > 0 && info.bad.nan + info.bad.infinite + info.bad.negative == 0);
    }
    assert_int_equal(atomic_load(&count.taken), taken);
    destroy_stage(&s);
    helio_context_destroy(context);
    assert_int_equal(atomic_load(&count.live), 0);
}

static void smaller_environments_share_a_sky(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    stage large = make_stage(context, 64), small = make_stage(context, 16);
    helio_sky_desc desc = describe(0, 45, 0, 0);
    assert_ok(helio_sky_update(large.sky, &desc, small.environment, NULL));
    const float *cube = helio_environment_cube(small.environment);
    desc.turbidity = 3; /* which is the default */
    float *copy = malloc(6 * 16 * 16 * 12);
    assert_non_null(copy);
    memcpy(copy, cube, 6 * 16 * 16 * 12);
    assert_memory_equal(update(&small, desc), copy, 6 * 16 * 16 * 12);
    free(copy);
    assert_int_equal(helio_sky_update(small.sky, &desc, large.environment, NULL), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "64"));
    destroy_stage(&small);
    destroy_stage(&large);
    helio_context_destroy(context);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    stage s = make_stage(context, 4);
    helio_sky *sky;
    const float nan = strtof("nan", NULL);
    const helio_sky_desc wrong[] = {
        describe(0, 10, 0.5f, 0), describe(0, 10, 11, 0),  describe(0, 10, nan, 0), describe(0, 10, 3, -0.1f),
        describe(0, 10, 3, 2),    describe(0, 10, 3, nan), describe(0, 91, 3, 0),   describe(0, (double)nan, 3, 0),
        describe(400, 0, 3, 0),   {.sun = {0, 10, 30}},    {.sun = {0, 10, -1}}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(helio_sky_update(s.sky, &wrong[i], s.environment, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_frame(s.environment), 0);
    assert_int_equal(helio_sky_update(NULL, &wrong[0], s.environment, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sky_update(s.sky, NULL, s.environment, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sky_update(s.sky, &wrong[0], NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sky_create(context, 0, &sky), HELIO_ERR_ARGUMENT);
    assert_null(sky);
    assert_int_equal(helio_sky_create(context, 4097, &sky), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sky_create(NULL, 4, &sky), HELIO_ERR_ARGUMENT);
    helio_sky_destroy(NULL);
    destroy_stage(&s);
    helio_context_destroy(context);
}

static void memory_that_runs_out_is_told(void **state)
{
    (void)state;
    memory_count count = {0};
    helio_context *context = make_context(1, &count);
    size_t before = atomic_load(&count.live);
    helio_sky *sky = NULL;
    for (size_t allowed = 0; sky == NULL; allowed++) {
        count.refuse_after = atomic_load(&count.taken) + allowed;
        helio_status status = helio_sky_create(context, 16, &sky);
        assert_int_equal(status, sky != NULL ? HELIO_OK : HELIO_ERR_MEMORY);
        assert_true(sky != NULL || atomic_load(&count.live) == before);
        assert_true(allowed < 10);
    }
    helio_sky_destroy(sky);
    assert_int_equal(atomic_load(&count.live), before);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radiance_is_that_of_the_published_model),
        cmocka_unit_test(angles_of_versines_are_exact),
        cmocka_unit_test(flux_of_the_sun_does_not_depend_on_the_size_of_texels),
        cmocka_unit_test(each_texel_gets_what_it_covers_of_the_disc),
        cmocka_unit_test(setting_sun_is_cut_at_the_horizon),
        cmocka_unit_test(illuminances_are_those_of_a_clear_day),
        cmocka_unit_test(twilight_has_published_illuminances),
        cmocka_unit_test(ground_is_lit_by_sun_and_sky),
        cmocka_unit_test(light_of_a_day_is_smooth),
        cmocka_unit_test(no_texel_of_the_sky_jumps_at_sunrise),
        cmocka_unit_test(small_cubes_have_the_light_of_large_ones),
        cmocka_unit_test(all_turbidities_albedos_and_elevations_give_light),
        cmocka_unit_test(machines_and_threads_give_the_same_bits),
        cmocka_unit_test(updates_take_no_memory_and_count_frames),
        cmocka_unit_test(smaller_environments_share_a_sky),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(memory_that_runs_out_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
