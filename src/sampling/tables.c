/* SPDX-License-Identifier: MIT
 *
 * Fixed-point tables. Each row is scaled by a power of two that depends only on its largest weight, rounded to integers
 * (at least 1 for a texel that is not black) and summed; the sums of the rows are scaled likewise into the marginal.
 * Scaling by a power of two is exact and integer sums do not depend on their order, so equal cubes give equal bits
 * everywhere. */
#include "sampling/tables.h"

#include "core/context.h"
#include "core/error.h"
#include "core/name_list.h"
#include "core/random.h"
#include "sampling/kernels.h"
#include "sampling/rules.h"

#include <float.h>

enum { ROWS_AT_ONCE = 16 }; /* the piece of work of a thread */

/* ---- creation ---- */

static const char *const NAMES[] = {"solid-angle", "paper", "compensated"};
static const name_list WEIGHTINGS = NAME_LIST("weighting", NAMES);

const char *helio_weighting_name(helio_weighting weighting)
{
    return name_list_get(&WEIGHTINGS, (int)weighting);
}

helio_status helio_weighting_parse(const char *name, helio_weighting *weighting)
{
    int value;
    HELIO_TRY(name_list_find(&WEIGHTINGS, weighting ? name : NULL, &value));
    *weighting = (helio_weighting)value;
    return HELIO_OK;
}

helio_status helio_tables_create(helio_environment *environment, helio_weighting weighting, helio_tables **out)
{
    if (out != NULL)
        *out = NULL;
    if (environment == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_tables_create needs an environment and a place for the result");
    HELIO_TRY(name_list_check(&WEIGHTINGS, (int)weighting));
    helio_context *context = environment->context;
    helio_tables *tables = context_allocate(context, 1, sizeof *tables);
    if (tables == NULL)
        return HELIO_ERR_MEMORY;
    size_t size = environment->size;
    tables->environment = environment;
    tables->weighting = weighting;
    tables->size = environment->size;
    tables->rows = context_allocate(context, CUBE_FACES * size * (size + 1), sizeof *tables->rows);
    tables->marginals = context_allocate(context, CUBE_FACES * (size + 1), sizeof *tables->marginals);
    tables->row_densities = context_allocate(context, CUBE_FACES * size, sizeof *tables->row_densities);
    tables->row_sums = context_allocate(context, CUBE_FACES * size, sizeof *tables->row_sums);
    tables->row_fluxes = tables->row_sums;
    if (weighting != HELIO_WEIGHTING_SOLID_ANGLE)
        tables->row_fluxes = context_allocate(context, CUBE_FACES * size, sizeof *tables->row_fluxes);
    if (!tables->rows || !tables->marginals || !tables->row_densities || !tables->row_sums || !tables->row_fluxes) {
        helio_tables_destroy(tables);
        return HELIO_ERR_MEMORY;
    }
    *out = tables;
    return HELIO_OK;
}

void helio_tables_destroy(helio_tables *tables)
{
    if (tables == NULL)
        return;
    helio_context *context = tables->environment->context;
    if (tables->row_fluxes != tables->row_sums)
        context_release(context, tables->row_fluxes);
    context_release(context, tables->row_sums);
    context_release(context, tables->row_densities);
    context_release(context, tables->marginals);
    context_release(context, tables->rows);
    context_release(context, tables);
}

/* ---- update ---- */

static const float *texels_of(const helio_tables *tables, size_t index)
{
    return tables->environment->cube + index * tables->size * 3;
}

static const float *solid_angles_of(const helio_tables *tables, size_t index)
{
    return tables->environment->solid_angle + index % tables->size * tables->size;
}

static void build_row(helio_tables *tables, size_t index)
{
    const bool is_paper = tables->weighting == HELIO_WEIGHTING_PAPER;
    const float *solid_angles = is_paper ? NULL : solid_angles_of(tables, index);
    tables->row_sums[index] = kernels_of(context_isa(tables->environment->context))
                                  ->sum_row(texels_of(tables, index), solid_angles, tables->level, tables->size,
                                            tables->rows + index * ((size_t)tables->size + 1));
}

/* Where the weights are not the flux. */
static void sum_flux_of_row(helio_tables *tables, size_t index)
{
    tables->row_fluxes[index] =
        kernels_of(context_isa(tables->environment->context))
            ->sum_row(texels_of(tables, index), solid_angles_of(tables, index), 0.0f, tables->size, NULL);
}

typedef struct row_work {
    helio_tables *tables;
    void (*build)(helio_tables *tables, size_t index);
} row_work;

static void build_rows(void *data, size_t piece)
{
    const row_work *work = data;
    size_t rows = CUBE_FACES * (size_t)work->tables->size, end = (piece + 1) * ROWS_AT_ONCE;
    for (size_t index = piece * ROWS_AT_ONCE; index < end && index < rows; index++)
        work->build(work->tables, index);
}

static void for_all_rows(helio_tables *tables, void (*build)(helio_tables *tables, size_t index))
{
    row_work work = {tables, build};
    size_t rows = CUBE_FACES * (size_t)tables->size;
    context_parallel_for(tables->environment->context, (rows + ROWS_AT_ONCE - 1) / ROWS_AT_ONCE, build_rows, &work);
}

/* Position of the highest bit of sum x 2^-exponent; the sum must not be 0. */
static int top_bit(row_sum row)
{
    return 31 - __builtin_clz(row.sum) - row.exponent;
}

/* The common exponent for which the largest of the sums is below 2^bits. */
static int common_exponent(const row_sum *rows, uint32_t count, int bits)
{
    int highest = INT32_MIN;
    for (uint32_t i = 0; i < count; i++)
        if (rows[i].sum != 0 && top_bit(rows[i]) > highest)
            highest = top_bit(rows[i]);
    return highest == INT32_MIN ? 0 : bits - 1 - highest;
}

/* sum x 2^-exponent x 2^to, rounded to the nearest integer, at least 1 unless the sum is 0. */
static uint32_t rescale(row_sum row, int to)
{
    int shift = row.exponent - to; /* to the right */
    if (row.sum == 0)
        return 0;
    if (shift <= 0)
        return row.sum << -shift;
    if (shift > 32)
        return 1;
    uint64_t rounded = ((uint64_t)row.sum + ((uint64_t)1 << (shift - 1))) >> shift;
    return rounded > 1 ? (uint32_t)rounded : 1;
}

row_sum tables_sum_rows(const row_sum *rows, uint32_t count, uint32_t *sums)
{
    int exponent = common_exponent(rows, count, tables_summand_bits(count));
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (sums)
            sums[i] = sum;
        sum += rescale(rows[i], exponent);
    }
    if (sums)
        sums[count] = sum;
    return (row_sum){sum, exponent};
}

/* Probability of each row, shared out among the units of weight in it, per area of the face's square. */
static void find_row_densities(helio_tables *tables, size_t face)
{
    size_t size = tables->size;
    const uint32_t *marginal = tables->marginals + face * (size + 1);
    float quarter_texels = 0.25f * ((float)size * (float)size);
    for (size_t row = 0; row < size; row++) {
        float probability = (float)(marginal[row + 1] - marginal[row]) / (float)marginal[size];
        uint32_t sum = tables->row_sums[face * size + row].sum;
        tables->row_densities[face * size + row] = sum != 0 ? probability / (float)sum * quarter_texels : 0.0f;
    }
}

/* sum x 2^-exponent x factor x 2^to. Of the sum 24 bits, so that it need not be rounded. */
static float scale_sum(row_sum row, float factor, int to)
{
    const int cut = row.sum >> 24 != 0 ? 8 - __builtin_clz(row.sum) : 0;
    return ldexpf((float)(int32_t)(row.sum >> cut) * factor, cut - row.exponent + to);
}

static void find_fluxes(helio_tables *tables)
{
    const size_t size = tables->size;
    for (size_t face = 0; face < CUBE_FACES; face++)
        tables->face_fluxes[face] = tables_sum_rows(tables->row_fluxes + face * size, tables->size, NULL);
}

/* A little more, so that rounding leaves nothing of a constant map; 0 where it is so little that machines may take it
 * for that. */
static float mean_luminance(const helio_tables *tables)
{
    const float part = (float)((1.0 + 0x1p-14) / PI), size = (float)tables->size;
    const row_sum flux = tables_sum_rows(tables->face_fluxes, CUBE_FACES, NULL);
    const float mean = scale_sum(flux, part / (size * size), 0);
    return mean >= FLT_MIN ? mean : 0.0f;
}

/* In floats, whatever the fluxes are, as only their ratios matter. */
static void find_worths(helio_tables *tables)
{
    const row_sum *sums = tables->weighting == HELIO_WEIGHTING_PAPER ? tables->face_fluxes : tables->face_sums;
    const int to = common_exponent(sums, CUBE_FACES, 1);
    for (size_t face = 0; face < CUBE_FACES; face++) {
        const bool is_dark = sums[face].sum == 0 || top_bit(sums[face]) + to < -RULE_FACE_BITS;
        const float least = sums[face].sum != 0 ? ldexpf(1.0f, -RULE_FACE_BITS) : 0.0f;
        tables->worth[face] = is_dark ? least : scale_sum(sums[face], 1.0f, to);
    }
}

static void build_face(void *data, size_t face)
{
    helio_tables *tables = data;
    const size_t size = tables->size;
    row_sum weight =
        tables_sum_rows(tables->row_sums + face * size, tables->size, tables->marginals + face * (size + 1));
    find_row_densities(tables, face);
    tables->face_sums[face] = weight;
    if (tables->weighting == HELIO_WEIGHTING_SOLID_ANGLE)
        tables->face_fluxes[face] = weight;
}

helio_status helio_tables_update(helio_tables *tables)
{
    if (tables == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_tables_update needs tables");
    if (tables->environment->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "the environment holds no map yet; call helio_environment_update first");
    environment_settle(tables->environment);
    if (tables->weighting != HELIO_WEIGHTING_SOLID_ANGLE) {
        for_all_rows(tables, sum_flux_of_row);
        find_fluxes(tables);
    }
    if (tables->weighting == HELIO_WEIGHTING_COMPENSATED)
        tables->level = mean_luminance(tables);
    for_all_rows(tables, build_row);
    context_parallel_for(tables->environment->context, CUBE_FACES, build_face, tables);
    tables_sum_rows(tables->face_sums, CUBE_FACES, tables->faces);
    find_worths(tables);
    tables->frame = tables->environment->frame;
    return HELIO_OK;
}

/* ---- drawing and density ---- */

uint32_t tables_invert(const uint32_t *sums, uint32_t count, uint32_t x, uint32_t *fraction)
{
    uint32_t whole = (uint32_t)(((uint64_t)x * sums[count]) >> 32), low = 0, high = count;
    while (high - low > 1) { /* sums[low] <= whole < sums[high] */
        uint32_t middle = low + (high - low) / 2;
        if (sums[middle] <= whole)
            low = middle;
        else
            high = middle;
    }
    *fraction = tables_fraction_within(sums, count, low, x);
    return low;
}

/* probability: of the face. */
static bool sample_face(const helio_tables *tables, uint32_t face, float probability, uint32_t x, uint32_t y,
                        helio_table_sample *sample)
{
    face_table table = tables_face(tables, face);
    uint32_t size = table.size, row_fraction, column_fraction;
    if (table.marginal[size] == 0)
        return false;
    uint32_t row = tables_invert(table.marginal, size, y, &row_fraction);
    uint32_t column = tables_invert(table.rows + (size_t)row * (size + 1), size, x, &column_fraction);
    face_place at = tables_place(size, face, row, row_fraction, column, column_fraction);
    tables_sample_at(tables, &at,
                     face_place_density(at.u, at.v, tables_texel_weight(tables, &at),
                                        tables_unit_density(tables, &at) * probability),
                     sample);
    return true;
}

bool tables_sample(const helio_tables *tables, uint32_t face, uint32_t x, uint32_t y, helio_table_sample *sample)
{
    return sample_face(tables, face, 1.0f, x, y, sample);
}

bool tables_sample_whole(const helio_tables *tables, uint32_t x, uint32_t y, helio_table_sample *sample)
{
    if (tables->faces[CUBE_FACES] == 0)
        return false;
    uint32_t rest, face = tables_invert(tables->faces, CUBE_FACES, y, &rest);
    return sample_face(tables, face, tables_face_probability(tables, face), x, rest, sample);
}

static uint32_t fraction_from_unit(float x)
{
    return x > 0.0f ? (x < 1.0f ? (uint32_t)((double)x * 0x1p32) : UINT32_MAX) : 0u;
}

bool helio_tables_sample(const helio_tables *tables, uint32_t face, float u, float v, helio_table_sample *sample)
{
    return face < CUBE_FACES && tables_sample(tables, face, fraction_from_unit(u), fraction_from_unit(v), sample);
}

float helio_tables_density(const helio_tables *tables, const float direction[3], uint32_t *face)
{
    cube_position meeting = cube_project(vec3_from(direction));
    const uint32_t row = cube_texel(meeting.v, tables->size), column = cube_texel(meeting.u, tables->size);
    const face_place at = {meeting.face, row, column, meeting.u, meeting.v};
    if (face != NULL)
        *face = at.face;
    return face_place_density(at.u, at.v, tables_texel_weight(tables, &at), tables_unit_density(tables, &at));
}

uint64_t helio_tables_frame(const helio_tables *tables)
{
    return tables->frame;
}

void helio_tables_flux(const helio_tables *tables, double flux[6])
{
    for (int face = 0; face < CUBE_FACES; face++)
        flux[face] = tables_flux(tables->size, tables->face_fluxes[face]);
}

helio_table_view helio_tables_view(const helio_tables *tables, uint32_t face)
{
    face_table table = tables_face(tables, face < CUBE_FACES ? face : 0);
    return (helio_table_view){.size = table.size, .rows = table.rows, .marginal = table.marginal};
}
