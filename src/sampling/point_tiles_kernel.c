/* SPDX-License-Identifier: MIT
 *
 * A shiny point's own density over the tiles, and samples from it. */
#include "sampling/fixed_point.h"
#include "sampling/kernels.h"
#include "sampling/tile_sums.h"
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

/* What a point thinks of groups of tiles, by the mean direction of their light. */
typedef struct group_lobes {
    alignas(64) float specular_part[TILE_GROUPS]; /* light x cosine x specular lobe, as BRDF samples leave it */
    alignas(64) float taken[TILE_GROUPS];         /* ... what they take of that */
    alignas(64) int32_t is_low[TILE_GROUPS];      /* of some tile the centre may be below the horizon */
    /* Sums over the tiles that are looked at: the same of those with a lobe of their own; weight x hue. */
    alignas(64) float tiles_taken[TILE_GROUP];
    alignas(64) float hues[3][TILE_GROUP];
} group_lobes;

/* All groups, as there are no more than a few registers of them. The light of a group is as wide as the directions of
 * its tiles vary, and so is a lobe that stands for all of it. Where all tiles are above the horizon the weight is the
 * sum of theirs, if they share the lobe. */
static inline __attribute__((always_inline)) void look_at_groups(helio_material_kind kind, const tiles *t,
                                                                 const tile_lobe *given, group_lobes *restrict groups,
                                                                 point_tiles *restrict p)
{
    const tile_lobe lobe = *given;
    const vec3 normal = lobe.normal, flat = lobe.geometric_normal;
    const float is_known = lobe.knows_diffuse ? 1.0f : 0.0f;
    const tile_groups *g = &t->groups;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUPS; i++) {
        const vec3 direction = {g->light_x[i], g->light_y[i], g->light_z[i]};
        const float above = normal.x * g->x[i] + normal.y * g->y[i] + normal.z * g->z[i];
        const float cosine = dot(normal, direction), soft = soft_cosine(cosine, g->edge[i], g->slope[i]);
        const float divisor = 1.0f + lobe.to_surface * g->spread[i], width = lobe.width + g->variance[i];
        const float left = specular_at(kind, &lobe, direction, width, cosine, soft, divisor);
        const int32_t taken = -((above > -g->edge[i]) & (g->light[i] > 0.0f)), low = -(above < g->inner[i]);
        const float light = masked(low ? g->light[i] * soft : g->moment[i] * cosine, taken);
        const float above_flat = flat.x * g->x[i] + flat.y * g->y[i] + flat.z * g->z[i];
        const float known = ((above >= g->edge[i]) & (above_flat >= g->edge[i])) ? is_known : 0.0f;
        const float value = lobe.diffuse * (1.0f - known) + left;
        p->knows_diffuse[i] = known;
        p->value[i] = value;
        groups->taken[i] = light * (left * (divisor - 1.0f));
        p->weight[i] = light * value;
        groups->specular_part[i] = light * left;
        groups->is_low[i] = low & taken;
    }
}

/* ---- tiles ---- */

/* Of a group that is not black: then a tile has a weight of at least the number of tiles, so that each of the others,
 * however dark, can have 1 or more. */
enum { POINT_LEAST_WEIGHT = TILE_GROUP * TILE_GROUP };

/* What the tiles of a group that has been looked at weigh together, and their hues. */
static inline void add_tiles(const tiles *t, uint32_t group, group_lobes *restrict groups, point_tiles *restrict p)
{
    const uint32_t first = group * TILE_GROUP;
    const float *weights = p->looked_at + first;
    for (int c = 0; c < 3; c++) {
        const float *hues = t->colours.hue[c] + first;
        float *sums = groups->hues[c];
#pragma omp simd
        for (uint32_t i = 0; i < TILE_GROUP; i++)
            sums[i] += weights[i] * hues[i];
    }
    p->weight[group] = sum_of_tiles(weights);
    p->is_shared[group] = 0;
}

/* With one value of the BRDF for all. */
static inline __attribute__((always_inline)) void weigh_alike(const tiles *t, const tile_lobe *lobe, uint32_t first,
                                                              float value, float *restrict weights)
{
    const vec3 normal = lobe->normal;
    const float edge = lobe->edge, slope = lobe->slope;
    const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        weights[i] = light[i] * (soft_cosine(dot(normal, (vec3){x[i], y[i], z[i]}), edge, slope) * value);
}

/* With a value for each. taken: adds what BRDF samples take. */
static inline __attribute__((always_inline)) void weigh_apart(helio_material_kind kind, const tiles *t,
                                                              const tile_lobe *lobe, uint32_t first, float diffuse,
                                                              float *restrict weights, float *restrict taken)
{
    const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
    const float *spread = t->spread + first;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++) {
        const vec3 direction = {x[i], y[i], z[i]};
        const float cosine = dot(lobe->normal, direction), soft = soft_cosine(cosine, lobe->edge, lobe->slope);
        const float divisor = 1.0f + lobe->to_surface * spread[i];
        const float specular = specular_at(kind, lobe, direction, lobe->width, cosine, soft, divisor);
        weights[i] = light[i] * (soft * (diffuse + specular));
        taken[i] += light[i] * (soft * (specular * (divisor - 1.0f)));
    }
}

/* Looks at the tiles of those groups of which the specular lobe has more than `least`. */
static inline __attribute__((always_inline)) void refine_groups(helio_material_kind kind, const tiles *t,
                                                                const tile_lobe *lobe, float least,
                                                                group_lobes *restrict groups, point_tiles *restrict p)
{
    for (uint32_t begin = 0; begin < TILE_GROUPS; begin += TILE_RUN) {
        int32_t taken[TILE_RUN];
#pragma omp simd
        for (uint32_t i = 0; i < TILE_RUN; i++)
            taken[i] = groups->specular_part[begin + i] > least;
        for (uint32_t rest = bits_of(taken); rest != 0; rest &= rest - 1) {
            const uint32_t group = begin + (uint32_t)__builtin_ctz(rest), first = group * TILE_GROUP;
            const float diffuse = lobe->diffuse * (1.0f - p->knows_diffuse[group]);
            weigh_apart(kind, t, lobe, first, diffuse, p->looked_at + first, groups->tiles_taken);
            add_tiles(t, group, groups, p);
            groups->taken[group] = 0.0f;
            groups->is_low[group] = 0;
        }
    }
}

/* ... and of those others where the horizon may pass among them. */
static inline __attribute__((always_inline)) void cut_groups(const tiles *t, const tile_lobe *lobe,
                                                             group_lobes *restrict groups, point_tiles *restrict p)
{
    for (uint32_t begin = 0; begin < TILE_GROUPS; begin += TILE_RUN)
        for (uint32_t rest = bits_of(groups->is_low + begin); rest != 0; rest &= rest - 1) {
            const uint32_t group = begin + (uint32_t)__builtin_ctz(rest), first = group * TILE_GROUP;
            weigh_alike(t, lobe, first, p->value[group], p->looked_at + first);
            add_tiles(t, group, groups, p);
        }
}

static inline __attribute__((always_inline)) void weigh_groups(helio_material_kind kind, const tiles *t,
                                                               const tile_lobe *given, group_lobes *restrict groups,
                                                               point_tiles *restrict p)
{
    const tile_lobe lobe = *given;
    memset(groups->tiles_taken, 0, sizeof groups->tiles_taken);
    memset(groups->hues, 0, sizeof groups->hues);
    memset(p->is_shared, 1, sizeof p->is_shared);
    look_at_groups(kind, t, &lobe, groups, p);
    refine_groups(kind, t, &lobe, sum_of_groups(p->weight) * lobe.least_part, groups, p);
    cut_groups(t, &lobe, groups, p);
}

/* Adds the sums over groups, by colour, of factor x normal . vector. */
static inline void add_along(vec3 normal, const float (*vectors)[3][TILE_GROUPS], const float *factors, float sums[3])
{
    for (int c = 0; c < 3; c++) {
        const float *x = vectors[c][0], *y = vectors[c][1], *z = vectors[c][2];
        float sum = 0.0f;
#pragma omp simd reduction(+ : sum)
        for (uint32_t i = 0; i < TILE_GROUPS; i++)
            sum += factors[i] * (normal.x * x[i] + normal.y * y[i] + normal.z * z[i]);
        sums[c] += sum;
    }
}

/* Of groups that share one value of the BRDF among tiles that are all above the horizon their mean hue is known. */
static void mix_hues(const group_lobes *groups, point_tiles *p)
{
    float values[TILE_GROUPS];
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUPS; i++)
        values[i] = masked(p->value[i], -((p->is_shared[i] != 0) & (p->weight[i] > 0.0f)));
    for (int c = 0; c < 3; c++)
        p->hue[c] = sum_of_tiles(groups->hues[c]);
    add_along(p->normal, p->tiles->groups.hue, values, p->hue);
    for (int c = 0; c < 3; c++)
        p->hue[c] = p->brightness > 0.0f ? p->hue[c] / p->brightness : 0.0f;
}

static void find_irradiance(point_tiles *p)
{
    memset(p->irradiance, 0, sizeof p->irradiance);
    add_along(p->normal, p->tiles->groups.radiance, p->knows_diffuse, p->irradiance);
}

/* Groups that weigh less count as black, so that nothing that know_tiles() divides is subnormal. */
static const float BLACK_BELOW = 0x1p-100f;

/* What part each group has of all, and BRDF samples have beside them. */
static void share_out(group_lobes *groups, point_tiles *p)
{
    int32_t largest = 0;
#pragma omp simd reduction(max : largest)
    for (uint32_t i = 0; i < TILE_GROUPS; i++) {
        p->weight[i] = masked(p->weight[i], -(p->weight[i] >= BLACK_BELOW));
        const int32_t bits = bits_of_float(p->weight[i]); /* see tables_kernel.c for why by its bits */
        largest = bits > largest ? bits : largest;
    }
    const float light = sum_of_groups(p->weight);
    const float taken = sum_of_groups(groups->taken) + sum_of_tiles(groups->tiles_taken);
    const int exponent = fixed_point_exponent(float_of_bits(largest), tables_summand_bits(TILE_GROUPS));
    const float factor = fixed_point_power(exponent);
    uint32_t integers[TILE_GROUPS];
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUPS; i++) {
        const uint32_t integer = fixed_point_integer(p->weight[i], factor);
        integers[i] = integer > 0 && integer < POINT_LEAST_WEIGHT ? POINT_LEAST_WEIGHT : integer;
    }
    memset(p->is_known, 0, sizeof p->is_known);
    p->total = p->sums[TILE_GROUPS] = fixed_point_scan(integers, TILE_GROUPS, 0, p->sums);
    p->brightness = light;
    p->left = taken > 0.0f ? taken / (taken + light) : 0.0f;
    p->share = p->total != 0 ? 1.0f / (float)p->total : 0.0f;
}

void KERNEL(weigh_point)(const tiles *t, const tile_lobe *lobe, point_tiles *p)
{
    group_lobes groups;
    p->tiles = t;
    p->normal = lobe->normal;
    if (lobe->kind == HELIO_MATERIAL_PHONG)
        weigh_groups(HELIO_MATERIAL_PHONG, t, lobe, &groups, p);
    else
        weigh_groups(HELIO_MATERIAL_GGX, t, lobe, &groups, p);
    share_out(&groups, p);
    mix_hues(&groups, p);
    if (lobe->knows_diffuse)
        find_irradiance(p);
}

/* The tiles of a group that share the BRDF, and are above the horizon. */
static inline void weigh_shared(const point_tiles *p, uint32_t group, float *restrict weights)
{
    const vec3 normal = p->normal;
    const tiles *t = p->tiles;
    const float value = p->value[group];
    const uint32_t first = group * TILE_GROUP;
    const float *x = t->x + first, *y = t->y + first, *z = t->z + first, *light = t->light + first;
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        weights[i] = light[i] * (dot(normal, (vec3){x[i], y[i], z[i]}) * value);
}

/* A tile that has at least a 16th of the weight of them all, or nearly so. */
static inline uint32_t heavy_tile(const float *weights, float sum)
{
    const float least = sum * (0.99f / TILE_GROUP);
    int32_t is_heavy[TILE_GROUP];
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        is_heavy[i] = weights[i] >= least;
    return (uint32_t)__builtin_ctz(bits_of(is_heavy) | 1u << (TILE_GROUP - 1));
}

/* Integers that sum to that of the group: rounded down, and what is left over or too much a heavy tile takes. */
void KERNEL(know_tiles)(point_tiles *p, uint32_t group)
{
    const uint32_t first = group * TILE_GROUP, whole = p->sums[group + 1] - p->sums[group];
    float *weights = p->looked_at + first;
    uint32_t *integers = p->weights + first;
    p->is_known[group] = true;
    if (whole == 0) {
        memset(integers, 0, TILE_GROUP * sizeof *integers);
        return;
    }
    if (p->is_shared[group])
        weigh_shared(p, group, weights);
    const float factor = (float)(int32_t)whole, per_weight = 1.0f / p->weight[group];
    uint32_t sum = 0;
#pragma omp simd reduction(+ : sum)
    for (uint32_t i = 0; i < TILE_GROUP; i++) {
        const int32_t least = weights[i] > 0.0f, integer = (int32_t)(weights[i] * per_weight * factor);
        integers[i] = (uint32_t)(integer > least ? integer : least);
        sum += integers[i];
    }
    integers[heavy_tile(weights, p->weight[group])] += whole - sum;
}

/* ---- samples ---- */

static void know_tiles_of(void *user, uint32_t group)
{
    point_tiles *p = user;
    if (!p->is_known[group])
        KERNEL(know_tiles)(p, group);
}

void KERNEL(choose_tiles)(gathering *g, uint32_t first, uint32_t count, sample_block *block)
{
    const normal_bins *bins = g->pools->bins;
    const tile_tree tree = {.sums = g->tiles.sums,
                            .weights = g->tiles.weights,
                            .list_starts = bins->list_starts,
                            .know = know_tiles_of,
                            .user = &g->tiles,
                            .listed = bins->listed};
    tile_tree_draw(&tree, true, g->counts.realised[0], first, count, g->tile_seed, block->draws);
    block->draw_count = count;
}

void KERNEL(take_tiles)(const gathering *g, sample_block *block)
{
    const listed_sample *listed = g->pools->bins->listed;
    const float expected = g->counts.expected[0];
    const float brightness = g->tiles.brightness;
    float red = 0.0f, green = 0.0f, blue = 0.0f;
    for (uint32_t i = 0; i < block->draw_count; i++) {
        const tile_draw *draw = &block->draws[i];
        const listed_sample *sample = &listed[draw->element];
        const float probability = point_tiles_probability(&g->tiles, draw->position);
        /* The mean hue is by weights, which integers only nearly are. */
        const float exactly = g->tiles.looked_at[draw->position] / (brightness * probability);
        block->samples[SAMPLE_X][i] = sample->direction[0];
        block->samples[SAMPLE_Y][i] = sample->direction[1];
        block->samples[SAMPLE_Z][i] = sample->direction[2];
        block->samples[SAMPLE_RED][i] = sample->radiance[0];
        block->samples[SAMPLE_GREEN][i] = sample->radiance[1];
        block->samples[SAMPLE_BLUE][i] = sample->radiance[2];
        block->samples[SAMPLE_DENSITY][i] = probability * sample->density * expected;
        block->known[i] = g->tiles.knows_diffuse[draw->position / TILE_GROUP];
        red += exactly * sample->hue[0];
        green += exactly * sample->hue[1];
        blue += exactly * sample->hue[2];
    }
    block->hue[0] = red;
    block->hue[1] = green;
    block->hue[2] = blue;
    block->count = block->draw_count;
}
