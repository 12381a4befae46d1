/* SPDX-License-Identifier: MIT
 *
 * What samples contribute to the light that leaves a point: the innermost loop of all. Multiplications and additions
 * may be fused here (cmake/HeliostatKernels.cmake), so results differ between instruction sets by their rounding. */
#include "sampling/kernels.h"

/* How the surface technique, if there is one, takes part in the density of a sample. */
typedef enum mixture {
    MIXTURE_LIGHT_ONLY,
    MIXTURE_SURFACE, /* it draws by the surface's own BRDF */
    MIXTURE_COSINE,
} mixture;

/* kind and mix are constants where this is expanded, and so vanish from the loop. */
static inline __attribute__((always_inline)) void weigh_samples(helio_material_kind kind, mixture mix,
                                                                bool knows_diffuse, const gathering *g,
                                                                sample_block *restrict block)
{
    const float intensity = g->environment->intensity, surface_expected = g->counts.expected[TECHNIQUE_SURFACE];
    const brdf surface = g->surface, proposal = g->proposal; /* copies: nothing written below can change them */
    const vec3 geometric_normal = g->geometric_normal;
    float(*samples)[BLOCK_STRIDE] = block->samples;
    const int32_t count = (int32_t)block->count;
    const int32_t padded = (count + HELIO_LANES - 1) / HELIO_LANES * HELIO_LANES;
#pragma omp simd
    for (int32_t i = 0; i < padded; i++) {
        vec3 direction = {samples[SAMPLE_X][i], samples[SAMPLE_Y][i], samples[SAMPLE_Z][i]};
        float cosine = dot(surface.normal, direction);
        float above = dot(geometric_normal, direction);
        float total = samples[SAMPLE_DENSITY][i];
        if (mix == MIXTURE_SURFACE)
            total += surface_expected * brdf_density_of(kind, &surface, direction);
        else if (mix == MIXTURE_COSINE)
            total += surface_expected * brdf_density_of(HELIO_MATERIAL_DIFFUSE, &proposal, direction);
        vec3 value = brdf_value_above(kind, &surface, direction, cosine);
        if (knows_diffuse)
            value = add_scaled(value, surface.colours[0], -block->known[i]);
        float factor = cosine * intensity / total;
        int32_t counts = -((i < count) & (cosine > 0.0f) & (above > 0.0f) & (total > 0.0f));
        block->red[i] = masked(samples[SAMPLE_RED][i] * value.x * factor, counts);
        block->green[i] = masked(samples[SAMPLE_GREEN][i] * value.y * factor, counts);
        block->blue[i] = masked(samples[SAMPLE_BLUE][i] * value.z * factor, counts);
        block->density[i] = total;
    }
}

/* Points that shine may know diffuse light. */
static inline __attribute__((always_inline)) void weigh_lobes(helio_material_kind kind, mixture mix, const gathering *g,
                                                              sample_block *block)
{
    if (kind != HELIO_MATERIAL_DIFFUSE && g->knows_diffuse)
        weigh_samples(kind, mix, true, g, block);
    else
        weigh_samples(kind, mix, false, g, block);
}

static inline __attribute__((always_inline)) void weigh_mixture(helio_material_kind kind, const gathering *g,
                                                                sample_block *block)
{
    if (g->counts.expected[TECHNIQUE_SURFACE] == 0.0f)
        weigh_lobes(kind, MIXTURE_LIGHT_ONLY, g, block);
    else if (g->pools->parts.surface == STRATEGY_SURFACE_COSINE)
        weigh_samples(kind, MIXTURE_COSINE, false, g, block);
    else
        weigh_lobes(kind, MIXTURE_SURFACE, g, block);
}

void KERNEL(weigh)(const gathering *g, sample_block *block)
{
    if (g->surface.kind == HELIO_MATERIAL_DIFFUSE)
        weigh_mixture(HELIO_MATERIAL_DIFFUSE, g, block);
    else if (g->surface.kind == HELIO_MATERIAL_PHONG)
        weigh_mixture(HELIO_MATERIAL_PHONG, g, block);
    else
        weigh_mixture(HELIO_MATERIAL_GGX, g, block);
}

block_sum KERNEL(sum_block)(const sample_block *block)
{
    const int32_t padded = ((int32_t)block->count + HELIO_LANES - 1) / HELIO_LANES * HELIO_LANES;
    float red = 0.0f, green = 0.0f, blue = 0.0f;
    int32_t useful = 0;
#pragma omp simd reduction(+ : red, green, blue, useful)
    for (int32_t i = 0; i < padded; i++) {
        red += block->red[i];
        green += block->green[i];
        blue += block->blue[i];
        useful += (block->red[i] + block->green[i]) + block->blue[i] > 0.0f;
    }
    return (block_sum){{red, green, blue}, (uint32_t)useful};
}
