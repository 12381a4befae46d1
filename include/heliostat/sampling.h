/* SPDX-License-Identifier: MIT
 *
 * sampling.h - the heart: tables that turn a cube into a density, pools of samples drawn from them, and the estimate of
 * the light that leaves a shading point.
 *
 *   environment --update--> tables --draw--> pools --gather / estimate--> radiance
 *
 * The method is that of Lu, Pacanowski, Granier, "Real-Time Importance Sampling of Dynamic Environment Maps",
 * Eurographics 2013 (short papers), called "the paper" below; docs/method.md has the mathematics.
 */
#ifndef HELIOSTAT_SAMPLING_H
#define HELIOSTAT_SAMPLING_H

#include <heliostat/core.h>
#include <heliostat/environment.h>
#include <heliostat/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- tables: one density per face ------------------------------------------------- */

typedef enum helio_weighting {
    HELIO_WEIGHTING_SOLID_ANGLE = 0, /* a texel's weight is luminance x solid angle */
    HELIO_WEIGHTING_PAPER,           /* luminance alone, as the paper's Eq. 1 is written */
    HELIO_WEIGHTING_COMPENSATED,     /* (luminance above the mean of the map) x solid angle: MIS compensation in its
                                        simplest     form (Karlik et al., "MIS Compensation", SIGGRAPH Asia 2019). For
                                        LIGHT_BRDF and     FACE_BRDF alone, whose BRDF samples see to the rest */
} helio_weighting;

HELIO_API const char *helio_weighting_name(helio_weighting weighting);
HELIO_API helio_status helio_weighting_parse(const char *name, helio_weighting *weighting);

typedef struct helio_tables helio_tables;

/* Takes the memory for the tables of an environment. Call helio_tables_update() before drawing. */
HELIO_API helio_status helio_tables_create(helio_environment *environment, helio_weighting weighting,
                                           helio_tables **tables);
HELIO_API void helio_tables_destroy(helio_tables *tables);

/* Builds the tables of the environment's current frame: for each face, uint32 prefix sums along the rows and over the
 * row sums. Integer sums are exact, so equal cubes give equal bits on any machine and any number of threads. */
HELIO_API helio_status helio_tables_update(helio_tables *tables);

/* The frame (helio_environment_frame) that the tables belong to; 0 before the first update. */
HELIO_API uint64_t helio_tables_frame(const helio_tables *tables);

/* One direction drawn from the table of a face. Directions are in the map's space: before orientation. */
typedef struct helio_table_sample {
    float direction[3];
    float radiance[3]; /* of the texel, without intensity */
    float density;     /* 1/sr, given the face: the paper's Eq. 1 with the stored weights; > 0 */
    uint32_t row, column;
} helio_table_sample;

/* Inverts the CDF of a face (0..5): v picks the row, u the column, each in [0, 1). false, and nothing written, if the
 * face is black. u and v carry 24 bits: cells less probable than 2^-24 may be missed near 1 (pools draw with 32 bits).
 * Call helio_tables_update() after each update of the environment, or radiance and density belong to different frames.
 */
HELIO_API bool helio_tables_sample(const helio_tables *tables, uint32_t face, float u, float v,
                                   helio_table_sample *sample);

/* The density with which helio_tables_sample() picks this direction, given its face: the same function of the same
 * stored numbers. face receives the face that holds the direction; may be NULL. 0 where the map is black. */
HELIO_API float helio_tables_density(const helio_tables *tables, const float direction[3], uint32_t *face);

/* Flux of each face, integral of luminance, as the tables have it: radiance unit x sr. */
HELIO_API void helio_tables_flux(const helio_tables *tables, double flux[6]);

/* The stored numbers of a face, for tests and for engines that upload them. */
typedef struct helio_table_view {
    uint32_t size;            /* R */
    const uint32_t *rows;     /* [R][R + 1], prefix sums along each row, starting with 0 */
    const uint32_t *marginal; /* [R + 1], prefix sums of the row weights, starting with 0 */
} helio_table_view;

HELIO_API helio_table_view helio_tables_view(const helio_tables *tables, uint32_t face);

/* ---- strategies --------------------------------------------------------------------- */

typedef enum helio_strategy {
    HELIO_STRATEGY_AUTO = 0, /* the best we have: PRODUCT_BRDF, but for frames whose light is so even that it does not
                                pay to aim at it: BRDF */
    HELIO_STRATEGY_COSINE,   /* cosine about the normal */
    HELIO_STRATEGY_BRDF,     /* the material's own sampling */
    HELIO_STRATEGY_LIGHT,    /* one table over the whole map, blind to the normal: what most renderers do */
    HELIO_STRATEGY_LIGHT_BRDF,
    HELIO_STRATEGY_FACE, /* the paper: a pool per face, samples spread over faces by flux x beta(normal) */
    HELIO_STRATEGY_FACE_BRDF,
    HELIO_STRATEGY_PRODUCT, /* past the paper: a pool per bin of normals, each drawn from light x softened cosine */
    HELIO_STRATEGY_PRODUCT_BRDF,
} helio_strategy;

HELIO_API const char *helio_strategy_name(helio_strategy strategy);
HELIO_API helio_status helio_strategy_parse(const char *name, helio_strategy *strategy);

/* What AUTO stands for in this version, even light apart; any other strategy is returned as it is. */
HELIO_API helio_strategy helio_strategy_resolve(helio_strategy strategy);

/* HELIO_ERR_ARGUMENT if a strategy cannot use tables of this weighting: compensated ones leave light out, to which only
 * LIGHT_BRDF and FACE_BRDF send BRDF samples everywhere. Strategies without light samples use no tables. */
HELIO_API helio_status helio_strategy_check_weighting(helio_strategy strategy, helio_weighting weighting);

/* ---- pools: samples drawn ahead, read by every shading point ------------------------- */

typedef struct helio_pools helio_pools;

typedef struct helio_pools_desc {
    helio_strategy strategy;
    uint32_t length; /* M, samples per pool: a power of two, 64..65536; default 1024, for PRODUCT 256. LIGHT has
                        one pool of 6 M. */
    uint32_t bins;   /* B, for PRODUCT: 6 B^2 bins of normals, 1..32; default 8 */
} helio_pools_desc;

/* desc may be NULL. Takes the memory; call helio_pools_draw() before gathering. */
HELIO_API helio_status helio_pools_create(helio_tables *tables, const helio_pools_desc *desc, helio_pools **pools);
HELIO_API void helio_pools_destroy(helio_pools *pools);

/* Redraws all pools from the tables at Owen-scrambled Sobol' points. Each (seed, pass) gives other points.
 * HELIO_ERR_ARGUMENT if the tables are not those of the environment's current frame: light of frame t never comes from
 * tables of frame t - 1. */
HELIO_API helio_status helio_pools_draw(helio_pools *pools, uint32_t seed, uint32_t pass);

/* Most samples that one gather may take from these pools: M / 8, for PRODUCT M / 4. */
HELIO_API uint32_t helio_pools_sample_limit(const helio_pools *pools);

/* How many pools there are: 6, one for each face (FACE), 1 (LIGHT), 6 B^2 (PRODUCT), or 0. From how many of them a
 * point takes samples: 6, 1, 1 or 0, the first entries of helio_counts. And how many samples each holds: M, or 6 M for
 * LIGHT. */
HELIO_API uint32_t helio_pools_count(const helio_pools *pools);
HELIO_API uint32_t helio_pools_techniques(const helio_pools *pools);
HELIO_API uint32_t helio_pools_length(const helio_pools *pools);

/* In PRODUCT_BRDF a point that shines mostly reads no pool: it weighs tiles of the map by light x BRDF x cosine itself,
 * and takes samples from the lists of these tiles. helio_counts then names this as its pool. Where the light in a lobe
 * that shines alone is calm, a few samples of its bin's pool and many of the BRDF do as well. */
#define HELIO_POOL_OF_TILES 0xffffffffu

/* How many samples the lists of the tiles hold together in this frame; 0 where there are none. */
HELIO_API uint32_t helio_pools_listed(const helio_pools *pools);

/* One sample of a pool, as every point that reads it finds it. */
typedef struct helio_pool_sample {
    float direction[3]; /* in the map's space: before orientation */
    float radiance[3];  /* of the texel, without intensity */
    float density;      /* 1/sr, given the pool, or the tile for HELIO_POOL_OF_TILES; 0 in a pool without light */
} helio_pool_sample;

/* Copies samples first ... first + count - 1 of a pool, or for HELIO_POOL_OF_TILES of the lists of all tiles. samples:
 * [count]. HELIO_ERR_ARGUMENT where there are no such samples, and before the first draw. */
HELIO_API helio_status helio_pools_read(const helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count,
                                        helio_pool_sample *samples);

/* ---- shading points ------------------------------------------------------------------ */

/* Directions must have unit length (to 1e-3) and the material must pass helio_material_check(): helio_count(),
 * helio_gather() and helio_estimate() answer HELIO_ERR_ARGUMENT otherwise. */
typedef struct helio_shading_point {
    float position[3];         /* metres; only handed to the visibility function */
    float normal[3];           /* shading normal, on the viewer's side of the surface */
    float geometric_normal[3]; /* of the flat surface, likewise; light from below it is not counted. Default: normal */
    float view[3]; /* towards the eye. Where normal . view < 1e-3, view is moved along the normal until it is
                                  1e-3: the one rule for grazing views, for all materials. */
    helio_material material;
    uint32_t seed; /* picks windows of the pools and rounds counts: a hash of the pixel, say. Points with the
                                  same seed use the same samples. */
} helio_shading_point;

/* Does light reach the point along these world-space directions? x, y and z: [count] each, one direction in three
 * arrays as ray tracers like it; visible: [count], to be filled. count is 1..64. */
typedef void (*helio_visibility)(void *user, const helio_shading_point *point, uint32_t count, const float *x,
                                 const float *y, const float *z, bool *visible);

typedef struct helio_estimate_desc {
    uint32_t samples; /* N_s, light + BRDF samples, 1..helio_pools_sample_limit(); default 64 or that limit */
    float brdf_share; /* part of N_s for the BRDF in ..._BRDF, 0 < share < 1; default 0.5. PRODUCT_BRDF finds a
                                    part of its own for each point, 0 for matte ones, which this moves: its odds are
                                    multiplied by those of the share */
    bool no_beta;     /* spread samples by flux alone over the faces that reach above the horizon: shows the
                                    discontinuities of the paper's supplement, Figure 1 */
    bool no_control;  /* leave out the control variate, see helio_counts */
    helio_visibility visibility; /* default: nothing is in the way */
    void *user;                  /* handed to visibility */
    /* For helio_gather() and helio_count(), without effect beside a visibility function: nobody will look for what is
     * in the way of the samples. They are then those of helio_estimate(), which leave out light that is known, and
     * control has it. */
    bool is_free;
} helio_estimate_desc;

/* Expected counts m and realised counts of the techniques that share N_s: faces 0..5 (FACE), or the whole map (LIGHT)
 * or the pool of the point's bin or its tiles (PRODUCT) in entry 0, and the BRDF or cosine technique in entry 6. */
typedef struct helio_counts {
    float expected[7];
    uint32_t realised[7]; /* sums to N_s exactly, or to 0 if there is no light to sample */
    uint32_t pool[7];     /* that a light technique reads, or HELIO_POOL_OF_TILES; else 0. Filled by helio_count(),
                             as is: */
    uint32_t first[7];    /* a light technique takes samples first ... first + realised - 1 of its pool; else 0, and
                             for HELIO_POOL_OF_TILES */
    /* The control variate of PRODUCT and PRODUCT_BRDF, radiance: what is known exactly of the light of a matte point's
     * bin, or of the colours of the tiles that a shiny point weighs, less what the point's samples say of it, and so 0
     * on average; half of that where desc has a visibility function. The estimate is the sum of the visible
     * contributions and this. May be negative; 0 where there is none. Hosts that trace the samples themselves may take
     * any part of it, and half is good.
     *
     * Where desc says is_free all of it must be taken: there it holds diffuse light of shiny points as well, that of
     * tiles well above the horizon, which the samples leave out. */
    float control[3];
} helio_counts;

/* One light sample of a point. The estimate is the sum of all contributions that are visible, and
 * helio_counts.control. */
typedef struct helio_sample {
    float direction[3];    /* world space */
    float contribution[3]; /* radiance x BRDF x cosine / sum_k m_k pdf_k: the balance heuristic, already divided; where
                              desc says is_free without known light, and then it may be below 0 */
    float density;         /* sum_k m_k pdf_k, 1/sr: the samples' total density at this direction */
    uint32_t technique;    /* entry of helio_counts that drew it */
    uint32_t number;       /* of a light technique: in its pool; else 0 */
} helio_sample;

/* How a point divides its samples. */
HELIO_API helio_status helio_count(const helio_pools *pools, const helio_shading_point *point,
                                   const helio_estimate_desc *desc, helio_counts *counts);

/* Writes N_s samples (or none, where there is no light) for hosts that trace or shadow-map them themselves: technique
 * by technique, and of each in the order of its pool, from helio_counts.first on.
 * samples: [desc->samples], or [64] where desc is NULL or leaves samples at 0. visibility is not called. count receives
 * how many were written. */
HELIO_API helio_status helio_gather(const helio_pools *pools, const helio_shading_point *point,
                                    const helio_estimate_desc *desc, helio_sample *samples, uint32_t *count);

typedef struct helio_estimate_info {
    uint32_t samples; /* taken */
    uint32_t useful;  /* of them, those above the horizon, with a contribution > 0 */
    uint32_t rays;    /* visibility tests */
} helio_estimate_info;

/* The radiance that leaves the point towards the eye by direct light from the environment, with orientation and
 * intensity. Unbiased for any strategy. desc and info may be NULL. */
HELIO_API helio_status helio_estimate(const helio_pools *pools, const helio_shading_point *point,
                                      const helio_estimate_desc *desc, float radiance[3], helio_estimate_info *info);

/* The same, to the bit, for many points: the pixels of a tile, say. Registers of points are prepared together, which
 * halves the time of strategies without BRDF samples where visibility is not asked for. points, radiance and infos:
 * [count]; infos may be NULL. Where a point is at fault, those before it may have been written. */
HELIO_API helio_status helio_estimate_points(const helio_pools *pools, uint32_t count,
                                             const helio_shading_point *points, const helio_estimate_desc *desc,
                                             float (*radiance)[3], helio_estimate_info *infos);

/* ---- BRDFs ---------------------------------------------------------------------------- */

/* BRDF value, 1/sr, [3]; 0 where either direction is below the normal. view is as given: the rule for grazing views is
 * the caller's (see helio_shading_point). */
HELIO_API void helio_brdf_value(const helio_material *material, const float normal[3], const float view[3],
                                const float light[3], float value[3]);

/* Draws a light direction for view; u: [3] in [0, 1). The direction may lie below the normal: it then counts as a
 * sample without light. Returns its density (the same function as helio_brdf_density). */
HELIO_API float helio_brdf_sample(const helio_material *material, const float normal[3], const float view[3],
                                  const float u[3], float light[3]);

/* Density with which helio_brdf_sample() draws light. */
HELIO_API float helio_brdf_density(const helio_material *material, const float normal[3], const float view[3],
                                   const float light[3]);

#ifdef __cplusplus
}
#endif
#endif
