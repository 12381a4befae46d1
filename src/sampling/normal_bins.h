/* SPDX-License-Identifier: MIT
 * normal_bins.h - cells of normals, each with a density of its own over the tiles of the map: light x softened cosine.
 * The cells also are those of the directions that lobes point in, see lobe_variance.h.
 *
 * Cells are B x B on each face of a cube, of nearly equal angles. A point shakes its normal before it looks for the
 * cell, so that neighbouring cells blend into each other; the shaking knows neither cells nor faces, so nothing happens
 * at their edges. Whatever normal may choose a bin, the bin's density is above 0 wherever light is above that normal's
 * horizon. */
#ifndef HELIOSTAT_SRC_NORMAL_BINS_H
#define HELIOSTAT_SRC_NORMAL_BINS_H

#include "sampling/lobe_variance.h"
#include "sampling/rules.h"
#include "sampling/tiles.h"

enum { NORMAL_BINS_DEFAULT = 8, NORMAL_BINS_MOST = 32 };

/* How lists of the tiles are sized. */
enum {
    LIST_LEAST = 8,  /* samples of a tile that gives light: as many as a sharp lobe may want of it */
    LIST_FACTOR = 4, /* samples of a tile for each that a pool takes */
    BINS_LOOKED_AT = 48,
};

/* What a cell of normals weighs tiles with. */
typedef struct normal_bin {
    vec3 centre;
    float reach; /* a tile is weighed if its centre's cosine to the bin's is above -reach: the sine of the largest angle
                    between centre and normal + that between tile and direction; above 1 for all tiles */
} normal_bin;

/* A direction drawn inside of a tile. In fours, which registers like. */
typedef struct listed_sample {
    float direction[4];         /* and its cosine to the tile's centre */
    float radiance[3], density; /* 1/sr, given the tile */
    float weighted[4];          /* radiance / density, and 0 */
    float hue[4];               /* weighted x that cosine, in relation to the tile's brightness, and 0 */
} listed_sample;

typedef struct normal_bins {
    helio_context *context;
    tiles *tiles;
    uint32_t per_edge;     /* B */
    uint32_t count;        /* 6 B^2 */
    float shake;           /* see normal_bins_shaken() */
    normal_bin *bins;      /* [count] */
    uint32_t *sums;        /* [count][tiles + 1]: prefix sums of the weights of the tiles, in their order */
    float *shares;         /* [count]: 1 / the sum of all, or 0 */
    float *lobe_variances; /* [count][LOBE_CLASSES]: of lobes about the centre of each; or NULL, nobody will ask */
    uint64_t frame;        /* of the tables, when weighed */
    /* Samples of each tile, from which all pools are made. A list is a few times as long as what any pool takes from
     * it. [starts[count of tiles]], at most `capacity`. */
    uint32_t pool_length, capacity;
    uint32_t list_starts[TILES_MOST + 1];
    listed_sample *listed;
} normal_bins;

/* per_edge: B. size: of the cube. pool_length: of the pools to be made. has_lobes: somebody asks for lobe_variances. */
helio_status normal_bins_create(helio_context *context, uint32_t per_edge, uint32_t size, uint32_t pool_length,
                                bool has_lobes, normal_bins **out);
void normal_bins_destroy(normal_bins *b);

/* Weighs the tiles of the tables' frame, unless that is done. No memory is taken. */
void normal_bins_update(normal_bins *b, const helio_tables *tables);

/* Draws the lists of the tiles anew. */
void normal_bins_draw_lists(normal_bins *b, const helio_tables *tables, uint32_t seed);

/* How many samples all lists hold together. */
static inline uint32_t normal_bins_listed(const normal_bins *b)
{
    return b->list_starts[b->tiles->count];
}

/* The weight of a tile's light at a cosine between its centre and that of a bin, see docs/method.md. */
static inline float normal_bin_cosine(const normal_bin *bin, float cosine)
{
    const float edge = RULE_BIN_EDGE * bin->reach;
    float within = cosine + bin->reach, risen = cosine + edge;
    within = within > 0.0f ? within : 0.0f;
    risen = risen > 0.0f ? risen : 0.0f;
    float bent = risen * risen * (1.0f / (4.0f * edge)); /* meets the cosine at `edge`, where both rise by 1 */
    return (cosine < edge ? bent : cosine) + RULE_BIN_LEAST * within;
}

/* From one bin that is looked at to the next: odd, so that it meets all columns of cells. */
static inline uint32_t normal_bins_step(const normal_bins *b)
{
    return b->count / BINS_LOOKED_AT | 1;
}

/* Prefix sums of a bin: [tiles + 1]. */
static inline const uint32_t *normal_bins_sums(const normal_bins *b, uint32_t bin)
{
    return b->sums + (size_t)bin * (b->tiles->count + 1);
}

/* Probability of a tile given the bin, by the bin's prefix sums and its share for a unit of weight. */
static inline float normal_bins_probability_by(const uint32_t *sums, uint32_t position, float share)
{
    return (float)(int32_t)(sums[position + 1] - sums[position]) * share; /* below 2^31 */
}

static inline float normal_bins_probability(const normal_bins *b, uint32_t bin, uint32_t position)
{
    return normal_bins_probability_by(normal_bins_sums(b, bin), position, b->shares[bin]);
}

/* face_place_density()'s unit for the density given the bin. */
static inline float normal_bins_unit_density(const normal_bins *b, uint32_t bin, const face_place *at)
{
    const uint32_t position = tiles_position(b->tiles, at->face, at->row, at->column);
    return normal_bins_probability(b, bin, position) * tiles_unit_density(b->tiles, at);
}

/* ---- the bin of a normal ---- */

/* Cells have borders at equal steps of this: 4/pi atan(u) nearly, by a polynomial that leaves -1, 0 and 1 alone. */
static inline float normal_bins_warp(float u)
{
    return u * (1.25f - 0.25f * u * u);
}

/* The normal moved by up to `shake` along each axis, evenly. Not a unit vector. */
static inline vec3 normal_bins_shaken(const normal_bins *b, vec3 normal, uint32_t random)
{
    const float step = b->shake / 512.0f;
    return (vec3){normal.x + ((float)(int32_t)(random & 1023u) - 511.5f) * step,
                  normal.y + ((float)(int32_t)((random >> 10) & 1023u) - 511.5f) * step,
                  normal.z + ((float)(int32_t)((random >> 20) & 1023u) - 511.5f) * step};
}

/* The cell of a vector of any length but 0. */
static inline uint32_t normal_bins_cell(uint32_t per_edge, vec3 v)
{
    cube_position at = cube_project(v);
    uint32_t row = cube_texel(normal_bins_warp(at.v), per_edge), column = cube_texel(normal_bins_warp(at.u), per_edge);
    return (at.face * per_edge + row) * per_edge + column;
}

#endif
