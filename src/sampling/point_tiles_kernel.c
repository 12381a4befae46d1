/* SPDX-License-Identifier: MIT
 *
 * A shiny point's own density over the tiles, and samples from it. */
#include "sampling/fixed_point.h"
#include "sampling/kernels.h"
#include "sampling/tile_tree.h"

#include <string.h>

/* ---- lobes ---- */

/* The cosine between normal and a tile, but falling to 0 where the tile's last corner sinks below the horizon. */
static inline float soft_cosine(float cosine, float edge, float slope)
{
    float risen = cosine + edge;
    risen = risen > 0.0f ? risen : 0.0f;
    return cosine < edge ? risen * risen * slope : cosine;
}

/* The specular lobe, of this width, / divisor. cosine: between normal and direction; soft: the same, softened. */
static inline __attribute__((always_inline)) float specular_at(helio_material_kind kind, const tile_lobe *lobe,
                                                               vec3 direction, float width, float cosine, float soft,
                                                               float divisor)
{
    const float along = dot(lobe->axis, direction);
    if (kind == HELIO_MATERIAL_PHONG) {
        const float per_nat = 1.44269504f, exponent = 1.0f / width;
        return lobe->specular * (exponent + 2.0f) * exp2_fast(per_nat * exponent * (along - 1.0f)) / divisor;
    }
    /* D by (n.h)^2 = (n.v + n.l)^2 / (2 + 2 v.l), without the square root of h; times Smith's masking of the light,
     * nearly cosine / (cosine (2 - alpha) + alpha). */
    const float narrowness = 1.0f - (width < 0.999f ? width : 0.999f);
    const float sum = lobe->view_cosine + cosine, whole = 2.0f + 2.0f * along;
    const float twice = whole > 1e-6f ? whole : 1e-6f; /* 0 opposite to the view */
    const float falling = twice - narrowness * (sum * sum);
    const float masking = soft * (2.0f - lobe->alpha) + lobe->alpha;
    const float safe = falling > 1e-6f ? falling : 1e-6f;
    return lobe->specular * width * (twice * twice) / (safe * safe * (masking * divisor));
}

/* ---- groups ---- */

/* What a point thinks of a group of tiles, by the mean direction of its light. */
typedef struct group_lobes {
    alignas(64) int32_t is_taken[TILE_GROUPS];    /* not black, nor wholly below the horizon */
    alignas(64) float specular[TILE_GROUPS];      /* the specular lobe that BRDF samples leave, 1/sr */
    alignas(64) float gain[TILE_GROUPS];          /* light of all in relation to the light that they leave */
    alignas(64) float weight[TILE_GROUPS];        /* light x BRDF x cosine */
    alignas(64) float specular_part[TILE_GROUPS]; /* of that, the specular lobe's */
    alignas(64) float wholes[TILE_GROUP]; /* of tiles that are weighed by themselves: sums, over all such groups, of
                                             their weights if BRDF samples left nothing out */
} group_lobes;

/* All groups, as there are no more than a few registers of them. The light of a group is as wide as the directions of
 * its tiles vary, and so is a lobe that stands for all of it. */
static inline __attribute__((always_inline)) void look_at_groups(helio_material_kind kind, const tiles *t,
                                                                 const tile_lobe *given, group_lobes *restrict groups)
{
    const tile_lobe lobe = *given;
    const vec3 normal = lobe.normal;
    const tile_groups *g = &t->groups;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUPS; i++) {
        const vec3 direction = {g->light_x[i], g->light_y[i], g->light_z[i]};
        const float above = normal.x * g->x[i] + normal.y * g->y[i] + normal.z * g->z[i];
        const float cosine = dot(normal, direction), soft = soft_cosine(cosine, g->edge[i], g->slope[i]);
        const float divisor = 1.0f + lobe.to_surface * g->spread[i], width = lobe.width + g->variance[i];
        const float left = specular_at(kind, &lobe, direction, width, cosine, soft, divisor);
        const float light = g->light[i] * soft;
        const int32_t taken = -((above > -g->edge[i]) & (g->light[i] > 0.0f));
        groups->is_taken[i] = taken;
        groups->specular[i] = left;
        groups->gain[i] = (lobe.diffuse + left * divisor) / (lobe.diffuse + left);
        groups->weight[i] = masked(light * (lobe.diffuse + left), taken);
        groups->specular_part[i] = light * left;
    }
}

/* In an order that is the same for all instruction sets. */
static inline float sum_in_order(const float *values, uint32_t count)
{
    enum { LANES = 16 };
    float lanes[LANES], sum = 0.0f;
#pragma omp simd
    for (uint32_t i = 0; i < LANES; i++) {
        float lane = values[i];
        for (uint32_t k = i + LANES; k < count; k += LANES)
            lane += values[k];
        lanes[i] = lane;
    }
    for (uint32_t i = 0; i < LANES; i++)
        sum += lanes[i];
    return sum;
}

/* ---- tiles ---- */

/* With one value of the lobe for all. */
static inline __attribute__((always_inline)) void weigh_alike(const tiles *t, const tile_lobe *lobe, uint32_t group,
                                                              float specular, float *restrict weights)
{
    const vec3 normal = lobe->normal;
    const float edge = lobe->edge, slope = lobe->slope, value = lobe->diffuse + specular;
    const uint32_t first = group * TILE_GROUP;
    const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        weights[i] = light[i] * (soft_cosine(dot(normal, (vec3){x[i], y[i], z[i]}), edge, slope) * value);
}

/* With a value for each. wholes: adds what they would weigh if BRDF samples looked after nothing. */
static inline __attribute__((always_inline)) void weigh_apart(helio_material_kind kind, const tiles *t,
                                                              const tile_lobe *lobe, uint32_t group,
                                                              float *restrict weights, float *restrict wholes)
{
    const uint32_t first = group * TILE_GROUP;
    const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
    const float *spread = t->spread + first;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++) {
        const vec3 direction = {x[i], y[i], z[i]};
        const float cosine = dot(lobe->normal, direction), soft = soft_cosine(cosine, lobe->edge, lobe->slope);
        const float divisor = 1.0f + lobe->to_surface * spread[i];
        const float specular = specular_at(kind, lobe, direction, lobe->width, cosine, soft, divisor);
        weights[i] = light[i] * (soft * (lobe->diffuse + specular));
        wholes[i] += light[i] * (soft * (lobe->diffuse + specular * divisor));
    }
}

static inline __attribute__((always_inline)) void weigh_groups(helio_material_kind kind, const tiles *t,
                                                               const tile_lobe *given, group_lobes *restrict groups,
                                                               float *restrict weights)
{
    const tile_lobe lobe = *given;
    look_at_groups(kind, t, &lobe, groups);
    const float least = sum_in_order(groups->weight, TILE_GROUPS) / (float)POINT_REFINED_PARTS;
    memset(groups->wholes, 0, sizeof groups->wholes);
    for (uint32_t group = 0; group < TILE_GROUPS; group++) {
        float *to = weights + (size_t)group * TILE_GROUP;
        if (!groups->is_taken[group])
            memset(to, 0, TILE_GROUP * sizeof *to);
        else if (groups->specular_part[group] > least) {
            weigh_apart(kind, t, &lobe, group, to, groups->wholes);
            groups->gain[group] = 0.0f;
        } else
            weigh_alike(t, &lobe, group, groups->specular[group], to);
    }
}

/* See tables_kernel.c for why by its bits. Of a few registers side by side, so that none waits for the one before. */
static float largest_of(const float *weights)
{
    enum { LANES = 64 };
    int32_t lanes[LANES] = {0}, largest_bits = 0;
    for (uint32_t first = 0; first < TILES_MOST; first += LANES) {
#pragma omp simd
        for (uint32_t i = 0; i < LANES; i++) {
            int32_t bits = bits_of_float(weights[first + i]);
            lanes[i] = bits > lanes[i] ? bits : lanes[i];
        }
    }
#pragma omp simd reduction(max : largest_bits)
    for (uint32_t i = 0; i < LANES; i++)
        largest_bits = lanes[i] > largest_bits ? lanes[i] : largest_bits;
    return float_of_bits(largest_bits);
}

static void sum_groups(const group_lobes *groups, const float *weights, float factor, point_tiles *p)
{
    uint32_t sum = 0;
    for (uint32_t group = 0; group < TILE_GROUPS; group++) {
        uint32_t *integers = p->weights + (size_t)group * TILE_GROUP;
        p->sums[group] = sum;
        if (!groups->is_taken[group]) {
            memset(integers, 0, TILE_GROUP * sizeof *integers);
            continue;
        }
        fixed_point_quantise(weights + (size_t)group * TILE_GROUP, TILE_GROUP, factor, integers);
        sum = fixed_point_total(integers, TILE_GROUP, sum);
    }
    p->sums[TILE_GROUPS] = p->total = sum;
}

/* The sum of all weights, as integers, if BRDF samples looked after nothing. */
static float find_whole(const point_tiles *p, float factor, group_lobes *groups)
{
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUPS; i++)
        groups->gain[i] *= (float)(int32_t)(p->sums[i + 1] - p->sums[i]); /* below 2^31 */
    return sum_in_order(groups->gain, TILE_GROUPS) + factor * sum_in_order(groups->wholes, TILE_GROUP);
}

void KERNEL(weigh_point)(const tiles *t, const tile_lobe *lobe, point_tiles *p)
{
    alignas(64) float weights[TILES_MOST];
    group_lobes groups;
    if (lobe->kind == HELIO_MATERIAL_PHONG)
        weigh_groups(HELIO_MATERIAL_PHONG, t, lobe, &groups, weights);
    else
        weigh_groups(HELIO_MATERIAL_GGX, t, lobe, &groups, weights);
    const int exponent = fixed_point_exponent(largest_of(weights), tables_summand_bits(t->count));
    const float factor = ldexpf(1.0f, exponent);
    sum_groups(&groups, weights, factor, p);
    const float whole = find_whole(p, factor, &groups), light = (float)p->total;
    p->brightness = ldexpf(light, -exponent);
    p->left = whole > light ? 1.0f - light / whole : 0.0f;
    p->share = p->total != 0 ? 1.0f / light : 0.0f;
}

void KERNEL(mix_hues)(const tiles *t, point_tiles *p)
{
    const float *reds = t->colours.hue[0], *greens = t->colours.hue[1], *blues = t->colours.hue[2];
    const int32_t *weights = (const int32_t *)p->weights; /* below 2^31 */
    float red = 0, green = 0, blue = 0;
#pragma omp simd reduction(+ : red, green, blue)
    for (uint32_t i = 0; i < TILES_MOST; i++) {
        const float weight = (float)weights[i];
        red += weight * reds[i];
        green += weight * greens[i];
        blue += weight * blues[i];
    }
    p->hue[0] = red * p->share;
    p->hue[1] = green * p->share;
    p->hue[2] = blue * p->share;
}

/* ---- samples ---- */

static void choose_tiles(const normal_bins *bins, const point_tiles *p, uint32_t samples, uint32_t first,
                         uint32_t count, uint32_t seed, tile_draw *draws)
{
    const tile_tree tree = {p->sums, p->weights, bins->list_starts};
    tile_tree_draw(&tree, true, samples, first, count, seed, draws);
    for (uint32_t i = 0; i < count; i++)
        __builtin_prefetch(&bins->listed[draws[i].element]);
}

void KERNEL(take_tiles)(const gathering *g, uint32_t first, uint32_t count, sample_block *block)
{
    const normal_bins *bins = g->pools->bins;
    const float expected = g->counts.expected[0];
    tile_draw draws[BLOCK_SAMPLES] = {{0}}; /* so that analyzers need not follow the tree */
    choose_tiles(bins, &g->tiles, g->counts.realised[0], first, count, g->tile_seed, draws);
    for (uint32_t i = 0, k = block->count; i < count; i++, k++) {
        const listed_sample *sample = &bins->listed[draws[i].element];
        block->samples[SAMPLE_X][k] = sample->direction[0];
        block->samples[SAMPLE_Y][k] = sample->direction[1];
        block->samples[SAMPLE_Z][k] = sample->direction[2];
        block->samples[SAMPLE_RED][k] = sample->radiance[0];
        block->samples[SAMPLE_GREEN][k] = sample->radiance[1];
        block->samples[SAMPLE_BLUE][k] = sample->radiance[2];
        block->listed[k] = draws[i].element;
        for (int c = 0; c < 3; c++)
            block->hue[c] += sample->hue[c];
        block->samples[SAMPLE_DENSITY][k] =
            point_tiles_probability(&g->tiles, draws[i].position) * sample->density * expected;
    }
    block->count += count;
}
