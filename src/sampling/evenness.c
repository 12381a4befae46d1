/* SPDX-License-Identifier: MIT */
#include "sampling/evenness.h"

#include "core/context.h"
#include "sampling/rules.h"

/* Up to which samples of the surface win: with 64 of them they have this / 64 as error, and pools have 2.5e-4 whatever
 * the map (docs/method.md). */
static const double GREATEST_VARIANCE = (double)RULE_EVEN_VARIANCE;

typedef struct evenness_work {
    const tiles *tiles;
    const helio_tables *tables;
    bool is_even[CUBE_FACES];
} evenness_work;

/* Of the luminance over a tile, with solid angle as measure. */
typedef struct tile_moments {
    double angle, light, square;
} tile_moments;

static tile_moments moments_of(const tiles *t, const helio_tables *tables, uint32_t face, uint32_t row, uint32_t column)
{
    tile_moments m = {0};
    for (uint32_t y = t->starts[row]; y < t->starts[row + 1]; y++)
        for (uint32_t x = t->starts[column]; x < t->starts[column + 1]; x++) {
            const double light = (double)luminance(environment_texel(tables->environment, face, y, x));
            const double angle = (double)tables->environment->solid_angle[(size_t)y * t->size + x];
            m.angle += angle;
            m.light += light * angle;
            m.square += light * light * angle;
        }
    return m;
}

/* Half the square of the difference between two tiles' means is what a border between them adds. */
static double step_between(const tile_moments *a, const tile_moments *b)
{
    double step = a->light / a->angle - b->light / b->angle;
    return 0.25 * step * step * (a->angle + b->angle) * 0.5;
}

/* What all that is uneven on a face may come to. */
static double most_of(const helio_tables *tables, uint32_t face)
{
    const double angle = 4.0 * PI / CUBE_FACES, mean = tables_flux(tables->size, tables->face_fluxes[face]) / angle;
    return GREATEST_VARIANCE * mean * mean * angle;
}

/* By the sums of tiles that the tables have told already: borders alone are too much under nearly all light, and then
 * no texel is looked at. A little more than is allowed is left to the texels, whose sums round otherwise. */
static bool borders_are_too_much(const tiles *t, const helio_tables *tables, uint32_t face)
{
    const double most = 1.001 * most_of(tables, face);
    tile_moments above[TILES_PER_EDGE] = {{0}};
    double sum = 0.0;
    for (uint32_t row = 0; row < t->per_edge; row++)
        for (uint32_t column = 0; column < t->per_edge; column++) {
            const uint32_t position = t->positions[(face * t->per_edge + row) * t->per_edge + column];
            const tile_moments m = {.angle = (double)t->angle[position],
                                    .light = tables_flux(t->size, t->totals[position])};
            sum += column > 0 ? step_between(&above[column - 1], &m) : 0.0;
            sum += row > 0 ? step_between(&above[column], &m) : 0.0;
            above[column] = m;
        }
    return sum > most;
}

/* Stops as soon as it is too much. */
static void judge_face(void *data, size_t face)
{
    evenness_work *work = data;
    const tiles *t = work->tiles;
    const double most = most_of(work->tables, (uint32_t)face);
    tile_moments above[TILES_PER_EDGE] = {{0}};
    double sum = 0.0;
    for (uint32_t row = 0; row < t->per_edge && sum <= most; row++)
        for (uint32_t column = 0; column < t->per_edge && sum <= most; column++) {
            const tile_moments m = moments_of(t, work->tables, (uint32_t)face, row, column);
            const double variance = m.square - m.light * m.light / m.angle;
            sum += variance > 0.0 ? variance : 0.0; /* a constant's may round to less */
            if (column > 0)
                sum += step_between(&above[column - 1], &m);
            if (row > 0)
                sum += step_between(&above[column], &m);
            above[column] = m;
        }
    work->is_even[face] = sum <= most * (1.0 + 1e-9);
}

bool evenness_holds(const tiles *t, const helio_tables *tables)
{
    evenness_work work = {.tiles = t, .tables = tables};
    bool is_even = true;
    if (tables->weighting == HELIO_WEIGHTING_SOLID_ANGLE) /* else the sums of tiles are not their light */
        for (uint32_t face = 0; face < CUBE_FACES; face++)
            if (borders_are_too_much(t, tables, face))
                return false;
    context_parallel_for(t->context, CUBE_FACES, judge_face, &work);
    for (int face = 0; face < CUBE_FACES; face++)
        is_even &= work.is_even[face];
    return is_even;
}
