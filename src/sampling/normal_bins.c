/* SPDX-License-Identifier: MIT */
#include "sampling/normal_bins.h"

#include "core/context.h"
#include "sampling/kernels.h"

enum {
    LISTS_PER_POOL = 128, /* samples of all tiles together, at most, for each of a pool */
    TILES_AT_ONCE = 16,   /* the piece of work of a thread */
};

/* ---- creation ---- */

/* What normal_bins_warp() takes to `warped`, by bisection: the same on every machine. */
static float unwarp(float warped)
{
    float low = -1.0f, high = 1.0f;
    for (int step = 0; step < 40; step++) {
        float middle = 0.5f * (low + high);
        if (normal_bins_warp(middle) < warped)
            low = middle;
        else
            high = middle;
    }
    return 0.5f * (low + high);
}

/* A point of the grid of half cells. */
static vec3 grid_point(uint32_t per_edge, uint32_t face, uint32_t row2, uint32_t column2)
{
    float step = 1.0f / (float)per_edge;
    return cube_direction(face, unwarp((float)column2 * step - 1.0f), unwarp((float)row2 * step - 1.0f));
}

/* What a unit normal that is shaken may turn by, with room for normals that are not quite unit vectors. */
static float shake_angle(float shake)
{
    return asinf(fminf(1.0f, 1.01f * sqrtf(3.0f) * shake));
}

static normal_bin make_bin(const normal_bins *b, uint32_t face, uint32_t row, uint32_t column)
{
    normal_bin bin = {.centre = grid_point(b->per_edge, face, 2 * row + 1, 2 * column + 1)};
    float least = 1.0f;
    for (uint32_t corner = 0; corner < 4; corner++)
        least = fminf(least, dot(bin.centre,
                                 grid_point(b->per_edge, face, 2 * row + corner / 2 * 2, 2 * column + corner % 2 * 2)));
    float angle = acosf(least) + shake_angle(b->shake) + b->tiles->radius;
    bin.reach = tiles_sine(angle);
    return bin;
}

static void make_bins(normal_bins *b)
{
    for (uint32_t i = 0; i < b->count; i++)
        b->bins[i] = make_bin(b, i / (b->per_edge * b->per_edge), i / b->per_edge % b->per_edge, i % b->per_edge);
}

/* A quarter of a cell in the middle of a face: each cell then blends into its neighbours over half of its width. More
 * takes points farther from the centre of their bin, which costs error. */
static float find_shake(uint32_t per_edge)
{
    return 0.4f / (float)per_edge;
}

/* Even maps give each tile the shortest of lists; a sun gets the longest. */
static uint32_t list_capacity(const normal_bins *b)
{
    uint32_t least = LIST_LEAST * b->tiles->count, for_pools = LISTS_PER_POOL * b->pool_length;
    return least > for_pools ? least : for_pools;
}

helio_status normal_bins_create(helio_context *context, uint32_t per_edge, uint32_t size, uint32_t pool_length,
                                bool has_lobes, normal_bins **out)
{
    normal_bins *b = context_allocate(context, 1, sizeof *b);
    if (b == NULL)
        return HELIO_ERR_MEMORY;
    b->context = context;
    b->per_edge = per_edge;
    b->count = CUBE_FACES * per_edge * per_edge;
    b->shake = find_shake(per_edge);
    b->pool_length = pool_length;
    helio_status status = tiles_create(context, size, &b->tiles);
    if (status == HELIO_OK) {
        b->bins = context_allocate(context, b->count, sizeof *b->bins);
        b->sums = context_allocate(context, b->count, (b->tiles->count + 1) * sizeof *b->sums);
        b->shares = context_allocate(context, b->count, sizeof *b->shares);
        if (has_lobes)
            b->lobe_variances = context_allocate(context, b->count, LOBE_CLASSES * sizeof *b->lobe_variances);
        b->capacity = list_capacity(b);
        b->listed = context_allocate(context, b->capacity, sizeof *b->listed);
        if (b->bins == NULL || b->sums == NULL || b->shares == NULL || (has_lobes && b->lobe_variances == NULL) ||
            b->listed == NULL)
            status = HELIO_ERR_MEMORY;
    }
    if (status != HELIO_OK) {
        normal_bins_destroy(b);
        return status;
    }
    make_bins(b);
    *out = b;
    return HELIO_OK;
}

void normal_bins_destroy(normal_bins *b)
{
    if (b == NULL)
        return;
    context_release(b->context, b->listed);
    context_release(b->context, b->lobe_variances);
    context_release(b->context, b->shares);
    context_release(b->context, b->sums);
    context_release(b->context, b->bins);
    tiles_destroy(b->tiles);
    context_release(b->context, b);
}

/* ---- update ---- */

static void weigh_bin(void *data, size_t bin)
{
    normal_bins *b = data;
    uint32_t *sums = b->sums + bin * (b->tiles->count + 1);
    const kernel_set *kernels = kernels_of(context_isa(b->context));
    const uint32_t total = kernels->weigh_tiles(b->tiles, &b->bins[bin], sums);
    b->shares[bin] = total != 0 ? 1.0f / (float)total : 0.0f;
    if (b->lobe_variances != NULL)
        kernels->find_lobe_variances(b->tiles, b->bins[bin].centre, b->lobe_variances + bin * LOBE_CLASSES);
}

/* ---- lists ---- */

typedef struct list_work {
    normal_bins *bins;
    const helio_tables *tables;
    uint32_t seed;
    float greatest[TILES_MOST]; /* probability of each tile, over some of the bins: neighbours differ little */
} list_work;

static void find_greatest(void *data, size_t piece)
{
    list_work *work = data;
    const normal_bins *b = work->bins;
    uint32_t first = (uint32_t)piece * TILES_AT_ONCE, end = first + TILES_AT_ONCE;
    const uint32_t stride = normal_bins_step(b);
    end = end < b->tiles->count ? end : b->tiles->count;
    for (uint32_t bin = 0; bin < b->count; bin += stride)
        for (uint32_t i = first; i < end; i++)
            work->greatest[i] = fmaxf(work->greatest[i], normal_bins_probability(b, bin, i));
}

static size_t pieces_of_tiles(const normal_bins *b)
{
    return (b->tiles->count + TILES_AT_ONCE - 1) / TILES_AT_ONCE;
}

/* Several times what the pool that takes most of a tile takes from it, but shorter where all together are too long. A
 * power of two, so that it, and with it what the list holds, mostly stays when the light changes a little. */
static uint32_t list_length(float greatest, uint32_t pool_length, uint32_t divisor)
{
    const uint32_t wanted = (uint32_t)((float)(LIST_FACTOR * pool_length) * greatest) + LIST_LEAST;
    uint32_t length = LIST_LEAST;
    while (length * divisor < wanted)
        length *= 2;
    return greatest > 0.0f ? length : 0;
}

static void size_lists(normal_bins *b, const float *greatest)
{
    uint32_t *starts = b->list_starts;
    for (uint32_t divisor = 1;; divisor++) {
        for (uint32_t i = 0; i < b->tiles->count; i++)
            starts[i + 1] = starts[i] + list_length(greatest[i], b->pool_length, divisor);
        if (starts[b->tiles->count] <= b->capacity)
            return;
    }
}

static void draw_lists(void *data, size_t piece)
{
    list_work *work = data;
    uint32_t first = (uint32_t)piece * TILES_AT_ONCE, end = first + TILES_AT_ONCE;
    end = end < work->bins->tiles->count ? end : work->bins->tiles->count;
    kernels_of(context_isa(work->bins->context))->draw_tiles(work->bins, work->tables, first, end, work->seed);
}

void normal_bins_draw_lists(normal_bins *b, const helio_tables *tables, uint32_t seed)
{
    list_work work = {.bins = b, .tables = tables, .seed = seed};
    context_parallel_for(b->context, pieces_of_tiles(b), draw_lists, &work);
}

void normal_bins_update(normal_bins *b, const helio_tables *tables)
{
    if (b->frame == tables->frame)
        return;
    tiles_update(b->tiles, tables);
    context_parallel_for(b->context, b->count, weigh_bin, b);
    list_work work = {.bins = b};
    context_parallel_for(b->context, pieces_of_tiles(b), find_greatest, &work);
    size_lists(b, work.greatest);
    b->frame = tables->frame;
}
