/* SPDX-License-Identifier: MIT
 *
 * The light of points that nothing shadows and whose samples come from pools alone: summed where the pools lie. The
 * faces share no direction, so that of the balance heuristic's sum one term is left, m_f pdf_f: radiance / pdf_f waits
 * in the pools, and what a point does with a sample is its cosine, the lobes of its BRDF, and sums. Multiplications and
 * additions may be fused here. */
#include "sampling/kernels.h"

/* Sums that each lane keeps for itself until a point has all of its samples. */
typedef struct lane_sums {
    alignas(64) float light[BRDF_LOBES][3][HELIO_LANES]; /* of weighted radiance x cosine x lobe */
    alignas(64) int32_t useful[HELIO_LANES];
} lane_sums;

enum { PIECES = 16, PIECES_AT_ONCE = 4, PIECE_ROOM = PIECES + PIECES_AT_ONCE };

/* Registers of samples that a point reads, from all pools in one list: one loop over it, where a loop for each pool
 * would end when no processor expects it. */
typedef struct piece_list {
    uint32_t count;
    alignas(64) uint32_t first[PIECE_ROOM];         /* in the array of all pools */
    alignas(64) int32_t rest[PIECE_ROOM];           /* lanes that count: as many as are below this */
    alignas(64) float inverse_expected[PIECE_ROOM]; /* 1 / m_f */
} piece_list;

/* What a point does with the samples of its pieces. Found in one loop and used in another: either's chain of operations
 * that wait for each other is so short that processors work on several registers at a time. */
typedef struct piece_lobes {
    alignas(64) float weight[PIECE_ROOM][HELIO_LANES]; /* cosine / m_f, 0 for what does not count */
    alignas(64) float second[PIECE_ROOM][HELIO_LANES]; /* lobes, see brdf_lobes(); for PHONG_WIDE log2 of the lobe */
    alignas(64) float third[PIECE_ROOM][HELIO_LANES];
    alignas(64) float first[PIECE_ROOM][HELIO_LANES];
} piece_lobes;

/* What is summed: a kind of BRDF, perhaps by a faster form of its lobes. */
typedef enum light_form {
    LIGHT_DIFFUSE,
    LIGHT_PHONG,
    LIGHT_PHONG_WIDE, /* see phong_lobe_wide() */
    LIGHT_GGX,
} light_form;

static light_form form_of(const brdf *surface)
{
    if (surface->kind == HELIO_MATERIAL_PHONG)
        return phong_is_wide(surface) ? LIGHT_PHONG_WIDE : LIGHT_PHONG;
    return surface->kind == HELIO_MATERIAL_GGX ? LIGHT_GGX : LIGHT_DIFFUSE;
}

static inline uint32_t lobes_of(light_form form)
{
    return form == LIGHT_GGX ? 3 : form == LIGHT_DIFFUSE ? 1 : 2;
}

static inline vec3 lobes_in(light_form form, const brdf *surface, vec3 direction, float cosine)
{
    switch (form) {
    case LIGHT_DIFFUSE: return brdf_lobes(HELIO_MATERIAL_DIFFUSE, surface, direction, cosine);
    case LIGHT_PHONG: return brdf_lobes(HELIO_MATERIAL_PHONG, surface, direction, cosine);
    case LIGHT_PHONG_WIDE: return (vec3){1.0f, phong_lobe_wide_log2(surface, direction), 0.0f};
    default: return brdf_lobes(HELIO_MATERIAL_GGX, surface, direction, cosine);
    }
}

/* The arrays of all pools that are read. */
typedef struct pool_arrays {
    const float *x, *y, *z, *red, *green, *blue; /* the last three weighted */
} pool_arrays;

static inline pool_arrays arrays_of(const helio_pools *pools)
{
    return (pool_arrays){
        pools_array(pools, 0, SAMPLE_X),
        pools_array(pools, 0, SAMPLE_Y),
        pools_array(pools, 0, SAMPLE_Z),
        pools_array(pools, 0, SAMPLE_WEIGHTED_RED),
        pools_array(pools, 0, SAMPLE_WEIGHTED_GREEN),
        pools_array(pools, 0, SAMPLE_WEIGHTED_BLUE),
    };
}

/* form is a constant where these are expanded, and so vanishes from the loops. */
static inline __attribute__((always_inline)) void find_lobes(light_form form, const brdf *surface,
                                                             vec3 geometric_normal, const pool_arrays *arrays,
                                                             const piece_list *pieces, piece_lobes *found)
{
    for (uint32_t p = 0; p < pieces->count; p++) {
        const size_t first = pieces->first[p];
        const int32_t rest = pieces->rest[p];
        const float inverse_expected = pieces->inverse_expected[p];
#pragma omp simd
        for (int32_t i = 0; i < HELIO_LANES; i++) {
            const size_t k = first + (size_t)i;
            vec3 direction = {arrays->x[k], arrays->y[k], arrays->z[k]};
            float cosine = dot(surface->normal, direction), above = dot(geometric_normal, direction);
            cosine = cosine > 0.0f ? cosine : 0.0f;
            vec3 lobes = lobes_in(form, surface, direction, cosine);
            found->weight[p][i] = masked(cosine * inverse_expected, -((i < rest) & (above > 0.0f)));
            if (form == LIGHT_GGX)
                found->first[p][i] = lobes.x;
            if (form != LIGHT_DIFFUSE)
                found->second[p][i] = lobes.y;
            if (form == LIGHT_GGX)
                found->third[p][i] = lobes.z;
        }
    }
}

static inline __attribute__((always_inline)) void add_light(light_form form, const brdf *surface,
                                                            const pool_arrays *arrays, const piece_list *pieces,
                                                            const piece_lobes *found, lane_sums *sums)
{
    const vec3 diffuse = surface->colours[0];
    const float shows = diffuse.x + diffuse.y + diffuse.z > 0.0f ? 1.0f : 0.0f;
    for (uint32_t p = 0; p < pieces->count; p++) {
        const size_t first = pieces->first[p];
#pragma omp simd
        for (int32_t i = 0; i < HELIO_LANES; i++) {
            const size_t k = first + (size_t)i;
            float red = arrays->red[k], green = arrays->green[k], blue = arrays->blue[k];
            float weight = found->weight[p][i], shown = shows * weight;
            float first_lobe = form == LIGHT_GGX ? weight * found->first[p][i] : weight;
            sums->light[0][0][i] += red * first_lobe;
            sums->light[0][1][i] += green * first_lobe;
            sums->light[0][2][i] += blue * first_lobe;
            if (form != LIGHT_DIFFUSE) {
                float second = found->second[p][i];
                second = weight * (form == LIGHT_PHONG_WIDE ? exp2_fast(second) : second);
                sums->light[1][0][i] += red * second;
                sums->light[1][1][i] += green * second;
                sums->light[1][2][i] += blue * second;
                shown += form == LIGHT_PHONG_WIDE ? 0.0f : second; /* wide lobes are beside a diffuse one */
            }
            if (form == LIGHT_GGX) {
                float third = weight * found->third[p][i];
                sums->light[2][0][i] += red * third;
                sums->light[2][1][i] += green * third;
                sums->light[2][2][i] += blue * third;
            }
            sums->useful[i] += shown > 0.0f;
        }
    }
}

/* How far a point has come with listing what it reads. */
typedef struct piece_cursor {
    uint32_t pool, done; /* samples of that pool */
} piece_cursor;

/* Some registers of a window. Writes always as many, so that there is no branch. */
static inline void list_some(uint32_t first, uint32_t count, float inverse_expected, piece_list *pieces)
{
    const uint32_t at = pieces->count, registers = (count + HELIO_LANES - 1) / HELIO_LANES;
    for (uint32_t i = 0; i < PIECES_AT_ONCE; i++) {
        pieces->first[at + i] = first + i * HELIO_LANES;
        pieces->rest[at + i] = (int32_t)count - (int32_t)i * HELIO_LANES;
        pieces->inverse_expected[at + i] = inverse_expected;
    }
    pieces->count += registers < PIECES_AT_ONCE ? registers : PIECES_AT_ONCE;
}

/* What the point reads next, as much as the list holds. */
static inline void list_pieces(const helio_pools *pools, const point_block *block, uint32_t index, piece_cursor *cursor,
                               piece_list *pieces)
{
    pieces->count = 0;
    while (cursor->pool < pools->count && pieces->count < PIECES) {
        const uint32_t pool = cursor->pool, done = cursor->done, count = block->realised[pool][index];
        const uint32_t first = pool * pools->pool_length + block->windows[pool][index];
        list_some(first + done, count - done, 1.0f / block->expected[pool][index], pieces);
        cursor->done += PIECES_AT_ONCE * HELIO_LANES;
        if (cursor->done >= count)
            *cursor = (piece_cursor){pool + 1, 0};
    }
}

/* The lobes get their colours lane by lane: red, green, blue, and how many samples are useful. */
static inline __attribute__((always_inline)) void colour_lanes(light_form form, const brdf *surface,
                                                               const lane_sums *sums, float lanes[4][HELIO_LANES])
{
    const uint32_t lobe_count = lobes_of(form);
#pragma omp simd
    for (int32_t i = 0; i < HELIO_LANES; i++) {
        vec3 light = {0, 0, 0};
        for (uint32_t k = 0; k < lobe_count; k++) {
            light.x += surface->colours[k].x * sums->light[k][0][i];
            light.y += surface->colours[k].y * sums->light[k][1][i];
            light.z += surface->colours[k].z * sums->light[k][2][i];
        }
        lanes[0][i] = light.x;
        lanes[1][i] = light.y;
        lanes[2][i] = light.z;
        lanes[3][i] = (float)sums->useful[i];
    }
}

static inline __attribute__((always_inline)) void add_half(float lanes[4][HELIO_LANES], int32_t half)
{
    if (half >= HELIO_LANES)
        return;
    for (int c = 0; c < 4; c++)
#pragma omp simd
        for (int32_t i = 0; i < half; i++)
            lanes[c][i] += lanes[c][i + half];
}

/* By halves, so that these additions too are done side by side. */
static inline __attribute__((always_inline)) block_sum add_lanes(float lanes[4][HELIO_LANES])
{
    add_half(lanes, 8);
    add_half(lanes, 4);
    add_half(lanes, 2);
    add_half(lanes, 1);
    return (block_sum){{lanes[0][0], lanes[1][0], lanes[2][0]}, (uint32_t)lanes[3][0]};
}

static inline __attribute__((always_inline)) void clear_lanes(lane_sums *sums)
{
    for (int k = 0; k < BRDF_LOBES; k++)
        for (int c = 0; c < 3; c++)
#pragma omp simd
            for (int32_t i = 0; i < HELIO_LANES; i++)
                sums->light[k][c][i] = 0.0f;
#pragma omp simd
    for (int32_t i = 0; i < HELIO_LANES; i++)
        sums->useful[i] = 0;
}

static inline __attribute__((always_inline)) block_sum
sum_point(light_form form, const helio_pools *pools, const point_block *block, uint32_t index, const brdf *surface)
{
    const vec3 geometric_normal = point_vector(&block->geometric_normal, index);
    const pool_arrays arrays = arrays_of(pools);
    piece_cursor cursor = {0};
    piece_list pieces;
    piece_lobes found;
    lane_sums sums;
    alignas(64) float lanes[4][HELIO_LANES];
    clear_lanes(&sums);
    do {
        list_pieces(pools, block, index, &cursor, &pieces);
        find_lobes(form, surface, geometric_normal, &arrays, &pieces, &found);
        add_light(form, surface, &arrays, &pieces, &found, &sums);
    } while (cursor.pool < pools->count);
    colour_lanes(form, surface, &sums, lanes);
    return add_lanes(lanes);
}

void KERNEL(sum_light)(const helio_pools *pools, const point_block *block, const brdf *surfaces, block_sum *sums)
{
    for (uint32_t i = 0; i < block->count; i++)
        switch (form_of(&surfaces[i])) {
        case LIGHT_DIFFUSE: sums[i] = sum_point(LIGHT_DIFFUSE, pools, block, i, &surfaces[i]); break;
        case LIGHT_PHONG: sums[i] = sum_point(LIGHT_PHONG, pools, block, i, &surfaces[i]); break;
        case LIGHT_PHONG_WIDE: sums[i] = sum_point(LIGHT_PHONG_WIDE, pools, block, i, &surfaces[i]); break;
        case LIGHT_GGX: sums[i] = sum_point(LIGHT_GGX, pools, block, i, &surfaces[i]); break;
        }
}
