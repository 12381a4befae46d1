/* SPDX-License-Identifier: MIT
 * gathering.h - the light samples of one point on their way to an estimate: what is known of the point, and blocks of
 * samples with what they contribute. */
#ifndef HELIOSTAT_SRC_GATHERING_H
#define HELIOSTAT_SRC_GATHERING_H

#include "sampling/brdf.h"
#include "sampling/point_tiles.h"
#include "sampling/pools.h"

#include <stdalign.h>

enum {
    BLOCK_SAMPLES = 64,
    BLOCK_STRIDE = BLOCK_SAMPLES + POOL_PADDING, /* kernels write whole registers */
};

/* Streams of random numbers of a point. */
enum { STREAM_ROUNDING = 1, STREAM_SURFACE, STREAM_WINDOW, STREAM_BIN };

/* What is known about a point before its samples. All directions are in the map's space. */
typedef struct gathering {
    const helio_pools *pools;
    const helio_environment *environment;
    brdf surface;  /* what reflects */
    brdf proposal; /* what draws surface samples: the surface, or a diffuse stand-in for COSINE */
    brdf_axes proposal_axes;
    vec3 geometric_normal;
    helio_counts counts;
    float expected_in_face[CUBE_FACES]; /* sum_k m_k pdf_k over light techniques is this x pools_density() */
    uint32_t pool;                      /* that technique 0 reads: the bin's, for STRATEGY_LIGHT_BINS */
    uint32_t windows[CUBE_FACES];
    uint32_t surface_seed;
    /* Points that shine and whose pools are of bins read no pool: technique 0 then draws from the tiles as the point
     * itself weighs them. */
    bool has_tiles;
    uint32_t tile_seed;
    point_tiles tiles;
} gathering;

/* face_place_density()'s unit for the density with which the light techniques draw a direction, each weighted with its
 * expected count. */
static inline float gathering_unit_density(const gathering *g, const face_place *at)
{
    const float expected = g->expected_in_face[at->face];
    if (!(expected > 0.0f))
        return 0.0f;
    if (!g->has_tiles)
        return expected * pools_unit_density(g->pools, g->pool, at);
    const tiles *t = g->pools->bins->tiles;
    const uint32_t position = tiles_position(t, at->face, at->row, at->column);
    return expected * (point_tiles_probability(&g->tiles, position) * tiles_unit_density(t, at));
}

/* Samples first ... first + count - 1, in the arrays of all pools, that a technique takes. */
typedef struct pool_piece {
    uint32_t technique, first, count;
} pool_piece;

/* Samples side by side, whatever technique took them, and what each contributes. */
typedef struct sample_block {
    uint32_t count;
    /* As in the pools, but with sum_k m_k pdf_k over the light techniques, 1/sr, as density. */
    alignas(64) float samples[SAMPLE_ARRAYS][BLOCK_STRIDE];
    /* Radiance x BRDF x cosine / density, 0 below a horizon. [BLOCK_STRIDE], 0 from count on to the end of a register.
     */
    alignas(64) float red[BLOCK_STRIDE];
    alignas(64) float green[BLOCK_STRIDE];
    alignas(64) float blue[BLOCK_STRIDE];
    alignas(64) float density[BLOCK_STRIDE]; /* sum_k m_k pdf_k over all techniques, 1/sr */
    float hue[3];                            /* of samples of tiles: sums of listed_sample.hue */
    uint32_t listed[BLOCK_SAMPLES];          /* of samples of tiles: which of the lists' */
} sample_block;

/* Sum of a block. */
typedef struct block_sum {
    float rgb[3];
    uint32_t useful; /* samples that contribute */
} block_sum;

#endif
