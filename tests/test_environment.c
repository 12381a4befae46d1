/* SPDX-License-Identifier: MIT
 * The environment: the geometry of the cube, every layout's way onto it, hygiene, lookups, exposure. Formulas that are
 * tested are written here a second time, in double precision and from the tables, not from the code. */
#include "support.h"

#include "env/cube.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the tables, by hand ------------------------------------------------------------------ */

/* Vulkan's cube map table solved for the direction: sc = u, tc = v, |ma| = 1. */
static void face_direction(uint32_t face, double u, double v, double d[3])
{
    const double table[6][3] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    memcpy(d, table[face], sizeof table[face]);
}

/* OpenEXR's faces: s and t grow with columns and rows, from -1 at the first pixel's centre to 1 at the last one's. */
static void openexr_direction(uint32_t face, double s, double t, double d[3])
{
    const double table[6][3] = {{1, -t, s}, {-1, -t, -s}, {s, 1, -t}, {s, -1, t}, {-s, -t, 1}, {s, -t, -1}};
    memcpy(d, table[face], sizeof table[face]);
}

static void normalize_double(double d[3])
{
    double length_of_d = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        d[c] /= length_of_d;
}

static double centre_of(uint32_t index, uint32_t size)
{
    return (2.0 * index + 1.0) / size - 1.0;
}

/* ---- radiance that is known everywhere ------------------------------------------------------ */

typedef double (*radiance_function)(const double d[3], int channel);

static double one(const double d[3], int channel)
{
    (void)d;
    (void)channel;
    return 1;
}

/* No two directions that a mistaken axis could swap look the same. */
static double smooth(const double d[3], int channel)
{
    double x = d[0], y = d[1], z = d[2];
    return channel == 0   ? 2 + 0.3 * x - 0.4 * y + 0.5 * z
           : channel == 1 ? 2 + 0.3 * x * y - 0.25 * y * z + 0.2 * z * x + 0.1 * y
                          : 3 + x * x - 0.5 * z * z + 0.3 * x * y * z - 0.2 * x;
}

/* Integral of f over a rectangle of a face, by three-point Gauss quadrature in cells of at most a sixteenth. */
static double integrate(radiance_function f, int channel, uint32_t face, const double u[2], const double v[2])
{
    static const double places[3] = {-0.77459666924148338, 0, 0.77459666924148338}, weights[3] = {5, 8, 5};
    int cells = (int)ceil(16 * fmax(u[1] - u[0], v[1] - v[0]));
    double du = (u[1] - u[0]) / cells, dv = (v[1] - v[0]) / cells, sum = 0;
    for (int i = 0; i < 3 * cells; i++)
        for (int k = 0; k < 3 * cells; k++) {
            double a = u[0] + (i / 3 + 0.5 + 0.5 * places[i % 3]) * du,
                   b = v[0] + (k / 3 + 0.5 + 0.5 * places[k % 3]) * dv;
            double d[3];
            face_direction(face, a, b, d);
            normalize_double(d);
            sum += f(d, channel) * weights[i % 3] * weights[k % 3] * pow(1 + a * a + b * b, -1.5);
        }
    return sum * du * dv / 324;
}

/* Solid angle of the pixel (row, column) of a face with these borders. */
static double pixel_solid_angle(const double *borders, uint32_t row, uint32_t column)
{
    return integrate(one, 0, 0, (double[2]){borders[column], borders[column + 1]},
                     (double[2]){borders[row], borders[row + 1]});
}

static void fill_borders(double *borders, uint32_t size, bool openexr)
{
    for (uint32_t i = 0; i <= size; i++)
        borders[i] = openexr && size > 1 ? (2.0 * i - 1.0) / (size - 1.0) - 1.0 : 2.0 * i / size - 1.0;
    borders[0] = -1;
    borders[size] = 1;
}

/* ---- maps ------------------------------------------------------------------------------------- */

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

static map make_random_map(helio_layout layout, uint32_t width, uint32_t height, uint64_t seed)
{
    map m = make_map(layout, width, height);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        m.rgb[i] = (float)pow(random_unit(&seed), 4);
    return m;
}

static uint32_t face_size(const map *m)
{
    return m->width < m->height ? m->width : m->height;
}

/* Face, row and column of a pixel of a strip. */
static void locate(const map *m, uint32_t row, uint32_t column, uint32_t *face, uint32_t *face_row,
                   uint32_t *face_column)
{
    uint32_t size = face_size(m);
    *face = m->height > m->width ? row / size : column / size;
    *face_row = row % size;
    *face_column = column % size;
}

/* Direction of the centre of a pixel. */
static void pixel_direction(const map *m, uint32_t row, uint32_t column, double d[3])
{
    uint32_t face, i, k;
    locate(m, row, column, &face, &i, &k);
    if (m->layout == HELIO_LAYOUT_LATLONG) {
        double latitude = PI * (0.5 - (row + 0.5) / m->height), longitude = PI * (1 - 2 * (column + 0.5) / m->width);
        d[0] = cos(latitude) * sin(longitude);
        d[1] = sin(latitude);
        d[2] = cos(latitude) * cos(longitude);
    } else if (m->layout == HELIO_LAYOUT_STRIP_OPENEXR && face_size(m) > 1) {
        double step = 2.0 / (face_size(m) - 1.0);
        openexr_direction(face, k * step - 1, i * step - 1, d);
    } else if (m->layout == HELIO_LAYOUT_STRIP_OPENEXR) {
        openexr_direction(face, 0, 0, d);
    } else {
        face_direction(face, centre_of(k, face_size(m)), centre_of(i, face_size(m)), d);
    }
    normalize_double(d);
}

static map make_analytic_map(helio_layout layout, uint32_t width, uint32_t height, radiance_function f)
{
    map m = make_map(layout, width, height);
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t column = 0; column < width; column++) {
            double d[3];
            pixel_direction(&m, row, column, d);
            for (int c = 0; c < 3; c++)
                m.rgb[((size_t)row * width + column) * 3 + c] = (float)f(d, c);
        }
    return m;
}

/* Integral over the sphere of one channel of the map, each pixel constant over its solid angle. */
static double map_flux(const map *m, int channel)
{
    double sum = 0, *borders = calloc(face_size(m) + 1, sizeof *borders);
    assert_non_null(borders);
    fill_borders(borders, face_size(m), m->layout == HELIO_LAYOUT_STRIP_OPENEXR);
    for (uint32_t row = 0; row < m->height; row++)
        for (uint32_t column = 0; column < m->width; column++) {
            double value = (double)m->rgb[((size_t)row * m->width + column) * 3 + channel];
            uint32_t face, i, k;
            if (value == 0)
                continue;
            locate(m, row, column, &face, &i, &k);
            /* cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2) keeps its digits at the poles */
            sum += value * (m->layout == HELIO_LAYOUT_LATLONG
                                ? 2 * PI / m->width * 2 * sin(PI * (row + 0.5) / m->height) * sin(PI * 0.5 / m->height)
                                : pixel_solid_angle(borders, i, k));
        }
    free(borders);
    return sum;
}

/* Solid angles of the texels of a face, [size][size], kept until another size is asked for. */
static const double *texel_solid_angles(uint32_t size)
{
    enum { LARGEST = 128 };
    static double angles[LARGEST * LARGEST];
    static uint32_t last_size;
    double borders[LARGEST + 1];
    assert_in_range(size, 1, LARGEST);
    if (size == last_size)
        return angles;
    fill_borders(borders, size, false);
    for (uint32_t texel = 0; texel < size * size; texel++)
        angles[texel] = pixel_solid_angle(borders, texel / size, texel % size);
    last_size = size;
    return angles;
}

static double cube_flux(const float *cube, uint32_t size, int channel)
{
    const double *angles = texel_solid_angles(size);
    double sum = 0;
    for (uint32_t texel = 0; texel < 6 * size * size; texel++)
        sum += (double)cube[texel * 3 + (uint32_t)channel] * angles[texel % (size * size)];
    return sum;
}

static helio_environment *make_from_map(helio_context *context, const map *m, uint32_t size,
                                        helio_environment_info *info)
{
    return make_environment(context, m->layout, m->width, m->height, size, m->rgb, info);
}

static const float *texel_of(const helio_environment *environment, uint32_t face, uint32_t row, uint32_t column)
{
    size_t size = helio_environment_cube_size(environment);
    return helio_environment_cube(environment) + ((face * size + row) * size + column) * 3;
}

static helio_context *shared_context; /* two threads, memory counted */
static memory_count shared_memory;

/* ---- geometry -------------------------------------------------------------------------------- */

static void solid_angles_of_texels_fill_the_sphere(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 5, 16, 512};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        double sum = 0, size = sizes[i];
        for (uint32_t row = 0; row < sizes[i]; row++)
            for (uint32_t column = 0; column < sizes[i]; column++)
                sum += cube_solid_angle(2 * column / size - 1, 2 * (column + 1) / size - 1, 2 * row / size - 1,
                                        2 * (row + 1) / size - 1);
        assert_true(fabs(6 * sum - 4 * PI) < 1e-9);
    }
}

static void solid_angles_equal_their_quadrature(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 5, 16, 512};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        double borders[513];
        fill_borders(borders, sizes[i], false);
        uint32_t step = sizes[i] > 16 ? 37 : 1;
        for (uint32_t row = 0; row < sizes[i]; row += step)
            for (uint32_t column = 0; column < sizes[i]; column += step) {
                double angle = cube_solid_angle(borders[column], borders[column + 1], borders[row], borders[row + 1]);
                double expected = pixel_solid_angle(borders, row, column);
                assert_true(fabs(angle - expected) < 1e-9 * expected + 1e-15);
            }
    }
}

/* sc, tc and ma as they stand in the table, for the face that the largest component picks. */
static void project_by_table(const float d[3], uint32_t *face, double *u, double *v)
{
    double x = (double)d[0], y = (double)d[1], z = (double)d[2], ax = fabs(x), ay = fabs(y), az = fabs(z);
    double sc, tc, ma;
    if (ax > ay && ax > az) {
        *face = x > 0 ? 0 : 1;
        sc = x > 0 ? -z : z, tc = -y, ma = ax;
    } else if (ay > az) {
        *face = y > 0 ? 2 : 3;
        sc = x, tc = y > 0 ? z : -z, ma = ay;
    } else {
        *face = z > 0 ? 4 : 5;
        sc = z > 0 ? x : -x, tc = -y, ma = az;
    }
    *u = sc / ma;
    *v = tc / ma;
}

static void faces_are_oriented_as_in_the_vulkan_table(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < 20000; i++) {
        float d[3];
        for (int c = 0; c < 3; c++)
            d[c] = (float)(2 * random_unit(&seed) - 1) * (i % 2 ? 1.0f : 1e-20f);
        uint32_t face;
        double u, v;
        project_by_table(d, &face, &u, &v);
        cube_position at = cube_project(vec3_from(d));
        assert_int_equal(at.face, face);
        assert_true(fabs((double)at.u - u) < 1e-6 && fabs((double)at.v - v) < 1e-6);
    }
}

static void face_coordinates_and_directions_are_inverse(void **state)
{
    (void)state;
    const float places[] = {-1, nextafterf(-1, 0), -0.5f, -FLT_TRUE_MIN,    -FLT_MIN,
                            0,  FLT_MIN,           0.3f,  nextafterf(1, 0), 1};
    enum { COUNT = sizeof places / sizeof *places };
    for (uint32_t face = 0; face < 6; face++)
        for (int i = 0; i < COUNT * COUNT; i++) {
            float u = places[i / COUNT], v = places[i % COUNT];
            vec3 d = cube_direction(face, u, v);
            double expected[3];
            face_direction(face, (double)u, (double)v, expected);
            normalize_double(expected);
            assert_true(fabs((double)d.x - expected[0]) + fabs((double)d.y - expected[1]) +
                            fabs((double)d.z - expected[2]) <
                        5e-7);
            cube_position at = cube_project(d);
            assert_true(at.face < 6 && fabsf(at.u) <= 1 && fabsf(at.v) <= 1);
            if (fmaxf(fabsf(u), fabsf(v)) < 0.9f) {
                assert_int_equal(at.face, face);
                assert_true(fabsf(at.u - u) < 2e-7f && fabsf(at.v - v) < 2e-7f);
            }
            vec3 back = cube_direction(at.face, at.u, at.v); /* on an edge, perhaps by another face */
            assert_true(length(subtract(back, d)) < 5e-7f);
        }
}

/* A direction on the border between two texels, or an ulp beside it, belongs to one of the two. */
static void borders_of_texels_belong_to_a_neighbour(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, 512};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (uint32_t k = 0; k <= sizes[i]; k++)
            for (uint32_t face = 0; face < 6; face++)
                for (int ulps = -1; ulps <= 1; ulps++) {
                    float border = 2.0f * (float)k / (float)sizes[i] - 1.0f;
                    float u = ulps == 0 ? border : nextafterf(border, (float)ulps);
                    if (fabsf(u) > 0.999f) /* edges of the face may go to another face: see above */
                        continue;
                    cube_position across = cube_project(cube_direction(face, u, 0.25f));
                    cube_position down = cube_project(cube_direction(face, 0.25f, u));
                    assert_int_equal(across.face, face);
                    assert_int_equal(down.face, face);
                    uint32_t column = cube_texel(across.u, sizes[i]), row = cube_texel(down.v, sizes[i]);
                    assert_true(column + 1 == k || column == k);
                    assert_true(row + 1 == k || row == k);
                }
}

static void centres_of_texels_are_found_again(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, 65, 512, 4095, 4096};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t size = sizes[i], step = size > 65 ? 61 : 1;
        for (uint32_t face = 0; face < 6; face++)
            for (uint32_t row = 0; row < size; row = row + step < size || row == size - 1 ? row + step : size - 1)
                for (uint32_t column = 0; column < size;
                     column = column + step < size || column == size - 1 ? column + step : size - 1) {
                    vec3 d = cube_direction(face, (float)centre_of(column, size), (float)centre_of(row, size));
                    cube_position at = cube_project(d);
                    assert_int_equal(at.face, face);
                    assert_int_equal(cube_texel(at.u, size), column);
                    assert_int_equal(cube_texel(at.v, size), row);
                }
    }
}

static void texel_indices_stay_in_range(void **state)
{
    (void)state;
    const float odd[] = {-1, 1,     nextafterf(1, 2), nextafterf(-1, -2), 5,   -5,
                         0,  -0.0f, INFINITY,         -INFINITY,          NAN, 1e-45f};
    const uint32_t sizes[] = {1, 2, 3, 4095, 4096};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        for (size_t k = 0; k < 5; k++)
            assert_true(cube_texel(odd[i], sizes[k]) < sizes[k]);
    assert_int_equal(cube_texel(-1, 4), 0);
    assert_int_equal(cube_texel(-0.5f, 4), 1);
    assert_int_equal(cube_texel(0, 4), 2);
    assert_int_equal(cube_texel(nextafterf(1, 0), 4), 3);
    assert_int_equal(cube_texel(1, 4), 3);
}

static void odd_directions_find_some_texel(void **state)
{
    (void)state;
    map m = make_random_map(HELIO_LAYOUT_LATLONG, 16, 8, 5);
    helio_environment *environment = make_from_map(shared_context, &m, 4, NULL);
    const float odd[] = {0, -0.0f, 1, -1, FLT_TRUE_MIN, -FLT_TRUE_MIN, FLT_MIN, 1e38f, INFINITY, -INFINITY, NAN};
    enum { COUNT = sizeof odd / sizeof *odd };
    for (int i = 0; i < COUNT * COUNT * COUNT; i++) {
        float d[3] = {odd[i % COUNT], odd[i / COUNT % COUNT], odd[i / COUNT / COUNT]}, radiance[3] = {-1, -1, -1};
        helio_environment_radiance(environment, d, radiance);
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(radiance[c]) && radiance[c] >= 0);
        helio_environment_filtered(environment, d, radiance); /* must not read beyond the cube */
        if (i % COUNT < 8 && i / COUNT % COUNT < 8 && i / COUNT / COUNT < 8 && i % COUNT > 1)
            for (int c = 0; c < 3; c++)
                assert_true(isfinite(radiance[c]));
    }
    helio_environment_destroy(environment);
    free(m.rgb);
}

/* ---- from map to cube ------------------------------------------------------------------------- */

static const map shapes[] = {
    {HELIO_LAYOUT_LATLONG, 1, 1, NULL},        {HELIO_LAYOUT_LATLONG, 2, 1, NULL},
    {HELIO_LAYOUT_LATLONG, 4, 2, NULL},        {HELIO_LAYOUT_LATLONG, 7, 3, NULL},
    {HELIO_LAYOUT_LATLONG, 1, 5, NULL},        {HELIO_LAYOUT_LATLONG, 64, 32, NULL},
    {HELIO_LAYOUT_STRIP, 6, 1, NULL},          {HELIO_LAYOUT_STRIP, 1, 6, NULL},
    {HELIO_LAYOUT_STRIP, 18, 3, NULL},         {HELIO_LAYOUT_STRIP, 7, 42, NULL},
    {HELIO_LAYOUT_STRIP_OPENEXR, 1, 6, NULL},  {HELIO_LAYOUT_STRIP_OPENEXR, 2, 12, NULL},
    {HELIO_LAYOUT_STRIP_OPENEXR, 8, 48, NULL}, {HELIO_LAYOUT_STRIP_OPENEXR, 3, 18, NULL},
};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void expect_constant(helio_layout layout, uint32_t width, uint32_t height, uint32_t size)
{
    const float colour[3] = {0.7f, 1e-3f, 12345.678f};
    map m = make_map(layout, width, height);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        m.rgb[i] = colour[i % 3];
    helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
    const float *cube = helio_environment_cube(environment);
    double worst = 0;
    for (size_t i = 0; i < (size_t)6 * size * size * 3; i++)
        worst = fmax(worst, fabs((double)(cube[i] / colour[i % 3]) - 1));
    if (!(worst < 1e-5))
        fail_msg("%s %ux%u at R = %u: a constant map is off by %g", helio_layout_name(layout), width, height, size,
                 worst);
    helio_environment_destroy(environment);
    free(m.rgb);
}

static void constant_maps_stay_constant(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, 65};
    for (int i = 0; i < SHAPES; i++)
        for (size_t k = 0; k < 5; k++)
            expect_constant(shapes[i].layout, shapes[i].width, shapes[i].height, sizes[k]);
}

static void constant_maps_stay_constant_when_they_shrink_much(void **state)
{
    (void)state;
    expect_constant(HELIO_LAYOUT_STRIP, 333, 1998, 1);
    expect_constant(HELIO_LAYOUT_STRIP_OPENEXR, 333, 1998, 2);
    expect_constant(HELIO_LAYOUT_LATLONG, 2000, 1000, 1);
    expect_constant(HELIO_LAYOUT_LATLONG, 20000, 10, 1);
    expect_constant(HELIO_LAYOUT_LATLONG, 10, 20000, 1);
}

/* Flux of the cube against flux of the map, relative. */
static void expect_flux(const map *m, uint32_t size, double tolerance, const char *what)
{
    helio_environment *environment = make_from_map(shared_context, m, size, NULL);
    for (int c = 0; c < 3; c++) {
        double expected = map_flux(m, c), flux = cube_flux(helio_environment_cube(environment), size, c);
        if (!(fabs(flux - expected) <= tolerance * expected))
            fail_msg("%s, %s %ux%u at R = %u: flux %.9g instead of %.9g, off by %.2g", what,
                     helio_layout_name(m->layout), m->width, m->height, size, flux, expected, flux / expected - 1);
    }
    helio_environment_destroy(environment);
}

static void flux_of_random_maps_is_kept(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 7, 16, 64};
    for (int i = 0; i < SHAPES; i++)
        for (size_t k = 0; k < 6; k++) {
            map m = make_random_map(shapes[i].layout, shapes[i].width, shapes[i].height, 100 + (uint64_t)i);
            expect_flux(&m, sizes[k], 1e-5, "random map");
            free(m.rgb);
        }
}

static void light_one_pixel(map *m, uint32_t row, uint32_t column, float value)
{
    memset(m->rgb, 0, (size_t)m->width * m->height * 3 * sizeof(float));
    for (int c = 0; c < 3; c++)
        m->rgb[((size_t)row * m->width + column) * 3 + c] = value;
}

/* Pixels at the poles, beside the wrap, across the edges and corners of faces (an eighth of the width off +Z), and
 * others. */
static void flux_of_single_pixels_is_kept_in_latlong_maps(void **state)
{
    (void)state;
    const uint32_t maps[][2] = {{4, 2}, {7, 3}, {64, 32}, {100, 7}, {5, 60}};
    const uint32_t sizes[] = {1, 3, 24};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        uint32_t width = maps[i][0], height = maps[i][1];
        map m = make_map(HELIO_LAYOUT_LATLONG, width, height);
        const uint32_t columns[] = {0, width / 8, width / 2, width * 2 / 5, width - 1};
        const double latitudes[] = {90, 89, 54.7, 45, 35.3, 20, 0, -41, -90};
        for (size_t k = 0; k < 5 * 9; k++) {
            double from_top = (90 - latitudes[k / 5]) / 180 * height;
            light_one_pixel(&m, from_top < height ? (uint32_t)from_top : height - 1, columns[k % 5], 1e4f);
            for (size_t s = 0; s < 3; s++)
                expect_flux(&m, sizes[s], 1e-5, "one pixel");
        }
        free(m.rgb);
    }
}

/* Small pixels that the edge between a side and +Y or -Y cuts, and an edge between texels near the poles. */
static void flux_of_small_pixels_on_edges_is_kept(void **state)
{
    (void)state;
    const uint32_t cases[][5] = {/* width, height, row, column, R */
                                 {360, 180, 46, 130, 64}, {1024, 512, 378, 573, 65}, {256, 128, 101, 90, 16},
                                 {64, 32, 26, 42, 64},    {64, 32, 6, 22, 17},       {360, 180, 45, 180, 64},
                                 {360, 180, 134, 44, 64}, {32, 16, 13, 28, 64}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        map m = make_map(HELIO_LAYOUT_LATLONG, cases[i][0], cases[i][1]);
        light_one_pixel(&m, cases[i][2], cases[i][3], 1e4f);
        expect_flux(&m, cases[i][4], 1e-5, "a pixel on an edge");
        free(m.rgb);
    }
}

static void flux_of_single_pixels_is_kept_in_strips(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int i = 6; i < SHAPES; i++) {
        map m = make_map(shapes[i].layout, shapes[i].width, shapes[i].height);
        for (int k = 0; k < 16; k++) {
            uint32_t row = random_bits(&seed) % m.height, column = random_bits(&seed) % m.width;
            light_one_pixel(&m, k == 0 ? 0 : k == 1 ? m.height - 1 : row, k < 2 ? 0 : column, 3);
            const uint32_t sizes[] = {1, 3, 8, 33};
            for (size_t s = 0; s < 4; s++)
                expect_flux(&m, sizes[s], 1e-5, "one pixel");
        }
        free(m.rgb);
    }
}

/* How far a direction lies outside of a pixel of a lat-long map, radians; 0 inside. */
static double distance_from_pixel(const map *m, uint32_t row, uint32_t column, const double d[3])
{
    double colatitude = acos(fmax(-1, fmin(1, d[1]))), top = PI * row / m->height, bottom = PI * (row + 1) / m->height;
    double centre = PI * (1 - 2 * (column + 0.5) / m->width), longitude = atan2(d[0], d[2]) - centre;
    longitude -= 2 * PI * round(longitude / (2 * PI));
    double vertical = fmax(0, fmax(top - colatitude, colatitude - bottom));
    double horizontal = fmax(0, fabs(longitude) - PI / m->width) * sin(colatitude);
    return fmax(vertical, horizontal);
}

/* Compares each texel with the part of it that the pixel covers, counted on a grid. */
static void expect_pixel_in_place(const map *m, uint32_t row, uint32_t column, uint32_t size)
{
    enum { GRID = 32 };
    helio_environment *environment = make_from_map(shared_context, m, size, NULL);
    for (uint32_t texel = 0; texel < 6 * size * size; texel++) {
        uint32_t face = texel / (size * size), i = texel / size % size, k = texel % size;
        double covered = 0, whole = 0, nearest = 10;
        for (uint32_t a = 0; a < GRID * GRID; a++) {
            double u = centre_of(k * GRID + a % GRID, size * GRID), v = centre_of(i * GRID + a / GRID, size * GRID),
                   d[3];
            face_direction(face, u, v, d);
            normalize_double(d);
            double distance = distance_from_pixel(m, row, column, d), weight = pow(1 + u * u + v * v, -1.5);
            covered += distance == 0 ? weight : 0;
            whole += weight;
            nearest = fmin(nearest, distance);
        }
        double value = (double)texel_of(environment, face, i, k)[1], expected = covered / whole;
        bool far = nearest > 3.0 / (size * GRID); /* no point of the texel can be in the pixel */
        if (far ? value != 0 : fabs(value - expected) > 2.5 / GRID)
            fail_msg("pixel (%u, %u) of %ux%u at R = %u: face %u (%u, %u) is %g instead of %g", row, column, m->width,
                     m->height, size, face, i, k, value, expected);
    }
    helio_environment_destroy(environment);
}

static void light_of_a_pixel_lands_where_the_pixel_is(void **state)
{
    (void)state;
    const uint32_t cases[][5] = {/* width, height, row, column, R */
                                 {16, 8, 0, 3, 5},   {16, 8, 7, 0, 8},   {16, 8, 2, 15, 6},  {16, 8, 3, 0, 4},
                                 {16, 8, 1, 1, 9},   {16, 8, 2, 2, 7},   {16, 8, 5, 8, 10},  {24, 12, 3, 4, 8},
                                 {64, 32, 9, 24, 8}, {64, 32, 8, 24, 3}, {7, 3, 0, 6, 8},    {4, 2, 1, 2, 6},
                                 {64, 32, 0, 9, 8},  {64, 32, 1, 1, 7},  {100, 7, 6, 99, 8}, {5, 60, 59, 2, 6},
                                 {1, 4, 1, 0, 5},    {2, 1, 0, 1, 4},    {64, 32, 8, 30, 8}, {64, 32, 8, 32, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        map m = make_map(HELIO_LAYOUT_LATLONG, cases[i][0], cases[i][1]);
        light_one_pixel(&m, cases[i][2], cases[i][3], 1);
        expect_pixel_in_place(&m, cases[i][2], cases[i][3], cases[i][4]);
        free(m.rgb);
    }
}

/* Every pixel covers what its texels say: each texel against the average of f over it, edges, corners and poles
 * included. */
static void expect_analytic(helio_layout layout, uint32_t width, uint32_t height, uint32_t size, double tolerance)
{
    map m = make_analytic_map(layout, width, height, smooth);
    helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
    double borders[129];
    fill_borders(borders, size, false);
    const uint32_t step = size > 32 ? 5 : 1; /* no divisor of a row's length, so that all columns are met */
    for (uint32_t texel = 0; texel < 6 * size * size; texel += step) {
        uint32_t face = texel / (size * size), row = texel / size % size, column = texel % size;
        const double u[2] = {borders[column], borders[column + 1]}, v[2] = {borders[row], borders[row + 1]};
        double d[3], solid_angle = pixel_solid_angle(borders, row, column);
        face_direction(face, centre_of(column, size), centre_of(row, size), d);
        normalize_double(d);
        for (int c = 0; c < 3; c++) {
            double value = (double)texel_of(environment, face, row, column)[c];
            double average = integrate(smooth, c, face, u, v) / solid_angle, centre = smooth(d, c);
            if (fabs(value - average) > tolerance || fabs(value - centre) > tolerance + 1.0 / (size * size))
                fail_msg("%s %ux%u at R = %u: face %u (%u, %u)[%d] is %.7g; average %.7g, centre %.7g",
                         helio_layout_name(layout), width, height, size, face, row, column, c, value, average, centre);
        }
    }
    helio_environment_destroy(environment);
    free(m.rgb);
}

static void smooth_radiance_keeps_its_values(void **state)
{
    (void)state;
    /* Shrinking: what is left is the error of pixels that the edge of a texel cuts, O(pixel^2 / texel). */
    expect_analytic(HELIO_LAYOUT_LATLONG, 1024, 512, 16, 2e-4);
    expect_analytic(HELIO_LAYOUT_LATLONG, 720, 361, 7, 2e-4);
    expect_analytic(HELIO_LAYOUT_STRIP, 256, 1536, 16, 5e-5);
    expect_analytic(HELIO_LAYOUT_STRIP, 1536, 256, 16, 5e-5);
    expect_analytic(HELIO_LAYOUT_STRIP, 201, 1206, 16, 4e-4);
    expect_analytic(HELIO_LAYOUT_STRIP_OPENEXR, 257, 1542, 16, 4e-4);
    expect_analytic(HELIO_LAYOUT_STRIP_OPENEXR, 200, 1200, 7, 4e-4);
    /* Same size and enlarging: a texel is at most half a pixel off. */
    expect_analytic(HELIO_LAYOUT_LATLONG, 256, 128, 64, 2e-2);
    expect_analytic(HELIO_LAYOUT_LATLONG, 128, 64, 97, 4e-2);
    expect_analytic(HELIO_LAYOUT_STRIP, 64, 384, 128, 2e-2);
    expect_analytic(HELIO_LAYOUT_STRIP_OPENEXR, 64, 384, 64, 2e-2);
}

static void strip_of_the_same_size_is_copied(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1,  2,   3,   7,
                              16, 100, 350, 352}; /* the last ones are written past the caches, or not quite */
    for (size_t i = 0; i < 16; i++) {
        uint32_t size = sizes[i / 2];
        bool stacked = i % 2;
        map m = make_random_map(HELIO_LAYOUT_STRIP, stacked ? size : 6 * size, stacked ? 6 * size : size, i);
        helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
        for (uint32_t row = 0; row < m.height; row++)
            for (uint32_t column = 0; column < m.width; column++) {
                uint32_t face, a, b;
                locate(&m, row, column, &face, &a, &b);
                assert_memory_equal(texel_of(environment, face, a, b), m.rgb + ((size_t)row * m.width + column) * 3,
                                    3 * sizeof(float));
            }
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

/* Each pixel of a stack by OpenEXR, lit alone, is seen in its own direction. */
static void openexr_strip_is_oriented_as_openexr_says(void **state)
{
    (void)state;
    for (uint32_t size = 2; size <= 4; size++) {
        map m = make_map(HELIO_LAYOUT_STRIP_OPENEXR, size, 6 * size);
        for (uint32_t pixel = 0; pixel < 6 * size * size; pixel++) {
            light_one_pixel(&m, pixel / size, pixel % size, 1);
            helio_environment *environment = make_from_map(shared_context, &m, 24, NULL);
            uint32_t face = pixel / (size * size), row = pixel / size % size, column = pixel % size;
            for (int i = 0; i < 9; i++) { /* a quarter of a pixel around, as far as the face reaches */
                double step = 2.0 / (size - 1), d[3];
                double s = (column + (i % 3 - 1) * 0.25) * step - 1, t = (row + (i / 3 - 1) * 0.25) * step - 1;
                openexr_direction(face, fmax(-0.99, fmin(0.99, s)), fmax(-0.99, fmin(0.99, t)), d);
                float radiance[3];
                helio_environment_radiance(environment, (float[3]){(float)d[0], (float)d[1], (float)d[2]}, radiance);
                assert_true(radiance[0] > 0.999f);
            }
            helio_environment_destroy(environment);
        }
        free(m.rgb);
    }
}

/* ---- against plain sums ------------------------------------------------------------------------- */

/* What hygiene makes of a pixel. */
static void clean_by_hand(float rgb[3])
{
    bool dark = false;
    for (int c = 0; c < 3; c++)
        dark |= isnan(rgb[c]) || fabs((double)rgb[c]) > (double)1e30f;
    for (int c = 0; c < 3; c++)
        rgb[c] = dark || !(rgb[c] > 0) ? 0 : rgb[c];
}

/* Puts a fault into one channel of some pixels: each with this chance, and the last one. */
static void add_faults(map *m, double chance, uint64_t seed)
{
    const float faults[] = {NAN, INFINITY, -INFINITY, 2e30f, -1, -0.0f, -2e30f, -NAN};
    size_t pixels = (size_t)m->width * m->height;
    for (size_t i = 0; i < pixels; i++)
        if (i + 1 == pixels || random_unit(&seed) < chance)
            m->rgb[i * 3 + random_bits(&seed) % 3] = faults[random_bits(&seed) % 8];
}

static map copy_cleaned(const map *m)
{
    map cleaned = make_map(m->layout, m->width, m->height);
    memcpy(cleaned.rgb, m->rgb, (size_t)m->width * m->height * 3 * sizeof(float));
    for (size_t i = 0; i < (size_t)m->width * m->height; i++)
        clean_by_hand(cleaned.rgb + i * 3);
    return cleaned;
}

/* Pixels beside faults are read by other code than the rest. */
static void expect_same_as_cleaned(helio_layout layout, uint32_t width, uint32_t height, uint32_t size, double chance)
{
    map m = make_random_map(layout, width, height, 41);
    add_faults(&m, chance, 42);
    map cleaned = copy_cleaned(&m);
    helio_environment *a = make_from_map(shared_context, &m, size, NULL);
    helio_environment *b = make_from_map(shared_context, &cleaned, size, NULL);
    if (memcmp(helio_environment_cube(a), helio_environment_cube(b), (size_t)18 * size * size * sizeof(float)) != 0)
        fail_msg("%s %ux%u at R = %u: faults (%g of the pixels) change other pixels", helio_layout_name(layout), width,
                 height, size, chance);
    helio_environment_destroy(a);
    helio_environment_destroy(b);
    free(m.rgb);
    free(cleaned.rgb);
}

static void maps_with_faults_give_the_bits_of_cleaned_ones(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 5, 16, 33};
    const double chances[] = {0, 0.003, 0.1, 1};
    for (size_t i = 0; i < 20; i++) {
        uint32_t size = sizes[i / 4];
        double chance = chances[i % 4];
        for (int k = 0; k < SHAPES; k++)
            expect_same_as_cleaned(shapes[k].layout, shapes[k].width, shapes[k].height, size, chance);
        expect_same_as_cleaned(HELIO_LAYOUT_LATLONG, 300, 150, size, chance);
        expect_same_as_cleaned(HELIO_LAYOUT_LATLONG, 301, 40, size, chance);
        expect_same_as_cleaned(HELIO_LAYOUT_STRIP, 64, 384, size, chance);
        expect_same_as_cleaned(HELIO_LAYOUT_STRIP_OPENEXR, 65, 390, size, chance);
    }
}

/* A rectangle of a face, and the planes through the origin that bound it: inside are all d with planes d >= 0. */
typedef struct plain_texel {
    uint32_t face;
    double u[2], v[2];
    double planes[4][3];
} plain_texel;

static plain_texel make_plain_texel(uint32_t face, uint32_t row, uint32_t column, uint32_t size)
{
    plain_texel t = {.face = face,
                     .u = {2.0 * column / size - 1, 2.0 * (column + 1) / size - 1},
                     .v = {2.0 * row / size - 1, 2.0 * (row + 1) / size - 1}};
    double middle[3];
    face_direction(face, 0.5 * (t.u[0] + t.u[1]), 0.5 * (t.v[0] + t.v[1]), middle);
    for (int i = 0; i < 4; i++) {
        double a[3], b[3], inside = 0;
        face_direction(face, t.u[i % 2], t.v[i / 2], a);
        face_direction(face, t.u[i == 0 || i == 1], t.v[i == 1 || i == 3], b);
        for (int c = 0; c < 3; c++) {
            t.planes[i][c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
            inside += t.planes[i][c] * middle[c];
        }
        for (int c = 0; c < 3; c++)
            t.planes[i][c] *= inside < 0 ? -1 : 1;
    }
    return t;
}

/* Sines of the latitudes between which a meridian is in the texel. false: it is not. */
static bool cut_meridian(const plain_texel *t, double longitude, double *low, double *high)
{
    double least = -HUGE_VAL, greatest = HUGE_VAL; /* tangent of latitude */
    for (int i = 0; i < 4; i++) {
        double a = t->planes[i][0] * sin(longitude) + t->planes[i][2] * cos(longitude), b = t->planes[i][1];
        if (fabs(b) < 1e-12 ? a < 0 : false)
            return false;
        if (fabs(b) >= 1e-12 && b > 0)
            least = fmax(least, -a / b);
        if (fabs(b) >= 1e-12 && b < 0)
            greatest = fmin(greatest, -a / b);
    }
    *low = sin(atan(least));
    *high = sin(atan(greatest));
    return least < greatest;
}

/* Positions, in columns from the left of the map on and across its edge, between which the texel lies: those of its
 * corners, or all if it holds a pole. */
static void find_positions(const map *m, const plain_texel *t, double *first, double *last)
{
    double d[3], low, high;
    bool holds_pole = true;
    for (int i = 0; i < 4; i++)
        holds_pole &= cut_meridian(t, (i + 0.5) * PI / 2, &low, &high);
    face_direction(t->face, 0.5 * (t->u[0] + t->u[1]), 0.5 * (t->v[0] + t->v[1]), d);
    double middle = (0.5 - atan2(d[0], d[2]) / (2 * PI)) * m->width + m->width;
    *first = holds_pole ? m->width : middle;
    *last = holds_pole ? 2 * m->width : middle;
    for (int i = 0; i < 4 && !holds_pole; i++) {
        face_direction(t->face, t->u[i % 2], t->v[i / 2], d);
        if (d[0] == 0 && d[2] == 0)
            continue;
        double position = (0.5 - atan2(d[0], d[2]) / (2 * PI)) * m->width;
        position -= m->width * round((position - middle) / m->width);
        *first = fmin(*first, position);
        *last = fmax(*last, position);
    }
}

/* Adds what the texel covers of the pixels that a meridian crosses. */
static void add_meridian(const map *m, const plain_texel *t, uint32_t column, double position, double width,
                         double sum[4])
{
    double low, high;
    if (!cut_meridian(t, PI * (1 - 2 * position / m->width), &low, &high))
        return;
    for (uint32_t row = 0; row < m->height; row++) {
        double height = fmin(high, cos(PI * row / m->height)) - fmax(low, cos(PI * (row + 1) / m->height));
        if (!(height > 0))
            continue;
        sum[3] += height * width;
        for (int c = 0; c < 3; c++)
            sum[c] += height * width * (double)m->rgb[((size_t)row * m->width + column) * 3 + (size_t)c];
    }
}

/* Average of the map over a texel, by meridians in what it covers of each column. */
static void plain_latlong_average(const map *m, const plain_texel *t, double average[3])
{
    enum { MERIDIANS = 100 };
    double first, last, sum[4] = {0, 0, 0, 0};
    find_positions(m, t, &first, &last);
    for (double column = floor(first); column < last; column++) {
        double from = fmax(first, column), width = (fmin(last, column + 1) - from) / MERIDIANS;
        for (int i = 0; i < MERIDIANS; i++)
            add_meridian(m, t, (uint32_t)column % m->width, from + (i + 0.5) * width, width, sum);
    }
    for (int c = 0; c < 3; c++)
        average[c] = sum[c] / sum[3];
}

/* The same for a strip, whose pixels cut rectangles out of a texel. OpenEXR's s and t are +-u and +-v. */
static void plain_strip_average(const map *m, const plain_texel *t, double average[3])
{
    uint32_t size = face_size(m);
    bool openexr = m->layout == HELIO_LAYOUT_STRIP_OPENEXR, pole = t->face == 2 || t->face == 3;
    double *borders = calloc(size + 1, sizeof *borders), whole = 0, sum[3] = {0, 0, 0};
    assert_non_null(borders);
    fill_borders(borders, size, openexr);
    for (uint32_t pixel = 0; pixel < size * size; pixel++) {
        uint32_t row = pixel / size, column = pixel % size;
        uint32_t i = openexr && pole ? size - 1 - row : row, k = openexr && !pole ? size - 1 - column : column;
        const double u[2] = {fmax(t->u[0], borders[column]), fmin(t->u[1], borders[column + 1])};
        const double v[2] = {fmax(t->v[0], borders[row]), fmin(t->v[1], borders[row + 1])};
        if (u[0] >= u[1] || v[0] >= v[1])
            continue;
        double area = integrate(one, 0, t->face, u, v);
        uint32_t map_row = m->height > m->width ? t->face * size + i : i;
        uint32_t map_column = m->height > m->width ? k : t->face * size + k;
        whole += area;
        for (int c = 0; c < 3; c++)
            sum[c] += area * (double)m->rgb[((size_t)map_row * m->width + map_column) * 3 + (size_t)c];
    }
    free(borders);
    for (int c = 0; c < 3; c++)
        average[c] = sum[c] / whole;
}

static void expect_plain_sums(const map *m, uint32_t size, double tolerance)
{
    map cleaned = copy_cleaned(m);
    helio_environment *environment = make_from_map(shared_context, m, size, NULL);
    for (uint32_t texel = 0; texel < 6 * size * size; texel++) {
        uint32_t face = texel / (size * size), row = texel / size % size, column = texel % size;
        plain_texel t = make_plain_texel(face, row, column, size);
        double average[3];
        if (m->layout == HELIO_LAYOUT_LATLONG)
            plain_latlong_average(&cleaned, &t, average);
        else
            plain_strip_average(&cleaned, &t, average);
        for (int c = 0; c < 3; c++) {
            double value = (double)texel_of(environment, face, row, column)[c];
            if (!(fabs(value - average[c]) <= tolerance))
                fail_msg("%s %ux%u at R = %u: face %u (%u, %u)[%d] is %.8g instead of %.8g",
                         helio_layout_name(m->layout), m->width, m->height, size, face, row, column, c, value,
                         average[c]);
        }
    }
    helio_environment_destroy(environment);
    free(cleaned.rgb);
}

/* Random pixels from 0 to 1, with faults. The sums for lat-long maps are quadratures and err by some 1e-4 of a pixel;
 * those for strips are exact. */
static void texels_equal_plain_sums(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 6, 7};
    const map more[] = {{HELIO_LAYOUT_LATLONG, 16, 8, NULL}, {HELIO_LAYOUT_LATLONG, 24, 11, NULL},
                        {HELIO_LAYOUT_LATLONG, 10, 6, NULL}, {HELIO_LAYOUT_LATLONG, 4, 40, NULL},
                        {HELIO_LAYOUT_STRIP, 90, 15, NULL},  {HELIO_LAYOUT_STRIP_OPENEXR, 15, 90, NULL}};
    enum { MORE = sizeof more / sizeof *more };
    for (int i = 0; i < 5 * (SHAPES + MORE); i++) {
        const map *shape = i / 5 < SHAPES ? &shapes[i / 5] : &more[i / 5 - SHAPES];
        map m = make_random_map(shape->layout, shape->width, shape->height, (uint64_t)i);
        add_faults(&m, 0.05, (uint64_t)i);
        expect_plain_sums(&m, sizes[i % 5], m.layout == HELIO_LAYOUT_LATLONG ? 3e-4 : 1e-6);
        free(m.rgb);
    }
}

/* ---- pictures that others made ---------------------------------------------------------------- */

static void need_openexr(void)
{
#ifndef HELIO_WITH_OPENEXR
    print_message("skipped: this build has no OpenEXR\n");
    skip();
#endif
}

static helio_environment *read_environment(const char *path, uint32_t size)
{
    helio_image *image;
    assert_ok(helio_image_read(shared_context, path, NULL, &image));
    assert_int_not_equal(image->layout, HELIO_LAYOUT_AUTO); /* OpenEXR's envmap attribute */
    map m = {image->layout, image->width, image->height, image->rgb};
    helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
    helio_image_destroy(shared_context, image);
    return environment;
}

/* One of the 48 ways to permute and mirror the axes; 0 leaves them as they are. */
static void apply_symmetry(int symmetry, const double d[3], float out[3])
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int c = 0; c < 3; c++)
        out[c] = (float)(d[orders[symmetry / 8][c]] * (symmetry >> c & 1 ? -1 : 1));
}

/* Mean absolute difference of the radiance of two cubes, the second one turned and mirrored. */
static double compare_environments(const helio_environment *a, const helio_environment *b, int symmetry)
{
    uint32_t size = helio_environment_cube_size(a);
    double sum = 0;
    for (uint32_t texel = 0; texel < 6 * size * size; texel++) {
        uint32_t face = texel / (size * size), row = texel / size % size, column = texel % size;
        double d[3];
        float turned[3], radiance[3];
        face_direction(face, centre_of(column, size), centre_of(row, size), d);
        apply_symmetry(symmetry, d, turned);
        helio_environment_radiance(b, turned, radiance);
        for (int c = 0; c < 3; c++)
            sum += fabs((double)(texel_of(a, face, row, column)[c] - radiance[c]));
    }
    return sum / (18.0 * size * size);
}

/* Both pictures show the same; turned or mirrored the second one is at least twice as different, but for those of the
 * 48 ways (twins) that leave the picture's pattern as it is. */
static void expect_same_place(const char *latlong, const char *cube, double difference, int twins)
{
    char paths[2][TEST_PATH_SIZE];
    need_openexr();
    find_test_data(latlong, paths[0]);
    find_test_data(cube, paths[1]);
    helio_environment *a = read_environment(paths[0], 64), *b = read_environment(paths[1], 64);
    double same = compare_environments(a, b, 0);
    int close = 0;
    for (int symmetry = 1; symmetry < 48; symmetry++)
        close += compare_environments(a, b, symmetry) < 2 * same;
    helio_environment_destroy(a);
    helio_environment_destroy(b);
    if (!(same < difference && close == twins))
        fail_msg("%s and its cube differ by %g; %d ways to turn it are as close, not %d", latlong, same, close, twins);
}

static void orientation_pictures_agree(void **state)
{
    (void)state;
    expect_same_place("environments/orientation-tests/OrientationLatLong.exr",
                      "environments/orientation-tests/OrientationCube.exr", 0.01, 0);
}

static void wavy_lines_agree(void **state)
{
    (void)state;
    expect_same_place("environments/orientation-tests/WavyLinesLatLong.exr",
                      "environments/orientation-tests/WavyLinesCube.exr", 0.02, 7);
}

static void stage_pictures_agree(void **state)
{
    (void)state;
    expect_same_place("environments/latlong/StageEnvLatLong.exr", "environments/cube-strip-openexr/StageEnvCube.exr",
                      0.5, 0);
}

/* Mean luminance from near the middle of the face of `axis` towards another axis. */
static double arm_luminance(const helio_environment *environment, int axis, double sign, int towards, double direction)
{
    double sum = 0;
    for (int i = 0; i < 40; i++) {
        float d[3] = {0, 0, 0}, radiance[3];
        d[axis] = (float)sign;
        d[towards] = (float)(direction * (0.04 + 0.008 * i));
        helio_environment_radiance(environment, d, radiance);
        sum += (double)luminance(radiance) / 40;
    }
    return sum;
}

/* In the middle of each face these pictures have dark arms that point along the two positive axes beside the face's
 * own. */
static void expect_drawn_axes(const char *name)
{
    char path[TEST_PATH_SIZE];
    need_openexr();
    find_test_data(name, path);
    helio_environment *environment = read_environment(path, 256);
    for (int axis = 0; axis < 3; axis++)
        for (double sign = -1; sign <= 1; sign += 2)
            for (int other = 0; other < 3; other++) {
                if (other == axis)
                    continue;
                double arm = arm_luminance(environment, axis, sign, other, 1);
                double none = arm_luminance(environment, axis, sign, other, -1);
                if (!(arm < 0.6 * none))
                    fail_msg("%s, face %+d, axis %d: luminance %g along the arm, %g opposite", name,
                             (int)sign * (axis + 1), other + 1, arm, none);
            }
    helio_environment_destroy(environment);
}

static void axes_drawn_in_the_latlong_picture_are_ours(void **state)
{
    (void)state;
    expect_drawn_axes("environments/orientation-tests/OrientationLatLong.exr");
}

static void axes_drawn_in_the_cube_picture_are_ours(void **state)
{
    (void)state;
    expect_drawn_axes("environments/orientation-tests/OrientationCube.exr");
}

/* ---- hygiene ------------------------------------------------------------------------------------ */

/* The class that one pixel is counted in: 0 none, 1 NaN, 2 infinite, 3 negative. */
static int fault_of(helio_environment *environment, const float rgb[3], float seen[3])
{
    helio_environment_info info;
    assert_ok(helio_environment_update(environment, rgb, &info));
    helio_environment_radiance(environment, (float[3]){0, 0, 1}, seen);
    assert_true(info.bad.nan + info.bad.infinite + info.bad.negative <= 1);
    return info.bad.nan ? 1 : info.bad.infinite ? 2 : info.bad.negative ? 3 : 0;
}

static void bad_channels_are_counted_once_per_pixel(void **state)
{
    (void)state;
    const float values[] = {1, 0, -0.0f, 1e30f, -1, -FLT_TRUE_MIN, 1.1e30f, FLT_MAX, INFINITY, -INFINITY, NAN, -NAN};
    const int classes[] = {0, 0, 0, 0, 3, 3, 2, 2, 2, 2, 1, 1};
    enum { COUNT = sizeof values / sizeof *values };
    helio_environment_desc desc = {.cube_size = 1, .width = 1, .height = 1};
    helio_environment *environment;
    assert_ok(helio_environment_create(shared_context, &desc, &environment));
    for (int i = 0; i < COUNT * COUNT * COUNT; i++) {
        const int which[3] = {i % COUNT, i / COUNT % COUNT, i / COUNT / COUNT};
        float rgb[3], seen[3];
        int expected = 0;
        for (int c = 0; c < 3; c++) {
            rgb[c] = values[which[c]];
            int class = classes[which[c]];
            expected = expected == 0 || (class != 0 && class < expected) ? class : expected;
        }
        assert_int_equal(fault_of(environment, rgb, seen), expected);
        for (int c = 0; c < 3; c++) {
            float kept = expected == 1 || expected == 2 || rgb[c] < 0 ? 0 : rgb[c];
            assert_true(isfinite(seen[c]) && !signbit(seen[c]) && fabsf(seen[c] - kept) <= 2e-7f * kept);
        }
    }
    helio_environment_destroy(environment);
}

/* Also where no texel looks: in the corners of crosses and of discs. */
static void a_fault_is_counted_wherever_it_is(void **state)
{
    (void)state;
    const map maps[] = {
        {HELIO_LAYOUT_LATLONG, 8, 4, NULL},    {HELIO_LAYOUT_LATLONG, 7, 3, NULL},
        {HELIO_LAYOUT_STRIP, 12, 2, NULL},     {HELIO_LAYOUT_STRIP_OPENEXR, 3, 18, NULL},
        {HELIO_LAYOUT_CROSS_V, 6, 8, NULL},    {HELIO_LAYOUT_CROSS_H, 8, 6, NULL},
        {HELIO_LAYOUT_OCTAHEDRAL, 6, 6, NULL}, {HELIO_LAYOUT_EQUAL_AREA, 6, 6, NULL},
        {HELIO_LAYOUT_ANGULAR, 7, 7, NULL},    {HELIO_LAYOUT_MIRRORBALL, 8, 8, NULL},
    };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        map m = make_random_map(maps[i].layout, maps[i].width, maps[i].height, 43);
        helio_environment_info info;
        helio_environment *environment = make_from_map(shared_context, &m, 4, &info);
        assert_true(info.bad.nan + info.bad.infinite + info.bad.negative == 0);
        for (size_t pixel = 0; pixel < (size_t)m.width * m.height; pixel++) {
            float *channel = m.rgb + pixel * 3 + pixel % 3, good = *channel;
            *channel = pixel % 2 ? NAN : -1;
            assert_ok(helio_environment_update(environment, m.rgb, &info));
            if (info.bad.nan != pixel % 2 || info.bad.negative != (pixel + 1) % 2 || info.bad.infinite != 0)
                fail_msg("%s: the fault of pixel %zu is not counted", helio_layout_name(m.layout), pixel);
            *channel = good;
        }
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

static void any_bits_give_a_finite_cube(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int shape = 0; shape < SHAPES; shape++)
        for (int kind = 0; kind < 2; kind++) {
            map m = make_map(shapes[shape].layout, shapes[shape].width, shapes[shape].height);
            uint64_t expected[4] = {0};
            for (size_t i = 0; i < (size_t)m.width * m.height; i++) {
                int class = 0;
                for (int c = 0; c < 3; c++) {
                    /* any bits, or exponents near the largest that is allowed */
                    uint32_t bits = random_bits(&seed);
                    bits = kind ? (bits & 0x007fffffu) | (224 + bits % 3) << 23 : bits;
                    memcpy(m.rgb + i * 3 + c, &bits, sizeof bits);
                    double value = (double)m.rgb[i * 3 + c];
                    int channel = isnan(value) ? 1 : fabs(value) > (double)1e30f ? 2 : value < 0 ? 3 : 0;
                    class = class == 0 || (channel != 0 && channel < class) ? channel : class;
                }
                expected[class]++;
            }
            helio_environment_info info;
            helio_environment *environment = make_from_map(shared_context, &m, 5, &info);
            assert_int_equal(info.bad.nan, expected[1]);
            assert_int_equal(info.bad.infinite, expected[2]);
            assert_int_equal(info.bad.negative, expected[3]);
            for (size_t i = 0; i < 6 * 5 * 5 * 3; i++) {
                float value = helio_environment_cube(environment)[i];
                assert_true(isfinite(value) && !signbit(value));
            }
            assert_true(isfinite(info.mean_luminance) && isfinite(info.max_luminance) && isfinite(info.auto_exposure));
            helio_environment_destroy(environment);
            free(m.rgb);
        }
}

/* ---- orientation ---------------------------------------------------------------------------------- */

static void look(const helio_environment *environment, float x, float y, float z, float expected)
{
    float radiance[3];
    helio_environment_radiance(environment, (float[3]){x, y, z}, radiance);
    if (!(fabsf(radiance[1] - expected) <= 1e-5f * expected))
        fail_msg("towards (%g, %g, %g): %g instead of %g", (double)x, (double)y, (double)z, (double)radiance[1],
                 (double)expected);
}

/* Faces of radiance 1 to 6 in the order +X -X +Y -Y +Z -Z. */
static helio_environment *make_numbered(void)
{
    float rgb[18];
    for (int i = 0; i < 18; i++)
        rgb[i] = (float)(i / 3 + 1);
    return make_environment(shared_context, HELIO_LAYOUT_STRIP, 6, 1, 3, rgb, NULL);
}

static void rotation_turns_light_from_z_to_x(void **state)
{
    (void)state;
    helio_environment *environment = make_numbered();
    for (float turns = -720; turns <= 720; turns += 360) {
        assert_ok(helio_environment_orient(environment, &(helio_orientation){.rotate = turns + 90}));
        look(environment, 1, 0, 0, 5);  /* from +Z */
        look(environment, 0, 0, -1, 1); /* from +X */
        look(environment, -1, 0, 0, 6);
        look(environment, 0, 0, 1, 2);
        look(environment, 0, 1, 0, 3);
        look(environment, 0, -1, 0, 4);
    }
    helio_environment_destroy(environment);
}

static void flip_mirrors_x_before_the_rotation(void **state)
{
    (void)state;
    helio_environment *environment = make_numbered();
    assert_ok(helio_environment_orient(environment, &(helio_orientation){.flip = true}));
    look(environment, 1, 0, 0, 2);
    look(environment, -1, 0, 0, 1);
    look(environment, 0, 0, 1, 5);
    look(environment, 0, 1, 0, 3);
    assert_ok(helio_environment_orient(environment, &(helio_orientation){.flip = true, .rotate = 90}));
    look(environment, 1, 0, 0, 5);  /* +Z stays under the mirror and turns to +X */
    look(environment, 0, 0, -1, 2); /* -X is mirrored to +X and turns to -Z */
    look(environment, 0, 0, 1, 1);
    look(environment, -1, 0, 0, 6);
    assert_ok(helio_environment_orient(environment, &(helio_orientation){0}));
    look(environment, 1, 0, 0, 1);
    helio_environment_destroy(environment);
}

/* A turned look-up equals an unturned one in the direction turned back by hand. */
static void any_rotation_is_undone_by_turning_back(void **state)
{
    (void)state;
    map m = make_analytic_map(HELIO_LAYOUT_LATLONG, 64, 32, smooth);
    helio_environment *turned = make_from_map(shared_context, &m, 16, NULL);
    helio_environment *plain = make_from_map(shared_context, &m, 16, NULL);
    uint64_t seed = 12;
    for (int i = 0; i < 2000; i++) {
        double angle = (random_unit(&seed) - 0.5) * 2000, a = angle * PI / 180;
        bool flip = i % 2;
        assert_ok(helio_environment_orient(turned, &(helio_orientation){.rotate = (float)angle, .flip = flip}));
        double y = random_unit(&seed) * 2 - 1, longitude = 2 * PI * random_unit(&seed), radius = sqrt(1 - y * y);
        double x = radius * sin(longitude), z = radius * cos(longitude); /* in the map */
        double mirrored = flip ? -x : x;
        double world_x = mirrored * cos(a) + z * sin(a), world_z = z * cos(a) - mirrored * sin(a);
        float there[3], here[3];
        helio_environment_filtered(turned, (float[3]){(float)world_x, (float)y, (float)world_z}, there);
        helio_environment_filtered(plain, (float[3]){(float)x, (float)y, (float)z}, here);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(there[c] - here[c]) < 2e-4f);
    }
    helio_environment_destroy(turned);
    helio_environment_destroy(plain);
    free(m.rgb);
}

static void intensity_scales_lookups_alone(void **state)
{
    (void)state;
    helio_environment *environment = make_numbered();
    assert_ok(helio_environment_orient(environment, &(helio_orientation){.intensity = 2.5f}));
    look(environment, 0, 1, 0, 7.5f);
    float filtered[3];
    helio_environment_filtered(environment, (float[3]){0, 1, 0}, filtered);
    assert_float_equal(filtered[0], 7.5, 1e-5);
    assert_true(texel_of(environment, 2, 1, 1)[0] == 3);
    assert_ok(helio_environment_orient(environment, &(helio_orientation){0}));
    look(environment, 0, 1, 0, 3);
    helio_environment_destroy(environment);
}

static void bad_orientations_are_refused(void **state)
{
    (void)state;
    helio_environment *environment = make_numbered();
    const helio_orientation keep = {.rotate = 90, .intensity = 2};
    assert_ok(helio_environment_orient(environment, &keep));
    const helio_orientation bad[] = {{.rotate = NAN},    {.rotate = INFINITY},    {.intensity = -1},
                                     {.intensity = NAN}, {.intensity = INFINITY}, {.rotate = -INFINITY}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(helio_environment_orient(environment, &bad[i]), HELIO_ERR_ARGUMENT);
        look(environment, 1, 0, 0, 10);
    }
    assert_int_equal(helio_environment_orient(NULL, &keep), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_orient(environment, NULL), HELIO_ERR_ARGUMENT);
    helio_environment_destroy(environment);
}

/* ---- filtered look-ups ------------------------------------------------------------------------------ */

static void filtered_lookup_equals_texels_at_their_centres(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16};
    for (size_t i = 0; i < 4; i++) {
        uint32_t size = sizes[i];
        map m = make_random_map(HELIO_LAYOUT_STRIP, 6 * size, size, 20 + i);
        helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
        for (uint32_t texel = 0; texel < 6 * size * size; texel++) {
            uint32_t face = texel / (size * size), row = texel / size % size, column = texel % size;
            float radiance[3], d[3];
            vec3_to(cube_direction(face, (float)centre_of(column, size), (float)centre_of(row, size)), d);
            helio_environment_filtered(environment, d, radiance);
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(radiance[c] - texel_of(environment, face, row, column)[c]) < 1e-4f);
        }
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

/* Two faces meet in each edge; a step across it that is as small as floats allow must not be seen. */
static void filtered_lookup_is_continuous_across_edges_and_corners(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 2, 3, 16, 512};
    for (size_t i = 0; i < 5; i++) {
        map m = make_random_map(HELIO_LAYOUT_STRIP, 6 * sizes[i], sizes[i], 30 + i);
        helio_environment *environment = make_from_map(shared_context, &m, sizes[i], NULL);
        for (int k = 0; k < 12 * 1001; k++) {
            int edge = k / 1001, axis = edge % 3;
            float along = (float)(k % 1001) / 500 - 1, near[3], far[3], a[3], b[3];
            near[axis] = far[axis] = along; /* 1 and -1 are the corners */
            for (int c = 1; c < 3; c++)
                near[(axis + c) % 3] = far[(axis + c) % 3] = edge / 3 >> (c - 1) & 1 ? 1.0f : -1.0f;
            near[(axis + 1) % 3] *= 0.999999f;
            far[(axis + 2) % 3] *= 0.999999f;
            helio_environment_filtered(environment, near, a);
            helio_environment_filtered(environment, far, b);
            for (int c = 0; c < 3; c++)
                if (fabsf(a[c] - b[c]) > 2e-6f * (float)sizes[i] + 1e-5f)
                    fail_msg("R = %u, edge %d at %g: %g on one side, %g on the other", sizes[i], edge, (double)along,
                             (double)a[c], (double)b[c]);
        }
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

static void filtered_lookup_of_smooth_radiance_is_smooth(void **state)
{
    (void)state;
    const uint32_t size = 64;
    map m = make_analytic_map(HELIO_LAYOUT_STRIP, size, 6 * size, smooth);
    helio_environment *environment = make_from_map(shared_context, &m, size, NULL);
    uint64_t seed = 40;
    for (int i = 0; i < 30000; i++) {
        double d[3] = {2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1};
        if (i % 2) /* on an edge */
            d[i / 2 % 3] = copysign(fmax(fabs(d[(i / 2 + 1) % 3]), fabs(d[(i / 2 + 2) % 3])), d[i / 2 % 3]);
        normalize_double(d);
        float radiance[3];
        helio_environment_filtered(environment, (float[3]){(float)d[0], (float)d[1], (float)d[2]}, radiance);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)radiance[c] - smooth(d, c)) < 0.01);
    }
    helio_environment_destroy(environment);
    free(m.rgb);
}

/* ---- what an update reports --------------------------------------------------------------------------- */

static float exposure_of(const map *m, uint32_t size)
{
    helio_environment_info info;
    helio_environment_destroy(make_from_map(shared_context, m, size, &info));
    return info.auto_exposure;
}

static void auto_exposure_of_even_light_makes_white_four_fifths(void **state)
{
    (void)state;
    const float white[3] = {1, 1, 1}, twice[3] = {2, 2, 2}, black[3] = {0, 0, 0};
    const uint32_t sizes[] = {1, 2, 3, 5, 8, 13, 16, 64, 100};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        float even = exposure_of(&(map){HELIO_LAYOUT_LATLONG, 1, 1, (float *)white}, sizes[i]);
        if (!(fabs((double)even - log2(0.8)) < 0.03))
            fail_msg("R = %u: %g stops instead of %g", sizes[i], (double)even, log2(0.8));
        assert_float_equal(exposure_of(&(map){HELIO_LAYOUT_LATLONG, 1, 1, (float *)twice}, sizes[i]), even - 1, 1e-5);
        assert_true(exposure_of(&(map){HELIO_LAYOUT_LATLONG, 1, 1, (float *)black}, sizes[i]) == 0);
    }
}

/* A surface that faces a small sun gets radiance x solid angle, wherever the sun stands. */
static void auto_exposure_of_a_small_sun_follows_its_flux(void **state)
{
    (void)state;
    uint64_t seed = 50;
    for (int i = 0; i < 20; i++) {
        map m = make_map(HELIO_LAYOUT_LATLONG, 256, 128);
        light_one_pixel(&m, random_bits(&seed) % 128, random_bits(&seed) % 256, 1e5f);
        double expected = log2(0.8 * PI / map_flux(&m, 1));
        assert_true(fabs((double)exposure_of(&m, 64) - expected) < 0.02);
        free(m.rgb);
    }
}

static void expect_sums_of_the_cube(uint32_t size)
{
    map m = make_random_map(HELIO_LAYOUT_LATLONG, 64, 32, 60);
    helio_environment_info info;
    helio_environment *environment = make_from_map(shared_context, &m, size, &info);
    double borders[301], total = 0, brightest = 0;
    fill_borders(borders, size, false);
    for (uint32_t face = 0; face < 6; face++) {
        double flux = 0;
        for (uint32_t row = 0; row < size; row++)
            for (uint32_t column = 0; column < size; column++) {
                const float *rgb = texel_of(environment, face, row, column);
                double value = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
                flux += value * pixel_solid_angle(borders, row, column);
                brightest = fmax(brightest, value);
            }
        assert_true(fabs(info.flux[face] - flux) < 1e-6 * flux);
        total += flux;
    }
    assert_true(fabs(info.mean_luminance - total / (4 * PI)) < 1e-6 * info.mean_luminance);
    assert_true(fabs((double)info.max_luminance - brightest) < 1e-6 * brightest);
    assert_int_equal(info.bad.nan + info.bad.infinite + info.bad.negative, 0);
    helio_environment_destroy(environment);
    free(m.rgb);
}

static void info_sums_up_the_cube(void **state)
{
    (void)state;
    const uint32_t sizes[] = {1, 3, 9, 300};
    for (size_t i = 0; i < 4; i++)
        expect_sums_of_the_cube(sizes[i]);
}

static void updates_start_new_frames(void **state)
{
    (void)state;
    helio_environment_desc desc = {.width = 2, .height = 1};
    helio_environment *environment;
    assert_ok(helio_environment_create(shared_context, &desc, &environment));
    assert_int_equal(helio_environment_cube_size(environment), 512);
    assert_int_equal(helio_environment_frame(environment), 0);
    helio_environment_destroy(environment);
    desc.cube_size = 4;
    assert_ok(helio_environment_create(shared_context, &desc, &environment));
    for (uint64_t frame = 1; frame <= 3; frame++) {
        const float value = (float)frame, rgb[6] = {value, value, value, value, value, value};
        assert_ok(helio_environment_update(environment, rgb, NULL));
        assert_int_equal(helio_environment_frame(environment), frame);
        assert_true(fabsf(texel_of(environment, 5, 3, 3)[2] - value) < 1e-5f); /* nothing is left of the frame before */
    }
    assert_int_equal(helio_environment_update(environment, NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_update(NULL, (float[3]){0}, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_frame(environment), 3);
    helio_environment_destroy(environment);
    helio_environment_destroy(NULL);
}

/* ---- descs, memory, threads --------------------------------------------------------------------------- */

static void expect_desc_refused(helio_environment_desc desc, const char *word)
{
    helio_environment *environment = (helio_environment *)1;
    helio_status status = helio_environment_create(shared_context, &desc, &environment);
    if (!(status == HELIO_ERR_ARGUMENT || status == HELIO_ERR_DATA) || environment != NULL)
        fail_msg("%ux%u, layout %d, R = %u is not refused", desc.width, desc.height, (int)desc.layout, desc.cube_size);
    if (strstr(helio_last_error(), word) == NULL)
        fail_msg("\"%s\" does not name %s", helio_last_error(), word);
}

static void bad_descs_are_refused(void **state)
{
    (void)state;
    size_t live = shared_memory.live;
    expect_desc_refused((helio_environment_desc){.width = 2}, "2");
    expect_desc_refused((helio_environment_desc){.height = 2}, "2");
    expect_desc_refused((helio_environment_desc){.width = 65537, .height = 2}, "65537");
    expect_desc_refused((helio_environment_desc){.width = 2, .height = UINT32_MAX}, "4294967295");
    expect_desc_refused((helio_environment_desc){.width = 2, .height = 1, .cube_size = 4097}, "4097");
    expect_desc_refused((helio_environment_desc){.width = 3, .height = 3}, "3");
    for (int layout = HELIO_LAYOUT_STRIP; layout <= HELIO_LAYOUT_STRIP_OPENEXR; layout++)
        expect_desc_refused((helio_environment_desc){.width = 4, .height = 2, .layout = (helio_layout)layout}, "strip");
    expect_desc_refused((helio_environment_desc){.width = 6, .height = 1, .layout = HELIO_LAYOUT_STRIP_OPENEXR},
                        "strip");
    expect_desc_refused((helio_environment_desc){.width = 1, .height = 6, .layout = (helio_layout)99}, "99");
    expect_desc_refused((helio_environment_desc){.width = 2, .height = 1, .layout = (helio_layout)-1}, "-1");
    const helio_environment_desc fine = {.width = 2, .height = 1, .cube_size = 1};
    helio_environment *environment = (helio_environment *)1;
    assert_int_equal(helio_environment_create(NULL, &fine, &environment), HELIO_ERR_ARGUMENT);
    assert_null(environment);
    environment = (helio_environment *)1;
    assert_int_equal(helio_environment_create(shared_context, NULL, &environment), HELIO_ERR_ARGUMENT);
    assert_null(environment);
    assert_int_equal(helio_environment_create(shared_context, &fine, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(shared_memory.live, live);
}

static void a_single_pixel_is_constant_in_every_layout(void **state)
{
    (void)state;
    for (int layout = HELIO_LAYOUT_AUTO; layout <= HELIO_LAYOUT_MIRRORBALL; layout++)
        expect_constant((helio_layout)layout, 1, 1, 3);
}

static void creation_without_memory_fails_cleanly(void **state)
{
    (void)state;
    for (int shape = 0; shape < SHAPES; shape += SHAPES - 1)
        for (size_t more = 0;; more++) {
            memory_count count = {0};
            helio_context *context = make_context(1, &count);
            size_t own = count.live;
            count.refuse_after = count.taken + more;
            helio_environment_desc desc = {.cube_size = 4,
                                           .width = shapes[shape].width,
                                           .height = shapes[shape].height,
                                           .layout = shapes[shape].layout};
            helio_environment *environment = (helio_environment *)1;
            helio_status status = helio_environment_create(context, &desc, &environment);
            if (status != HELIO_OK) {
                assert_int_equal(status, HELIO_ERR_MEMORY);
                assert_null(environment);
                assert_int_equal(count.live, own);
            }
            helio_environment_destroy(environment);
            helio_context_destroy(context);
            assert_int_equal(count.live, 0);
            if (status == HELIO_OK)
                break;
            assert_in_range(more, 0, 50);
        }
}

static void updates_and_lookups_take_no_memory(void **state)
{
    (void)state;
    for (int shape = 0; shape < SHAPES; shape++) {
        map m = make_random_map(shapes[shape].layout, shapes[shape].width, shapes[shape].height, 70);
        helio_environment *environment = make_from_map(shared_context, &m, 8, NULL);
        size_t taken = shared_memory.taken;
        helio_environment_info info;
        float radiance[3];
        for (int i = 0; i < 3; i++)
            assert_ok(helio_environment_update(environment, m.rgb, &info));
        assert_ok(helio_environment_orient(environment, &(helio_orientation){.rotate = 30}));
        helio_environment_filtered(environment, (float[3]){1, 1, 1}, radiance);
        assert_int_equal(shared_memory.taken, taken);
        helio_environment_destroy(environment);
        free(m.rgb);
    }
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    const uint32_t threads[] = {1, 2, 5};
    const uint32_t size = 33;
    for (int shape = 3; shape < SHAPES; shape++) {
        map m = make_random_map(shapes[shape].layout, shapes[shape].width, shapes[shape].height, 80);
        float *first = NULL;
        helio_environment_info first_info = {0};
        size_t bytes = (size_t)6 * size * size * 3 * sizeof *first;
        for (size_t i = 0; i < 3; i++) {
            helio_context *context = make_context(threads[i], NULL);
            helio_environment_info info;
            helio_environment *environment = make_from_map(context, &m, size, &info);
            if (first == NULL) {
                first = malloc(bytes);
                assert_non_null(first);
                memcpy(first, helio_environment_cube(environment), bytes);
                first_info = info;
            }
            assert_memory_equal(first, helio_environment_cube(environment), bytes);
            assert_memory_equal(first_info.flux, info.flux, sizeof info.flux);
            assert_memory_equal(&first_info.auto_exposure, &info.auto_exposure, sizeof info.auto_exposure);
            helio_environment_destroy(environment);
            helio_context_destroy(context);
        }
        free(first);
        free(m.rgb);
    }
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
        cmocka_unit_test(solid_angles_of_texels_fill_the_sphere),
        cmocka_unit_test(solid_angles_equal_their_quadrature),
        cmocka_unit_test(faces_are_oriented_as_in_the_vulkan_table),
        cmocka_unit_test(face_coordinates_and_directions_are_inverse),
        cmocka_unit_test(borders_of_texels_belong_to_a_neighbour),
        cmocka_unit_test(centres_of_texels_are_found_again),
        cmocka_unit_test(texel_indices_stay_in_range),
        cmocka_unit_test(odd_directions_find_some_texel),
        cmocka_unit_test(constant_maps_stay_constant),
        cmocka_unit_test(constant_maps_stay_constant_when_they_shrink_much),
        cmocka_unit_test(flux_of_random_maps_is_kept),
        cmocka_unit_test(flux_of_single_pixels_is_kept_in_latlong_maps),
        cmocka_unit_test(flux_of_small_pixels_on_edges_is_kept),
        cmocka_unit_test(flux_of_single_pixels_is_kept_in_strips),
        cmocka_unit_test(light_of_a_pixel_lands_where_the_pixel_is),
        cmocka_unit_test(smooth_radiance_keeps_its_values),
        cmocka_unit_test(strip_of_the_same_size_is_copied),
        cmocka_unit_test(openexr_strip_is_oriented_as_openexr_says),
        cmocka_unit_test(maps_with_faults_give_the_bits_of_cleaned_ones),
        cmocka_unit_test(texels_equal_plain_sums),
        cmocka_unit_test(orientation_pictures_agree),
        cmocka_unit_test(wavy_lines_agree),
        cmocka_unit_test(stage_pictures_agree),
        cmocka_unit_test(axes_drawn_in_the_latlong_picture_are_ours),
        cmocka_unit_test(axes_drawn_in_the_cube_picture_are_ours),
        cmocka_unit_test(bad_channels_are_counted_once_per_pixel),
        cmocka_unit_test(a_fault_is_counted_wherever_it_is),
        cmocka_unit_test(any_bits_give_a_finite_cube),
        cmocka_unit_test(rotation_turns_light_from_z_to_x),
        cmocka_unit_test(flip_mirrors_x_before_the_rotation),
        cmocka_unit_test(any_rotation_is_undone_by_turning_back),
        cmocka_unit_test(intensity_scales_lookups_alone),
        cmocka_unit_test(bad_orientations_are_refused),
        cmocka_unit_test(filtered_lookup_equals_texels_at_their_centres),
        cmocka_unit_test(filtered_lookup_is_continuous_across_edges_and_corners),
        cmocka_unit_test(filtered_lookup_of_smooth_radiance_is_smooth),
        cmocka_unit_test(auto_exposure_of_even_light_makes_white_four_fifths),
        cmocka_unit_test(auto_exposure_of_a_small_sun_follows_its_flux),
        cmocka_unit_test(info_sums_up_the_cube),
        cmocka_unit_test(updates_start_new_frames),
        cmocka_unit_test(bad_descs_are_refused),
        cmocka_unit_test(a_single_pixel_is_constant_in_every_layout),
        cmocka_unit_test(creation_without_memory_fails_cleanly),
        cmocka_unit_test(updates_and_lookups_take_no_memory),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests_name("environment", tests, make_shared_context, destroy_shared_context);
}
