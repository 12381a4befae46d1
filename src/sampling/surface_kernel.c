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

/* Where each direction meets the cube. */
typedef struct texel_list {
    uint32_t face[BLOCK_SAMPLES], row[BLOCK_SAMPLES], column[BLOCK_SAMPLES];
    uint32_t index[BLOCK_SAMPLES];    /* of all texels */
    uint32_t mirrored[BLOCK_SAMPLES]; /* of the solid angle, see texel_weight.h */
    float u[BLOCK_SAMPLES], v[BLOCK_SAMPLES];
    float solid_angle[BLOCK_SAMPLES];
    int32_t exponent[BLOCK_SAMPLES]; /* of the row */
    float unit[BLOCK_SAMPLES];       /* of gathering_unit_density() */
} texel_list;

static void find_texels(const gathering *g, uint32_t count, const float *restrict x, const float *restrict y,
                        const float *restrict z, texel_list *restrict texels)
{
    const uint32_t size = g->environment->size;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        cube_position at = cube_project((vec3){x[i], y[i], z[i]});
        texels->face[i] = at.face;
        texels->u[i] = at.u;
        texels->v[i] = at.v;
        const uint32_t row = cube_texel(at.v, size), column = cube_texel(at.u, size);
        texels->row[i] = row;
        texels->column[i] = column;
        texels->index[i] = (at.face * size + row) * size + column;
        texels->mirrored[i] = texel_mirrored(size, row, column);
    }
}

static const float *texel_at(const gathering *g, const texel_list *texels, uint32_t i)
{
    return g->environment->cube + 3 * (size_t)texels->index[i];
}

/* Texels are in no near cache, and where a sample goes no processor can guess: all are sent for before the first is
 * waited for. Some end in the next line of the cache. Inlined, as compilers leave out functions that only send. */
static inline __attribute__((always_inline)) void fetch_ahead(const gathering *g, bool has_light, uint32_t count,
                                                              const texel_list *texels)
{
    for (uint32_t i = 0; i < count; i++) {
        const float *rgb = texel_at(g, texels, i);
        __builtin_prefetch(rgb);
        if (((uintptr_t)rgb & 63) > 52)
            __builtin_prefetch(rgb + 2);
        if (has_light)
            __builtin_prefetch(g->environment->solid_angle + texels->mirrored[i]);
    }
}

/* The radiance in each direction. */
static void read_texels(const gathering *g, uint32_t count, const texel_list *texels, sample_block *block)
{
    float(*to)[BLOCK_STRIDE] = block->samples;
    for (uint32_t i = 0, k = block->count; i < count; i++, k++) {
        const float *rgb = texel_at(g, texels, i);
        to[SAMPLE_RED][k] = rgb[0];
        to[SAMPLE_GREEN][k] = rgb[1];
        to[SAMPLE_BLUE][k] = rgb[2];
    }
}

static bool has_light_techniques(const gathering *g)
{
    float expected = 0.0f;
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        expected += g->expected_in_face[face];
    return expected > 0.0f;
}

/* What the density of the light techniques is made of, besides the radiance. */
static void look_up(const gathering *g, uint32_t count, texel_list *texels)
{
    for (uint32_t i = 0; i < count; i++) {
        const face_place at = {texels->face[i], texels->row[i], texels->column[i], texels->u[i], texels->v[i]};
        texels->solid_angle[i] = g->environment->solid_angle[texels->mirrored[i]];
        texels->exponent[i] = g->pools->tables->row_sums[(size_t)at.face * g->environment->size + at.row].exponent;
        texels->unit[i] = gathering_unit_density(g, &at);
    }
}

/* What the tables know of a texel follows from its radiance, so that they, in no near cache either, are left alone. */
static inline __attribute__((always_inline)) void find_densities(texel_weight_kind kind, const helio_tables *tables,
                                                                 uint32_t count, const texel_list *restrict texels,
                                                                 const float *restrict red, float *restrict density)
{
    const float *green = red + BLOCK_STRIDE, *blue = green + BLOCK_STRIDE;
    const float level = tables->level, quarter = texel_quarter(tables->size);
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const vec3 radiance = {red[i], green[i], blue[i]};
        const uint32_t weight =
            texel_weight_integer(kind, radiance, texels->solid_angle[i], quarter, level, texels->exponent[i]);
        density[i] = face_place_density(texels->u[i], texels->v[i], weight, texels->unit[i]);
    }
}

static void weigh_texels(const gathering *g, uint32_t count, const texel_list *texels, sample_block *block)
{
    const helio_tables *tables = g->pools->tables;
    const float *red = block->samples[SAMPLE_RED] + block->count;
    float *density = block->samples[SAMPLE_DENSITY] + block->count;
    switch (texel_weight_kind_of(tables->weighting != HELIO_WEIGHTING_PAPER, tables->level)) {
    case WEIGHT_LUMINANCE: find_densities(WEIGHT_LUMINANCE, tables, count, texels, red, density); break;
    case WEIGHT_FLUX_ABOVE: find_densities(WEIGHT_FLUX_ABOVE, tables, count, texels, red, density); break;
    default: find_densities(WEIGHT_FLUX, tables, count, texels, red, density); break;
    }
}

void KERNEL(draw_surface)(const gathering *g, uint32_t first, uint32_t count, sample_block *block)
{
    float *x = block->samples[SAMPLE_X] + block->count, *y = block->samples[SAMPLE_Y] + block->count;
    float *z = block->samples[SAMPLE_Z] + block->count;
    if (g->proposal.kind == HELIO_MATERIAL_DIFFUSE)
        draw_directions(HELIO_MATERIAL_DIFFUSE, g, first, count, x, y, z);
    else if (g->proposal.kind == HELIO_MATERIAL_PHONG)
        draw_directions(HELIO_MATERIAL_PHONG, g, first, count, x, y, z);
    else
        draw_directions(HELIO_MATERIAL_GGX, g, first, count, x, y, z);
    texel_list texels;
    find_texels(g, count, x, y, z, &texels);
    const bool has_light = has_light_techniques(g);
    fetch_ahead(g, has_light, count, &texels);
    read_texels(g, count, &texels, block);
    if (has_light) {
        look_up(g, count, &texels);
        weigh_texels(g, count, &texels, block);
    } else
        memset(block->samples[SAMPLE_DENSITY] + block->count, 0, count * sizeof(float));
    block->count += count;
}
