/* SPDX-License-Identifier: MIT
 *
 * Samples of the surface technique: scrambled points, directions, and the light found there. */
#include "core/random.h"
#include "env/environment.h"
#include "sampling/kernels.h"
#include "sampling/texel_weight.h"

#include <string.h>

/* Directions of samples first ... first + count - 1 of the point's own set of scrambled points. */
static inline __attribute__((always_inline)) void draw_directions(helio_material_kind kind, const gathering *g,
                                                                  uint32_t first, uint32_t count, float *restrict x,
                                                                  float *restrict y, float *restrict z)
{
    const brdf proposal = g->proposal;
    const brdf_axes axes = g->proposal_axes;
    const uint32_t seed_u = dimension_seed(g->surface_seed, 0), seed_lobe = dimension_seed(g->surface_seed, 1);
    const uint32_t seed_v = dimension_seed(g->surface_seed, 2);
    const float per_sample = 1.0f / (float)g->counts.realised[TECHNIQUE_SURFACE];
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        float u = unit_float(owen_scramble_reversed(first + i, seed_u));
        float v = stratified_unit(first + i, per_sample, seed_v);
        float lobe = unit_float(owen_scramble_reversed(pascal_transform(first + i), seed_lobe));
        vec3 direction = brdf_sample_of(kind, &proposal, &axes, lobe, u, v);
        x[i] = direction.x;
        y[i] = direction.y;
        z[i] = direction.z;
    }
}

/* Where each direction of samples begin ... end - 1 meets the cube. */
static void find_texels(const gathering *g, uint32_t begin, uint32_t end, surface_aim *aim)
{
    const uint32_t size = g->environment->size;
    surface_aim *restrict to = aim;
#pragma omp simd
    for (uint32_t i = begin; i < end; i++) {
        cube_position at = cube_project((vec3){to->x[i], to->y[i], to->z[i]});
        to->face[i] = at.face;
        to->u[i] = at.u;
        to->v[i] = at.v;
        const uint32_t row = cube_texel(at.v, size), column = cube_texel(at.u, size);
        to->row[i] = row;
        to->column[i] = column;
        to->line[i] = at.face * size + row;
        to->index[i] = (at.face * size + row) * size + column;
        to->mirrored[i] = texel_mirrored(size, row, column);
    }
}

static const float *texel_at(const gathering *g, const surface_aim *aim, uint32_t i)
{
    return g->environment->cube + 3 * (size_t)aim->index[i];
}

static bool has_light_techniques(const gathering *g)
{
    float expected = 0.0f;
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        expected += g->expected_in_face[face];
    return expected > 0.0f;
}

static inline __attribute__((always_inline)) void find_tiles(const tiles *t, uint32_t begin, uint32_t end,
                                                             surface_aim *aim)
{
    const uint32_t per_edge = t->per_edge;
    const float per_texel = 1.0f / (float)t->size;
    surface_aim *restrict to = aim;
#pragma omp simd
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t row = tiles_of_line(per_edge, per_texel, to->row[i]);
        const uint32_t column = tiles_of_line(per_edge, per_texel, to->column[i]);
        to->tile[i] = (to->face[i] * per_edge + row) * per_edge + column;
        to->segment[i] = to->line[i] * per_edge + column;
    }
    for (uint32_t i = begin; i < end; i++)
        aim->tile[i] = t->positions[aim->tile[i]];
}

/* Texels are in no near cache, and where a sample goes no processor can guess: all are sent for before the first is
 * waited for. Some end in the next line of the cache. Inlined, as compilers leave out functions that only send. */
static inline __attribute__((always_inline)) void fetch_texels(const gathering *g, uint32_t begin, uint32_t end,
                                                               const surface_aim *aim)
{
    for (uint32_t i = begin; i < end; i++) {
        const float *rgb = texel_at(g, aim, i);
        __builtin_prefetch(rgb);
        if (((uintptr_t)rgb & 63) > 52)
            __builtin_prefetch(rgb + 2);
    }
}

/* What densities are made of. Of other strategies than those with bins that is small, but for solid angles. */
static inline __attribute__((always_inline)) void fetch_densities(const gathering *g, uint32_t begin, uint32_t end,
                                                                  const surface_aim *aim)
{
    const float *solid_angles = g->environment->solid_angle;
    const normal_bins *bins = g->pools->bins;
    for (uint32_t i = begin; i < end; i++)
        __builtin_prefetch(solid_angles + aim->mirrored[i]);
    for (uint32_t i = begin; i < end && bins != NULL; i++) {
        __builtin_prefetch(bins->tiles->segment_densities + aim->segment[i]);
        __builtin_prefetch(g->pools->tables->row_sums + aim->line[i]);
    }
}

/* Processors forget what they are sent for when it is too much at once. */
enum { SENT_TOGETHER = 16 };

static inline __attribute__((always_inline)) void aim_samples(helio_material_kind kind, const gathering *g,
                                                              uint32_t first, surface_aim *aim)
{
    const bool has_light = has_light_techniques(g);
    const bool wants_tiles = g->pools->bins != NULL && (has_light || g->knows_diffuse);
    for (uint32_t begin = 0; begin < aim->count; begin += SENT_TOGETHER) {
        const uint32_t end = begin + SENT_TOGETHER < aim->count ? begin + SENT_TOGETHER : aim->count;
        draw_directions(kind, g, first + begin, end - begin, aim->x + begin, aim->y + begin, aim->z + begin);
        find_texels(g, begin, end, aim);
        fetch_texels(g, begin, end, aim);
        if (wants_tiles)
            find_tiles(g->pools->bins->tiles, begin, end, aim);
        if (has_light)
            fetch_densities(g, begin, end, aim);
    }
}

void KERNEL(aim_surface)(const gathering *g, uint32_t first, uint32_t count, sample_block *block)
{
    surface_aim *aim = &block->aim;
    aim->count = count;
    if (g->proposal.kind == HELIO_MATERIAL_DIFFUSE)
        aim_samples(HELIO_MATERIAL_DIFFUSE, g, first, aim);
    else if (g->proposal.kind == HELIO_MATERIAL_PHONG)
        aim_samples(HELIO_MATERIAL_PHONG, g, first, aim);
    else
        aim_samples(HELIO_MATERIAL_GGX, g, first, aim);
}

/* The directions, and the radiance in each. */
static void read_texels(const gathering *g, sample_block *block)
{
    const surface_aim *aim = &block->aim;
    float(*to)[BLOCK_STRIDE] = block->samples;
    for (uint32_t i = 0, k = block->count; i < aim->count; i++, k++) {
        const float *rgb = texel_at(g, aim, i);
        to[SAMPLE_X][k] = aim->x[i];
        to[SAMPLE_Y][k] = aim->y[i];
        to[SAMPLE_Z][k] = aim->z[i];
        to[SAMPLE_RED][k] = rgb[0];
        to[SAMPLE_GREEN][k] = rgb[1];
        to[SAMPLE_BLUE][k] = rgb[2];
    }
}

/* Of points that know diffuse light. */
static void look_for_known(const gathering *g, const surface_aim *aim, float *known)
{
    for (uint32_t i = 0; i < aim->count; i++)
        known[i] = g->tiles.knows_diffuse[aim->tile[i] / TILE_GROUP];
}

/* What the density of the light techniques is made of, besides the radiance. */
typedef struct density_parts {
    float solid_angle[BLOCK_SAMPLES];
    int32_t exponent[BLOCK_SAMPLES]; /* of the row */
    float unit[BLOCK_SAMPLES];
} density_parts;

/* face_place_density()'s unit for the density with which the light techniques draw a direction, each weighted with its
 * expected count: by the tiles as a point weighs them, */
static void find_units_of_tiles(gathering *g, const surface_aim *aim, float *unit)
{
    const float *segments = g->pools->bins->tiles->segment_densities, expected = g->counts.expected[0];
    for (uint32_t i = 0; i < aim->count; i++) {
        const uint32_t tile = aim->tile[i];
        if (!g->tiles.is_known[tile / TILE_GROUP])
            KERNEL(know_tiles)(&g->tiles, tile / TILE_GROUP);
        unit[i] = expected * (point_tiles_probability(&g->tiles, tile) * segments[aim->segment[i]]);
    }
}

/* by the pool of a bin, */
static void find_units_of_bin(const gathering *g, const surface_aim *aim, float *unit)
{
    const normal_bins *bins = g->pools->bins;
    const float *segments = bins->tiles->segment_densities, share = bins->shares[g->pool];
    const float expected = g->counts.expected[0];
    const uint32_t *sums = normal_bins_sums(bins, g->pool);
    for (uint32_t i = 0; i < aim->count; i++)
        unit[i] = expected * (normal_bins_probability_by(sums, aim->tile[i], share) * segments[aim->segment[i]]);
}

/* and by other pools. */
static void find_units_of_pools(const gathering *g, const surface_aim *aim, float *unit)
{
    for (uint32_t i = 0; i < aim->count; i++) {
        const face_place at = {aim->face[i], aim->row[i], aim->column[i], aim->u[i], aim->v[i]};
        const float expected = g->expected_in_face[at.face];
        unit[i] = expected > 0.0f ? expected * pools_unit_density(g->pools, g->pool, &at) : 0.0f;
    }
}

static void look_up(gathering *g, const surface_aim *aim, density_parts *parts)
{
    const float *solid_angles = g->environment->solid_angle;
    const row_sum *rows = g->pools->tables->row_sums;
    for (uint32_t i = 0; i < aim->count; i++) {
        parts->solid_angle[i] = solid_angles[aim->mirrored[i]];
        parts->exponent[i] = rows[aim->line[i]].exponent;
    }
    if (g->has_tiles)
        find_units_of_tiles(g, aim, parts->unit);
    else if (g->pools->bins != NULL)
        find_units_of_bin(g, aim, parts->unit);
    else
        find_units_of_pools(g, aim, parts->unit);
}

/* What the tables know of a texel follows from its radiance, so that they, in no near cache either, are left alone. */
static inline __attribute__((always_inline)) void find_densities(texel_weight_kind kind, const helio_tables *tables,
                                                                 const surface_aim *restrict aim,
                                                                 const density_parts *restrict parts,
                                                                 const float *restrict red, float *restrict density)
{
    const float *green = red + BLOCK_STRIDE, *blue = green + BLOCK_STRIDE;
    const float level = tables->level, quarter = texel_quarter(tables->size);
    const uint32_t count = aim->count;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const vec3 radiance = {red[i], green[i], blue[i]};
        const uint32_t weight =
            texel_weight_integer(kind, radiance, parts->solid_angle[i], quarter, level, parts->exponent[i]);
        density[i] = face_place_density(aim->u[i], aim->v[i], weight, parts->unit[i]);
    }
}

static void weigh_texels(gathering *g, sample_block *block)
{
    const helio_tables *tables = g->pools->tables;
    const surface_aim *aim = &block->aim;
    const float *red = block->samples[SAMPLE_RED] + block->count;
    float *density = block->samples[SAMPLE_DENSITY] + block->count;
    density_parts parts;
    look_up(g, aim, &parts);
    switch (texel_weight_kind_of(tables->weighting != HELIO_WEIGHTING_PAPER, tables->level)) {
    case WEIGHT_LUMINANCE: find_densities(WEIGHT_LUMINANCE, tables, aim, &parts, red, density); break;
    case WEIGHT_FLUX_ABOVE: find_densities(WEIGHT_FLUX_ABOVE, tables, aim, &parts, red, density); break;
    default: find_densities(WEIGHT_FLUX, tables, aim, &parts, red, density); break;
    }
}

void KERNEL(take_surface)(gathering *g, sample_block *block)
{
    const uint32_t count = block->aim.count;
    read_texels(g, block);
    if (g->knows_diffuse)
        look_for_known(g, &block->aim, block->known + block->count);
    if (has_light_techniques(g))
        weigh_texels(g, block);
    else
        memset(block->samples[SAMPLE_DENSITY] + block->count, 0, count * sizeof(float));
    block->count += count;
}
