/* SPDX-License-Identifier: MIT */
#include "env/resampling.h"

#include "core/context.h"
#include "sampling/kernels.h"

typedef struct frame_work {
    struct resampling resampling;
    const kernel_set *kernels;
} frame_work;

/* All lists have the same tiles. Quarters that share the middle texels of a face are resampled by the same thread. */
static void resample_tile(void *data, size_t index)
{
    const frame_work *work = data;
    const resampler *plan = work->resampling.plan;
    for (int i = 0; i < plan->group_count; i++)
        work->kernels->resample(&work->resampling, &plan->groups[i], &plan->groups[i].list->tiles[index]);
}

static void prepare_group(struct resampling *work, int index, const uint8_t *readings)
{
    const resampler *plan = work->plan;
    const view_group *group = &plan->groups[index];
    for (uint32_t row = 0; row < plan->list_rows; row++) {
        uint8_t reading = plan->part_shift != 0 ? ROW_BY_PIXEL : ROW_AS_IT_IS;
        for (int v = 0; v < GROUP_VIEWS; v++) {
            uint8_t own = readings[group->views[v].row_offset + group->views[v].row_sign * row];
            reading = own > reading ? own : reading;
        }
        group->readings[row] = reading;
    }
    for (int i = 0; i < MAP_QUARTERS * GROUP_VIEWS; i++) {
        const quarter_view *view = &group->views[i % GROUP_VIEWS];
        int64_t column = quarter_view_column(plan, view, i / GROUP_VIEWS, 0) >> plan->part_shift;
        work->origins[index][i / GROUP_VIEWS][i % GROUP_VIEWS] = map_pixels_at(&work->pixels, view->row_offset, column);
    }
}

void resampler_run(helio_context *context, const resampler *plan, const map_pixels *pixels, const uint8_t *readings,
                   float *cube)
{
    frame_work work = {.resampling = {.plan = plan, .pixels = *pixels, .cube = cube},
                       .kernels = kernels_of(context_isa(context))};
    for (int i = 0; i < plan->group_count; i++)
        prepare_group(&work.resampling, i, readings);
    context_parallel_for(context, plan->lists[0].tile_count, resample_tile, &work);
}
