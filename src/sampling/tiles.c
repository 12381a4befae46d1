/* SPDX-License-Identifier: MIT */
#include "sampling/tiles.h"

#include "core/context.h"

static const double LEAST_LIGHT = 0x1p-60; /* so that no product with it is subnormal; as an integer it is 1 anyway */

/* ---- creation ---- */

/* Faces that follow each other share an edge. */
static const uint32_t FACE_ORDER[CUBE_FACES] = {0, 2, 4, 1, 3, 5};

typedef struct curve_point {
    uint32_t x, y;
} curve_point;

/* Point `index` of Hilbert's curve through a square of side x side points, side a power of two. */
static curve_point hilbert_point(uint32_t side, uint32_t index)
{
    curve_point at = {0, 0};
    for (uint32_t half = 1; half < side; half *= 2, index /= 4) {
        uint32_t right = 1 & (index / 2), up = 1 & (index ^ right);
        if (up == 0) {
            if (right == 1)
                at = (curve_point){half - 1 - at.x, half - 1 - at.y};
            at = (curve_point){at.y, at.x};
        }
        at = (curve_point){at.x + half * right, at.y + half * up};
    }
    return at;
}

static vec3 tile_centre(const tiles *t, uint32_t face, uint32_t row, uint32_t column)
{
    float scale = 1.0f / (float)t->size;
    float u = (float)(t->starts[column] + t->starts[column + 1]) * scale - 1.0f;
    float v = (float)(t->starts[row] + t->starts[row + 1]) * scale - 1.0f;
    return cube_direction(face, u, v);
}

/* A tile is convex and smaller than a hemisphere, so one of its corners is farthest from the centre. */
static float tile_radius(const tiles *t, uint32_t row, uint32_t column)
{
    float least = 1.0f, scale = 2.0f / (float)t->size;
    vec3 centre = tile_centre(t, 0, row, column);
    for (uint32_t corner = 0; corner < 4; corner++) {
        uint32_t right = corner & 1u, below = corner >> 1;
        float u = (float)t->starts[column + right] * scale - 1.0f, v = (float)t->starts[row + below] * scale - 1.0f;
        least = fminf(least, dot(centre, cube_direction(0, u, v)));
    }
    return acosf(least);
}

static float tile_angle(const tiles *t, uint32_t row, uint32_t column)
{
    const double scale = 2.0 / (double)t->size;
    const uint32_t *starts = t->starts;
    return (float)cube_solid_angle(starts[column] * scale - 1.0, starts[column + 1] * scale - 1.0,
                                   starts[row] * scale - 1.0, starts[row + 1] * scale - 1.0);
}

static void place_tile(tiles *t, uint32_t position, uint32_t face, uint32_t row, uint32_t column)
{
    uint32_t grid = (face * t->per_edge + row) * t->per_edge + column;
    vec3 centre = tile_centre(t, face, row, column);
    t->positions[grid] = (uint16_t)position;
    t->grid[position] = (uint16_t)grid;
    t->x[position] = centre.x;
    t->y[position] = centre.y;
    t->z[position] = centre.z;
    t->angle[position] = tile_angle(t, row, column);
    t->radius = fmaxf(t->radius, tile_radius(t, row, column));
}

static void place_tiles(tiles *t)
{
    uint32_t side = 1;
    while (side < t->per_edge)
        side *= 2;
    for (uint32_t i = 0; i < CUBE_FACES; i++)
        for (uint32_t k = 0; k < side * side; k++) {
            curve_point at = hilbert_point(side, k);
            if (at.x < t->per_edge && at.y < t->per_edge)
                place_tile(t, t->count++, FACE_ORDER[i], at.y, at.x);
        }
}

float tiles_sine(float angle)
{
    float sine = angle < (float)PI / 2 ? sinf(angle) : 2.0f; /* all of the sphere, and by far */
    return ceilf(sine * 256.0f + 1.0f) / 256.0f;
}

static void divide_edge(tiles *t)
{
    for (uint32_t k = 0; k < t->per_edge; k++) {
        t->starts[k] = k * t->size / t->per_edge;
        t->starts[k + 1] = (k + 1) * t->size / t->per_edge;
        for (uint32_t line = t->starts[k]; line < t->starts[k + 1]; line++)
            t->of_line[line] = (uint8_t)k;
    }
}

helio_status tiles_create(helio_context *context, uint32_t size, tiles **out)
{
    tiles *t = context_allocate(context, 1, sizeof *t);
    if (t == NULL)
        return HELIO_ERR_MEMORY;
    t->context = context;
    t->size = size;
    t->per_edge = size < TILES_PER_EDGE ? size : TILES_PER_EDGE;
    t->stride = (size + t->per_edge - 1) / t->per_edge + 1;
    const size_t count = CUBE_FACES * (size_t)t->per_edge * t->per_edge, lines = CUBE_FACES * (size_t)size;
    t->of_line = context_allocate(context, size, sizeof *t->of_line);
    t->sums = context_allocate(context, count * t->stride, sizeof *t->sums);
    t->segment_densities = context_allocate(context, lines * t->per_edge, sizeof *t->segment_densities);
    if (t->of_line == NULL || t->sums == NULL || t->segment_densities == NULL) {
        tiles_destroy(t);
        return HELIO_ERR_MEMORY;
    }
    divide_edge(t);
    place_tiles(t);
    t->edge = tiles_sine(t->radius);
    tile_groups_place(t);
    *out = t;
    return HELIO_OK;
}

void tiles_destroy(tiles *t)
{
    if (t == NULL)
        return;
    context_release(t->context, t->segment_densities);
    context_release(t->context, t->sums);
    context_release(t->context, t->of_line);
    context_release(t->context, t);
}

/* ---- update ---- */

typedef struct summing {
    tiles *tiles;
    const helio_tables *tables;
} summing;

/* Probability of each row given the tile, shared out among the units of weight in this part of the row, per area of the
 * face's square. */
static void find_segment_densities(tiles *t, const row_sum *segments, uint32_t rows, const uint32_t *sums, float *to)
{
    const float quarter_texels = 0.25f * ((float)t->size * (float)t->size);
    for (uint32_t i = 0; i < rows; i++) {
        float probability = (float)(sums[i + 1] - sums[i]) / (float)sums[rows];
        to[(size_t)i * t->per_edge] =
            segments[i].sum != 0 ? probability / (float)segments[i].sum * quarter_texels : 0.0f;
    }
}

/* By its rows alone: (sum)^2 / (rows x sum of squares) is the part of them that even light would need. In integers,
 * of which 24 bits are divided. */
static float find_spread(const tiles *t, const uint32_t *sums, uint32_t rows)
{
    uint64_t squares = 0;
    for (uint32_t i = 0; i < rows; i++)
        squares += (uint64_t)(sums[i + 1] - sums[i]) * (sums[i + 1] - sums[i]);
    if (squares == 0)
        return t->radius;
    const uint64_t all = rows * squares, lit = (uint64_t)sums[rows] * sums[rows]; /* at most `all` */
    const int cut = all >> 24 != 0 ? 40 - __builtin_clzll(all) : 0;
    return t->radius * ((float)(int32_t)(lit >> cut) / (float)(int32_t)(all >> cut));
}

/* What the rows of a row of tiles hold in each tile. */
typedef row_sum tile_segments[TILES_PER_EDGE][CUBE_MAX_SIZE / TILES_PER_EDGE];

/* Row by row, as they lie in memory. */
static void find_segments(const tiles *t, const helio_tables *tables, size_t first, uint32_t rows,
                          tile_segments segments)
{
    for (uint32_t i = 0; i < rows; i++) {
        const uint32_t *texels = tables->rows + (first + i) * (t->size + 1);
        const int32_t exponent = tables->row_sums[first + i].exponent;
        for (uint32_t column = 0; column < t->per_edge; column++)
            segments[column][i] = (row_sum){texels[t->starts[column + 1]] - texels[t->starts[column]], exponent};
    }
}

static void sum_row_of_tiles(void *data, size_t index)
{
    const summing *work = data;
    tiles *t = work->tiles;
    const size_t face = index / t->per_edge, row = index % t->per_edge, first = face * t->size + t->starts[row];
    const uint32_t rows = t->starts[row + 1] - t->starts[row];
    tile_segments segments;
    find_segments(t, work->tables, first, rows, segments);
    for (uint32_t column = 0; column < t->per_edge; column++) {
        const uint32_t position = t->positions[index * t->per_edge + column];
        uint32_t *sums = t->sums + (size_t)position * t->stride;
        t->totals[position] = tables_sum_rows(segments[column], rows, sums);
        t->spread[position] = find_spread(t, sums, rows);
        find_segment_densities(t, segments[column], rows, sums, t->segment_densities + first * t->per_edge + column);
    }
}

static double value_of(row_sum sum)
{
    return ldexp((double)sum.sum, -sum.exponent);
}

static void find_light(tiles *t)
{
    double brightest = 0.0;
    int exponent;
    for (uint32_t i = 0; i < t->count; i++)
        brightest = fmax(brightest, value_of(t->totals[i]));
    frexp(brightest, &exponent);
    for (uint32_t i = 0; i < t->count; i++) {
        double light = ldexp(value_of(t->totals[i]), -exponent);
        t->light[i] = light > 0.0 ? (float)fmax(light, LEAST_LIGHT) : 0.0f;
        const float part = t->spread[i] / t->radius;
        t->peak[i] = t->light[i] / (t->angle[i] * (part * part));
    }
}

void tiles_update(tiles *t, const helio_tables *tables)
{
    summing work = {t, tables};
    context_parallel_for(t->context, CUBE_FACES * (size_t)t->per_edge, sum_row_of_tiles, &work);
    find_light(t);
    tile_colours_update(t, tables->environment);
    tile_groups_update(t);
}
