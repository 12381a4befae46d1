/* SPDX-License-Identifier: MIT
 *
 * A shiny point's own density over the tiles, and samples from it. */
#include "sampling/fixed_point.h"
#include "sampling/kernels.h"
#include "sampling/tile_tree.h"

/* ---- weights ---- */

/* Groups of tiles that are not wholly below the horizon, nor black. */
static void choose_groups(const tiles *t, vec3 normal, point_tiles *p)
{
    int32_t is_above[TILE_GROUPS] = {0};
#pragma omp simd
    for (uint32_t i = 0; i < t->group_count; i++) {
        float cosine = normal.x * t->group_x[i] + normal.y * t->group_y[i] + normal.z * t->group_z[i];
        is_above[i] = cosine > -t->group_edge[i];
    }
    p->group_count = p->runs[0] = 0;
    for (uint32_t i = 0; i < TILE_GROUPS; i++) {
        const bool is_taken = is_above[i] && t->group_is_lit[i];
        p->groups[p->group_count] = (uint8_t)i; /* overwritten by the next where it is not taken */
        p->places[i] = (uint8_t)(is_taken ? p->group_count : TILE_GROUPS);
        p->group_count += is_taken;
        p->runs[i / TILE_RUN + 1] = (uint8_t)p->group_count;
    }
}

/* The cosine between normal and a tile, but falling to 0 where the tile's last corner sinks below the horizon. */
static inline float soft_cosine(float cosine, float edge, float slope)
{
    float risen = cosine + edge;
    risen = risen > 0.0f ? risen : 0.0f;
    return cosine < edge ? risen * risen * slope : cosine;
}

/* BRDF x cosine: of what BRDF samples leave, and of all. */
typedef struct lobe_values {
    float light, all;
} lobe_values;

/* x: what BRDF samples look after is x / (1 + x) of the specular lobe. */
static inline __attribute__((always_inline)) lobe_values lobe_at(helio_material_kind kind, const tile_lobe *lobe,
                                                                 vec3 direction, float x)
{
    const float cosine = dot(lobe->normal, direction), soft = soft_cosine(cosine, lobe->edge, lobe->slope);
    const float along = dot(lobe->axis, direction);
    if (kind == HELIO_MATERIAL_PHONG) {
        const float all = lobe->specular * exp2_fast(lobe->sharpness * (along - 1.0f));
        return (lobe_values){soft * (lobe->diffuse + all / (1.0f + x)), soft * (lobe->diffuse + all)};
    }
    /* D by (n.h)^2 = (n.v + n.l)^2 / (2 + 2 v.l), without the square root of h; times Smith's masking of the light,
     * nearly cosine / (cosine (2 - alpha) + alpha). */
    const float sum = lobe->view_cosine + cosine, twice = 2.0f + 2.0f * along;
    const float falling = twice - lobe->narrowness * (sum * sum);
    const float masking = soft * (2.0f - lobe->alpha) + lobe->alpha;
    const float safe = falling > 1e-6f ? falling : 1e-6f;
    const float light = lobe->specular * (twice * twice) / (safe * safe * masking * (1.0f + x));
    return (lobe_values){soft * (lobe->diffuse + light), soft * (lobe->diffuse + light * (1.0f + x))};
}

/* The weights of the chosen groups' tiles, and what they were if BRDF samples looked after nothing. */
static inline __attribute__((always_inline)) void weigh_groups(helio_material_kind kind, const tiles *t,
                                                               const tile_lobe *given, const point_tiles *p,
                                                               float *restrict weights, float *restrict wholes)
{
    const tile_lobe lobe = *given;
    for (uint32_t k = 0; k < p->group_count; k++) {
        const uint32_t first = (uint32_t)p->groups[k] * TILE_GROUP;
        const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
        const float *spread = t->spread + first;
        float *to = weights + (size_t)k * TILE_GROUP, *whole = wholes + (size_t)k * TILE_GROUP;
#pragma omp simd
        for (uint32_t i = 0; i < TILE_GROUP; i++) {
            const lobe_values values = lobe_at(kind, &lobe, (vec3){x[i], y[i], z[i]}, lobe.to_surface * spread[i]);
            to[i] = light[i] * values.light;
            whole[i] = light[i] * values.all;
        }
    }
}

/* See tables_kernel.c for why by its bits. */
static float largest_of(const float *weights, uint32_t count)
{
    int32_t largest_bits = 0;
#pragma omp simd reduction(max : largest_bits)
    for (uint32_t i = 0; i < count; i++) {
        int32_t bits = bits_of_float(weights[i]);
        largest_bits = bits > largest_bits ? bits : largest_bits;
    }
    return float_of_bits(largest_bits);
}

/* A sum of weights that has the same bits with every instruction set: of integers, in their order. */
static double exact_sum(const float *weights, uint32_t count, uint32_t tile_count, uint32_t *integers, uint32_t *sum)
{
    const int exponent = fixed_point_exponent(largest_of(weights, count), tables_summand_bits(tile_count));
    fixed_point_quantise(weights, count, ldexpf(1.0f, exponent), integers);
    *sum = fixed_point_total(integers, count, 0);
    return ldexp((double)*sum, -exponent);
}

static void sum_groups(point_tiles *p)
{
    uint32_t sum = 0;
    for (uint32_t k = 0; k < p->group_count; k++) {
        p->sums[k] = sum;
        sum = fixed_point_total(p->weights + (size_t)k * TILE_GROUP, TILE_GROUP, sum);
    }
    p->sums[p->group_count] = sum;
}

void KERNEL(weigh_point)(const tiles *t, const tile_lobe *lobe, point_tiles *p)
{
    alignas(64) float weights[TILES_MOST];
    alignas(64) float wholes[TILES_MOST];
    alignas(64) uint32_t integers[TILES_MOST];
    uint32_t unused;
    choose_groups(t, lobe->normal, p);
    if (lobe->kind == HELIO_MATERIAL_PHONG)
        weigh_groups(HELIO_MATERIAL_PHONG, t, lobe, p, weights, wholes);
    else
        weigh_groups(HELIO_MATERIAL_GGX, t, lobe, p, weights, wholes);
    const uint32_t count = p->group_count * TILE_GROUP;
    const double light = exact_sum(weights, count, t->count, p->weights, &p->total);
    const double all = exact_sum(wholes, count, t->count, integers, &unused);
    p->brightness = (float)light;
    p->left = all > light ? (float)(1.0 - light / all) : 0.0f;
    p->share = p->total != 0 ? 1.0f / (float)p->total : 0.0f;
    sum_groups(p);
}

void KERNEL(mix_hues)(const tiles *t, point_tiles *p)
{
    float red = 0, green = 0, blue = 0;
    for (uint32_t k = 0; k < p->group_count; k++) {
        const uint32_t first = (uint32_t)p->groups[k] * TILE_GROUP;
        const float *reds = t->colours.hue[0] + first, *greens = t->colours.hue[1] + first;
        const float *blues = t->colours.hue[2] + first;
        const int32_t *weights = (const int32_t *)p->weights + (size_t)k * TILE_GROUP; /* below 2^31 */
#pragma omp simd reduction(+ : red, green, blue)
        for (uint32_t i = 0; i < TILE_GROUP; i++) {
            const float weight = (float)weights[i];
            red += weight * reds[i];
            green += weight * greens[i];
            blue += weight * blues[i];
        }
    }
    p->hue[0] = red * p->share;
    p->hue[1] = green * p->share;
    p->hue[2] = blue * p->share;
}

/* ---- samples ---- */

static void choose_tiles(const normal_bins *bins, const point_tiles *p, uint32_t samples, uint32_t first,
                         uint32_t count, uint32_t seed, tile_draw *draws)
{
    const tile_tree tree = {p->runs, p->groups, p->sums, p->weights, bins->list_starts};
    tile_tree_draw(&tree, true, samples, first, count, seed, draws);
    for (uint32_t i = 0; i < count; i++)
        __builtin_prefetch(&bins->listed[draws[i].element]);
}

void KERNEL(take_tiles)(const gathering *g, uint32_t first, uint32_t count, sample_block *block)
{
    const normal_bins *bins = g->pools->bins;
    const float expected = g->counts.expected[0];
    const float share = g->tiles.share;
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
        block->samples[SAMPLE_DENSITY][k] = (float)draws[i].weight * share * sample->density * expected;
    }
    block->count += count;
}
