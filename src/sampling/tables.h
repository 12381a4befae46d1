/* SPDX-License-Identifier: MIT
 * tables.h - the tables from inside, and the one density function of the project. */
#ifndef HELIOSTAT_SRC_TABLES_H
#define HELIOSTAT_SRC_TABLES_H

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
    uint32_t *rows;      /* [6][R][R + 1], see helio_table_view */
    uint32_t *marginals; /* [6][R + 1] */
    row_sum *row_sums;   /* [6][R]: of the table's weights */
    row_sum *row_fluxes; /* [6][R]: of luminance x solid angle; the same array unless the weighting is the paper's */
    uint32_t faces[7];   /* prefix sums over the faces: how the strategy LIGHT divides the whole map */
    double flux[6];      /* radiance unit x sr */
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

/* Density, 1/sr, of a direction given its face, from the stored integers: Eq. 1 of the paper's supplement,
 *   pdf(w | f) = I_ij / I_f x K / 4 x (1 + u^2 + v^2)^(3/2),
 * where I_ij / I_f is the product of the probabilities of the row and of the column in it. Drawing and MIS both use
 * this. */
static inline float face_table_density(const face_table *table, uint32_t row, uint32_t column, float u, float v)
{
    uint32_t size = table->size;
    const uint32_t *sums = table->rows + (size_t)row * (size + 1);
    uint32_t row_weight = table->marginal[row + 1] - table->marginal[row];
    if (row_weight == 0)
        return 0.0f;
    float row_probability = (float)row_weight / (float)table->marginal[size];
    float column_probability = (float)(sums[column + 1] - sums[column]) / (float)sums[size];
    float radius2 = 1.0f + u * u + v * v;
    float texels = (float)size * (float)size;
    return row_probability * column_probability * (0.25f * texels) * (radius2 * sqrtf(radius2));
}

/* Probability that LIGHT gives to a face. */
static inline float tables_face_probability(const helio_tables *tables, uint32_t face)
{
    return tables->faces[6] ? (float)(tables->faces[face + 1] - tables->faces[face]) / (float)tables->faces[6] : 0.0f;
}

/* Inverts prefix sums [count + 1] at x, a fraction of 2^32. fraction receives where x lies inside of the cell found, as
 * a fraction of 2^32 again. All in integers. The total must not be 0. */
uint32_t tables_invert(const uint32_t *sums, uint32_t count, uint32_t x, uint32_t *fraction);

/* helio_tables_sample() at a point given as fractions of 2^32. */
bool tables_sample(const helio_tables *tables, uint32_t face, uint32_t x, uint32_t y, helio_table_sample *sample);

/* Draws from all faces as one map: y picks face and row, x the column. false if the map is black. */
bool tables_sample_whole(const helio_tables *tables, uint32_t x, uint32_t y, helio_table_sample *sample);

#endif
