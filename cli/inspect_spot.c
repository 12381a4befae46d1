/* SPDX-License-Identifier: MIT */
#include "inspect.h"

#include "message.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A spot is what is brighter than this times the average. */
static const double SPOT_CONTRAST = 2;
/* A spot ends where luminance falls below these parts of its brightest texel's: the first one at which it is no larger
 * than SPOT_MOST, or the last one. And it never goes beyond SPOT_REACH of that texel, or the brightest spot of an even
 * sky would be half the sky. */
static const double SPOT_EDGES[] = {SPOT_FIRST_EDGE, 0.5, 0.9};
enum { SPOT_EDGE_COUNT = sizeof SPOT_EDGES / sizeof SPOT_EDGES[0] };
static const double SPOT_MOST = 0.1;    /* sr: a disc of 20 degrees */
static const double SPOT_REACH = 0.866; /* cosine of 30 degrees */

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
    double middle[3];  /* unit vector, towards the brightest texel */
    uint32_t *waiting; /* [texels] */
    size_t count;
    bool *seen; /* [texels] */
    double light[3], flux, irradiance, area;
} spot_search;

/* Of unit length, towards the middle of a texel. */
static void texel_direction(uint32_t size, size_t texel, double direction[3])
{
    texel_place at = place_of(size, texel);
    direction_of(size, at.face, at.row, at.column, direction);
    double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int i = 0; i < 3; i++)
        direction[i] /= length;
}

static bool is_in_spot(const spot_search *search, size_t texel)
{
    double d[3];
    if (inspect_luminance(search->cube + 3 * texel) < search->edge)
        return false;
    texel_direction(search->size, texel, d);
    return d[0] * search->middle[0] + d[1] * search->middle[1] + d[2] * search->middle[2] >= SPOT_REACH;
}

static void add_light(spot_search *search, size_t texel)
{
    texel_place at = place_of(search->size, texel);
    double direction[3];
    double flux = face_solid_angle(search->size, at.row, at.column) * inspect_luminance(search->cube + 3 * texel);
    texel_direction(search->size, texel, direction);
    for (int i = 0; i < 3; i++)
        search->light[i] += flux * direction[i];
    search->flux += flux;
    search->irradiance += flux * fmax(direction[1], 0);
}

/* Texels of the spot are waiting to be looked around from. Those beside it, over which the texels of the cube spread
 * the last of its light, count with their light but not with their area. */
static void visit(spot_search *search, size_t texel)
{
    if (search->seen[texel])
        return;
    search->seen[texel] = true;
    add_light(search, texel);
    if (!is_in_spot(search, texel))
        return;
    texel_place at = place_of(search->size, texel);
    search->area += face_solid_angle(search->size, at.row, at.column);
    search->waiting[search->count++] = (uint32_t)texel;
}

static void grow(spot_search *search, size_t brightest)
{
    visit(search, brightest);
    for (size_t next = 0; next < search->count; next++)
        for (int rows = -1; rows <= 1; rows++)
            for (int columns = -1; columns <= 1; columns++)
                visit(search, neighbour(search->size, search->waiting[next], rows, columns));
}

/* With an edge that keeps the spot small, if there is one. */
static void grow_as_needed(spot_search *search, size_t brightest, inspect_spot *spot)
{
    double greatest = inspect_luminance(search->cube + 3 * brightest);
    texel_direction(search->size, brightest, search->middle);
    for (int i = 0; i < SPOT_EDGE_COUNT && (i == 0 || search->area > SPOT_MOST); i++) {
        spot->edge = SPOT_EDGES[i];
        memset(search->seen, 0, FACE_COUNT * (size_t)search->size * search->size * sizeof search->seen[0]);
        memset(search->light, 0, sizeof search->light);
        search->count = 0;
        search->flux = search->irradiance = search->area = 0;
        search->edge = spot->edge * greatest;
        grow(search, brightest);
    }
}

static size_t find_brightest(const float *cube, size_t texels)
{
    size_t brightest = 0;
    for (size_t i = 1; i < texels; i++)
        if (inspect_luminance(cube + 3 * i) > inspect_luminance(cube + 3 * brightest))
            brightest = i;
    return brightest;
}

static void describe(const spot_search *search, size_t brightest, inspect_findings *found)
{
    inspect_spot *spot = &found->spot;
    double *d = spot->direction,
           length = sqrt(search->light[0] * search->light[0] + search->light[1] * search->light[1] +
                         search->light[2] * search->light[2]);
    for (int i = 0; i < 3; i++)
        d[i] = search->light[i] / length;
    const double degrees = 180 / acos(-1);
    spot->azimuth = atan2(d[0], -d[2]) * degrees;
    if (spot->azimuth < 0)
        spot->azimuth += 360;
    spot->elevation = asin(fmax(fmin(d[1], 1), -1)) * degrees;
    spot->solid_angle = search->area;
    spot->luminance = inspect_luminance(search->cube + 3 * brightest);
    spot->share = found->all_flux > 0 ? fmin(search->flux / found->all_flux, 1) : 0;
    spot->irradiance_share = found->irradiance > 0 ? fmin(search->irradiance / found->irradiance, 1) : 0;
}

bool inspect_find_spot(const float *cube, uint32_t size, inspect_findings *found)
{
    size_t texels = FACE_COUNT * (size_t)size * size, brightest = find_brightest(cube, texels);
    double greatest = inspect_luminance(cube + 3 * brightest);
    found->has_spot = greatest > SPOT_CONTRAST * found->mean_luminance;
    if (!found->has_spot)
        return true;
    spot_search search = {.cube = cube, .size = size};
    search.waiting = malloc(texels * sizeof search.waiting[0]);
    search.seen = malloc(texels * sizeof search.seen[0]);
    bool good = search.waiting != NULL && search.seen != NULL;
    if (good) {
        grow_as_needed(&search, brightest, &found->spot);
        describe(&search, brightest, found);
    } else {
        message_failure("no memory to look for the brightest spot of %s", found->name);
    }
    free(search.waiting);
    free(search.seen);
    return good;
}
