/* SPDX-License-Identifier: MIT
 *
 * Samples of the surface technique: scrambled points, directions, and the light found there. */
#include "core/random.h"
#include "env/environment.h"
#include "sampling/kernels.h"

/* Directions of samples first ... first + count - 1, from scrambled Sobol' points of the point's own. */
static inline __attribute__((always_inline)) void draw_directions(helio_material_kind kind, const gathering *g,
                                                                  uint32_t first, uint32_t count, float *restrict x,
                                                                  float *restrict y, float *restrict z)
{
    const brdf proposal = g->proposal;
    const brdf_axes axes = g->proposal_axes;
    const uint32_t *third = g->pools->third_dimension + first;
    const uint32_t seed_u = dimension_seed(g->surface_seed, 0), seed_v = dimension_seed(g->surface_seed, 1);
    const uint32_t seed_lobe = dimension_seed(g->surface_seed, 2);
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        float u = unit_float(owen_scramble_reversed(first + i, seed_u));
        float v = unit_float(owen_scramble_reversed(pascal_transform(first + i), seed_v));
        float lobe = unit_float(owen_scramble_reversed(third[i], seed_lobe));
        vec3 direction = brdf_sample_of(kind, &proposal, &axes, lobe, u, v);
        x[i] = direction.x;
        y[i] = direction.y;
        z[i] = direction.z;
    }
}

/* Where each direction meets the cube. */
typedef struct texel_list {
    uint32_t face[BLOCK_SAMPLES], row[BLOCK_SAMPLES], column[BLOCK_SAMPLES];
    float u[BLOCK_SAMPLES], v[BLOCK_SAMPLES];
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
        texels->row[i] = cube_texel(at.v, size);
        texels->column[i] = cube_texel(at.u, size);
    }
}

/* Texels and tables are in no near cache, and where a sample goes no processor can guess: all are sent for before the
 * first is waited for. */
static void fetch_ahead(const gathering *g, uint32_t count, const texel_list *texels)
{
    for (uint32_t i = 0; i < count; i++) {
        face_table table = tables_face(g->pools->tables, texels->face[i]);
        __builtin_prefetch(environment_texel(g->environment, texels->face[i], texels->row[i], texels->column[i]));
        __builtin_prefetch(table.rows + (size_t)texels->row[i] * (table.size + 1) + texels->column[i]);
    }
}

/* The texel in each direction, and the density of the light techniques there. */
static void look_up(const gathering *g, uint32_t count, const texel_list *texels, sample_block *block)
{
    float(*to)[BLOCK_STRIDE] = block->samples;
    for (uint32_t i = 0, k = block->count; i < count; i++, k++) {
        const face_place at = {texels->face[i], texels->row[i], texels->column[i], texels->u[i], texels->v[i]};
        const float *rgb = environment_texel(g->environment, at.face, at.row, at.column);
        to[SAMPLE_RED][k] = rgb[0];
        to[SAMPLE_GREEN][k] = rgb[1];
        to[SAMPLE_BLUE][k] = rgb[2];
        to[SAMPLE_DENSITY][k] = gathering_light_density(g, &at);
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
    fetch_ahead(g, count, &texels);
    look_up(g, count, &texels, block);
    block->count += count;
}
