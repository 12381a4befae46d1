/* SPDX-License-Identifier: MIT
 * tile_groups.h - tiles that follow each other in the order of the tiles, and so are neighbours, 16 at a time: where
 * they are, and what light they give together. */
#ifndef HELIOSTAT_SRC_TILE_GROUPS_H
#define HELIOSTAT_SRC_TILE_GROUPS_H

#include <stdalign.h>
#include <stdint.h>

struct tiles;

enum {
    TILE_GROUP = 16, /* tiles of a group: 4 x 4 where a face has 16 x 16 */
    TILE_GROUPS = 96,
    TILE_RUN = 16, /* groups that follow each other: a face where it has 16 x 16 tiles */
    TILE_RUNS = TILE_GROUPS / TILE_RUN,
};

/* [TILE_GROUPS] each, of which those from `count` on are black. */
typedef struct tile_groups {
    uint32_t count;
    alignas(64) float x[TILE_GROUPS]; /* direction to the middle */
    alignas(64) float y[TILE_GROUPS];
    alignas(64) float z[TILE_GROUPS];
    alignas(64) float edge[TILE_GROUPS]; /* of a group whose cosine to a normal is at most the negative of this, no tile
                                            reaches above the horizon */
    alignas(64) float slope[TILE_GROUPS]; /* 1 / (4 edge) */
    alignas(64) float inner[TILE_GROUPS]; /* of one whose cosine is at least this, the centres of all tiles are above
                                             the horizon; 2 where they are too far apart */
    alignas(64) float angle[TILE_GROUPS]; /* sum of tiles.angle */
    /* Of a frame. */
    alignas(64) float light[TILE_GROUPS];   /* sum of tiles.light */
    alignas(64) float light_x[TILE_GROUPS]; /* its mean direction, of unit length */
    alignas(64) float light_y[TILE_GROUPS];
    alignas(64) float light_z[TILE_GROUPS];
    alignas(64) float moment[TILE_GROUPS];         /* sum of tiles.light x cosine to that direction */
    alignas(64) float hue[3][3][TILE_GROUPS];      /* sums of tiles.light x hue x direction (x, y, z), by colour */
    alignas(64) float radiance[3][3][TILE_GROUPS]; /* integrals of radiance x direction, by colour, as tile_colours has
                                                      them of tiles */
    alignas(64) float variance[TILE_GROUPS]; /* of the directions to its tiles about that, rad^2 for small angles */
    alignas(64) float spread[TILE_GROUPS];   /* mean of tiles.spread */
    alignas(64) float peak[TILE_GROUPS];     /* ... and of tiles.peak, each by its light */
} tile_groups;

/* Finds where they are; the tiles' places must be there. */
void tile_groups_place(struct tiles *t);

/* Finds their light; that of the tiles, and its colours, must be there. */
void tile_groups_update(struct tiles *t);

#endif
