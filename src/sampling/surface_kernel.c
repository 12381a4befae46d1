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

/* Texels are in no near cache, and where a sample goes no processor can guess: all are sent for before the first is
 * waited for. Some end in the next line of the cache. Inlined, as compilers leave out functions that only send. */
static inline __attribute__((always_inline)) void fetch_ahead(const gathering *g, uint32_t begin, uint32_t end,
                                                              const surface_aim *aim)
{
    const bool has_light = has_light_techniques(g), has_tiles = g->has_tiles;
    for (uint32_t i = begin; i < end; i++) {
        const float *rgb = texel_at(g, aim, i);
        __builtin_prefetch(rgb);
        if (((uintptr_t)rgb & 63) > 52)
            __builtin_prefetch(rgb + 2);
        if (has_light)
            __builtin_prefetch(g->environment->solid_angle + aim->mirrored[i]);
        if (has_tiles) { /* what other strategies look up is small */
            const face_place at = {aim->face[i], aim->row[i], aim->column[i], aim->u[i], aim->v[i]};
            __builtin_prefetch(tiles_unit_density_at(g->pools->bins->tiles, &at));
            __builtin_prefetch(&g->pools->tables->row_sums[(size_t)at.face * g->environment->size + at.row]);
        }
    }
}

/* Processors forget what they are sent for when it is too much at once. */
enum { SENT_TOGETHER = 16 };

static inline __attribute__((always_inline)) void aim_samples(helio_material_kind kind, const gathering *g,
                                                              uint32_t first, surface_aim *aim)
{
    for (uint32_t begin = 0; begin < aim->count; begin += SENT_TOGETHER) {
        const uint32_t end = begin + SENT_TOGETHER < aim->count ? begin + SENT_TOGETHER : aim->count;
        draw_directions(kind, g, first + begin, end - begin, aim->x + begin, aim->y + begin, aim->z + begin);
        find_texels(g, begin, end, aim);
        fetch_ahead(g, begin, end, aim);
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

/* face_place_density()'s unit for the density with which the light techniques draw a direction, each weighted with its
 * expected count. */
static inline float unit_density(gathering *g, const face_place *at)
{
    const float expected = g->expected_in_face[at->face];
    if (!(expected > 0.0f))
        return 0.0f;
    if (!g->has_tiles)
        return expected * pools_unit_density(g->pools, g->pool, at);
    const tiles *t = g->pools->bins->tiles;
    const uint32_t position = tiles_position(t, at->face, at->row, at->column);
    if (!g->tiles.is_known[position / TILE_GROUP])
        KERNEL(know_tiles)(&g->tiles, position / TILE_GROUP);
    return expected * (point_tiles_probability(&g->tiles, position) * tiles_unit_density(t, at));
}

/* Of points that know diffuse light. */
static void look_for_known(const gathering *g, const surface_aim *aim, float *known)
{
    const tiles *t = g->pools->bins->tiles;
    for (uint32_t i = 0; i < aim->count; i++)
        known[i] = g->tiles.knows_diffuse[tiles_position(t, aim->face[i], aim->row[i], aim->column[i]) / TILE_GROUP];
}

/* What the density of the light techniques is made of, besides the radiance. */
typedef struct density_parts {
    float solid_angle[BLOCK_SAMPLES];
    int32_t exponent[BLOCK_SAMPLES]; /* of the row */
    float unit[BLOCK_SAMPLES];
} density_parts;

static void look_up(gathering *g, const surface_aim *aim, density_parts *parts)
{
    for (uint32_t i = 0; i < aim->count; i++) {
        const face_place at = {aim->face[i], aim->row[i], aim->column[i], aim->u[i], aim->v[i]};
        parts->solid_angle[i] = g->environment->solid_angle[aim->mirrored[i]];
        parts->exponent[i] = g->pools->tables->row_sums[(size_t)at.face * g->environment->size + at.row].exponent;
        parts->unit[i] = unit_density(g, &at);
    }
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
