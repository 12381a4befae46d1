/* SPDX-License-Identifier: MIT
 * Tables: what is stored against exact sums, what is drawn against what is stored, and the same bits on any threads.
 *
 * Maps are strips of six faces as large as the cube's, so that the cube holds the map's own pixels. */
#include "support.h"

#include "core/vector.h"
#include "env/cube.h"
#include "sampling/texel_weight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const helio_weighting weightings[] = {HELIO_WEIGHTING_SOLID_ANGLE, HELIO_WEIGHTING_PAPER};
static const double LEAST_P = 1e-9;

/* ---- maps --------------------------------------------------------------------------------- */

typedef enum map_kind {
    MAP_NOISE = 0, /* independent colours */
    MAP_SMOOTH,    /* a bright side */
    MAP_SUN,       /* a sky of 1 and one texel of 1e6 */
    MAP_BIG_SUN,   /* the same with 1e8 */
    MAP_HOLES,     /* noise with black texels, rows and faces */
    MAP_ONE_TEXEL, /* one lit texel in all */
    MAP_RANGE,     /* from denormal numbers to 1e30 */
    MAP_BLACK,
    MAPS,
    MAP_GREY = MAPS, /* the same everywhere */
} map_kind;

static void fill_texel(map_kind kind, size_t face, size_t row, size_t column, size_t size, uint64_t *state,
                       float rgb[3])
{
    double noise = random_unit(state), colour = random_unit(state), value = 0.1 + noise;
    bool is_sun = face == 2 && row == size / 3 && column == size / 2;
    switch (kind) {
    case MAP_SMOOTH:
        value = 1.2 + sin(3.0 * (double)(row + face) / (double)size + (double)column / (double)size);
        break;
    case MAP_SUN: value = is_sun ? 1e6 : 1; break;
    case MAP_BIG_SUN: value = is_sun ? 1e8 : 1; break;
    case MAP_HOLES: value = face == 1 || face == 4 || row % 3 == 1 || noise < 0.3 ? 0 : noise; break;
    case MAP_ONE_TEXEL: value = is_sun ? 1 : 0; break;
    case MAP_RANGE: value = pow(10, -45 + 75 * noise); break;
    case MAP_BLACK: value = 0; break;
    default: break;
    }
    if (kind == MAP_GREY)
        value = 1, colour = 0.5;
    rgb[0] = (float)(value * colour);
    rgb[1] = (float)value;
    rgb[2] = (float)(value * (1 - colour));
}

/* [6 R][R][3]; the caller frees it. */
static float *make_map(map_kind kind, uint32_t size, uint64_t seed)
{
    float *map = malloc((size_t)CUBE_FACES * size * size * 3 * sizeof *map);
    assert_non_null(map);
    for (size_t i = 0; i < (size_t)CUBE_FACES * size * size; i++)
        fill_texel(kind, i / size / size, i / size % size, i % size, size, &seed, map + i * 3);
    return map;
}

typedef struct fixture {
    helio_context *context;
    helio_environment *environment;
    helio_tables *tables;
    helio_environment_info info;
    float *map;
    uint32_t size;
    helio_weighting weighting;
} fixture;

static fixture make_fixture_in(helio_context *context, map_kind kind, uint32_t size, helio_weighting weighting)
{
    fixture f = {.context = context, .size = size, .weighting = weighting, .map = make_map(kind, size, kind + 1)};
    f.environment = make_environment(context, HELIO_LAYOUT_STRIP, size, 6 * size, size, f.map, &f.info);
    assert_memory_equal(helio_environment_cube(f.environment), f.map, 6 * (size_t)size * size * 3 * sizeof(float));
    assert_ok(helio_tables_create(f.environment, weighting, &f.tables));
    assert_ok(helio_tables_update(f.tables));
    return f;
}

static fixture make_fixture(map_kind kind, uint32_t size, helio_weighting weighting)
{
    return make_fixture_in(make_context(1, NULL), kind, size, weighting);
}

static void destroy_fixture(fixture *f)
{
    helio_tables_destroy(f->tables);
    helio_environment_destroy(f->environment);
    helio_context_destroy(f->context);
    free(f->map);
}

/* ---- exact weights ------------------------------------------------------------------------- */

static const float *texel(const fixture *f, size_t face, size_t row, size_t column)
{
    return f->map + ((face * f->size + row) * f->size + column) * 3;
}

static bool is_lit(const float rgb[3])
{
    return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0;
}

static double exact_luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static double texel_solid_angle(uint32_t size, size_t row, size_t column)
{
    double step = 2.0 / size, u = (double)column * step - 1, v = (double)row * step - 1;
    return cube_solid_angle(u, u + step, v, v + step);
}

static double exact_weight(const fixture *f, size_t face, size_t row, size_t column)
{
    double value = exact_luminance(texel(f, face, row, column));
    return f->weighting == HELIO_WEIGHTING_PAPER ? value : value * texel_solid_angle(f->size, row, column);
}

static double row_weight(const fixture *f, size_t face, size_t row)
{
    double sum = 0;
    for (size_t column = 0; column < f->size; column++)
        sum += exact_weight(f, face, row, column);
    return sum;
}

/* ---- the stored numbers -------------------------------------------------------------------- */

/* Every lit texel, and no black one, has a share of its row, and every row with light a share of its face. */
static void check_reach(const fixture *f)
{
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        helio_table_view view = helio_tables_view(f->tables, face);
        assert_int_equal(view.size, f->size);
        assert_int_equal(view.marginal[0], 0);
        for (size_t row = 0; row < f->size; row++) {
            const uint32_t *sums = view.rows + row * (f->size + 1);
            assert_int_equal(sums[0], 0);
            for (size_t column = 0; column < f->size; column++) {
                bool reachable = sums[column + 1] > sums[column];
                if (sums[column + 1] < sums[column] || reachable != is_lit(texel(f, face, row, column)))
                    fail_msg("R %u, face %u, row %zu, column %zu: %u to %u", f->size, face, row, column, sums[column],
                             sums[column + 1]);
            }
            assert_true(view.marginal[row + 1] >= view.marginal[row]);
            assert_int_equal(view.marginal[row + 1] > view.marginal[row], sums[f->size] > 0);
        }
    }
}

static void every_lit_texel_and_no_black_one_can_be_drawn(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 5, 16, 64};
    for (int i = 0; i < 5 * MAPS * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 2 % MAPS), sizes[i / 2 / MAPS], weightings[i % 2]);
        check_reach(&f);
        destroy_fixture(&f);
    }
    for (int i = 0; i < 2; i++) {
        fixture f = make_fixture(i ? MAP_SUN : MAP_BIG_SUN, 512, weightings[i]);
        check_reach(&f);
        destroy_fixture(&f);
    }
}

/* Stored and exact probabilities differ by no more than rounding to integers may cause. A weight x that is stored as an
 * integer with |stored - x| <= e has, in a sum S of stored weights with errors e_1 ... e_n, a probability off by at
 * most (e + p (e_1 + ... + e_n)) / S. Each rounding has e <= 1 (where 1 is the least weight that is kept), and the
 * single precision of a weight adds 4 roundings of 2^-24. */
static double row_bound(uint32_t size, double p, uint32_t sum)
{
    return (1 + p * size) / sum + 4e-7 * p;
}

static void check_row(const fixture *f, uint32_t face, size_t row)
{
    const uint32_t *sums = helio_tables_view(f->tables, face).rows + row * (f->size + 1);
    double total = row_weight(f, face, row);
    for (size_t column = 0; column < f->size && sums[f->size] > 0; column++) {
        double exact = exact_weight(f, face, row, column) / total;
        double stored = (double)(sums[column + 1] - sums[column]) / sums[f->size];
        if (!(fabs(stored - exact) <= row_bound(f->size, exact, sums[f->size])))
            fail_msg("R %u, face %u, row %zu, column %zu: probability %g in place of %g", f->size, face, row, column,
                     stored, exact);
    }
}

/* The error of a row's sum is R roundings of its own, scaled as the row is, and one more. */
static void check_marginal(const fixture *f, uint32_t face)
{
    helio_table_view view = helio_tables_view(f->tables, face);
    uint32_t size = f->size;
    double total = 0, errors = 0, error[64], scale;
    for (size_t row = 0; row < size; row++)
        total += row_weight(f, face, row);
    scale = total > 0 ? view.marginal[size] / total : 0;
    for (size_t row = 0; row < size; row++) {
        uint32_t sum = view.rows[row * (size + 1) + size];
        error[row] = sum > 0 ? 1 + 2 * size * (row_weight(f, face, row) * scale / sum) : 0;
        errors += error[row];
    }
    for (size_t row = 0; row < size && view.marginal[size] > 0; row++) {
        double exact = row_weight(f, face, row) / total;
        double stored = (double)(view.marginal[row + 1] - view.marginal[row]) / view.marginal[size];
        if (!(fabs(stored - exact) <= (error[row] + exact * errors) / view.marginal[size] + 4e-7 * exact))
            fail_msg("R %u, face %u, row %zu: probability %g in place of %g", size, face, row, stored, exact);
    }
}

static void stored_probabilities_are_exact_but_for_rounding(void **state)
{
    (void)state;
    static const map_kind kinds[] = {MAP_NOISE, MAP_SMOOTH, MAP_SUN, MAP_BIG_SUN, MAP_HOLES, MAP_ONE_TEXEL};
    static const uint32_t sizes[] = {1, 2, 5, 16, 64};
    for (int i = 0; i < 5 * 6 * 2; i++) {
        fixture f = make_fixture(kinds[i / 2 % 6], sizes[i / 2 / 6], weightings[i % 2]);
        for (uint32_t face = 0; face < CUBE_FACES; face++) {
            for (size_t row = 0; row < f.size; row++)
                check_row(&f, face, row);
            check_marginal(&f, face);
        }
        destroy_fixture(&f);
    }
}

/* On a map without extremes the tables are precise, and not merely within the bound that suns call for. */
static void a_map_without_extremes_is_stored_to_six_digits(void **state)
{
    (void)state;
    fixture f = make_fixture(MAP_SMOOTH, 64, HELIO_WEIGHTING_SOLID_ANGLE);
    helio_table_view view = helio_tables_view(f.tables, 3);
    double total = 0;
    for (size_t row = 0; row < 64; row++)
        total += row_weight(&f, 3, row);
    for (size_t row = 0; row < 64; row++)
        for (size_t column = 0; column < 64; column++) {
            const uint32_t *sums = view.rows + row * 65;
            double stored = (double)(view.marginal[row + 1] - view.marginal[row]) / view.marginal[64] *
                            (sums[column + 1] - sums[column]) / sums[64];
            double exact = exact_weight(&f, 3, row, column) / total;
            assert_true(fabs(stored / exact - 1) < 1e-6);
        }
    destroy_fixture(&f);
}

/* ---- flux and whole-map probabilities --------------------------------------------------------- */

static double exact_flux(const fixture *f, size_t face)
{
    double sum = 0;
    for (size_t row = 0; row < f->size; row++)
        for (size_t column = 0; column < f->size; column++)
            sum += exact_luminance(texel(f, face, row, column)) * texel_solid_angle(f->size, row, column);
    return sum;
}

/* R integers of a row or of the marginal use b = 31 - ceil(log2 R) bits, and the largest of them the highest bit, so
 * that rounding changes the sum by at most R / 2^(b - 1) of it, twice; single precision comes on top. Weights are kept
 * in steps of 2^-126 at the least. */
static double flux_tolerance(uint32_t size, double exact)
{
    return (1e-6 + (double)size * size * 0x1p-28) * exact + 0x1p-122;
}

static void flux_is_the_integral_of_luminance(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 5, 16, 64};
    for (int i = 0; i < 5 * MAPS * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 2 % MAPS), sizes[i / 2 / MAPS], weightings[i % 2]);
        double flux[6];
        helio_tables_flux(f.tables, flux);
        for (size_t face = 0; face < CUBE_FACES; face++) {
            double exact = exact_flux(&f, face), tolerance = flux_tolerance(f.size, exact);
            if (!(fabs(flux[face] - exact) <= tolerance))
                fail_msg("R %u, map %d, face %zu: flux %.9g in place of %.9g", f.size, i / 2 % MAPS, face, flux[face],
                         exact);
            if (!(fabs(flux[face] - f.info.flux[face]) <= tolerance + 1e-6 * exact))
                fail_msg("R %u, map %d, face %zu: flux %.9g, but %.9g in the environment's info", f.size, i / 2 % MAPS,
                         face, flux[face], f.info.flux[face]);
        }
        destroy_fixture(&f);
    }
}

/* ---- density --------------------------------------------------------------------------------------- */

static double density_at(const fixture *f, uint32_t face, double u, double v)
{
    float direction[3];
    uint32_t found;
    vec3_to(cube_direction(face, (float)u, (float)v), direction);
    double density = (double)helio_tables_density(f->tables, direction, &found);
    assert_int_equal(found, face);
    assert_true(density == (double)helio_tables_density(f->tables, direction, NULL));
    return density;
}

/* The sum over 3 x 3 points of each texel of density x (1 + u^2 + v^2)^(-3/2) du dv. */
static double integrate_face(const fixture *f, uint32_t face)
{
    uint32_t points = 3 * f->size;
    double sum = 0, step = 2.0 / points;
    for (uint32_t i = 0; i < points; i++)
        for (uint32_t j = 0; j < points; j++) {
            double u = (j + 0.5) * step - 1, v = (i + 0.5) * step - 1;
            sum += density_at(f, face, u, v) * pow(1 + u * u + v * v, -1.5) * step * step;
        }
    return sum;
}

static void densities_integrate_to_one_over_each_face(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 5, 16};
    for (int i = 0; i < 4 * MAPS * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 2 % MAPS), sizes[i / 2 / MAPS], weightings[i % 2]);
        for (uint32_t face = 0; face < CUBE_FACES; face++) {
            double sum = integrate_face(&f, face);
            bool black = helio_tables_view(f.tables, face).marginal[f.size] == 0;
            if (!(fabs(sum - (black ? 0 : 1)) <= (black ? 0 : 3e-6)))
                fail_msg("R %u, map %d, face %u: the density integrates to %.9f", f.size, i / 2 % MAPS, face, sum);
        }
        destroy_fixture(&f);
    }
}

/* Who has the radiance of a texel at hand need not read the tables. */
static void check_weights_of_texels(const fixture *f)
{
    const helio_tables *t = f->tables;
    const texel_weight_kind kind = texel_weight_kind_of(t->weighting != HELIO_WEIGHTING_PAPER, t->level);
    for (uint32_t i = 0; i < CUBE_FACES * f->size * f->size; i++) {
        const face_place at = {i / f->size / f->size, i / f->size % f->size, i % f->size, 0, 0};
        const float solid_angle = f->environment->solid_angle[texel_mirrored(f->size, at.row, at.column)];
        const vec3 radiance = vec3_from(environment_texel(f->environment, at.face, at.row, at.column));
        assert_int_equal(texel_weight_integer(kind, radiance, solid_angle, texel_quarter(f->size), t->level,
                                              t->row_sums[i / f->size].exponent),
                         tables_texel_weight(t, &at));
    }
}

static void weights_of_texels_follow_from_their_radiance(void **state)
{
    (void)state;
    static const helio_weighting all[] = {HELIO_WEIGHTING_SOLID_ANGLE, HELIO_WEIGHTING_PAPER,
                                          HELIO_WEIGHTING_COMPENSATED};
    static const uint32_t sizes[] = {1, 2, 7, 33, 64};
    for (size_t w = 0; w < sizeof all / sizeof *all; w++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
            for (map_kind kind = 0; kind < MAPS; kind++) {
                fixture f = make_fixture(kind, sizes[s], all[w]);
                check_weights_of_texels(&f);
                destroy_fixture(&f);
            }
}

/* pdf(w | f) = I_ij K / (4 I_f) (1 + u^2 + v^2)^(3/2), with I_ij the luminance, or luminance x solid angle. */
static void density_is_equation_1_of_the_paper(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < 4 * 2; i++) {
        fixture f = make_fixture(i / 4 ? MAP_NOISE : MAP_SMOOTH, i / 2 % 2 ? 16 : 5, weightings[i % 2]);
        for (uint32_t face = 0; face < CUBE_FACES; face++) {
            double sum = 0, texels = (double)f.size * f.size;
            for (size_t row = 0; row < f.size; row++)
                sum += row_weight(&f, face, row);
            for (size_t k = 0; k < f.size * f.size * 4; k++) {
                size_t row = k / 4 / f.size, column = k / 4 % f.size;
                double u = 2 * ((double)column + 0.01 + 0.98 * random_unit(&random)) / f.size - 1;
                double v = 2 * ((double)row + 0.01 + 0.98 * random_unit(&random)) / f.size - 1;
                double exact = exact_weight(&f, face, row, column) * texels / (4 * sum) * pow(1 + u * u + v * v, 1.5);
                double density = density_at(&f, face, u, v);
                if (!(fabs(density / exact - 1) < 3e-6))
                    fail_msg("R %u, u %g, v %g: density %.9g in place of %.9g", f.size, u, v, density, exact);
            }
        }
        destroy_fixture(&f);
    }
}

/* ---- drawing --------------------------------------------------------------------------------------- */

/* Numbers of a table row with zeros, ones and giants among them; returns the index of the first and last positive cell.
 */
static void random_sums(uint32_t *sums, uint32_t count, uint64_t *state, uint32_t *first, uint32_t *last)
{
    *first = UINT32_MAX;
    sums[0] = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t kind = random_bits(state) % 4, room = UINT32_MAX / count;
        uint32_t weight = kind == 0 ? 0 : kind == 1 ? 1 : random_bits(state) % (kind == 2 ? 1000 : room);
        if (i + 1 == count && *first == UINT32_MAX)
            weight = 1;
        if (weight > 0 && *first == UINT32_MAX)
            *first = i;
        if (weight > 0)
            *last = i;
        sums[i + 1] = sums[i] + weight;
    }
}

static void inversion_leads_back_to_where_it_came_from(void **state)
{
    (void)state;
    uint64_t random = 2;
    uint32_t sums[65], first, last, fraction;
    for (int trial = 0; trial < 2000; trial++) {
        uint32_t count = trial < 100 ? 1 : 1 + random_bits(&random) % 64;
        random_sums(sums, count, &random, &first, &last);
        assert_int_equal(tables_invert(sums, count, 0, &fraction), first);
        assert_int_equal(fraction, 0);
        assert_int_equal(tables_invert(sums, count, UINT32_MAX, &fraction), last);
        uint32_t x = 0, cell = first, before = 0;
        for (;;) {
            uint32_t next = tables_invert(sums, count, x, &fraction), width = sums[next + 1] - sums[next];
            assert_true(width > 0);
            assert_true(next > cell || (next == cell && fraction >= before));
            /* Exact in units of 2^-32 of an integer weight: the fraction is rounded down. */
            uint64_t there = (uint64_t)x * sums[count],
                     back = ((uint64_t)sums[next] << 32) + (uint64_t)fraction * width;
            assert_true(back <= there && there - back < width);
            cell = next;
            before = fraction;
            uint32_t step = random_bits(&random) >> (4 + random_bits(&random) % 24);
            if (x > UINT32_MAX - step - 1)
                break;
            x += step + 1;
        }
    }
}

/* Where a direction lies inside the texel that it was drawn for, in texels: [0, 1) but for rounding. */
static void place_in_texel(const fixture *f, uint32_t face, const helio_table_sample *sample, double place[2])
{
    const cube_face *c = &cube_faces[face];
    vec3 d = vec3_from(sample->direction);
    double along = (double)dot(d, c->axis);
    place[0] = ((double)dot(d, c->right) / along + 1) / 2 * f->size - sample->column;
    place[1] = ((double)dot(d, c->down) / along + 1) / 2 * f->size - sample->row;
}

static float random_float(uint64_t *state)
{
    return (float)(random_bits(state) >> 8) * 0x1p-24f;
}

/* The fraction of the row and of the column that is below a place, from the stored sums. */
static double below(const uint32_t *sums, uint32_t size, uint32_t index, double place)
{
    return (sums[index] + place * (sums[index + 1] - sums[index])) / sums[size];
}

static void drawn_directions_lead_back_to_their_numbers(void **state)
{
    (void)state;
    uint64_t random = 3;
    static const float ends[] = {0, 0x1.fffffep-1f, 1};
    for (int i = 0; i < (MAPS - 1) * 2 * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 4), i / 2 % 2 ? 16 : 1, weightings[i % 2]);
        for (int k = 0; k < 9 + 500; k++) {
            uint32_t face = random_bits(&random) % CUBE_FACES;
            float u = k < 9 ? ends[k % 3] : random_float(&random), v = k < 9 ? ends[k / 3] : random_float(&random);
            helio_table_sample sample;
            if (!helio_tables_sample(f.tables, face, u, v, &sample))
                continue;
            helio_table_view view = helio_tables_view(f.tables, face);
            double place[2], tolerance = 3e-7 * (f.size + 1);
            place_in_texel(&f, face, &sample, place);
            assert_true(place[0] > -tolerance && place[0] < 1 + tolerance);
            assert_true(place[1] > -tolerance && place[1] < 1 + tolerance);
            const uint32_t *sums = view.rows + sample.row * (f.size + 1);
            assert_true(fabs(below(sums, f.size, sample.column, place[0]) - (double)u) < 2 * tolerance);
            assert_true(fabs(below(view.marginal, f.size, sample.row, place[1]) - (double)v) < 2 * tolerance);
            assert_true(is_lit(texel(&f, face, sample.row, sample.column)));
            assert_memory_equal(sample.radiance, texel(&f, face, sample.row, sample.column), sizeof sample.radiance);
        }
        destroy_fixture(&f);
    }
}

static void a_drawn_direction_has_the_density_it_was_drawn_with(void **state)
{
    (void)state;
    enum { DRAWS = 20000 };
    uint64_t random = 4;
    for (int i = 0; i < (MAPS - 1) * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 2), 16, weightings[i % 2]);
        int drawn = 0, differ = 0;
        for (int k = 0; k < DRAWS; k++) {
            uint32_t face = random_bits(&random) % CUBE_FACES, found;
            helio_table_sample sample;
            if (!helio_tables_sample(f.tables, face, random_float(&random), random_float(&random), &sample))
                continue;
            drawn++;
            assert_true(sample.density > 0 && isfinite(sample.density));
            float density = helio_tables_density(f.tables, sample.direction, &found);
            if (found == face && fabsf(density - sample.density) < 1e-4f * sample.density)
                continue;
            /* Only next to a border of the texel may rounding put the direction into another one. */
            double place[2];
            place_in_texel(&f, face, &sample, place);
            double border = fmin(fmin(place[0], 1 - place[0]), fmin(place[1], 1 - place[1]));
            assert_true(border < 1e-5);
            differ++;
        }
        assert_true(drawn > 0);
        assert_true(differ <= drawn * 1e-3);
        destroy_fixture(&f);
    }
}

/* ---- chi-square ------------------------------------------------------------------------------------ */

static void check_draws_of_face(const fixture *f, uint32_t face, uint64_t *random)
{
    enum { DRAWS = 40000, PARTS = 8 };
    double expected[256], drawn[256] = {0}, places[PARTS * PARTS], even[PARTS * PARTS], total = 0;
    uint32_t size = f->size;
    memset(places, 0, sizeof places);
    for (size_t row = 0; row < size; row++)
        total += row_weight(f, face, row);
    for (size_t i = 0; i < (size_t)size * size; i++)
        expected[i] = exact_weight(f, face, i / size, i % size) / total * DRAWS;
    for (int i = 0; i < PARTS * PARTS; i++)
        even[i] = (double)DRAWS / (PARTS * PARTS);
    for (int k = 0; k < DRAWS; k++) {
        helio_table_sample sample;
        double place[2];
        assert_true(helio_tables_sample(f->tables, face, random_float(random), random_float(random), &sample));
        drawn[sample.row * size + sample.column]++;
        place_in_texel(f, face, &sample, place);
        int x = (int)fmin(fmax(place[0], 0) * PARTS, PARTS - 1), y = (int)fmin(fmax(place[1], 0) * PARTS, PARTS - 1);
        places[y * PARTS + x]++;
    }
    double p = chi_square_tail(drawn, expected, (size_t)size * size, 1);
    if (!(p > LEAST_P))
        fail_msg("R %u, face %u: draws do not follow the texels, p = %g", size, face, p);
    p = chi_square_tail(places, even, PARTS * PARTS, 1);
    if (!(p > LEAST_P))
        fail_msg("R %u, face %u: draws are not even inside of texels, p = %g", size, face, p);
}

static void draws_follow_the_map(void **state)
{
    (void)state;
    static const map_kind kinds[] = {MAP_NOISE, MAP_SMOOTH, MAP_SUN, MAP_HOLES};
    uint64_t random = 5;
    for (int i = 0; i < 4 * 2 * 2; i++) {
        fixture f = make_fixture(kinds[i / 4], i / 2 % 2 ? 16 : 5, weightings[i % 2]);
        check_draws_of_face(&f, 2, &random);
        check_draws_of_face(&f, 5, &random);
        destroy_fixture(&f);
    }
}

/* ---- the whole map ----------------------------------------------------------------------------------- */

static double face_weight(const fixture *f, size_t face)
{
    double sum = 0;
    for (size_t row = 0; row < f->size; row++)
        sum += row_weight(f, face, row);
    return sum;
}

/* By which points divide their samples. A face that is next to black is not lost. */
static void check_worths(const fixture *f)
{
    const float *worth = f->tables->worth, least = 0x1p-60f;
    double flux[6], greatest = 0;
    float most = 0;
    helio_tables_flux(f->tables, flux);
    for (int face = 0; face < 6; face++) {
        greatest = fmax(greatest, flux[face]);
        most = fmaxf(most, worth[face]);
    }
    assert_true(greatest == 0 ? most == 0 : most >= 1 && most <= 2);
    for (int face = 0; face < 6 && greatest > 0; face++) {
        const double expected = flux[face] / greatest * (double)most;
        if (expected < (double)least)
            assert_true(worth[face] == (flux[face] > 0 ? least : 0.0f));
        else
            assert_true(fabs((double)worth[face] / expected - 1) < 1e-6);
    }
}

static void faces_are_worth_their_flux(void **state)
{
    (void)state;
    for (int kind = 0; kind < MAPS; kind++)
        for (int i = 0; i < 2; i++) {
            fixture f = make_fixture((map_kind)kind, 17, i ? HELIO_WEIGHTING_PAPER : HELIO_WEIGHTING_SOLID_ANGLE);
            check_worths(&f);
            destroy_fixture(&f);
        }
}

static void faces_of_the_whole_map_have_their_share(void **state)
{
    (void)state;
    for (int i = 0; i < MAPS * 2 * 2; i++) {
        fixture f = make_fixture((map_kind)(i / 4), i / 2 % 2 ? 16 : 1, weightings[i % 2]);
        double total = 0, sum = 0;
        for (size_t face = 0; face < CUBE_FACES; face++)
            total += face_weight(&f, face);
        for (uint32_t face = 0; face < CUBE_FACES; face++) {
            double share = (double)tables_face_probability(f.tables, face), exact = face_weight(&f, face) / total;
            sum += share;
            assert_int_equal(share > 0, helio_tables_view(f.tables, face).marginal[f.size] > 0);
            assert_true(total == 0 || fabs(share - exact) < 1e-7 + 3e-6 * exact);
        }
        assert_true(fabs(sum - (total > 0 ? 1 : 0)) < 1e-6);
        destroy_fixture(&f);
    }
}

static void draws_of_the_whole_map_follow_it(void **state)
{
    (void)state;
    enum { DRAWS = 40000, SIZE = 5, TEXELS = CUBE_FACES * SIZE * SIZE };
    static const map_kind kinds[] = {MAP_NOISE, MAP_SUN, MAP_HOLES};
    uint64_t random = 6;
    for (int i = 0; i < 3 * 2; i++) {
        fixture f = make_fixture(kinds[i / 2], SIZE, weightings[i % 2]);
        double expected[TEXELS], drawn[TEXELS] = {0}, total = 0;
        for (size_t face = 0; face < CUBE_FACES; face++)
            total += face_weight(&f, face);
        for (size_t k = 0; k < TEXELS; k++)
            expected[k] = exact_weight(&f, k / SIZE / SIZE, k / SIZE % SIZE, k % SIZE) / total * DRAWS;
        int differ = 0;
        for (int k = 0; k < DRAWS; k++) {
            helio_table_sample sample;
            uint32_t face;
            uint32_t x = random_bits(&random);
            assert_true(tables_sample_whole(f.tables, x, random_bits(&random), &sample));
            float density = helio_tables_density(f.tables, sample.direction, &face);
            density *= tables_face_probability(f.tables, face);
            drawn[(face * SIZE + sample.row) * SIZE + sample.column]++;
            differ += !(fabsf(density - sample.density) < 1e-4f * sample.density); /* rounded over a border */
        }
        assert_true(differ < 1e-3 * DRAWS);
        double p = chi_square_tail(drawn, expected, TEXELS, 1);
        if (!(p > LEAST_P))
            fail_msg("map %d: draws of the whole map do not follow it, p = %g", kinds[i / 2], p);
        destroy_fixture(&f);
    }
}

/* ---- threads ------------------------------------------------------------------------------------------- */

static void loop_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    while (count-- > 0)
        body(data, count);
}

static void assert_same_tables(const fixture *a, const fixture *b)
{
    size_t size = a->size;
    assert_memory_equal(a->tables->rows, b->tables->rows, CUBE_FACES * size * (size + 1) * sizeof(uint32_t));
    assert_memory_equal(a->tables->marginals, b->tables->marginals, CUBE_FACES * (size + 1) * sizeof(uint32_t));
    assert_memory_equal(a->tables->faces, b->tables->faces, sizeof a->tables->faces);
    assert_memory_equal(a->tables->face_fluxes, b->tables->face_fluxes, sizeof a->tables->face_fluxes);
}

static void tables_have_the_same_bits_on_any_threads(void **state)
{
    (void)state;
    for (int i = 0; i < (MAPS - 1) * 2; i++) {
        map_kind kind = (map_kind)(i / 2);
        fixture one = make_fixture_in(make_context(1, NULL), kind, 33, weightings[i % 2]);
        fixture two = make_fixture_in(make_context(2, NULL), kind, 33, weightings[i % 2]);
        fixture five = make_fixture_in(make_context(5, NULL), kind, 33, weightings[i % 2]);
        helio_context *context;
        assert_ok(helio_context_create(&(helio_context_desc){.parallel_for = loop_backwards}, &context));
        fixture backwards = make_fixture_in(context, kind, 33, weightings[i % 2]);
        assert_same_tables(&one, &two);
        assert_same_tables(&one, &five);
        assert_same_tables(&one, &backwards);
        assert_ok(helio_tables_update(two.tables));
        assert_same_tables(&one, &two);
        destroy_fixture(&one);
        destroy_fixture(&two);
        destroy_fixture(&five);
        destroy_fixture(&backwards);
    }
}

/* ---- frames, memory, mistakes ---------------------------------------------------------------------------- */

static void a_black_map_cannot_be_drawn_from(void **state)
{
    (void)state;
    fixture f = make_fixture(MAP_BLACK, 5, HELIO_WEIGHTING_SOLID_ANGLE);
    helio_table_sample sample, before;
    double flux[6];
    memset(&sample, 0x5a, sizeof sample);
    before = sample;
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        assert_false(helio_tables_sample(f.tables, face, 0.5f, 0.5f, &sample));
    assert_false(tables_sample_whole(f.tables, 1u << 31, 1u << 31, &sample));
    assert_memory_equal(&sample, &before, sizeof sample);
    helio_tables_flux(f.tables, flux);
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        assert_true(flux[face] == 0 && density_at(&f, face, 0.3, -0.2) == 0);
    destroy_fixture(&f);
}

static void tables_know_their_frame(void **state)
{
    (void)state;
    fixture f = make_fixture(MAP_NOISE, 5, HELIO_WEIGHTING_SOLID_ANGLE);
    helio_tables *late;
    helio_table_sample sample;
    const float up[3] = {0, 1, 0};
    assert_ok(helio_tables_create(f.environment, HELIO_WEIGHTING_PAPER, &late));
    assert_true(helio_tables_frame(late) == 0);
    assert_false(helio_tables_sample(late, 2, 0.5f, 0.5f, &sample));
    assert_true(helio_tables_density(late, up, NULL) == 0.0f);
    assert_true(helio_tables_frame(f.tables) == 1);
    float *sun = make_map(MAP_ONE_TEXEL, 5, 1);
    assert_ok(helio_environment_update(f.environment, sun, NULL));
    assert_true(helio_tables_frame(f.tables) == 1);
    assert_ok(helio_tables_update(f.tables));
    assert_true(helio_tables_frame(f.tables) == 2);
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        assert_int_equal(helio_tables_sample(f.tables, face, 0.9f, 0.1f, &sample), face == 2);
    assert_true(sample.row == 5 / 3 && sample.column == 5 / 2);
    free(sun);
    helio_tables_destroy(late);
    destroy_fixture(&f);
}

static void update_takes_no_memory(void **state)
{
    (void)state;
    memory_count count = {0};
    fixture f = make_fixture_in(make_context(2, &count), MAP_NOISE, 16, HELIO_WEIGHTING_PAPER);
    size_t taken = count.taken;
    for (int i = 0; i < 3; i++) {
        assert_ok(helio_environment_update(f.environment, f.map, NULL));
        assert_ok(helio_tables_update(f.tables));
    }
    assert_int_equal(count.taken, taken);
    destroy_fixture(&f);
    assert_int_equal(count.live, 0);
    assert_false(count.misaligned);
}

static void creation_without_memory_fails_and_leaks_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        memory_count count = {0};
        helio_context *context = make_context(1, &count);
        float *map = make_map(MAP_NOISE, 4, 1);
        helio_environment *environment = make_environment(context, HELIO_LAYOUT_STRIP, 4, 24, 4, map, NULL);
        size_t live = count.live;
        helio_tables *tables = NULL;
        helio_status status = HELIO_ERR_MEMORY;
        int failures = 0;
        for (; status == HELIO_ERR_MEMORY; failures++) {
            count.refuse_after = count.taken + (size_t)failures;
            tables = (helio_tables *)&count;
            status = helio_tables_create(environment, weightings[i], &tables);
            assert_true(status == HELIO_OK || (tables == NULL && count.live == live));
        }
        assert_ok(status);
        assert_true(failures > 4);
        helio_tables_destroy(tables);
        assert_int_equal(count.live, live);
        helio_environment_destroy(environment);
        helio_context_destroy(context);
        free(map);
    }
}

static void assert_refused(helio_status status)
{
    assert_int_equal(status, HELIO_ERR_ARGUMENT);
    assert_true(strlen(helio_last_error()) > 20);
}

static void mistakes_are_refused_with_a_sentence(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    helio_environment *environment;
    helio_tables *tables = (helio_tables *)context;
    const helio_environment_desc desc = {.cube_size = 4, .width = 8, .height = 4};
    assert_ok(helio_environment_create(context, &desc, &environment));
    assert_refused(helio_tables_create(NULL, HELIO_WEIGHTING_PAPER, &tables));
    assert_refused(helio_tables_create(environment, HELIO_WEIGHTING_PAPER, NULL));
    assert_refused(helio_tables_create(environment, (helio_weighting)3, &tables));
    assert_null(tables);
    assert_refused(helio_tables_update(NULL));
    assert_ok(helio_tables_create(environment, HELIO_WEIGHTING_PAPER, &tables));
    assert_refused(helio_tables_update(tables)); /* no map yet */
    assert_true(helio_tables_frame(tables) == 0);
    helio_table_sample sample;
    assert_false(helio_tables_sample(tables, 6, 0.5f, 0.5f, &sample));
    helio_tables_destroy(tables);
    helio_tables_destroy(NULL);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

/* ---- MIS compensation ---------------------------------------------------------------------- */

static double mean_luminance(const fixture *f)
{
    double flux[6], sum = 0;
    helio_tables_flux(f->tables, flux);
    for (int face = 0; face < 6; face++)
        sum += flux[face];
    return sum / (4 * PI);
}

/* Each texel's share of its row is that of what it has above the mean; the flux is still that of all light. */
static void compensated_tables_hold_what_is_above_the_mean(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {2, 5, 16, 64};
    for (int i = 0; i < 4; i++) {
        fixture f = make_fixture(MAP_NOISE, sizes[i], HELIO_WEIGHTING_COMPENSATED);
        fixture plain = make_fixture(MAP_NOISE, sizes[i], HELIO_WEIGHTING_SOLID_ANGLE);
        const double mean = mean_luminance(&plain);
        assert_true(fabs(mean_luminance(&f) / mean - 1) < 1e-9);
        uint32_t above = 0, below = 0;
        for (uint32_t face = 0; face < 6; face++) {
            helio_table_view view = helio_tables_view(f.tables, face);
            for (uint32_t row = 0; row < f.size; row++) {
                const uint32_t *sums = view.rows + row * (f.size + 1);
                double expected = 0;
                for (uint32_t column = 0; column < f.size; column++)
                    expected += fmax(0, exact_luminance(texel(&f, face, row, column)) - mean) *
                                texel_solid_angle(f.size, row, column);
                for (uint32_t column = 0; column < f.size; column++) {
                    double over = exact_luminance(texel(&f, face, row, column)) - mean;
                    bool is_drawn = sums[column + 1] > sums[column];
                    if (fabs(over) > 1e-3 * mean) /* else the level's own rounding decides */
                        assert_int_equal(is_drawn, over > 0);
                    above += is_drawn;
                    below += !is_drawn;
                    if (is_drawn)
                        assert_true(fabs((sums[column + 1] - sums[column]) / (double)sums[f.size] -
                                         over * texel_solid_angle(f.size, row, column) / expected) < 1e-3);
                }
            }
        }
        assert_true(above > 0 && below > 0);
        destroy_fixture(&plain);
        destroy_fixture(&f);
    }
}

static void compensated_tables_of_even_light_are_empty(void **state)
{
    (void)state;
    fixture f = make_fixture(MAP_GREY, 16, HELIO_WEIGHTING_COMPENSATED);
    helio_table_sample sample;
    for (uint32_t face = 0; face < 6; face++)
        assert_false(helio_tables_sample(f.tables, face, 0.3f, 0.6f, &sample));
    assert_true(mean_luminance(&f) > 0);
    destroy_fixture(&f);
}

static void weightings_have_names(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        helio_weighting weighting = (helio_weighting)7;
        assert_ok(helio_weighting_parse(helio_weighting_name((helio_weighting)i), &weighting));
        assert_int_equal(weighting, i);
    }
    assert_string_equal(helio_weighting_name(HELIO_WEIGHTING_PAPER), "paper");
    assert_string_equal(helio_weighting_name(HELIO_WEIGHTING_COMPENSATED), "compensated");
    helio_weighting kept = HELIO_WEIGHTING_PAPER;
    assert_refused(helio_weighting_parse("Paper", &kept));
    assert_non_null(strstr(helio_last_error(), "Paper"));
    assert_refused(helio_weighting_parse(NULL, &kept));
    assert_refused(helio_weighting_parse("paper", NULL));
    assert_int_equal(kept, HELIO_WEIGHTING_PAPER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lit_texel_and_no_black_one_can_be_drawn),
        cmocka_unit_test(stored_probabilities_are_exact_but_for_rounding),
        cmocka_unit_test(a_map_without_extremes_is_stored_to_six_digits),
        cmocka_unit_test(flux_is_the_integral_of_luminance),
        cmocka_unit_test(densities_integrate_to_one_over_each_face),
        cmocka_unit_test(weights_of_texels_follow_from_their_radiance),
        cmocka_unit_test(density_is_equation_1_of_the_paper),
        cmocka_unit_test(inversion_leads_back_to_where_it_came_from),
        cmocka_unit_test(drawn_directions_lead_back_to_their_numbers),
        cmocka_unit_test(a_drawn_direction_has_the_density_it_was_drawn_with),
        cmocka_unit_test(draws_follow_the_map),
        cmocka_unit_test(faces_are_worth_their_flux),
        cmocka_unit_test(faces_of_the_whole_map_have_their_share),
        cmocka_unit_test(draws_of_the_whole_map_follow_it),
        cmocka_unit_test(tables_have_the_same_bits_on_any_threads),
        cmocka_unit_test(a_black_map_cannot_be_drawn_from),
        cmocka_unit_test(tables_know_their_frame),
        cmocka_unit_test(update_takes_no_memory),
        cmocka_unit_test(creation_without_memory_fails_and_leaks_nothing),
        cmocka_unit_test(mistakes_are_refused_with_a_sentence),
        cmocka_unit_test(compensated_tables_hold_what_is_above_the_mean),
        cmocka_unit_test(compensated_tables_of_even_light_are_empty),
        cmocka_unit_test(weightings_have_names),
    };
    return cmocka_run_group_tests_name("tables", tests, NULL, NULL);
}
