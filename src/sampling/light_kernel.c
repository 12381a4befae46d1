/* SPDX-License-Identifier: MIT
 *
 * The light of points that nothing shadows and whose samples come from pools alone: summed where the pools lie. The
 * faces share no direction, so that of the balance heuristic's sum one term is left, m_f pdf_f: radiance / pdf_f waits
 * in the pools, and what a point does with a sample is its cosine, the lobes of its BRDF, and sums. Multiplications and
 * additions may be fused here. */
#include "sampling/kernels.h"

/* Samples of a point side by side, whatever pool they come from, so that registers are full; and what the point does
 * with them. That is found in one loop and used in another: either's chain of operations that wait for each other is so
 * short that processors work on several registers at a time. */
typedef struct light_block {
    uint32_t count;
    alignas(64) float x[BLOCK_STRIDE];
    alignas(64) float y[BLOCK_STRIDE];
    alignas(64) float z[BLOCK_STRIDE];
    alignas(64) float red[BLOCK_STRIDE]; /* of radiance / (m_f pdf_f) */
    alignas(64) float green[BLOCK_STRIDE];
    alignas(64) float blue[BLOCK_STRIDE];
    alignas(64) float weight[BLOCK_STRIDE]; /* cosine, 0 for what does not count */
    alignas(64) float first[BLOCK_STRIDE];  /* lobes, see brdf_lobes() ... */
    alignas(64) float second[BLOCK_STRIDE]; /* ... and for PHONG_WIDE log2 of the lobe */
    alignas(64) float third[BLOCK_STRIDE];
} light_block;

/* What is summed: a kind of BRDF, perhaps by a faster form of its lobes. */
typedef enum light_form {
    LIGHT_DIFFUSE,
    LIGHT_PHONG,
    LIGHT_PHONG_WIDE, /* see phong_lobe_wide_log2() */
    LIGHT_GGX,
} light_form;

static light_form form_of(const brdf *surface)
{
    if (surface->kind == HELIO_MATERIAL_PHONG)
        return phong_is_wide(surface) ? LIGHT_PHONG_WIDE : LIGHT_PHONG;
    return surface->kind == HELIO_MATERIAL_GGX ? LIGHT_GGX : LIGHT_DIFFUSE;
}

/* ---- taking samples ---- */

/* The arrays of all pools that are read; colours weighted. */
typedef struct pool_arrays {
    const float *x, *y, *z, *red, *green, *blue;
} pool_arrays;

static pool_arrays arrays_of(const helio_pools *pools)
{
    return (pool_arrays){pools_array(pools, 0, SAMPLE_X),
                         pools_array(pools, 0, SAMPLE_Y),
                         pools_array(pools, 0, SAMPLE_Z),
                         pools_array(pools, 0, SAMPLE_WEIGHTED_RED),
                         pools_array(pools, 0, SAMPLE_WEIGHTED_GREEN),
                         pools_array(pools, 0, SAMPLE_WEIGHTED_BLUE)};
}

/* A register from the pools to the end of a block. What is too much is overwritten by the next, or never read. */
static inline __attribute__((always_inline)) void copy_register(const pool_arrays *pools, size_t from, float scale,
                                                                size_t to, light_block *restrict block)
{
#pragma omp simd
    for (size_t i = 0; i < HELIO_LANES; i++) {
        block->x[to + i] = pools->x[from + i];
        block->y[to + i] = pools->y[from + i];
        block->z[to + i] = pools->z[from + i];
        block->red[to + i] = pools->red[from + i] * scale;
        block->green[to + i] = pools->green[from + i] * scale;
        block->blue[to + i] = pools->blue[from + i] * scale;
    }
}

/* `count` samples of a pool, at least a register: a branch for none would be guessed wrong. */
static inline __attribute__((always_inline)) void copy_window(const pool_arrays *pools, size_t from, uint32_t count,
                                                              float scale, size_t to, light_block *restrict block)
{
    uint32_t copied = 0;
    do {
        copy_register(pools, from + copied, scale, to + copied, block);
        copied += HELIO_LANES;
    } while (copied < count);
}

/* Samples first ... of all that a point takes, as many as fit, counted through all pools. */
static inline __attribute__((always_inline)) void take_samples(const pool_arrays *arrays, uint32_t technique_count,
                                                               const point_block *points, uint32_t index,
                                                               uint32_t first, light_block *block)
{
    uint32_t taken = 0;
    for (uint32_t k = 0; k < technique_count; k++) {
        const uint32_t all = points->realised[k][index], skipped = first < all ? first : all;
        const uint32_t rest = all - skipped, room = BLOCK_SAMPLES - taken, count = rest < room ? rest : room;
        copy_window(arrays, points->windows[k][index] + skipped, count, points->scales[k][index], taken, block);
        taken += count;
        first -= skipped;
    }
    block->count = taken;
}

/* ---- using them ---- */

static inline vec3 lobes_in(light_form form, const brdf *surface, vec3 direction, float cosine)
{
    switch (form) {
    case LIGHT_DIFFUSE: return brdf_lobes(HELIO_MATERIAL_DIFFUSE, surface, direction, cosine);
    case LIGHT_PHONG: return brdf_lobes(HELIO_MATERIAL_PHONG, surface, direction, cosine);
    case LIGHT_PHONG_WIDE: return (vec3){1.0f, phong_lobe_wide_log2(surface, direction), 0.0f};
    default: return brdf_lobes(HELIO_MATERIAL_GGX, surface, direction, cosine);
    }
}

static inline int32_t whole_registers(uint32_t count)
{
    return ((int32_t)count + HELIO_LANES - 1) / HELIO_LANES * HELIO_LANES;
}

/* form is a constant where these are expanded, and so vanishes from the loops. */
static inline __attribute__((always_inline)) void find_lobes(light_form form, const brdf *surface,
                                                             vec3 geometric_normal, light_block *restrict block)
{
    const int32_t count = (int32_t)block->count, padded = whole_registers(block->count);
#pragma omp simd
    for (int32_t i = 0; i < padded; i++) {
        vec3 direction = {block->x[i], block->y[i], block->z[i]};
        float cosine = dot(surface->normal, direction), above = dot(geometric_normal, direction);
        cosine = cosine > 0.0f ? cosine : 0.0f;
        vec3 lobes = lobes_in(form, surface, direction, cosine);
        block->weight[i] = masked(cosine, -((i < count) & (above > 0.0f)));
        if (form == LIGHT_GGX)
            block->first[i] = lobes.x;
        if (form != LIGHT_DIFFUSE)
            block->second[i] = lobes.y;
        if (form == LIGHT_GGX)
            block->third[i] = lobes.z;
    }
}

/* Light by lobe and colour. */
typedef struct lobe_sums {
    vec3 first, second, third;
    int32_t useful;
} lobe_sums;

static inline __attribute__((always_inline)) void add_light(light_form form, const brdf *surface,
                                                            const light_block *block, lobe_sums *sums)
{
    const int32_t padded = whole_registers(block->count);
    const vec3 diffuse = surface->colours[0];
    const float shows = diffuse.x + diffuse.y + diffuse.z > 0.0f ? 1.0f : 0.0f;
    float red1 = 0, green1 = 0, blue1 = 0, red2 = 0, green2 = 0, blue2 = 0, red3 = 0, green3 = 0, blue3 = 0;
    int32_t useful = 0;
#pragma omp simd reduction(+ : red1, green1, blue1, red2, green2, blue2, red3, green3, blue3, useful)
    for (int32_t i = 0; i < padded; i++) {
        float red = block->red[i], green = block->green[i], blue = block->blue[i];
        float weight = block->weight[i], shown = shows * weight;
        float first = form == LIGHT_GGX ? weight * block->first[i] : weight;
        red1 += red * first;
        green1 += green * first;
        blue1 += blue * first;
        if (form != LIGHT_DIFFUSE) {
            float lobe = form == LIGHT_PHONG_WIDE ? exp2_fast(block->second[i]) : block->second[i];
            float second = weight * lobe;
            red2 += red * second;
            green2 += green * second;
            blue2 += blue * second;
            shown += form == LIGHT_PHONG_WIDE ? 0.0f : second; /* wide lobes are beside a diffuse one */
        }
        if (form == LIGHT_GGX) {
            float third = weight * block->third[i];
            red3 += red * third;
            green3 += green * third;
            blue3 += blue * third;
        }
        useful += shown > 0.0f;
    }
    sums->first = add(sums->first, (vec3){red1, green1, blue1});
    sums->second = add(sums->second, (vec3){red2, green2, blue2});
    sums->third = add(sums->third, (vec3){red3, green3, blue3});
    sums->useful += useful;
}

static inline vec3 product(vec3 a, vec3 b)
{
    return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline __attribute__((always_inline)) block_sum sum_point(light_form form, const helio_pools *pools,
                                                                 uint32_t samples, const point_block *points,
                                                                 uint32_t index, const brdf *surface)
{
    const vec3 geometric_normal = point_vector(&points->geometric_normal, index);
    const pool_arrays arrays = arrays_of(pools);
    light_block block;
    lobe_sums sums = {0};
    uint32_t done = 0;
    do {
        take_samples(&arrays, pools->techniques, points, index, done, &block);
        find_lobes(form, surface, geometric_normal, &block);
        add_light(form, surface, &block, &sums);
        done += block.count;
    } while (block.count > 0 && done < samples);
    vec3 light = product(sums.first, surface->colours[0]);
    if (form != LIGHT_DIFFUSE)
        light = add(light, product(sums.second, surface->colours[1]));
    if (form == LIGHT_GGX)
        light = add(light, product(sums.third, surface->colours[2]));
    return (block_sum){{light.x, light.y, light.z}, (uint32_t)sums.useful};
}

void KERNEL(sum_light)(const helio_pools *pools, uint32_t samples, const point_block *points, const brdf *surfaces,
                       block_sum *sums)
{
    for (uint32_t i = 0; i < points->count; i++) {
        if (points->surface_share[i] > 0.0f)
            continue;
        switch (form_of(&surfaces[i])) {
        case LIGHT_DIFFUSE: sums[i] = sum_point(LIGHT_DIFFUSE, pools, samples, points, i, &surfaces[i]); break;
        case LIGHT_PHONG: sums[i] = sum_point(LIGHT_PHONG, pools, samples, points, i, &surfaces[i]); break;
        case LIGHT_PHONG_WIDE: sums[i] = sum_point(LIGHT_PHONG_WIDE, pools, samples, points, i, &surfaces[i]); break;
        case LIGHT_GGX: sums[i] = sum_point(LIGHT_GGX, pools, samples, points, i, &surfaces[i]); break;
        }
    }
}
