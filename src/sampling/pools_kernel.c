/* SPDX-License-Identifier: MIT
 *
 * Samples of a pool: scrambled points, and the inversion of the tables at them. Several searches go on at once, one
 * step of each after the other, so that they wait for memory together. */
#include "core/random.h"
#include "sampling/kernels.h"

#include <float.h>

enum { GROUP = 32 }; /* samples drawn together */

/* Searches that go on together. fraction is that of tables_invert(): in x, out where x lies inside of the cell. */
typedef struct search_group {
    uint32_t fraction[GROUP];
    const uint32_t *sums[GROUP]; /* [length + 1] each */
    uint32_t cell[GROUP];
} search_group;

/* tables_invert() for each: as many steps for all, without branches. */
static void invert_group(search_group *group, uint32_t count, uint32_t length)
{
    uint32_t whole[GROUP], highest = 1;
    for (uint32_t i = 0; i < count; i++) {
        whole[i] = (uint32_t)(((uint64_t)group->fraction[i] * group->sums[i][length]) >> 32);
        group->cell[i] = 0;
    }
    while (highest < length)
        highest *= 2;
    for (uint32_t step = highest / 2; step > 0; step /= 2)
        for (uint32_t i = 0; i < count; i++) {
            uint32_t next = group->cell[i] + step;
            next = next < length ? next : length; /* where the sum is above whole */
            uint32_t is_below = group->sums[i][next] <= whole[i];
            group->cell[i] += step & (0u - is_below); /* a branch would be guessed wrong half of the time */
        }
    for (uint32_t i = 0; i < count; i++)
        group->fraction[i] = tables_fraction_within(group->sums[i], length, group->cell[i], group->fraction[i]);
}

/* The face of each sample: the pool's, or for the whole map by the sums over faces, which leaves the row's fraction. */
static void choose_faces(const helio_pools *pools, uint32_t pool, uint32_t count, uint32_t *fractions, uint32_t *faces)
{
    bool whole = pools->parts.light == STRATEGY_LIGHT_WHOLE;
    for (uint32_t i = 0; i < count; i++)
        faces[i] = whole ? tables_invert(pools->tables->faces, CUBE_FACES, fractions[i], &fractions[i]) : pool;
}

/* Finite, so that times 0 it is 0. */
static float weighted(float radiance, float density)
{
    float ratio = radiance / density;
    return ratio < FLT_MAX ? ratio : FLT_MAX;
}

static void store_sample(helio_pools *pools, uint32_t pool, uint32_t index, const helio_table_sample *sample)
{
    float *to = pools_array(pools, pool, SAMPLE_X) + index;
    to[SAMPLE_X * pools->stride] = sample->direction[0];
    to[SAMPLE_Y * pools->stride] = sample->direction[1];
    to[SAMPLE_Z * pools->stride] = sample->direction[2];
    to[SAMPLE_RED * pools->stride] = sample->radiance[0];
    to[SAMPLE_GREEN * pools->stride] = sample->radiance[1];
    to[SAMPLE_BLUE * pools->stride] = sample->radiance[2];
    to[SAMPLE_DENSITY * pools->stride] = sample->density;
    to[SAMPLE_WEIGHTED_RED * pools->stride] = weighted(sample->radiance[0], sample->density);
    to[SAMPLE_WEIGHTED_GREEN * pools->stride] = weighted(sample->radiance[1], sample->density);
    to[SAMPLE_WEIGHTED_BLUE * pools->stride] = weighted(sample->radiance[2], sample->density);
}

static void draw_group(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed)
{
    const helio_tables *tables = pools->tables;
    const uint32_t size = tables->size, seed_x = dimension_seed(seed, 0), seed_y = dimension_seed(seed, 1);
    search_group rows, columns;
    uint32_t faces[GROUP];
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        columns.fraction[i] = owen_scramble_reversed(first + i, seed_x);
        rows.fraction[i] = owen_scramble_reversed(pascal_transform(first + i), seed_y);
    }
    choose_faces(pools, pool, count, rows.fraction, faces);
    for (uint32_t i = 0; i < count; i++)
        rows.sums[i] = tables_face(tables, faces[i]).marginal;
    invert_group(&rows, count, size);
    for (uint32_t i = 0; i < count; i++)
        columns.sums[i] = tables_face(tables, faces[i]).rows + (size_t)rows.cell[i] * (size + 1);
    invert_group(&columns, count, size);
    for (uint32_t i = 0; i < count; i++)
        __builtin_prefetch(environment_texel(tables->environment, faces[i], rows.cell[i], columns.cell[i]));
    for (uint32_t i = 0; i < count; i++) {
        helio_table_sample sample;
        tables_sample_at(tables, faces[i], rows.cell[i], rows.fraction[i], columns.cell[i], columns.fraction[i],
                         &sample);
        if (pools->parts.light == STRATEGY_LIGHT_WHOLE)
            sample.density *= tables_face_probability(tables, faces[i]);
        store_sample(pools, pool, first + i, &sample);
    }
}

void KERNEL(draw_pool)(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed)
{
    for (uint32_t done = 0; done < count; done += GROUP)
        draw_group(pools, pool, first + done, count - done < GROUP ? count - done : GROUP, seed);
}

/* Whole registers, past the last sample too: what is too much is overwritten by the next samples, or never read. */
void KERNEL(take_pools)(const gathering *g, const pool_piece *pieces, uint32_t piece_count, sample_block *block)
{
    const size_t stride = g->pools->stride;
    const float *const samples = g->pools->samples;
    float *restrict to = block->samples[SAMPLE_X] + block->count;
    for (const pool_piece *piece = pieces; piece < pieces + piece_count; piece++) {
        const float expected = g->counts.expected[piece->pool];
        const float *from = samples + piece->first;
        for (uint32_t chunk = 0; chunk < piece->count; chunk += HELIO_LANES) {
#pragma omp simd
            for (size_t i = 0; i < HELIO_LANES; i++) {
                to[SAMPLE_X * BLOCK_STRIDE + chunk + i] = from[SAMPLE_X * stride + chunk + i];
                to[SAMPLE_Y * BLOCK_STRIDE + chunk + i] = from[SAMPLE_Y * stride + chunk + i];
                to[SAMPLE_Z * BLOCK_STRIDE + chunk + i] = from[SAMPLE_Z * stride + chunk + i];
                to[SAMPLE_RED * BLOCK_STRIDE + chunk + i] = from[SAMPLE_RED * stride + chunk + i];
                to[SAMPLE_GREEN * BLOCK_STRIDE + chunk + i] = from[SAMPLE_GREEN * stride + chunk + i];
                to[SAMPLE_BLUE * BLOCK_STRIDE + chunk + i] = from[SAMPLE_BLUE * stride + chunk + i];
                to[SAMPLE_DENSITY * BLOCK_STRIDE + chunk + i] = from[SAMPLE_DENSITY * stride + chunk + i] * expected;
            }
        }
        to += piece->count;
        block->count += piece->count;
    }
}
