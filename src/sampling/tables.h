/* SPDX-License-Identifier: MIT
 * tables.h - the tables from inside, and the one density function of the project. */
#ifndef HELIOSTAT_SRC_TABLES_H
#define HELIOSTAT_SRC_TABLES_H

#include "core/random.h"
#include "env/environment.h"

#include <heliostat/sampling.h>

/* The weight of a row before it is scaled into the marginal: sum x 2^-exponent, exactly. */
typedef struct row_sum {
    uint32_t sum;
    int32_t exponent;
} row_sum;

/* A row of the table holds R integers below 2^bits; their sum, rounding included, stays below 2^32. */
static inline int tables_summand_bits(uint32_t count)
{
    int bits = 31;
    for (uint32_t power = 1; power < count; power *= 2)
        bits--;
    return bits;
}

struct helio_tables {
    const helio_environment *environment;
    helio_weighting weighting;
    uint32_t size;
    uint64_t frame;
    uint32_t *rows;       /* [6][R][R + 1], see helio_table_view */
    uint32_t *marginals;  /* [6][R + 1] */
    float *row_densities; /* [6][R]: what a unit of weight in this row adds to the density, see tables_unit_density() */
    row_sum *row_sums;    /* [6][R]: of the table's weights */
    row_sum *row_fluxes;  /* [6][R]: of luminance x solid angle; the same array for SOLID_ANGLE */
    row_sum face_sums[6]; /* of the marginals */
    row_sum face_fluxes[6]; /* of row_fluxes */
    uint32_t faces[7];      /* prefix sums over the faces: how the strategy LIGHT divides the whole map */
    float worth[6];         /* what a point divides its samples among the faces by, in proportion: the flux, but for
                               COMPENSATED that of what is above the level. 1 to 2 for the greatest; 2^-60 or more unless
                               there is no light */
    float level;            /* luminance that does not count, for COMPENSATED; else 0 */
};

/* One face of the tables. */
typedef struct face_table {
    uint32_t size;
    const uint32_t *rows, *marginal;
} face_table;

static inline face_table tables_face(const helio_tables *tables, uint32_t face)
{
    size_t size = tables->size;
    return (face_table){tables->size, tables->rows + face * size * (size + 1), tables->marginals + face * (size + 1)};
}

/* A place in a texel. */
typedef struct face_place {
    uint32_t face, row, column;
    float u, v; /* of the place, not of the texel's centre */
} face_place;

/* The integer that a texel has in its row. */
static inline uint32_t tables_texel_weight(const helio_tables *tables, const face_place *at)
{
    const size_t row = (size_t)at->face * tables->size + at->row;
    const uint32_t *sums = tables->rows + row * (tables->size + 1) + at->column;
    return sums[1] - sums[0];
}

/* Density, 1/sr, of a place, from the integer of its texel and what a unit of it adds to the density per area of the
 * face's square. Drawing and MIS both use this. */
static inline float face_place_density(float u, float v, uint32_t weight, float unit)
{
    const float radius2 = 1.0f + u * u + v * v;
    return (float)(int32_t)weight * unit * (radius2 * sqrtf(radius2));
}

/* For the density given the face, Eq. 1 of the paper's supplement,
 *   pdf(w | f) = I_ij / I_f x K / 4 x (1 + u^2 + v^2)^(3/2),
 * where I_ij / I_f is the product of the probabilities of the row and of the column in it: what depends on the row
 * alone, worked out once a frame. */
static inline float tables_unit_density(const helio_tables *tables, const face_place *at)
{
    return tables->row_densities[(size_t)at->face * tables->size + at->row];
}

/* Probability that LIGHT gives to a face. */
static inline float tables_face_probability(const helio_tables *tables, uint32_t face)
{
    return tables->faces[6] ? (float)(tables->faces[face + 1] - tables->faces[face]) / (float)tables->faces[6] : 0.0f;
}

/* Prefix sums over sums of rows, all scaled by the same power of two. sums: [count + 1], or NULL if only the total is
 * wanted. */
row_sum tables_sum_rows(const row_sum *rows, uint32_t count, uint32_t *sums);

/* The flux, radiance unit x sr, of which a sum of the texels' luminance x solid angle / (4 / K sr) tells. */
static inline double tables_flux(uint32_t size, row_sum sum)
{
    return ldexp((double)sum.sum, -sum.exponent) * 4.0 / ((double)size * (double)size);
}

/* Where x, a fraction of 2^32 that falls into a cell of prefix sums [count + 1], lies inside of that cell: a fraction
 * of 2^32 again. The sums may be a piece of longer ones, which does not begin with 0. All in integers. */
static inline uint32_t tables_fraction_within(const uint32_t *sums, uint32_t count, uint32_t cell, uint32_t x)
{
    uint64_t target = (uint64_t)x * (sums[count] - sums[0]); /* in units of 2^-32 */
    return (uint32_t)((target - ((uint64_t)(sums[cell] - sums[0]) << 32)) / (sums[cell + 1] - sums[cell]));
}

/* Inverts prefix sums [count + 1] at x, a fraction of 2^32: the cell that holds it. The total must not be 0. fraction
 * receives where x lies inside of the cell. */
uint32_t tables_invert(const uint32_t *sums, uint32_t count, uint32_t x, uint32_t *fraction);

/* At fractions of 2^32 of the texel's height and width. */
static inline face_place tables_place(uint32_t size, uint32_t face, uint32_t row, uint32_t row_fraction,
                                      uint32_t column, uint32_t column_fraction)
{
    float u = ((float)(int32_t)(2 * column) + 2.0f * unit_float(column_fraction)) / (float)(int32_t)size - 1.0f;
    float v = ((float)(int32_t)(2 * row) + 2.0f * unit_float(row_fraction)) / (float)(int32_t)size - 1.0f;
    return (face_place){face, row, column, u, v};
}

/* The sample at a place, drawn with some density. */
static inline void tables_sample_at(const helio_tables *tables, const face_place *at, float density,
                                    helio_table_sample *sample)
{
    vec3_to(cube_direction(at->face, at->u, at->v), sample->direction);
    const float *rgb = environment_texel(tables->environment, at->face, at->row, at->column);
    for (int c = 0; c < 3; c++)
        sample->radiance[c] = rgb[c];
    sample->density = density;
    sample->row = at->row;
    sample->column = at->column;
}

/* helio_tables_sample() at a point given as fractions of 2^32. */
bool tables_sample(const helio_tables *tables, uint32_t face, uint32_t x, uint32_t y, helio_table_sample *sample);

/* Draws from all faces as one map: y picks face and row, x the column. false if the map is black. */
bool tables_sample_whole(const helio_tables *tables, uint32_t x, uint32_t y, helio_table_sample *sample);

#endif
