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
enum { STREAM_ROUNDING = 1, STREAM_SURFACE, STREAM_WINDOW, STREAM_BIN, STREAM_LOBE };

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
    /* Where pools are of bins most points that shine read none: technique 0 then draws from the tiles as the point
     * itself weighs them. */
    bool has_tiles;
    bool knows_diffuse; /* part of the diffuse light of such a point is known, and left out of its samples */
    uint32_t tile_seed;
    point_tiles tiles;
} gathering;

/* Samples first ... first + count - 1, in the arrays of all pools, that a technique takes. */
typedef struct pool_piece {
    uint32_t technique, first, count;
} pool_piece;

/* Surface samples that wait for the texels that they meet. [count] each. */
typedef struct surface_aim {
    uint32_t count;
    float x[BLOCK_SAMPLES], y[BLOCK_SAMPLES], z[BLOCK_SAMPLES];
    uint32_t face[BLOCK_SAMPLES], row[BLOCK_SAMPLES], column[BLOCK_SAMPLES];
    uint32_t line[BLOCK_SAMPLES];     /* the row, counted through all faces */
    uint32_t index[BLOCK_SAMPLES];    /* of all texels */
    uint32_t tile[BLOCK_SAMPLES];     /* its position; only of bins, and where somebody asks, ... */
    uint32_t segment[BLOCK_SAMPLES];  /* ... as this: see tiles_segment() */
    uint32_t mirrored[BLOCK_SAMPLES]; /* of the solid angle, see texel_weight.h */
    float u[BLOCK_SAMPLES], v[BLOCK_SAMPLES];
} surface_aim;

/* Samples side by side, whatever technique took them, and what each contributes. */
typedef struct sample_block {
    uint32_t count;
    uint32_t draw_count;
    tile_draw draws[BLOCK_SAMPLES]; /* [draw_count]: of samples of tiles, which come first */
    surface_aim aim;
    /* As in the pools, but with sum_k m_k pdf_k over the light techniques, 1/sr, as density. */
    alignas(64) float samples[SAMPLE_ARRAYS][BLOCK_STRIDE];
    /* Radiance x BRDF x cosine / density, 0 below a horizon. [BLOCK_STRIDE], 0 from count on to the end of a register.
     */
    alignas(64) float red[BLOCK_STRIDE];
    alignas(64) float green[BLOCK_STRIDE];
    alignas(64) float blue[BLOCK_STRIDE];
    alignas(64) float known[BLOCK_STRIDE];   /* of points that know diffuse light: part of it that is known there */
    alignas(64) float density[BLOCK_STRIDE]; /* sum_k m_k pdf_k over all techniques, 1/sr */
    float hue[3];                            /* of samples of tiles: sums of listed_sample.hue */
} sample_block;

/* Sum of a block. */
typedef struct block_sum {
    float rgb[3];
    uint32_t useful; /* samples that contribute */
} block_sum;

#endif
