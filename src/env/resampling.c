/* SPDX-License-Identifier: MIT */
#include "env/resampling.h"

#include "core/context.h"
#include "sampling/kernels.h"

#include <stdatomic.h>

typedef struct frame_work {
    struct resampling resampling;
    const kernel_set *kernels;
    resampling_space *spaces;
    atomic_size_t next; /* tile of all lists */
    atomic_bool faults;
} frame_work;

/* The list that holds a tile of all; the tile's index becomes one of this list. */
static const overlap_list *find_list(const resampler *plan, size_t *tile)
{
    const overlap_list *list = plan->lists, *end = list + plan->list_count;
    for (; list < end && *tile >= list->tile_count; list++)
        *tile -= list->tile_count;
    return list < end ? list : NULL;
}

/* Takes tiles while there are some. Which ones changes nothing in the result. */
static void resample_tiles(void *data, size_t thread)
{
    frame_work *work = data;
    const resampler *plan = work->resampling.plan;
    for (;;) {
        size_t tile = atomic_fetch_add_explicit(&work->next, 1, memory_order_relaxed);
        const overlap_list *list = find_list(plan, &tile);
        if (list == NULL)
            return;
        for (const view_group *group = plan->groups; group < plan->groups + plan->group_count; group++)
            if (group->list == list &&
                work->kernels->resample(&work->resampling, group, &list->tiles[tile], &work->spaces[thread]))
                atomic_store_explicit(&work->faults, true, memory_order_relaxed);
    }
}

static void find_origins(struct resampling *work, int index)
{
    const resampler *plan = work->plan;
    for (int i = 0; i < MAP_QUARTERS * GROUP_VIEWS; i++) {
        const quarter_view *view = &plan->groups[index].views[i % GROUP_VIEWS];
        int64_t column = quarter_view_column(plan, view, i / GROUP_VIEWS, 0) >> plan->part_shift;
        work->origins[index][i / GROUP_VIEWS][i % GROUP_VIEWS] = map_pixels_at(&work->pixels, view->row_offset, column);
    }
}

/* Pixels are read four numbers at a time, which must not leave the map. */
static const unsigned char *find_last_pixel(const resampler *plan, const map_pixels *pixels)
{
    uint32_t numbers = pixels->pixel_bytes / map_number_bytes(pixels->numbers);
    return numbers != 3 ? NULL : map_pixels_at(pixels, pixels->row_bytes > 0 ? plan->height - 1 : 0, plan->width - 1);
}

/* Past the caches, if they would hold little of the cube when it is read: lines that are about to be overwritten are
 * not fetched then, which is a third of what there is to move. */
static bool is_large(const resampler *plan)
{
    const size_t caches = (size_t)8 << 20;
    return (size_t)CUBE_FACES * plan->size * plan->size * 3 * sizeof(float) > caches;
}

bool resampler_run(helio_context *context, resampler *plan, const map_pixels *pixels, float *cube)
{
    frame_work work = {.resampling = {.plan = plan, .pixels = *pixels, .cube = cube},
                       .kernels = kernels_of(context_isa(context)),
                       .spaces = plan->spaces};
    work.resampling.last_pixel = find_last_pixel(plan, pixels);
    work.resampling.streams = is_large(plan);
    for (int i = 0; i < plan->group_count; i++)
        find_origins(&work.resampling, i);
    context_parallel_for(context, plan->space_count, resample_tiles, &work);
    return work.faults;
}
