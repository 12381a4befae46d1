/* SPDX-License-Identifier: MIT */
#include "inspect.h"

#include "message.h"

#include <math.h>
#include <stdlib.h>

/* A spot is what is brighter than this times the average. */
static const double SPOT_CONTRAST = 2;
static const double SPOT_EDGE = 0.1; /* of its brightest texel's luminance */

static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

typedef struct texel_place {
    int face;
    uint32_t row, column;
} texel_place;

static texel_place place_of(uint32_t size, size_t texel)
{
    size_t face = texel / ((size_t)size * size), rest = texel % ((size_t)size * size);
    return (texel_place){(int)face, (uint32_t)(rest / size), (uint32_t)(rest % size)};
}

/* Towards the middle of a texel, which may lie beyond an edge of the face; not of unit length. */
static void direction_of(uint32_t size, int face, int64_t row, int64_t column, double direction[3])
{
    face_direction(face, (2.0 * (double)column + 1) / size - 1, (2.0 * (double)row + 1) / size - 1, direction);
}

static size_t neighbour(uint32_t size, size_t texel, int rows, int columns)
{
    texel_place at = place_of(size, texel);
    double direction[3];
    direction_of(size, at.face, (int64_t)at.row + rows, (int64_t)at.column + columns, direction);
    return face_texel(size, direction);
}

/* What grows from the brightest texel. */
typedef struct spot_search {
    const float *cube;
    uint32_t size;
    double edge;       /* luminance */
    uint32_t *waiting; /* [texels] */
    size_t count;
    bool *seen; /* [texels] */
    double light[3], flux, irradiance, area;
} spot_search;

static void visit(spot_search *search, size_t texel)
{
    if (search->seen[texel] || luminance(search->cube + 3 * texel) < search->edge)
        return;
    search->seen[texel] = true;
    search->waiting[search->count++] = (uint32_t)texel;
}

static void add_texel(spot_search *search, size_t texel)
{
    texel_place at = place_of(search->size, texel);
    double area = face_solid_angle(search->size, at.row, at.column), direction[3];
    double flux = area * luminance(search->cube + 3 * texel);
    direction_of(search->size, at.face, at.row, at.column, direction);
    double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int i = 0; i < 3; i++)
        search->light[i] += flux * direction[i] / length;
    search->flux += flux;
    search->irradiance += flux * fmax(direction[1] / length, 0);
    search->area += area;
}

static void grow(spot_search *search)
{
    for (size_t next = 0; next < search->count; next++) {
        size_t texel = search->waiting[next];
        add_texel(search, texel);
        for (int rows = -1; rows <= 1; rows++)
            for (int columns = -1; columns <= 1; columns++)
                visit(search, neighbour(search->size, texel, rows, columns));
    }
}

static size_t find_brightest(const float *cube, size_t texels)
{
    size_t brightest = 0;
    for (size_t i = 1; i < texels; i++)
        if (luminance(cube + 3 * i) > luminance(cube + 3 * brightest))
            brightest = i;
    return brightest;
}

static void describe(const spot_search *search, size_t brightest, inspect_findings *found)
{
    inspect_spot *spot = &found->spot;
    texel_place at = place_of(search->size, brightest);
    double *d = spot->direction,
           length = sqrt(search->light[0] * search->light[0] + search->light[1] * search->light[1] +
                         search->light[2] * search->light[2]);
    if (length > 1e-3 * search->flux) { /* else it is all around, and its centre means nothing */
        for (int i = 0; i < 3; i++)
            d[i] = search->light[i] / length;
    } else {
        direction_of(search->size, at.face, at.row, at.column, d);
        double scale = 1 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++)
            d[i] *= scale;
    }
    const double degrees = 180 / acos(-1);
    spot->azimuth = atan2(d[0], -d[2]) * degrees;
    if (spot->azimuth < 0)
        spot->azimuth += 360;
    spot->elevation = asin(fmax(fmin(d[1], 1), -1)) * degrees;
    spot->solid_angle = search->area;
    spot->luminance = luminance(search->cube + 3 * brightest);
    spot->share = found->all_flux > 0 ? fmin(search->flux / found->all_flux, 1) : 0;
    spot->irradiance_share = found->irradiance > 0 ? fmin(search->irradiance / found->irradiance, 1) : 0;
}

bool inspect_find_spot(const float *cube, uint32_t size, inspect_findings *found)
{
    size_t texels = FACE_COUNT * (size_t)size * size, brightest = find_brightest(cube, texels);
    double greatest = luminance(cube + 3 * brightest);
    found->has_spot = greatest > SPOT_CONTRAST * found->mean_luminance;
    if (!found->has_spot)
        return true;
    spot_search search = {.cube = cube, .size = size, .edge = SPOT_EDGE * greatest};
    search.waiting = malloc(texels * sizeof search.waiting[0]);
    search.seen = calloc(texels, sizeof search.seen[0]);
    bool good = search.waiting != NULL && search.seen != NULL;
    if (good) {
        visit(&search, brightest);
        grow(&search);
        describe(&search, brightest, found);
    } else {
        message_failure("no memory to look for the brightest spot of %s", found->name);
    }
    free(search.waiting);
    free(search.seen);
    return good;
}
