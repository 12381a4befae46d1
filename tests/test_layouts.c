/* SPDX-License-Identifier: MIT
 * Layouts: every way from a map into the cube and back, between all of them. Where a point of a map lies on the sphere
 * is written here a second time, from the definitions. */
#include "support.h"

#include "core/vector.h"
#include "env/environment.h"
#include "env/map_pixels.h"

#include <heliostat/image.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static helio_context *shared_context; /* two threads, memory counted */
static memory_count shared_memory;

/* ---- layouts, by hand ---------------------------------------------------------------------- */

static const helio_layout layouts[] = {HELIO_LAYOUT_LATLONG,    HELIO_LAYOUT_CROSS_V,       HELIO_LAYOUT_CROSS_H,
                                       HELIO_LAYOUT_STRIP,      HELIO_LAYOUT_STRIP_OPENEXR, HELIO_LAYOUT_OCTAHEDRAL,
                                       HELIO_LAYOUT_EQUAL_AREA, HELIO_LAYOUT_ANGULAR,       HELIO_LAYOUT_MIRRORBALL};
enum { LAYOUTS = sizeof layouts / sizeof *layouts };

static bool is_square(helio_layout layout)
{
    return layout >= HELIO_LAYOUT_OCTAHEDRAL;
}

static bool is_disc(helio_layout layout)
{
    return layout == HELIO_LAYOUT_ANGULAR || layout == HELIO_LAYOUT_MIRRORBALL;
}

static void set(double d[3], double x, double y, double z)
{
    double length_of_d = sqrt(x * x + y * y + z * z);
    d[0] = x / length_of_d, d[1] = y / length_of_d, d[2] = z / length_of_d;
}

static bool find_on_face(int face, double u, double v, double d[3])
{
    const double table[6][3] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    set(d, table[face][0], table[face][1], table[face][2]);
    return true;
}

/* Which faces of a cross stand where; -1: none. */
static bool find_in_cross(bool upright, double x, double y, double d[3])
{
    const int high[4][3] = {{-1, 2, -1}, {1, 4, 0}, {-1, 3, -1}, {-1, 5, -1}};
    const int wide[3][4] = {{-1, 2, -1, -1}, {1, 4, 0, 5}, {-1, 3, -1, -1}};
    double across = x * (upright ? 3 : 4), down = y * (upright ? 4 : 3);
    int column = (int)across, row = (int)down, face = upright ? high[row][column] : wide[row][column];
    double u = 2 * (across - column) - 1, v = 2 * (down - row) - 1;
    if (face < 0)
        return false;
    return upright && face == 5 ? find_on_face(face, -u, -v, d) : find_on_face(face, u, v, d);
}

static bool find_by_openexr(double x, double y, uint32_t size, double d[3])
{
    int face = (int)(6 * y);
    double s = size > 1 ? (2 * x * size - 1) / (size - 1.0) - 1 : 0;
    double t = size > 1 ? (2 * (6 * y - face) * size - 1) / (size - 1.0) - 1 : 0;
    const double table[6][3] = {{1, -t, s}, {-1, -t, -s}, {s, 1, -t}, {s, -1, t}, {-s, -t, 1}, {s, -t, -1}};
    set(d, table[face][0], table[face][1], table[face][2]);
    return fabs(s) <= 1 && fabs(t) <= 1;
}

static bool find_octahedral(double a, double b, double d[3])
{
    double y = 1 - fabs(a) - fabs(b);
    if (y >= 0)
        set(d, a, y, -b);
    else
        set(d, (1 - fabs(b)) * (a < 0 ? -1 : 1), y, (1 - fabs(a)) * (b < 0 ? 1 : -1));
    return true;
}

/* Circles of latitude are squares, and areas are kept: a square out to r = |a| + |b| <= 1 has the area 2 r^2 of 4, the
 * cap above it 2 pi (1 - sin latitude) of 4 pi. Along a side the longitude grows evenly. */
static bool find_equal_area(double a, double b, double d[3])
{
    double r = fabs(a) + fabs(b), height = 1 - r * r, along = fabs(b) / r;
    if (r > 1) {
        double from_corner = 2 - r;
        height = from_corner * from_corner - 1;
        along = (1 - fabs(a)) / from_corner;
    }
    double longitude = r > 0 ? PI / 2 * along : 0, radius = sqrt(fmax(0, 1 - height * height));
    set(d, radius * cos(longitude) * (a < 0 ? -1 : 1), height, radius * sin(longitude) * (b < 0 ? 1 : -1));
    return true;
}

static bool find_on_disc(bool ball, double a, double b, double d[3])
{
    double r = sqrt(a * a + b * b), angle = ball ? 2 * asin(fmin(r, 1)) : PI * r;
    double around = r > 0 ? sin(angle) / r : 0;
    set(d, a * around, -b * around, -cos(angle));
    return r < 1;
}

/* Direction of a point of a map, counted in parts of its width and height. False where the map shows nothing. */
static bool find_direction(helio_layout layout, uint32_t width, uint32_t height, double x, double y, double d[3])
{
    double latitude = PI * (0.5 - y), longitude = PI * (1 - 2 * x);
    int face = (int)(6 * (height > width ? y : x));
    switch (layout) {
    case HELIO_LAYOUT_LATLONG:
        set(d, cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude));
        return true;
    case HELIO_LAYOUT_CROSS_V: return find_in_cross(true, x, y, d);
    case HELIO_LAYOUT_CROSS_H: return find_in_cross(false, x, y, d);
    case HELIO_LAYOUT_STRIP_OPENEXR: return find_by_openexr(x, y, width, d);
    case HELIO_LAYOUT_OCTAHEDRAL: return find_octahedral(2 * x - 1, 2 * y - 1, d);
    case HELIO_LAYOUT_EQUAL_AREA: return find_equal_area(2 * x - 1, 2 * y - 1, d);
    case HELIO_LAYOUT_ANGULAR: return find_on_disc(false, 2 * x - 1, 2 * y - 1, d);
    case HELIO_LAYOUT_MIRRORBALL: return find_on_disc(true, 2 * x - 1, 2 * y - 1, d);
    default:
        return height > width ? find_on_face(face, 2 * x - 1, 2 * (6 * y - face) - 1, d)
                              : find_on_face(face, 2 * (6 * x - face) - 1, 2 * y - 1, d);
    }
}

/* ---- maps ------------------------------------------------------------------------------------ */

typedef struct map {
    helio_layout layout;
    uint32_t width, height;
    float *rgb; /* [height][width][3] */
} map;

static map make_map(helio_layout layout, uint32_t width, uint32_t height)
{
    map m = {layout, width, height, calloc((size_t)width * height, 3 * sizeof(float))};
    assert_non_null(m.rgb);
    return m;
}

static map make_map_for(helio_layout layout, uint32_t size)
{
    uint32_t width, height;
    assert_ok(helio_layout_shape(layout, size, &width, &height));
    return make_map(layout, width, height);
}

static map make_random_map(helio_layout layout, uint32_t width, uint32_t height, uint64_t seed)
{
    map m = make_map(layout, width, height);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        m.rgb[i] = (float)pow(random_unit(&seed), 4);
    return m;
}

static float *pixel_of(const map *m, uint32_t row, uint32_t column)
{
    return m->rgb + ((size_t)row * m->width + column) * 3;
}

static size_t count_numbers(const map *m)
{
    return (size_t)m->width * m->height * 3;
}

/* Every direction has a colour of its own, and a map that is mirrored or turned shows others. */
static double colour_of(const double d[3], int channel)
{
    return 1 + 0.5 * d[channel];
}

/* Average over a pixel, from a grid of points in it, each with the solid angle around it. Returns that of the pixel in
 * all, as a part of the sphere per area of the map; 0 where it shows nothing. */
static double average_of_pixel(const map *m, uint32_t row, uint32_t column, int grid, double average[3])
{
    const double step = 1e-4;
    double sum[3] = {0}, weights = 0;
    for (int i = 0; i < grid * grid; i++) {
        double x = (column + (i % grid + 0.5) / grid) / m->width, y = (row + (i / grid + 0.5) / grid) / m->height;
        double d[3], right[3], down[3], h = step / fmax(m->width, m->height) / grid;
        if (!find_direction(m->layout, m->width, m->height, x, y, d) ||
            !find_direction(m->layout, m->width, m->height, x + h, y, right) ||
            !find_direction(m->layout, m->width, m->height, x, y + h, down))
            continue;
        double a[3], b[3];
        for (int c = 0; c < 3; c++)
            a[c] = (right[c] - d[c]) / h, b[c] = (down[c] - d[c]) / h;
        double weight = fabs(d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
                             d[2] * (a[0] * b[1] - a[1] * b[0]));
        for (int c = 0; c < 3; c++)
            sum[c] += weight * colour_of(d, c);
        weights += weight;
    }
    for (int c = 0; c < 3; c++)
        average[c] = weights > 0 ? sum[c] / weights : 0;
    return weights;
}

static map make_orientation_map(helio_layout layout, uint32_t size)
{
    map m = make_map_for(layout, size);
    for (uint32_t row = 0; row < m.height; row++)
        for (uint32_t column = 0; column < m.width; column++) {
            double average[3];
            average_of_pixel(&m, row, column, 4, average);
            for (int c = 0; c < 3; c++)
                pixel_of(&m, row, column)[c] = (float)average[c];
        }
    return m;
}

static helio_environment *make_from_map(const map *m, uint32_t size, helio_environment_info *info)
{
    return make_environment(shared_context, m->layout, m->width, m->height, size, m->rgb, info);
}

static map unfold(const helio_environment *environment, helio_layout layout, uint32_t width, uint32_t height)
{
    map m = make_map(layout, width, height);
    for (size_t i = 0; i < count_numbers(&m); i++)
        m.rgb[i] = NAN; /* all of it is written */
    assert_ok(helio_environment_unfold(environment, layout, width, height, m.rgb));
    return m;
}

static double total_flux(const helio_environment_info *info)
{
    double sum = 0;
    for (int face = 0; face < 6; face++)
        sum += info->flux[face];
    return sum;
}

/* ---- directions -------------------------------------------------------------------------------- */

/* Each texel shows the colour of its direction, also at edges, poles and folds and where discs end. */
static void expect_colours_in_cube(const helio_environment *environment, double tolerance, const char *what)
{
    uint32_t size = environment->size;
    for (uint32_t texel = 0; texel < 6 * size * size; texel++) {
        double d[3];
        find_on_face((int)(texel / size / size), (2.0 * (texel % size) + 1) / size - 1,
                     (2.0 * (texel / size % size) + 1) / size - 1, d);
        for (int c = 0; c < 3; c++) {
            double value = (double)environment->cube[texel * 3 + (uint32_t)c];
            if (!(fabs(value - colour_of(d, c)) < tolerance))
                fail_msg("%s: face %u (%u, %u)[%d] is %g, not %g", what, texel / size / size, texel / size % size,
                         texel % size, c, value, colour_of(d, c));
        }
    }
}

static void every_layout_shows_each_direction_where_it_is(void **state)
{
    (void)state;
    for (int i = 0; i < LAYOUTS; i++) {
        map m = make_orientation_map(layouts[i], 64);
        helio_environment *environment = make_from_map(&m, 32, NULL);
        /* Pixels of a mirror ball reach far at its rim, and there a texel sees parts of them. */
        expect_colours_in_cube(environment, layouts[i] == HELIO_LAYOUT_MIRRORBALL ? 0.05 : 0.012,
                               helio_layout_name(layouts[i]));
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

static void unfolded_maps_show_each_direction_where_it_is(void **state)
{
    (void)state;
    map strip = make_orientation_map(HELIO_LAYOUT_STRIP, 96);
    helio_environment *environment = make_from_map(&strip, 96, NULL);
    for (int i = 0; i < LAYOUTS; i++) {
        uint32_t width, height;
        assert_ok(helio_layout_shape(layouts[i], 24, &width, &height));
        map m = unfold(environment, layouts[i], width, height);
        for (uint32_t row = 0; row < height; row++)
            for (uint32_t column = 0; column < width; column++) {
                double average[3], covered = average_of_pixel(&m, row, column, 8, average);
                const float *pixel = pixel_of(&m, row, column);
                for (int c = 0; c < 3; c++)
                    if (!(fabs((double)pixel[c] - average[c]) < (is_disc(layouts[i]) ? 0.02 : 0.006)) && covered > 0)
                        fail_msg("%s: pixel (%u, %u)[%d] is %g, not %g", helio_layout_name(layouts[i]), row, column, c,
                                 (double)pixel[c], average[c]);
            }
        free(m.rgb);
    }
    helio_environment_destroy(environment);
    free(strip.rgb);
}

static void pixels_outside_of_discs_and_crosses_are_black(void **state)
{
    (void)state;
    map white = make_map(HELIO_LAYOUT_LATLONG, 1, 1);
    white.rgb[0] = white.rgb[1] = white.rgb[2] = 1;
    helio_environment *environment = make_from_map(&white, 7, NULL);
    const helio_layout with_outside[] = {HELIO_LAYOUT_CROSS_V, HELIO_LAYOUT_CROSS_H, HELIO_LAYOUT_ANGULAR,
                                         HELIO_LAYOUT_MIRRORBALL};
    for (int i = 0; i < 4; i++) {
        uint32_t width, height;
        assert_ok(helio_layout_shape(with_outside[i], 9, &width, &height));
        map m = unfold(environment, with_outside[i], width, height);
        for (uint32_t row = 0; row < height; row++)
            for (uint32_t column = 0; column < width; column++) {
                bool inside = false;
                for (int k = 0; k < 400; k++) {
                    double d[3];
                    inside |= find_direction(with_outside[i], width, height, (column + (k % 20 + 0.5) / 20) / width,
                                             (row + (k / 20 + 0.5) / 20) / height, d);
                }
                for (int c = 0; c < 3; c++) {
                    float value = pixel_of(&m, row, column)[c];
                    assert_true(inside ? fabsf(value - 1) < 1e-6f : value == 0 || fabsf(value - 1) < 1e-6f);
                }
            }
        assert_true(m.rgb[0] == 0 && m.rgb[count_numbers(&m) - 1] == 0);
        free(m.rgb);
    }
    helio_environment_destroy(environment);
    free(white.rgb);
}

/* ---- round trips ------------------------------------------------------------------------------ */

/* From one environment to a map of the layout, and back to another environment, which is made for such maps. */
static void expect_orientation_survives(helio_environment *environment, helio_layout from, helio_environment *back,
                                        helio_layout to, double *worst)
{
    char what[64];
    map there = unfold(environment, to, back->map.width, back->map.height);
    assert_ok(helio_environment_update(back, there.rgb, NULL));
    snprintf(what, sizeof what, "%s to %s", helio_layout_name(from), helio_layout_name(to));
    bool ball = from == HELIO_LAYOUT_MIRRORBALL || to == HELIO_LAYOUT_MIRRORBALL;
    expect_colours_in_cube(back, ball ? 0.1 : 0.03, what);
    for (size_t i = 0; i < (size_t)18 * back->size * back->size; i++)
        *worst = fmax(*worst, fabs((double)back->cube[i] - (double)environment->cube[i]));
    free(there.rgb);
}

static void orientation_survives_between_all_pairs_of_layouts(void **state)
{
    (void)state;
    const uint32_t size = is_thorough() ? 48 : 32;
    double worst = 0;
    helio_environment *environments[LAYOUTS], *backs[LAYOUTS];
    for (int i = 0; i < LAYOUTS; i++) {
        map m = make_orientation_map(layouts[i], 2 * size);
        environments[i] = make_from_map(&m, size, NULL);
        backs[i] = make_from_map(&m, size, NULL);
        free(m.rgb);
    }
    for (int i = 0; i < LAYOUTS * LAYOUTS; i++) {
        int from = i / LAYOUTS, to = i % LAYOUTS;
        expect_orientation_survives(environments[from], layouts[from], backs[to], layouts[to], &worst);
    }
    for (int i = 0; i < LAYOUTS; i++) {
        helio_environment_destroy(environments[i]);
        helio_environment_destroy(backs[i]);
    }
    printf("between all pairs, texels differ by at most %.3g of the brightest\n", worst / 1.5);
}

/* Faces are copied between layouts of faces, whatever their places. */
static void crosses_and_strips_of_one_size_are_copies(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 8, 17};
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 3; k++) {
            const helio_layout places[3] = {HELIO_LAYOUT_CROSS_V, HELIO_LAYOUT_CROSS_H, HELIO_LAYOUT_FACES};
            uint32_t size = sizes[i], width, height;
            map strip = make_random_map(HELIO_LAYOUT_STRIP, size, 6 * size, 7);
            helio_environment *environment = make_from_map(&strip, size, NULL);
            assert_memory_equal(environment->cube, strip.rgb, count_numbers(&strip) * sizeof(float));
            assert_ok(helio_layout_shape(places[k], size, &width, &height));
            map cross = unfold(environment, places[k], width, height);
            helio_environment *back = make_from_map(&cross, size, NULL);
            for (size_t n = 0; n < count_numbers(&strip); n++)
                assert_true(fabsf(back->cube[n] - strip.rgb[n]) <= 2e-7f * strip.rgb[n]);
            helio_environment_destroy(back);
            helio_environment_destroy(environment);
            free(cross.rgb);
            free(strip.rgb);
        }
}

/* ---- light ------------------------------------------------------------------------------------- */

static const map shapes[] = {{HELIO_LAYOUT_CROSS_V, 3, 4, NULL},       {HELIO_LAYOUT_CROSS_V, 15, 20, NULL},
                             {HELIO_LAYOUT_CROSS_H, 4, 3, NULL},       {HELIO_LAYOUT_CROSS_H, 28, 21, NULL},
                             {HELIO_LAYOUT_OCTAHEDRAL, 2, 2, NULL},    {HELIO_LAYOUT_OCTAHEDRAL, 7, 7, NULL},
                             {HELIO_LAYOUT_OCTAHEDRAL, 64, 64, NULL},  {HELIO_LAYOUT_EQUAL_AREA, 2, 2, NULL},
                             {HELIO_LAYOUT_EQUAL_AREA, 5, 5, NULL},    {HELIO_LAYOUT_EQUAL_AREA, 66, 66, NULL},
                             {HELIO_LAYOUT_ANGULAR, 2, 2, NULL},       {HELIO_LAYOUT_ANGULAR, 3, 3, NULL},
                             {HELIO_LAYOUT_ANGULAR, 65, 65, NULL},     {HELIO_LAYOUT_MIRRORBALL, 2, 2, NULL},
                             {HELIO_LAYOUT_MIRRORBALL, 9, 9, NULL},    {HELIO_LAYOUT_MIRRORBALL, 100, 100, NULL},
                             {HELIO_LAYOUT_LATLONG, 37, 20, NULL},     {HELIO_LAYOUT_STRIP, 30, 5, NULL},
                             {HELIO_LAYOUT_STRIP_OPENEXR, 6, 36, NULL}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void constant_maps_stay_constant_both_ways(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, 33};
    const int size_count = is_thorough() ? 5 : 4;
    const float colour[3] = {0.7f, 1e-3f, 12345.678f};
    for (int i = 0; i < SHAPES; i++)
        for (int k = 0; k < size_count; k++) {
            map m = make_map(shapes[i].layout, shapes[i].width, shapes[i].height);
            for (size_t n = 0; n < count_numbers(&m); n++)
                m.rgb[n] = colour[n % 3];
            helio_environment *environment = make_from_map(&m, sizes[k], NULL);
            map back = unfold(environment, m.layout, m.width, m.height);
            for (size_t n = 0; n < (size_t)18 * sizes[k] * sizes[k]; n++)
                assert_true(fabsf(environment->cube[n] / colour[n % 3] - 1) < 1e-5f);
            for (size_t n = 0; n < count_numbers(&m); n++)
                assert_true(back.rgb[n] == 0 || fabsf(back.rgb[n] / colour[n % 3] - 1) < 1e-5f);
            helio_environment_destroy(environment);
            free(back.rgb);
            free(m.rgb);
        }
}

/* Solid angle of a pixel: of an equal-area map the same for all, of a mirror ball 4 for the area of its whole square,
 * of an angular map by quadrature. */
static double solid_angle_of(const map *m, uint32_t row, uint32_t column)
{
    enum { GRID = 400 };
    if (m->layout == HELIO_LAYOUT_EQUAL_AREA)
        return 4 * PI / m->width / m->width;
    double sum = 0, step = 2.0 / m->width / GRID;
    for (int i = 0; i < GRID * GRID; i++) {
        double a = 2.0 * column / m->width - 1 + (i % GRID + 0.5) * step;
        double b = 2.0 * row / m->height - 1 + (i / GRID + 0.5) * step, r = sqrt(a * a + b * b);
        double length_of_octahedral = r;
        if (m->layout == HELIO_LAYOUT_OCTAHEDRAL) {
            double y = 1 - fabs(a) - fabs(b), x = y < 0 ? 1 - fabs(b) : a, z = y < 0 ? 1 - fabs(a) : b;
            length_of_octahedral = sqrt(x * x + y * y + z * z);
            sum += pow(length_of_octahedral, -3);
        } else if (r < 1) {
            sum += m->layout == HELIO_LAYOUT_MIRRORBALL ? 4 : PI * sin(PI * r) / r;
        }
    }
    return sum * step * step;
}

enum { LIGHT_SIZES = 4 };
static const uint32_t light_sizes[LIGHT_SIZES] = {1, 4, 7, 40};

/* Lights one pixel in environments of several sizes. */
static void expect_solid_angle(map *m, uint32_t row, uint32_t column, helio_environment *const *environments,
                               double worst[2])
{
    double expected = solid_angle_of(m, row, column);
    if (expected == 0)
        return;
    double furthest = hypot(fabs(2 * (column + 0.5) / m->width - 1), fabs(2 * (row + 0.5) / m->width - 1));
    bool rim = is_disc(m->layout) && furthest + 1.5 / m->width > 1;
    pixel_of(m, row, column)[1] = 1;
    for (int s = 0; s < LIGHT_SIZES; s++) {
        helio_environment_info info;
        assert_ok(helio_environment_update(environments[s], m->rgb, &info));
        double error = fabs(total_flux(&info) / 0.7152 - expected);
        /* The rim leaves slivers of some pixels, and the quadrature above is coarse there. */
        error /= rim ? expected + 0.01 * 4 * PI / m->width / m->width : expected;
        if (!(error < (rim ? 2e-3 : 2e-6)))
            fail_msg("%s %u wide, pixel (%u, %u), R = %u: %g sr, not %g", helio_layout_name(m->layout), m->width, row,
                     column, light_sizes[s], total_flux(&info) / 0.7152, expected);
        worst[rim] = fmax(error, worst[rim]);
    }
    pixel_of(m, row, column)[1] = 0;
}

/* The flux of a map with one lit pixel is the pixel's solid angle, whatever the cube's size. */
static void single_pixels_of_squares_have_their_solid_angle(void **state)
{
    (void)state;
    const uint32_t widths[] = {2, 3, 8, 33};
    const int pixels = is_thorough() ? 12 : 5;
    double worst[2] = {0};
    for (int i = 0; i < LAYOUTS; i++)
        for (int w = 0; w < 4 && is_square(layouts[i]); w++) {
            map m = make_map(layouts[i], widths[w], widths[w]);
            helio_environment *environments[LIGHT_SIZES];
            uint64_t seed = 3;
            for (int s = 0; s < LIGHT_SIZES; s++)
                environments[s] = make_from_map(&m, light_sizes[s], NULL);
            for (int k = 0; k < pixels; k++) {
                uint32_t row = random_bits(&seed) % m.height, column = random_bits(&seed) % m.width;
                expect_solid_angle(&m, row, column, environments, worst);
            }
            for (int s = 0; s < LIGHT_SIZES; s++)
                helio_environment_destroy(environments[s]);
            free(m.rgb);
        }
    printf("solid angles of pixels are off by at most %.2g, at the rim of discs %.2g\n", worst[false], worst[true]);
}

/* All pixels together fill the sphere: of random maps the cube has the light that the pixels have. */
static void random_maps_keep_their_light_both_ways(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, is_thorough() ? 64 : 24};
    double worst = 0;
    for (int i = 0; i < SHAPES; i++)
        for (int k = 0; k < 5; k++) {
            /* from a cube to the map, and to a cube of another size */
            map random = make_random_map(HELIO_LAYOUT_STRIP, sizes[k], 6 * sizes[k], 5);
            helio_environment_info here, there, back;
            helio_environment *environment = make_from_map(&random, sizes[k], &here);
            map m = unfold(environment, shapes[i].layout, shapes[i].width, shapes[i].height);
            helio_environment_destroy(make_from_map(&m, sizes[k], &there));
            helio_environment_destroy(make_from_map(&m, sizes[(k + 2) % 5], &back));
            worst = fmax(worst, fabs(total_flux(&there) / total_flux(&here) - 1));
            worst = fmax(worst, fabs(total_flux(&back) / total_flux(&here) - 1));
            if (!(worst < 1e-5))
                fail_msg("%s %ux%u at R = %u: flux %.9g, then %.9g and %.9g", helio_layout_name(m.layout), m.width,
                         m.height, sizes[k], total_flux(&here), total_flux(&there), total_flux(&back));
            helio_environment_destroy(environment);
            free(m.rgb);
            free(random.rgb);
        }
    printf("the light of random cubes changes by at most %.2g\n", worst);
}

/* A sun of one texel, 10^6 times as bright as anything, through every layout and many sizes. */
static void a_sun_of_one_texel_keeps_its_flux(void **state)
{
    (void)state;
    const uint32_t sizes[] = {16, 61, 256, 1024};
    double worst = 0;
    uint64_t seed = 17;
    for (int i = 0; i < LAYOUTS; i++)
        for (int k = 0; k < (is_thorough() ? 4 : layouts[i] == HELIO_LAYOUT_LATLONG ? 3 : 2); k++) {
            map strip = make_map(HELIO_LAYOUT_STRIP, 64, 384);
            uint32_t row = random_bits(&seed) % strip.height, column = random_bits(&seed) % strip.width;
            pixel_of(&strip, row, column)[1] = 1e6f;
            helio_environment_info here, there;
            helio_environment *environment = make_from_map(&strip, 64, &here);
            uint32_t width, height;
            assert_ok(helio_layout_shape(layouts[i], sizes[k] < 256 ? sizes[k] : 256, &width, &height));
            map m = unfold(environment, layouts[i], width, height);
            helio_environment_destroy(make_from_map(&m, sizes[k], &there));
            double error = fabs(total_flux(&there) / total_flux(&here) - 1);
            worst = fmax(worst, error);
            if (!(error < 1e-5))
                fail_msg("%s %ux%u to R = %u: %.9g instead of %.9g", helio_layout_name(m.layout), width, height,
                         sizes[k], total_flux(&there), total_flux(&here));
            helio_environment_destroy(environment);
            free(m.rgb);
            free(strip.rgb);
        }
    printf("a sun's flux changes by at most %.2g\n", worst);
}

/* ---- pixels ------------------------------------------------------------------------------------ */

static void add_faults(map *m, double chance, uint64_t seed)
{
    const float faults[] = {NAN, INFINITY, -INFINITY, 2e30f, -1, -0.0f, -2e30f, -NAN};
    size_t pixels = count_numbers(m) / 3;
    for (size_t i = 0; i < pixels; i++)
        if (random_unit(&seed) < chance)
            m->rgb[i * 3 + random_bits(&seed) % 3] = faults[random_bits(&seed) % 8];
}

static map copy_cleaned(const map *m)
{
    map cleaned = make_map(m->layout, m->width, m->height);
    for (size_t i = 0; i < count_numbers(m); i += 3) {
        bool dark = false;
        for (size_t c = 0; c < 3; c++)
            dark |= isnan(m->rgb[i + c]) || fabs((double)m->rgb[i + c]) > (double)1e30f;
        for (size_t c = 0; c < 3; c++)
            cleaned.rgb[i + c] = !dark && m->rgb[i + c] > 0 ? m->rgb[i + c] : 0;
    }
    return cleaned;
}

static size_t cube_bytes(const helio_environment *environment)
{
    return (size_t)18 * environment->size * environment->size * sizeof(float);
}

static void maps_with_faults_give_the_bits_of_cleaned_ones(void **state)
{
    (void)state;
    const double chances[] = {0.002, 0.3};
    for (int i = 0; i < 2 * SHAPES; i++) {
        const map *shape = &shapes[i / 2];
        map m = make_random_map(shape->layout, shape->width, shape->height, 41);
        add_faults(&m, chances[i % 2], 42);
        map cleaned = copy_cleaned(&m);
        helio_environment *a = make_from_map(&m, 33, NULL), *b = make_from_map(&cleaned, 33, NULL);
        assert_memory_equal(a->cube, b->cube, cube_bytes(a));
        for (size_t n = 0; n < cube_bytes(a) / sizeof(float); n++)
            assert_true(isfinite(a->cube[n]) && !signbit(a->cube[n]));
        helio_environment_destroy(a);
        helio_environment_destroy(b);
        free(cleaned.rgb);
        free(m.rgb);
    }
}

/* By the definition of IEEE binary16. */
static double value_of_half(uint16_t half)
{
    int exponent = half >> 10 & 31, fraction = half & 1023;
    double magnitude = exponent == 0    ? ldexp(fraction, -24)
                       : exponent == 31 ? (fraction == 0 ? (double)INFINITY : (double)NAN)
                                        : ldexp(1024 + fraction, exponent - 25);
    return half & 0x8000 ? -magnitude : magnitude;
}

static void all_half_numbers_have_their_value(void **state)
{
    (void)state;
    for (uint32_t half = 0; half <= UINT16_MAX; half++) {
        double expected = value_of_half((uint16_t)half);
        float value = half_to_float((uint16_t)half);
        assert_true(isnan(expected) ? isnan(value)
                                    : (double)value == expected && !signbit(value) == !signbit(expected));
    }
}

/* A map as pixels of a format in memory of exactly its size, so that nothing beyond may be read. */
typedef struct pixel_copy {
    void *memory;
    helio_pixels pixels;
} pixel_copy;

static pixel_copy copy_pixels(const map *m, const uint16_t *halves, helio_pixel_format format, size_t padding,
                              bool upwards)
{
    bool alpha = format == HELIO_PIXELS_RGBA_FLOAT || format == HELIO_PIXELS_RGBA_HALF;
    bool half = format >= HELIO_PIXELS_RGB_HALF;
    size_t number = half ? 2 : 4, channels = alpha ? 4 : 3, row_bytes = m->width * channels * number + padding * number;
    pixel_copy copy = {.memory = malloc(row_bytes * m->height - padding * number)};
    assert_non_null(copy.memory);
    memset(copy.memory, 0xff, row_bytes * m->height - padding * number); /* padding and alpha are not looked at */
    unsigned char *first = (unsigned char *)copy.memory + (upwards ? row_bytes * (m->height - 1) : 0);
    copy.pixels = (helio_pixels){first, format, upwards ? -(ptrdiff_t)row_bytes : (ptrdiff_t)row_bytes};
    for (size_t i = 0; i < count_numbers(m); i++) {
        size_t row = i / 3 / m->width, column = i / 3 % m->width;
        unsigned char *at = first + (ptrdiff_t)row * copy.pixels.row_bytes + (column * channels + i % 3) * number;
        memcpy(at, half ? (const void *)(halves + i) : (const void *)(m->rgb + i), number);
    }
    return copy;
}

static void all_pixel_formats_give_the_same_bits(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * SHAPES; i++) {
        const map *shape = &shapes[i / 2];
        map m = make_map(shape->layout, shape->width, shape->height);
        uint16_t *halves = calloc(count_numbers(&m), sizeof *halves);
        uint64_t seed = 23 + (uint64_t)i;
        assert_non_null(halves);
        for (size_t n = 0; n < count_numbers(&m); n++) { /* any bits at all, or good ones with some below 0 */
            halves[n] = (uint16_t)random_bits(&seed);
            if (i % 2)
                halves[n] = halves[n] % 0x7c00 | (random_unit(&seed) < 0.001 ? 0x8000 : 0);
            m.rgb[n] = (float)value_of_half(halves[n]);
        }
        helio_environment_info expected, info;
        helio_environment *environment = make_from_map(&m, 21, &expected);
        const size_t taken = shared_memory.taken, bytes = cube_bytes(environment);
        float *plain = malloc(bytes);
        assert_non_null(plain);
        memcpy(plain, environment->cube, bytes);
        for (int variant = 0; variant < 16; variant++) {
            pixel_copy copy =
                copy_pixels(&m, halves, (helio_pixel_format)(variant % 4), variant & 4 ? 5 : 0, variant & 8);
            memset(environment->cube, 0, bytes);
            assert_ok(helio_environment_update_pixels(environment, &copy.pixels, &info));
            assert_memory_equal(environment->cube, plain, bytes);
            assert_memory_equal(&info, &expected, sizeof info);
            free(copy.memory);
        }
        assert_int_equal(shared_memory.taken, taken); /* updates take no memory */
        helio_environment_destroy(environment);
        free(plain);
        free(halves);
        free(m.rgb);
    }
}

/* Of any words, as each is a good pixel; with every instruction set. words: [height][width]; mirrored: from
 * below. */
static void check_words(const char *isa, const map *m, const uint32_t *words, const uint32_t *mirrored)
{
    helio_context *context;
    helio_environment_info expected, info;
    assert_ok(helio_context_create(&(helio_context_desc){.threads = 1, .isa = isa}, &context));
    helio_environment *environment = make_environment(context, m->layout, m->width, m->height, 21, m->rgb, &expected);
    const size_t bytes = cube_bytes(environment);
    float *plain = malloc(bytes);
    assert_non_null(plain);
    memcpy(plain, environment->cube, bytes);
    for (int i = 0; i < 2; i++) {
        const ptrdiff_t row_bytes = (ptrdiff_t)(m->width * sizeof *words);
        const helio_pixels pixels = {words, HELIO_PIXELS_RGB9E5, 0};
        const helio_pixels upwards = {mirrored + (size_t)(m->height - 1) * m->width, HELIO_PIXELS_RGB9E5, -row_bytes};
        memset(environment->cube, 0, bytes);
        assert_ok(helio_environment_update_pixels(environment, i == 0 ? &pixels : &upwards, &info));
        assert_memory_equal(environment->cube, plain, bytes);
        assert_memory_equal(&info, &expected, sizeof info);
    }
    free(plain);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

static void shared_exponents_give_the_bits_of_floats(void **state)
{
    (void)state;
    for (int i = 0; i < SHAPES; i++) {
        map m = make_map(shapes[i].layout, shapes[i].width, shapes[i].height);
        uint64_t seed = 57 + (uint64_t)i;
        const size_t pixels = (size_t)m.width * m.height;
        uint32_t *words = malloc(pixels * sizeof *words), *mirrored = malloc(pixels * sizeof *words);
        assert_true(words != NULL && mirrored != NULL);
        for (size_t p = 0; p < pixels; p++) {
            words[p] = mirrored[(m.height - 1 - p / m.width) * m.width + p % m.width] = random_bits(&seed);
            for (size_t c = 0; c < 3; c++)
                m.rgb[3 * p + c] = ldexpf((float)(words[p] >> 9 * c & 511), (int)(words[p] >> 27) - 24);
        }
        const char *isa;
        for (uint32_t set = 0; (isa = helio_isa_name(set)) != NULL; set++)
            check_words(isa, &m, words, mirrored);
        free(words);
        free(mirrored);
        free(m.rgb);
    }
}

static void bad_pixels_are_refused(void **state)
{
    (void)state;
    _Alignas(16) float memory[64] = {0};
    helio_environment_desc desc = {.cube_size = 2, .width = 4, .height = 2};
    helio_environment *environment;
    assert_ok(helio_environment_create(shared_context, &desc, &environment));
    const helio_pixels bad[] = {{NULL, HELIO_PIXELS_RGB_FLOAT, 0},
                                {memory, (helio_pixel_format)5, 0},
                                {memory, (helio_pixel_format)-1, 0},
                                {memory, HELIO_PIXELS_RGB_FLOAT, 44},
                                {memory, HELIO_PIXELS_RGB_FLOAT, -44},
                                {memory, HELIO_PIXELS_RGB_FLOAT, 50},
                                {memory, HELIO_PIXELS_RGBA_HALF, 33},
                                {(char *)memory + 2, HELIO_PIXELS_RGB_FLOAT, 0},
                                {(char *)memory + 1, HELIO_PIXELS_RGB_HALF, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(helio_environment_update_pixels(environment, &bad[i], NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_update_pixels(environment, NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_frame(environment), 0);
    helio_environment_destroy(environment);
}

/* ---- reshaping --------------------------------------------------------------------------------- */

static void reshaped_environments_give_the_bits_of_fresh_ones(void **state)
{
    (void)state;
    helio_environment_desc desc = {.cube_size = 9}; /* no map yet */
    helio_environment *environment;
    assert_ok(helio_environment_create(shared_context, &desc, &environment));
    for (size_t n = 0; n < cube_bytes(environment) / sizeof(float); n++)
        assert_true(environment->cube[n] == 0);
    assert_int_equal(helio_environment_update(environment, (float[3]){1, 1, 1}, NULL), HELIO_ERR_ARGUMENT);
    for (int i = 0; i < SHAPES; i++) {
        map m = make_random_map(shapes[i].layout, shapes[i].width, shapes[i].height, 60 + (uint64_t)i);
        helio_environment *fresh = make_from_map(&m, 9, NULL);
        assert_ok(helio_environment_reshape(environment, m.width, m.height, m.layout));
        assert_ok(helio_environment_update(environment, m.rgb, NULL));
        assert_memory_equal(environment->cube, fresh->cube, cube_bytes(fresh));
        size_t taken = shared_memory.taken; /* the same shape again: nothing happens */
        assert_ok(helio_environment_reshape(environment, m.width, m.height, m.layout));
        assert_int_equal(shared_memory.taken, taken);
        helio_environment_destroy(fresh);
        free(m.rgb);
    }
    assert_int_equal(helio_environment_frame(environment), SHAPES);
    helio_environment_destroy(environment);
}

static void failed_reshapes_leave_everything_as_it_was(void **state)
{
    (void)state;
    map m = make_random_map(HELIO_LAYOUT_LATLONG, 8, 4, 70);
    for (size_t more = 0;; more++) {
        memory_count count = {0};
        helio_context *context = make_context(1, &count);
        helio_environment *environment = make_environment(context, m.layout, 8, 4, 3, m.rgb, NULL);
        const uint32_t bad[][2] = {{0, 0}, {0, 4}, {65537, 4}, {7, 9}};
        for (int i = 0; i < 4; i++)
            assert_true(helio_environment_reshape(environment, bad[i][0], bad[i][1], HELIO_LAYOUT_AUTO) != HELIO_OK);
        size_t live = count.live;
        float *cube = malloc(cube_bytes(environment));
        assert_non_null(cube);
        memcpy(cube, environment->cube, cube_bytes(environment));
        count.refuse_after = count.taken + more;
        helio_status status = helio_environment_reshape(environment, 4, 4, HELIO_LAYOUT_ANGULAR);
        if (status != HELIO_OK) {
            assert_int_equal(status, HELIO_ERR_MEMORY);
            assert_int_equal(count.live, live);
            assert_ok(helio_environment_update(environment, m.rgb, NULL));
            assert_memory_equal(environment->cube, cube, cube_bytes(environment));
        }
        free(cube);
        helio_environment_destroy(environment);
        helio_context_destroy(context);
        assert_int_equal(count.live, 0);
        if (status == HELIO_OK)
            break;
        assert_in_range(more, 0, 100);
    }
    free(m.rgb);
}

static void unfolding_without_memory_fails_cleanly(void **state)
{
    (void)state;
    map m = make_random_map(HELIO_LAYOUT_LATLONG, 8, 4, 70);
    float rgb[4 * 4 * 3];
    for (size_t more = 0;; more++) {
        memory_count count = {0};
        helio_context *context = make_context(1, &count);
        helio_environment *environment = make_environment(context, m.layout, 8, 4, 3, m.rgb, NULL);
        size_t live = count.live;
        count.refuse_after = count.taken + more;
        helio_status status = helio_environment_unfold(environment, HELIO_LAYOUT_EQUAL_AREA, 4, 4, rgb);
        assert_int_equal(count.live, live);
        assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
        helio_environment_destroy(environment);
        helio_context_destroy(context);
        if (status == HELIO_OK)
            break;
        assert_in_range(more, 0, 100);
    }
    free(m.rgb);
}

static void bad_unfolds_are_refused(void **state)
{
    (void)state;
    map m = make_random_map(HELIO_LAYOUT_LATLONG, 8, 4, 70);
    helio_environment *environment = make_from_map(&m, 5, NULL);
    float rgb[64 * 3];
    assert_int_equal(helio_environment_unfold(NULL, HELIO_LAYOUT_STRIP, 1, 6, rgb), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_unfold(environment, HELIO_LAYOUT_STRIP, 1, 6, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_unfold(environment, HELIO_LAYOUT_STRIP, 0, 6, rgb), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_unfold(environment, (helio_layout)99, 1, 6, rgb), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_unfold(environment, HELIO_LAYOUT_ANGULAR, 4, 5, rgb), HELIO_ERR_DATA);
    assert_int_equal(helio_environment_unfold(environment, HELIO_LAYOUT_CROSS_V, 4, 3, rgb), HELIO_ERR_DATA);
    helio_environment_destroy(environment);
    free(m.rgb);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    const uint32_t threads[] = {1, 3};
    for (int i = 0; i < SHAPES; i++) {
        map m = make_random_map(shapes[i].layout, shapes[i].width, shapes[i].height, 80);
        map back[2];
        float *cubes[2];
        for (int k = 0; k < 2; k++) {
            helio_context *context = make_context(threads[k], NULL);
            helio_environment *environment = make_environment(context, m.layout, m.width, m.height, 21, m.rgb, NULL);
            cubes[k] = malloc(cube_bytes(environment));
            assert_non_null(cubes[k]);
            memcpy(cubes[k], environment->cube, cube_bytes(environment));
            back[k] = unfold(environment, m.layout, m.width, m.height);
            helio_environment_destroy(environment);
            helio_context_destroy(context);
        }
        assert_memory_equal(cubes[0], cubes[1], (size_t)18 * 21 * 21 * sizeof(float));
        assert_memory_equal(back[0].rgb, back[1].rgb, count_numbers(&m) * sizeof(float));
        for (int k = 0; k < 2; k++) {
            free(cubes[k]);
            free(back[k].rgb);
        }
        free(m.rgb);
    }
}

enum { STARTS = 1024 };

/* The start of the cube in each format with an instruction set, into starts or compared with it. */
static void check_instruction_set(const char *isa, const map *m, const uint16_t *halves, uint32_t size, bool is_first,
                                  float starts[4][STARTS])
{
    helio_context *context;
    assert_ok(helio_context_create(&(helio_context_desc){.threads = 1, .isa = isa}, &context));
    helio_environment *environment = make_environment(context, m->layout, m->width, m->height, size, m->rgb, NULL);
    const size_t bytes =
        cube_bytes(environment) < STARTS * sizeof(float) ? cube_bytes(environment) : STARTS * sizeof(float);
    for (int format = 0; format < 4; format++) {
        pixel_copy copy = copy_pixels(m, halves, (helio_pixel_format)format, 0, false);
        assert_ok(helio_environment_update_pixels(environment, &copy.pixels, NULL));
        if (is_first)
            memcpy(starts[format], environment->cube, bytes);
        assert_memory_equal(starts[format], environment->cube, bytes);
        free(copy.memory);
    }
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

/* Half and float pixels, some of them faulty or negative, and texels with many of them. */
static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    static float starts[4][STARTS];
    for (int i = 0; i < SHAPES; i++) {
        map m = make_random_map(shapes[i].layout, shapes[i].width, shapes[i].height, 90);
        if (i % 3)
            add_faults(&m, i % 3 == 1 ? 0.01 : 0.2, 91);
        uint16_t *halves = calloc(count_numbers(&m), sizeof *halves);
        assert_non_null(halves);
        for (size_t n = 0; n < count_numbers(&m); n++)
            halves[n] = (uint16_t)(n * 40503u);
        for (uint32_t size = 2; size <= 13; size += 11) {
            const char *isa;
            for (uint32_t set = 0; (isa = helio_isa_name(set)) != NULL; set++)
                check_instruction_set(isa, &m, halves, size, set == 0, starts);
        }
        free(halves);
        free(m.rgb);
    }
}

/* ---- shapes and guesses ------------------------------------------------------------------------ */

static void shapes_fit_their_layouts(void **state)
{
    (void)state;
    for (uint32_t size = 1; size <= 4096; size = size * 3 / 2 + 1)
        for (helio_layout layout = HELIO_LAYOUT_LATLONG; layout <= HELIO_LAYOUT_MIRRORBALL; layout++) {
            uint32_t width, height;
            helio_layout guessed;
            assert_ok(helio_layout_shape(layout, size, &width, &height));
            assert_ok(helio_layout_guess(width, height, layout, &guessed));
            assert_int_equal(guessed, layout);
            if (is_square(layout))
                assert_true(width == height && width % 2 == 0 && width * (uint64_t)width >= UINT64_C(8) * size * size &&
                            (width - 2.0) * (width - 2.0) < 8.0 * size * size);
            if (layout == HELIO_LAYOUT_LATLONG)
                assert_true(width == 4 * size && height == 2 * size);
        }
    uint32_t width = 77, height;
    assert_int_equal(helio_layout_shape(HELIO_LAYOUT_AUTO, 4, &width, &height), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_shape((helio_layout)11, 4, &width, &height), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_shape(HELIO_LAYOUT_STRIP, 0, &width, &height), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_shape(HELIO_LAYOUT_STRIP, 4097, &width, &height), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_shape(HELIO_LAYOUT_STRIP, 4, NULL, &height), HELIO_ERR_ARGUMENT);
    assert_int_equal(width, 77);
}

static void guesses_follow_the_shape(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height;
        helio_layout hint, layout;
    } good[] = {{768, 1024, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_CROSS_V},
                {1024, 768, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_CROSS_H},
                {3, 4, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_CROSS_V},
                {512, 512, HELIO_LAYOUT_ANGULAR, HELIO_LAYOUT_ANGULAR},
                {512, 512, HELIO_LAYOUT_EQUAL_AREA, HELIO_LAYOUT_EQUAL_AREA},
                {512, 512, HELIO_LAYOUT_LATLONG, HELIO_LAYOUT_LATLONG},
                {6, 1, HELIO_LAYOUT_FACES, HELIO_LAYOUT_FACES}};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        helio_layout layout = HELIO_LAYOUT_AUTO;
        assert_ok(helio_layout_guess(good[i].width, good[i].height, good[i].hint, &layout));
        assert_int_equal(layout, good[i].layout);
    }
    helio_layout layout;
    assert_int_equal(helio_layout_guess(512, 512, HELIO_LAYOUT_AUTO, &layout), HELIO_ERR_DATA);
    for (int i = 0; i < LAYOUTS; i++)
        if (is_square(layouts[i]))
            assert_non_null(strstr(helio_last_error(), helio_layout_name(layouts[i])));
    assert_int_equal(helio_layout_guess(500, 333, HELIO_LAYOUT_AUTO, &layout), HELIO_ERR_DATA);
    for (int i = 0; i < LAYOUTS; i++)
        assert_non_null(strstr(helio_last_error(), helio_layout_name(layouts[i])));
    const helio_layout strict[] = {HELIO_LAYOUT_CROSS_V, HELIO_LAYOUT_CROSS_H,    HELIO_LAYOUT_FACES,
                                   HELIO_LAYOUT_STRIP,   HELIO_LAYOUT_OCTAHEDRAL, HELIO_LAYOUT_MIRRORBALL};
    for (int i = 0; i < 6; i++)
        assert_int_equal(helio_layout_guess(500, 250, strict[i], &layout), HELIO_ERR_DATA);
}

/* ---- captured and drawn maps ----------------------------------------------------------------------- */

static helio_environment *make_from_file(const char *path, uint32_t size)
{
    helio_image *image;
    assert_ok(helio_image_read(shared_context, path, NULL, &image));
    helio_environment *environment =
        make_environment(shared_context, image->layout, image->width, image->height, size, image->rgb, NULL);
    helio_image_destroy(shared_context, image);
    return environment;
}

/* Mean difference of luminance, relative to the mean luminance. */
static double difference(const helio_environment *a, const helio_environment *b)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < (size_t)6 * a->size * a->size; i++) {
        double here = (double)luminance(a->cube + i * 3), there = (double)luminance(b->cube + i * 3);
        sum += fabs(here - there);
        all += here;
    }
    return sum / all;
}

/* A picture through every layout is still the picture, seams included; its mirror image is not. */
static void expect_picture_survives(const char *name, double tolerance)
{
    char path[TEST_PATH_SIZE];
    const uint32_t size = is_thorough() ? 96 : 48;
#ifndef HELIO_WITH_OPENEXR
    puts("skipped: this build reads no OpenEXR");
    skip();
#endif
    find_test_data(name, path);
    helio_environment *environment = make_from_file(path, size);
    for (int i = 0; i < LAYOUTS; i++) {
        uint32_t width, height;
        assert_ok(helio_layout_shape(layouts[i], 4 * size, &width, &height));
        map m = unfold(environment, layouts[i], width, height);
        helio_environment *there = make_from_map(&m, size, NULL);
        double off = difference(environment, there);
        for (uint32_t row = 0; row < height; row++) /* left to right */
            for (uint32_t column = 0; column < width / 2; column++)
                for (int c = 0; c < 3; c++) {
                    float *a = pixel_of(&m, row, column) + c, *b = pixel_of(&m, row, width - 1 - column) + c, kept = *a;
                    *a = *b;
                    *b = kept;
                }
        assert_ok(helio_environment_update(there, m.rgb, NULL));
        double mirrored = difference(environment, there);
        if (!(off < tolerance) || !(mirrored > 2 * tolerance))
            fail_msg("%s through %s differs by %g, mirrored by %g", name, helio_layout_name(layouts[i]), off, mirrored);
        helio_environment_destroy(there);
        free(m.rgb);
    }
    helio_environment_destroy(environment);
}

static void orientation_picture_survives_every_layout(void **state)
{
    (void)state;
    expect_picture_survives("environments/orientation-tests/OrientationLatLong.exr", 0.012);
}

static void seam_picture_survives_every_layout(void **state)
{
    (void)state;
    expect_picture_survives("environments/orientation-tests/WavyLinesCube.exr", 0.1);
}

static void captured_picture_survives_every_layout(void **state)
{
    (void)state;
    expect_picture_survives("environments/latlong/StageEnvLatLong.exr", 0.1);
}

static int make_shared_context(void **state)
{
    (void)state;
    shared_context = make_context(2, &shared_memory);
    return 0;
}

static int destroy_shared_context(void **state)
{
    (void)state;
    helio_context_destroy(shared_context);
    return shared_memory.live == 0 && !shared_memory.misaligned ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_layout_shows_each_direction_where_it_is),
        cmocka_unit_test(unfolded_maps_show_each_direction_where_it_is),
        cmocka_unit_test(pixels_outside_of_discs_and_crosses_are_black),
        cmocka_unit_test(orientation_survives_between_all_pairs_of_layouts),
        cmocka_unit_test(crosses_and_strips_of_one_size_are_copies),
        cmocka_unit_test(constant_maps_stay_constant_both_ways),
        cmocka_unit_test(single_pixels_of_squares_have_their_solid_angle),
        cmocka_unit_test(random_maps_keep_their_light_both_ways),
        cmocka_unit_test(a_sun_of_one_texel_keeps_its_flux),
        cmocka_unit_test(maps_with_faults_give_the_bits_of_cleaned_ones),
        cmocka_unit_test(all_half_numbers_have_their_value),
        cmocka_unit_test(all_pixel_formats_give_the_same_bits),
        cmocka_unit_test(shared_exponents_give_the_bits_of_floats),
        cmocka_unit_test(bad_pixels_are_refused),
        cmocka_unit_test(reshaped_environments_give_the_bits_of_fresh_ones),
        cmocka_unit_test(failed_reshapes_leave_everything_as_it_was),
        cmocka_unit_test(unfolding_without_memory_fails_cleanly),
        cmocka_unit_test(bad_unfolds_are_refused),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(shapes_fit_their_layouts),
        cmocka_unit_test(guesses_follow_the_shape),
        cmocka_unit_test(orientation_picture_survives_every_layout),
        cmocka_unit_test(seam_picture_survives_every_layout),
        cmocka_unit_test(captured_picture_survives_every_layout),
    };
    return cmocka_run_group_tests_name("layouts", tests, make_shared_context, destroy_shared_context);
}
