/* SPDX-License-Identifier: MIT
 * point_tiles.h - the tiles of the map as one shiny point weighs them: light x BRDF x cosine, each at the centre of a
 * tile. Where bins of normals know the light and the normal, this knows the lobe as well, for the price of a few
 * operations for each tile above the point's horizon. Far from the lobe it is enough to know it once for a group of
 * tiles.
 *
 * Weights become integers, as those of bins do, so that the probability that is reported is the one that is drawn. */
#ifndef HELIOSTAT_SRC_POINT_TILES_H
#define HELIOSTAT_SRC_POINT_TILES_H

#include "sampling/brdf.h"
#include "sampling/tiles.h"

/* What tiles are weighed with: a BRDF in a form that is cheap and smooth, with its lobe no narrower than tiles are, as
 * it stands for all of a tile, or of a group of them. docs/method.md has the formulas. */
typedef struct tile_lobe {
    helio_material_kind kind; /* PHONG or GGX */
    vec3 normal;
    vec3 axis;        /* PHONG: of the mirror direction. GGX: of the view */
    float edge;       /* sine of the radius of a tile: those down to -edge below the horizon reach above it */
    float slope;      /* 1 / (4 edge) */
    float diffuse;    /* luminance of the diffuse lobe, 1/sr */
    float specular;   /* ... and a factor of the specular one */
    float width;      /* PHONG: 1 / exponent, GGX: alpha^2, widened by a tile */
    float to_surface; /* BRDF samples look after x / (1 + x) of the specular light of a tile, x this times its spread */
    float alpha;      /* GGX, as it is: for the masking */
    float view_cosine;
    float least_part;   /* a group of which the specular lobe has more than this part of all light has its tiles weighed
                           by themselves; others share the lobe at its middle */
    bool knows_diffuse; /* leaves the diffuse lobe out for groups that are wholly above the horizons of both normals, */
    vec3 geometric_normal; /* as their diffuse light is known */
} tile_lobe;

/* tile_lobe.least_part is one of so many for a lobe that BRDF samples do not help, and so many times that for one that
 * they have alone. */
enum { POINT_REFINED_PARTS = 256, POINT_REFINED_TIMES = 6 };

/* First groups are chosen, each by the sum of its tiles' weights, then one of its tiles. Of most groups nobody ever
 * asks for the tiles, and so they are weighed when somebody does. */
typedef struct point_tiles {
    uint32_t total;      /* of the weights of all groups; 0 if no light is above the horizon */
    float share;         /* 1 / total, or 0 */
    float brightness;    /* of the light, by tiles.light: what the point is thought to get from light samples */
    float hue[3];        /* mean over the tiles, each with its probability */
    float irradiance[3]; /* of groups whose diffuse light is known, if the lobe leaves it out, in units of radiance */
    alignas(64) float knows_diffuse[TILE_GROUPS]; /* 1 for these, else 0 */
    float left;                                   /* part of the light that is left to BRDF samples, 0 ... 1 */
    uint32_t sums[TILE_GROUPS + 1];               /* prefix sums over groups, below 2^31 */
    bool is_known[TILE_GROUPS];               /* whether the kernel know_tiles() was asked for the tiles of a group */
    alignas(64) uint32_t weights[TILES_MOST]; /* of tiles of such groups; they sum to their group's */
    /* What the tiles of a group follow from. */
    const tiles *tiles;
    vec3 normal;
    alignas(64) float value[TILE_GROUPS];    /* the BRDF that BRDF samples leave, 1/sr */
    alignas(64) float weight[TILE_GROUPS];   /* light x BRDF x cosine; 0 if wholly below the horizon */
    uint8_t is_shared[TILE_GROUPS];          /* all tiles have that BRDF, and are above the horizon; others have been */
    alignas(64) float looked_at[TILES_MOST]; /* looked at: light x BRDF x cosine, also of known groups */
} point_tiles;

/* Part of a point's samples that are best drawn from the specular lobe where light is even, at an even split: nearly
 * all for a mirror, whose lobe is lost in a tile, few where the lobe is wider than tiles are, and in proportion to what
 * it reflects of the light, b->specular_share. */
float tile_lobe_need(const tiles *t, const brdf *b);

/* The same as the light is: between that and what is left when the tiles are weighed. */
static inline float point_tiles_need(const point_tiles *p, float need_of_lobe)
{
    return sqrtf(p->left * need_of_lobe);
}

/* b: with brdf_prepare_share() done for the material's own share. Nothing is known of diffuse light. */
void tile_lobe_prepare(tile_lobe *lobe, const tiles *t, const brdf *b);

/* Probability of a tile, the group of which is known. Drawing and MIS both use this. */
static inline float point_tiles_probability(const point_tiles *p, uint32_t position)
{
    return (float)p->weights[position] * p->share;
}

#endif
