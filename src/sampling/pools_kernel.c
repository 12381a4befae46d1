/* SPDX-License-Identifier: MIT
 *
 * Samples of pools of faces, and of the lists of tiles: scrambled points, and the inversion of the tables at them.
 * Several searches go on at once, one step of each after the other, so that they wait for memory together. */
#include "core/random.h"
#include "sampling/kernels.h"

#include <float.h>

enum {
    GROUP = 32, /* samples drawn side by side */
    PIECES = 8, /* of lists, drawn one step of each after the other */
};

/* Searches that go on together. fraction is that of tables_invert(): in x, out where x lies inside of the cell. */
typedef struct search_group {
    const uint32_t *sums;
    alignas(64) int32_t first[GROUP]; /* of the [length + 1] sums that are searched, perhaps a piece of longer ones */
    alignas(64) uint32_t fraction[GROUP];
    alignas(64) uint32_t cell[GROUP];
} search_group;

/* What prefix sums must exceed for the cell that holds x to end. */
static void find_wholes(search_group *group, uint32_t count, uint32_t length, uint32_t *restrict wholes)
{
    const uint32_t *sums = group->sums;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t before = sums[group->first[i]], total = sums[group->first[i] + (int32_t)length] - before;
        wholes[i] = before + (uint32_t)(((uint64_t)group->fraction[i] * total) >> 32);
        group->cell[i] = 0;
    }
}

/* tables_invert() for each: as many steps for all, without branches. */
static void invert_group(search_group *group, uint32_t count, uint32_t length)
{
    alignas(64) uint32_t wholes[GROUP];
    const uint32_t *sums = group->sums;
    uint32_t highest = 1;
    find_wholes(group, count, length, wholes);
    while (highest < length)
        highest *= 2;
    for (uint32_t step = highest / 2; step > 0; step /= 2)
#pragma omp simd
        for (uint32_t i = 0; i < count; i++) {
            uint32_t next = group->cell[i] + step;
            next = next < length ? next : length; /* where the sum is above whole */
            group->cell[i] += sums[group->first[i] + (int32_t)next] <= wholes[i] ? step : 0;
        }
    for (uint32_t i = 0; i < count; i++)
        group->fraction[i] = tables_fraction_within(sums + group->first[i], length, group->cell[i], group->fraction[i]);
}

/* A group of samples on its way from points to texels. */
typedef struct sample_group {
    uint32_t count, first_column;
    alignas(64) uint32_t faces[GROUP], rows[GROUP], columns[GROUP];
    alignas(64) float u[GROUP], v[GROUP];
    search_group row, column;
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
    group->row.sums = tables->marginals;
    for (uint32_t i = 0; i < group->count; i++) {
        uint32_t *fraction = &group->row.fraction[i];
        group->faces[i] = whole ? tables_invert(tables->faces, CUBE_FACES, *fraction, fraction) : pool;
        group->row.first[i] = (int32_t)(group->faces[i] * (tables->size + 1));
    }
    invert_group(&group->row, group->count, tables->size);
    for (uint32_t i = 0; i < group->count; i++)
        group->rows[i] = group->row.cell[i];
}

/* Where the sums of each row begin, of which those of `columns` texels from first_column on are searched. */
static void aim_at_columns(const helio_tables *tables, uint32_t first_column, uint32_t columns, sample_group *group)
{
    const uint32_t size = tables->size;
    group->first_column = first_column;
    group->column.sums = tables->rows;
    for (uint32_t i = 0; i < group->count; i++) {
        const uint32_t line = group->faces[i] * size + group->rows[i];
        group->column.first[i] = (int32_t)(line * (size + 1) + first_column);
        const uint32_t *sums = &tables->rows[group->column.first[i]];
        __builtin_prefetch(sums);
        __builtin_prefetch(sums + columns / 2);
        __builtin_prefetch(sums + columns);
    }
}

/* The texel in each row, and the place in it. */
static void choose_texels(const helio_tables *tables, uint32_t columns, sample_group *group)
{
    const uint32_t size = tables->size;
    invert_group(&group->column, group->count, columns);
    for (uint32_t i = 0; i < group->count; i++) {
        group->columns[i] = group->first_column + group->column.cell[i];
        __builtin_prefetch(environment_texel(tables->environment, group->faces[i], group->rows[i], group->columns[i]));
    }
#pragma omp simd
    for (uint32_t i = 0; i < group->count; i++) {
        const face_place at =
            tables_place(size, 0, group->rows[i], group->row.fraction[i], group->columns[i], group->column.fraction[i]);
        group->u[i] = at.u;
        group->v[i] = at.v;
    }
}

static face_place place_of(const sample_group *group, uint32_t i)
{
    return (face_place){group->faces[i], group->rows[i], group->columns[i], group->u[i], group->v[i]};
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

void KERNEL(draw_pool)(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed)
{
    sample_group group;
    for (uint32_t done = 0; done < count; done += GROUP) {
        group.count = count - done < GROUP ? count - done : GROUP;
        choose_points(first + done, seed, &group);
        choose_rows(pools, pool, &group);
        aim_at_columns(pools->tables, 0, pools->tables->size, &group);
        choose_texels(pools->tables, pools->tables->size, &group);
        for (uint32_t i = 0; i < group.count; i++) {
            const face_place at = place_of(&group, i);
            helio_table_sample sample;
            tables_sample_at(pools->tables, &at, pools_density(pools, pool, &at), &sample);
            store_sample(pools, pool, first + done + i, &sample);
        }
    }
}

/* ---- lists of tiles ---- */

/* Points first ... of 2^bits: one in each of that many strata of y, in their order. Together they are a (0,2)-net, and
 * those at equal steps have columns as far apart as rows. */
static void choose_strata(uint32_t first, int bits, uint32_t seed, sample_group *group)
{
    const uint32_t seed_x = dimension_seed(seed, 0), seed_y = dimension_seed(seed, 1);
#pragma omp simd
    for (uint32_t i = 0; i < group->count; i++) {
        const uint32_t stratum = first + i, index = reverse_bits(stratum) >> (32 - bits);
        group->column.fraction[i] = owen_scramble_reversed(pascal_transform(index), seed_x);
        group->row.fraction[i] = (stratum << (32 - bits)) + (hash_combine(seed_y, stratum) >> bits);
    }
}

/* A tile in the tables. */
typedef struct tile_texels {
    uint32_t position, face, row, column; /* of the first texel */
    uint32_t rows, columns;
} tile_texels;

static tile_texels texels_of(const tiles *t, uint32_t position)
{
    const uint32_t edge = t->per_edge, grid = t->grid[position], row = grid / edge % edge, column = grid % edge;
    return (tile_texels){position,
                         grid / (edge * edge),
                         t->starts[row],
                         t->starts[column],
                         t->starts[row + 1] - t->starts[row],
                         t->starts[column + 1] - t->starts[column]};
}

static void choose_rows_of_tile(const tiles *t, const tile_texels *tile, sample_group *group)
{
    group->row.sums = t->sums + (size_t)tile->position * t->stride;
    for (uint32_t i = 0; i < group->count; i++)
        group->row.first[i] = 0;
    invert_group(&group->row, group->count, tile->rows);
    for (uint32_t i = 0; i < group->count; i++) {
        group->faces[i] = tile->face;
        group->rows[i] = tile->row + group->row.cell[i];
    }
}

/* What samples of a tile have beside their light: [count] each. */
typedef struct listed_places {
    alignas(64) float x[GROUP], y[GROUP], z[GROUP];
    alignas(64) float towards[GROUP]; /* cosine to the tile's centre */
    alignas(64) float density[GROUP];
} listed_places;

/* Where each is, and its density. */
static void find_places(const tiles *t, const helio_tables *tables, const tile_texels *tile, const sample_group *group,
                        listed_places *places)
{
    const cube_face face = cube_faces[tile->face];
    const vec3 centre = {t->x[tile->position], t->y[tile->position], t->z[tile->position]};
    const float *per_weight = t->segment_densities + t->of_line[tile->column];
    const int32_t first_line = (int32_t)(tile->face * t->size), per_edge = (int32_t)t->per_edge;
#pragma omp simd
    for (uint32_t i = 0; i < group->count; i++) {
        const float u = group->u[i], v = group->v[i];
        const vec3 direction = cube_direction_on(&face, u, v);
        const int32_t texel = group->column.first[i] + (int32_t)group->column.cell[i];
        const uint32_t weight = tables->rows[texel + 1] - tables->rows[texel];
        places->x[i] = direction.x;
        places->y[i] = direction.y;
        places->z[i] = direction.z;
        places->towards[i] = dot(centre, direction);
        places->density[i] =
            face_place_density(u, v, weight, per_weight[(first_line + (int32_t)group->rows[i]) * per_edge]);
    }
}

static inline void list_sample(const listed_places *places, uint32_t i, const float *rgb, float brightness,
                               listed_sample *listed)
{
    const float hue = places->towards[i] / brightness;
    listed->direction[0] = places->x[i];
    listed->direction[1] = places->y[i];
    listed->direction[2] = places->z[i];
    listed->direction[3] = places->towards[i];
    listed->density = places->density[i];
    for (int c = 0; c < 3; c++) {
        listed->radiance[c] = rgb[c];
        listed->weighted[c] = weighted(rgb[c], places->density[i]);
        listed->hue[c] = listed->weighted[c] * hue;
    }
}

/* Samples of a list that are drawn side by side. */
typedef struct list_piece {
    tile_texels tile;
    listed_sample *listed;
    sample_group group;
} list_piece;

static void begin_piece(const normal_bins *bins, const helio_tables *tables, uint32_t position, uint32_t first,
                        uint32_t seed, list_piece *piece)
{
    const uint32_t start = bins->list_starts[position], length = bins->list_starts[position + 1] - start;
    piece->tile = texels_of(bins->tiles, position);
    piece->listed = &bins->listed[start + first];
    piece->group.count = length - first < GROUP ? length - first : GROUP;
    choose_strata(first, 31 - __builtin_clz(length), seed, &piece->group);
    choose_rows_of_tile(bins->tiles, &piece->tile, &piece->group);
    aim_at_columns(tables, piece->tile.column, piece->tile.columns, &piece->group);
}

static void end_piece(const normal_bins *bins, const helio_tables *tables, const list_piece *piece)
{
    const sample_group *group = &piece->group;
    listed_places places;
    find_places(bins->tiles, tables, &piece->tile, group, &places);
    for (uint32_t i = 0; i < group->count; i++)
        list_sample(&places, i,
                    environment_texel(tables->environment, piece->tile.face, group->rows[i], group->columns[i]),
                    bins->tiles->colours.brightness[piece->tile.position], &piece->listed[i]);
}

/* What one step asks of memory has come when the same step is done for all pieces. */
static void draw_pieces(const normal_bins *bins, const helio_tables *tables, list_piece *pieces, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        choose_texels(tables, pieces[i].tile.columns, &pieces[i].group);
    for (uint32_t i = 0; i < count; i++)
        end_piece(bins, tables, &pieces[i]);
}

void KERNEL(draw_tiles)(normal_bins *bins, const helio_tables *tables, uint32_t first, uint32_t end, uint32_t seed)
{
    list_piece pieces[PIECES];
    uint32_t count = 0;
    for (uint32_t position = first; position < end; position++) {
        const uint32_t length = bins->list_starts[position + 1] - bins->list_starts[position];
        for (uint32_t done = 0; done < length; done += GROUP) {
            begin_piece(bins, tables, position, done, hash_combine(seed, position), &pieces[count++]);
            if (count == PIECES) {
                draw_pieces(bins, tables, pieces, count);
                count = 0;
            }
        }
    }
    draw_pieces(bins, tables, pieces, count);
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
