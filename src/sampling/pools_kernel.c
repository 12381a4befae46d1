/* SPDX-License-Identifier: MIT
 *
 * Samples of a pool: scrambled points, and the inversion of the tables at them. Several searches go on at once, one
 * step of each after the other, so that they wait for memory together. */
#include "core/random.h"
#include "sampling/kernels.h"
#include "sampling/tile_levels.h"

#include <float.h>

enum { GROUP = 32 }; /* samples drawn together */

/* Searches that go on together. fraction is that of tables_invert(): in x, out where x lies inside of the cell. */
typedef struct search_group {
    uint32_t fraction[GROUP];
    const uint32_t *sums[GROUP]; /* [length + 1] each, perhaps a piece of longer ones */
    uint32_t cell[GROUP];
} search_group;

/* tables_invert() for each: as many steps for all, without branches. */
static void invert_group(search_group *group, uint32_t count, uint32_t length)
{
    uint32_t whole[GROUP], highest = 1;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *sums = group->sums[i], total = sums[length] - sums[0];
        whole[i] = sums[0] + (uint32_t)(((uint64_t)group->fraction[i] * total) >> 32);
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

/* A group of samples on its way from points to texels. */
typedef struct sample_group {
    uint32_t count;
    uint32_t faces[GROUP], rows[GROUP], first_columns[GROUP];
    search_group row, column;
    face_place places[GROUP];
} sample_group;

/* Points first ... of a pool: x for the columns, y for the rows. */
static void choose_points(uint32_t first, uint32_t seed, sample_group *group)
{
    const uint32_t seed_x = dimension_seed(seed, 0), seed_y = dimension_seed(seed, 1);
#pragma omp simd
    for (uint32_t i = 0; i < group->count; i++) {
        group->column.fraction[i] = owen_scramble_reversed(first + i, seed_x);
        group->row.fraction[i] = owen_scramble_reversed(pascal_transform(first + i), seed_y);
    }
}

/* The row of each sample in the table of its face: the pool's, or for the whole map by the sums over faces, which
 * leaves the row's fraction. */
static void choose_rows(const helio_pools *pools, uint32_t pool, sample_group *group)
{
    const helio_tables *tables = pools->tables;
    const bool whole = pools->parts.light == STRATEGY_LIGHT_WHOLE;
    for (uint32_t i = 0; i < group->count; i++) {
        uint32_t *fraction = &group->row.fraction[i];
        group->faces[i] = whole ? tables_invert(tables->faces, CUBE_FACES, *fraction, fraction) : pool;
        group->row.sums[i] = tables_face(tables, group->faces[i]).marginal;
    }
    invert_group(&group->row, group->count, tables->size);
    for (uint32_t i = 0; i < group->count; i++) {
        group->rows[i] = group->row.cell[i];
        group->first_columns[i] = 0;
    }
}

/* The texel in each row, among `columns` of them, and the place in it. */
static void choose_texels(const helio_tables *tables, uint32_t columns, sample_group *group)
{
    const uint32_t size = tables->size;
    for (uint32_t i = 0; i < group->count; i++)
        group->column.sums[i] =
            tables_face(tables, group->faces[i]).rows + (size_t)group->rows[i] * (size + 1) + group->first_columns[i];
    invert_group(&group->column, group->count, columns);
    for (uint32_t i = 0; i < group->count; i++) {
        group->places[i] = tables_place(size, group->faces[i], group->rows[i], group->row.fraction[i],
                                        group->first_columns[i] + group->column.cell[i], group->column.fraction[i]);
        const face_place *at = &group->places[i];
        __builtin_prefetch(environment_texel(tables->environment, at->face, at->row, at->column));
    }
}

/* Finite, so that times 0 it is 0. */
static float weighted(float radiance, float density)
{
    float ratio = radiance / density;
    return ratio < FLT_MAX ? ratio : FLT_MAX;
}

/* What samples of all pools have: directions and radiance, in arrays `stride` floats apart. */
static inline void store_light(float *to, size_t stride, const float direction[3], const float radiance[3])
{
    to[SAMPLE_X * stride] = direction[0];
    to[SAMPLE_Y * stride] = direction[1];
    to[SAMPLE_Z * stride] = direction[2];
    to[SAMPLE_RED * stride] = radiance[0];
    to[SAMPLE_GREEN * stride] = radiance[1];
    to[SAMPLE_BLUE * stride] = radiance[2];
}

static void store_sample(helio_pools *pools, uint32_t pool, uint32_t index, const helio_table_sample *sample)
{
    float *to = pools_array(pools, pool, SAMPLE_X) + index;
    store_light(to, pools->stride, sample->direction, sample->radiance);
    to[SAMPLE_DENSITY * pools->stride] = sample->density;
    to[SAMPLE_WEIGHTED_RED * pools->stride] = weighted(sample->radiance[0], sample->density);
    to[SAMPLE_WEIGHTED_GREEN * pools->stride] = weighted(sample->radiance[1], sample->density);
    to[SAMPLE_WEIGHTED_BLUE * pools->stride] = weighted(sample->radiance[2], sample->density);
}

void KERNEL(draw_pool)(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed)
{
    for (uint32_t done = 0; done < count; done += GROUP) {
        sample_group group = {.count = count - done < GROUP ? count - done : GROUP};
        choose_points(first + done, seed, &group);
        choose_rows(pools, pool, &group);
        choose_texels(pools->tables, pools->tables->size, &group);
        for (uint32_t i = 0; i < group.count; i++) {
            helio_table_sample sample;
            tables_sample_at(pools->tables, &group.places[i], pools_density(pools, pool, &group.places[i]), &sample);
            store_sample(pools, pool, first + done + i, &sample);
        }
    }
}

/* ---- samples of tiles, and pools of bins made of them ---- */

/* Points first ... of `length`, a power of two: one in each of that many strata of y, in their order. Together they are
 * a (0,2)-net, and those at equal steps have columns as far apart as rows. */
static void choose_strata(uint32_t first, uint32_t length, uint32_t seed, sample_group *group)
{
    const uint32_t seed_x = dimension_seed(seed, 0), seed_y = dimension_seed(seed, 1);
    for (uint32_t i = 0; i < group->count; i++) {
        const uint32_t index = (uint32_t)(((uint64_t)reverse_bits(first + i) * length) >> 32);
        group->column.fraction[i] = owen_scramble_reversed(pascal_transform(index), seed_x);
        const uint64_t y = ((uint64_t)(first + i) << 32) + hash_combine(seed_y, first + i);
        group->row.fraction[i] = (uint32_t)(y / length);
    }
}

/* The row of each sample in a tile, whose number of columns is returned. */
static uint32_t choose_rows_of_tile(const tiles *t, uint32_t position, sample_group *group)
{
    const uint32_t edge = t->per_edge, grid = t->grid[position], row = grid / edge % edge, column = grid % edge;
    for (uint32_t i = 0; i < group->count; i++)
        group->row.sums[i] = t->sums + (size_t)position * t->stride;
    invert_group(&group->row, group->count, t->starts[row + 1] - t->starts[row]);
    for (uint32_t i = 0; i < group->count; i++) {
        group->faces[i] = grid / (edge * edge);
        group->rows[i] = t->starts[row] + group->row.cell[i];
        group->first_columns[i] = t->starts[column];
    }
    return t->starts[column + 1] - t->starts[column];
}

static listed_sample list_sample(const tiles *t, uint32_t position, const helio_table_sample *sample)
{
    const vec3 centre = {t->x[position], t->y[position], t->z[position]};
    const float towards = dot(centre, vec3_from(sample->direction)), scale = towards / t->colours.brightness[position];
    listed_sample listed = {.direction[3] = towards, .density = sample->density};
    for (int c = 0; c < 3; c++) {
        listed.direction[c] = sample->direction[c];
        listed.radiance[c] = sample->radiance[c];
        listed.weighted[c] = weighted(sample->radiance[c], sample->density);
        listed.hue[c] = listed.weighted[c] * scale;
    }
    return listed;
}

void KERNEL(draw_tile)(normal_bins *bins, const helio_tables *tables, uint32_t position, uint32_t seed)
{
    const uint32_t start = bins->list_starts[position], length = bins->list_starts[position + 1] - start;
    for (uint32_t done = 0; done < length; done += GROUP) {
        sample_group group = {.count = length - done < GROUP ? length - done : GROUP};
        choose_strata(done, length, seed, &group);
        choose_texels(tables, choose_rows_of_tile(bins->tiles, position, &group), &group);
        for (uint32_t i = 0; i < group.count; i++) {
            helio_table_sample sample;
            tables_sample_at(tables, &group.places[i], tiles_density(bins->tiles, tables, &group.places[i]), &sample);
            bins->listed[start + done + i] = list_sample(bins->tiles, position, &sample);
        }
    }
}

/* Samples of the pool of a bin that are drawn together, in the order in which they are stored. */
typedef struct bin_samples {
    alignas(64) uint32_t positions[POOL_RUN_MOST], elements[POOL_RUN_MOST];
    alignas(64) float probabilities[POOL_RUN_MOST], scales[POOL_RUN_MOST]; /* of the tile given the bin; 1 / that */
    alignas(64) float slopes[POOL_RUN_MOST], offsets[POOL_RUN_MOST];       /* see control_line */
} bin_samples;

/* Samples of a run lie in the order of their numbers with the bits reversed, and some of them flipped at random: so
 * each aligned window of a power of two has one of each of that many parts of the run, and any place holds each of the
 * samples with the same probability. */
static void choose_run(const normal_bins *bins, const tile_levels *levels, uint32_t run, uint32_t seed,
                       uint32_t *positions, uint32_t *elements)
{
    alignas(64) uint32_t drawn_positions[POOL_RUN_MOST], drawn_elements[POOL_RUN_MOST];
    const uint32_t flipped = tile_tree_random(seed, TILE_TREE_ORDER);
    tile_levels_draw(levels, bins->list_starts, run, seed, drawn_positions, drawn_elements);
    for (uint32_t i = 0; i < run; i++) {
        const uint32_t number = (uint32_t)(((uint64_t)(reverse_bits(i) ^ flipped) * run) >> 32);
        positions[i] = drawn_positions[number];
        elements[i] = drawn_elements[number];
        __builtin_prefetch(&bins->listed[elements[i]]);
    }
}

static void weigh_samples(const normal_bins *bins, uint32_t bin, const uint32_t *restrict sums, uint32_t count,
                          bin_samples *restrict samples)
{
    const tiles *restrict t = bins->tiles;
    const normal_bin b = bins->bins[bin];
    const float share = bins->shares[bin];
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t tile = samples->positions[i];
        const float cosine = b.centre.x * t->x[tile] + b.centre.y * t->y[tile] + b.centre.z * t->z[tile];
        const control_line line = control_line_of(&b, cosine);
        samples->slopes[i] = line.slope;
        samples->offsets[i] = line.offset;
        samples->probabilities[i] = (float)(int32_t)(sums[tile + 1] - sums[tile]) * share; /* below 2^31 */
        samples->scales[i] = 1.0f / samples->probabilities[i];
    }
}

/* What a sample is worth given the bin: weighted is finite here too. */
static inline void scale_light(const listed_sample *sample, float scale, float light[4])
{
    for (int c = 0; c < 4; c++) {
        const float product = sample->weighted[c] * scale;
        light[c] = product < FLT_MAX ? product : FLT_MAX;
    }
}

/* Adds what a sample stands for, see control.h. */
static inline void add_known(const listed_sample *sample, float slope, float offset, const float light[4],
                             control_matrix *sum)
{
    const float line[4] = {slope, slope, slope, offset};
    for (int row = 0; row < 4; row++)
        for (int c = 0; c < 4; c++)
            sum->rows[row][c] += line[row] * sample->direction[row] * light[c];
}

/* The samples of a chunk, and the sums up to its end. */
static inline void store_chunk(const listed_sample *listed, const bin_samples *samples, uint32_t first, float *to,
                               size_t stride, const control_matrix *before, control_matrix *after)
{
    control_matrix sum = {{{0}}};
    for (uint32_t i = first; i < first + CONTROL_CHUNK; i++) {
        const listed_sample *sample = &listed[samples->elements[i]];
        float light[4];
        scale_light(sample, samples->scales[i], light);
        store_light(to + i, stride, sample->direction, sample->radiance);
        to[SAMPLE_DENSITY * stride + i] = samples->probabilities[i] * sample->density;
        to[SAMPLE_WEIGHTED_RED * stride + i] = light[0];
        to[SAMPLE_WEIGHTED_GREEN * stride + i] = light[1];
        to[SAMPLE_WEIGHTED_BLUE * stride + i] = light[2];
        add_known(sample, samples->slopes[i], samples->offsets[i], light, &sum);
    }
    for (int row = 0; row < 4; row++)
        for (int c = 0; c < 4; c++)
            after->rows[row][c] = sum.rows[row][c] + before->rows[row][c];
}

/* Whole runs, as many as fit. */
static void draw_runs(helio_pools *pools, uint32_t bin, const tile_levels *levels, uint32_t first, uint32_t count,
                      uint32_t seed)
{
    const normal_bins *bins = pools->bins;
    const uint32_t run = pools_run_of_bin(pools);
    float *to = pools_array(pools, bin, SAMPLE_X) + first;
    control_matrix *control = control_sums(pools->control, bin) + first / CONTROL_CHUNK;
    bin_samples samples;
    for (uint32_t done = 0; done < count; done += run)
        choose_run(bins, levels, run, hash_combine(seed, (first + done) / run), samples.positions + done,
                   samples.elements + done);
    weigh_samples(bins, bin, levels->tiles, count, &samples);
    for (uint32_t i = 0; i < count; i += CONTROL_CHUNK, control++)
        store_chunk(bins->listed, &samples, i, to, pools->stride, control, control + 1);
}

void KERNEL(draw_bin)(helio_pools *pools, uint32_t bin, uint32_t seed)
{
    const uint32_t length = pools->pool_length, most = length < POOL_RUN_MOST ? length : POOL_RUN_MOST;
    tile_levels levels;
    tile_levels_make(normal_bins_sums(pools->bins, bin), pools->bins->tiles->count, &levels);
    for (uint32_t first = 0; first < length; first += most)
        draw_runs(pools, bin, &levels, first, most, seed);
}

/* ---- taking samples ---- */

/* Whole registers, past the last sample too: what is too much is overwritten by the next samples, or never read. */
void KERNEL(take_pools)(const gathering *g, const pool_piece *pieces, uint32_t piece_count, sample_block *block)
{
    const size_t stride = g->pools->stride;
    const float *const samples = g->pools->samples;
    float *restrict to = block->samples[SAMPLE_X] + block->count;
    for (const pool_piece *piece = pieces; piece < pieces + piece_count; piece++) {
        const float expected = g->counts.expected[piece->technique];
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
