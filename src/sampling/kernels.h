/* SPDX-License-Identifier: MIT
 * kernels.h - the inner loops that are built once for each instruction set, and how to get those of one.
 *
 * The files named ..._kernel.c are compiled with HELIO_ISA, the suffix of their functions' names, and HELIO_LANES, how
 * many floats a register holds (1 for the scalar build, the definition of the others). They hold no state and no
 * policy: what to compute is decided elsewhere. */
#ifndef HELIOSTAT_SRC_KERNELS_H
#define HELIOSTAT_SRC_KERNELS_H

#include "core/isa.h"
#include "sampling/gathering.h"
#include "sampling/normal_bins.h"
#include "sampling/point_block.h"
#include "sampling/tables.h"

#define KERNEL_JOIN(name, set) name##_##set
#define KERNEL_NAME(name, set) KERNEL_JOIN(name, set)
#define KERNEL(name) KERNEL_NAME(name, HELIO_ISA)

struct background;
struct colour_sums;
struct column_colours;
struct control_matrix;
struct exposure_columns;
struct face_points;
struct overlap_tile;
struct resampling;
struct resampling_space;
struct view_group;
struct sky_light;
struct sky_row;
struct texel_moments;
struct texel_rows;

typedef struct kernel_set {
    /* Prefix sums of the weights of one row of texels. rgb: [size][3]. solid_angles: [size], or NULL for luminance
     * alone. level: luminance that does not count, 0 for luminance alone. sums: [size + 1], or NULL if only the total
     * is wanted. The same bits with every instruction set. */
    row_sum (*sum_row)(const float *rgb, const float *solid_angles, float level, uint32_t size, uint32_t *sums);

    /* Prefix sums of the weights that a bin of normals gives to the tiles. sums: [tiles + 1]. Returns their total. The
     * same bits with every instruction set. */
    uint32_t (*weigh_tiles)(const tiles *t, const normal_bin *bin, uint32_t *sums);

    /* How uneven the light is in lobes of each class about an axis: the variance of one sample of a point in such a
     * lobe that weighs no tiles, as part of the square of the mean. The same bits with every instruction set. */
    void (*find_lobe_variances)(const tiles *t, vec3 axis, float variances[LOBE_CLASSES]);

    /* The integrals of direction over rows of texels; and adds radiance x these to sums over the columns. rgb:
     * [rows][count][3], rows `stride` floats apart. */
    void (*find_moments)(const struct texel_rows *texels, struct texel_moments *moments);
    void (*add_texels)(const struct texel_rows *texels, const float *rgb, size_t stride,
                       const struct texel_moments *moments, struct column_colours *sums);

    /* Sums of columns first ... end - 1. u: of the columns. */
    struct colour_sums (*sum_columns)(const struct column_colours *columns, const float *u, uint32_t first,
                                      uint32_t end);

    /* The known light of a bin of normals, from that of the tiles. */
    void (*know_bin)(const tiles *t, const normal_bin *bin, struct control_matrix *known);

    /* Weighs groups of tiles for one point. But for hues and irradiance, the same bits with every instruction set. */
    void (*weigh_point)(const tiles *t, const tile_lobe *lobe, point_tiles *p);

    /* Sees to it that the probabilities of a group's tiles can be read. The same bits with every instruction set. */
    void (*know_tiles)(point_tiles *p, uint32_t group);

    /* Draws samples first ... first + count - 1 of the pool of a face or the map that is not black. seed: of the pool.
     * The same bits with every instruction set. */
    void (*draw_pool)(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed);

    /* Draws the lists of tiles first ... end - 1 anew. seed: of all lists. Draws the pool of a bin that is not black
     * from the lists of the tiles, and its sums for the control variate. seed: of the pool. The same bits with every
     * instruction set. */
    void (*draw_tiles)(normal_bins *bins, const helio_tables *tables, uint32_t first, uint32_t end, uint32_t seed);
    void (*draw_bin)(helio_pools *pools, uint32_t bin, uint32_t seed);

    /* Prepares points for their samples: turns their directions to the map's space, lifts views that graze, and fills
     * in counts and windows. The same bits with every instruction set. */
    void (*prepare_points)(const helio_pools *pools, const helio_estimate_desc *desc, point_block *block);

    /* A part of it. Realised counts: systematic rounding of the expected ones. Each has its expected value as mean over
     * `rounding`, and they sum to samples exactly (or to 0, if all expected counts are 0). */
    void (*round_counts)(uint32_t samples, point_block *block);

    /* The unoccluded light of those points whose samples all come from pools, without the intensity of the environment.
     * samples: of each. surfaces, sums: [block->count] */
    void (*sum_light)(const helio_pools *pools, uint32_t samples, const point_block *block, const brdf *surfaces,
                      block_sum *sums);

    /* Choose samples first ... first + count - 1, of those that a point draws from the tiles as it weighs them itself
     * and of those of the surface technique, and send for what is to be read of them, which takes its time: neither is
     * in a block yet. The same bits with every instruction set, as with those that follow. */
    void (*choose_tiles)(gathering *g, uint32_t first, uint32_t count, sample_block *block);
    void (*aim_surface)(const gathering *g, uint32_t first, uint32_t count, sample_block *block);

    /* Add samples to a block, which must have room: those that have been chosen, the tiles' first of all and the
     * surface's last of all, and pieces of pools. */
    void (*take_tiles)(const gathering *g, sample_block *block);
    void (*take_pools)(const gathering *g, const pool_piece *pieces, uint32_t piece_count, sample_block *block);
    void (*take_surface)(gathering *g, sample_block *block);

    /* What the samples of a block contribute, and the sum. */
    void (*weigh)(const gathering *g, sample_block *block);
    block_sum (*sum_block)(const sample_block *block);

    /* background_fill(), except for those points whose numbers are written to left: [count]. Returns how many these
     * are. */
    uint32_t (*fill_background)(const struct background *b, uint32_t count, const float *x, const float *y,
                                float (*rgba)[4], uint32_t *left);

    /* Radiance of the sky along a row of texel centres. rgb: one array [count][3] for the top face, or one for each of
     * the side faces. The same bits with every instruction set. */
    void (*fill_sky)(const struct sky_light *light, const struct sky_row *row, float *const *rgb);

    /* The texels of a tile in four views. Returns whether some of their pixels were no light. The same bits with every
     * instruction set. */
    bool (*resample)(const struct resampling *work, const struct view_group *group, const struct overlap_tile *tile,
                     struct resampling_space *space);

    /* Is there perhaps a pixel among these numbers that is not light? Surely not if this is false. */
    bool (*may_have_faults)(const void *numbers, uint32_t count, map_numbers kind);

    /* Adds texels of a row to the sums of their columns. rgb: [count][3]. solid_angles: [count]. v: of the row's
     * centre. The same bits with every instruction set. */
    void (*add_light)(const float *rgb, const float *solid_angles, float v, uint32_t count,
                      struct exposure_columns *sums);

    /* Fills a block with the directions of places of a face, and their light: radiance x solid angle, density 1. The
     * same bits with every instruction set. */
    void (*aim)(const struct face_points *points, sample_block *block);
} kernel_set;

const kernel_set *kernels_of(isa set);

#ifdef HELIO_ISA
_Static_assert(HELIO_LANES <= POOL_PADDING && BLOCK_SAMPLES % HELIO_LANES == 0 && POINT_BLOCK % HELIO_LANES == 0,
               "kernels read and write whole registers, also past the last sample");

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, float level, uint32_t size, uint32_t *sums);
uint32_t KERNEL(weigh_tiles)(const tiles *t, const normal_bin *bin, uint32_t *sums);
void KERNEL(find_lobe_variances)(const tiles *t, vec3 axis, float variances[LOBE_CLASSES]);
void KERNEL(find_moments)(const struct texel_rows *texels, struct texel_moments *moments);
void KERNEL(add_texels)(const struct texel_rows *texels, const float *rgb, size_t stride,
                        const struct texel_moments *moments, struct column_colours *sums);
struct colour_sums KERNEL(sum_columns)(const struct column_colours *columns, const float *u, uint32_t first,
                                       uint32_t end);
void KERNEL(know_bin)(const tiles *t, const normal_bin *bin, struct control_matrix *known);
void KERNEL(weigh_point)(const tiles *t, const tile_lobe *lobe, point_tiles *p);
void KERNEL(know_tiles)(point_tiles *p, uint32_t group);
void KERNEL(draw_pool)(helio_pools *pools, uint32_t pool, uint32_t first, uint32_t count, uint32_t seed);
void KERNEL(draw_tiles)(normal_bins *bins, const helio_tables *tables, uint32_t first, uint32_t end, uint32_t seed);
void KERNEL(draw_bin)(helio_pools *pools, uint32_t bin, uint32_t seed);
void KERNEL(prepare_points)(const helio_pools *pools, const helio_estimate_desc *desc, point_block *block);
void KERNEL(round_counts)(uint32_t samples, point_block *block);
void KERNEL(sum_light)(const helio_pools *pools, uint32_t samples, const point_block *block, const brdf *surfaces,
                       block_sum *sums);
void KERNEL(choose_tiles)(gathering *g, uint32_t first, uint32_t count, sample_block *block);
void KERNEL(aim_surface)(const gathering *g, uint32_t first, uint32_t count, sample_block *block);
void KERNEL(take_tiles)(const gathering *g, sample_block *block);
void KERNEL(take_pools)(const gathering *g, const pool_piece *pieces, uint32_t piece_count, sample_block *block);
void KERNEL(take_surface)(gathering *g, sample_block *block);
void KERNEL(weigh)(const gathering *g, sample_block *block);
block_sum KERNEL(sum_block)(const sample_block *block);
uint32_t KERNEL(fill_background)(const struct background *b, uint32_t count, const float *x, const float *y,
                                 float (*rgba)[4], uint32_t *left);
void KERNEL(fill_sky)(const struct sky_light *light, const struct sky_row *row, float *const *rgb);
bool KERNEL(resample)(const struct resampling *work, const struct view_group *group, const struct overlap_tile *tile,
                      struct resampling_space *space);
bool KERNEL(may_have_faults)(const void *numbers, uint32_t count, map_numbers kind);
void KERNEL(add_light)(const float *rgb, const float *solid_angles, float v, uint32_t count,
                       struct exposure_columns *sums);
void KERNEL(aim)(const struct face_points *points, sample_block *block);
extern const kernel_set KERNEL(kernels);
#endif

#endif
