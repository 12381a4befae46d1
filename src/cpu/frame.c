/* SPDX-License-Identifier: MIT
 *
 * The tiles of a frame, divided among the threads. */
#include "core/clock.h"
#include "core/context.h"
#include "cpu/renderer.h"

double frame_milliseconds(void)
{
    return 1e3 * clock_seconds();
}

static void share_counts(struct frame *frame, const frame_counts *counts)
{
    atomic_fetch_add_explicit(&frame->samples, counts->samples, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->useful, counts->useful, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->rays, counts->rays, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->points, counts->points, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->camera_rays, counts->camera_rays, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->primary_ns, (uint64_t)(counts->primary_ms * 1e6), memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->shade_ns, (uint64_t)(counts->shade_ms * 1e6), memory_order_relaxed);
}

/* Returns when it was done. */
static double work_on_tile(struct frame *frame, size_t index, double start, frame_counts *counts)
{
    struct tile tile = frame_tile(frame, index);
    double traced = start;
    if (frame->traces) {
        primary_tile(frame, tile);
        counts->camera_rays += (uint64_t)(tile.x1 - tile.x0) * (tile.y1 - tile.y0);
        traced = frame_milliseconds();
    }
    shade_tile(frame, tile, counts);
    double shaded = frame_milliseconds();
    counts->primary_ms += traced - start;
    counts->shade_ms += shaded - traced;
    return shaded;
}

/* Takes tiles until there are none or the time is over. Tiles come from a counter of the frame, not from the loop that
 * calls this for each thread: whatever that loop's order, the tiles that are done are the first ones. */
static void work(void *data, size_t thread)
{
    struct frame *frame = data;
    frame_counts counts = {0};
    double now = frame_milliseconds();
    (void)thread;
    do {
        size_t index = atomic_fetch_add_explicit(&frame->next_tile, 1, memory_order_relaxed);
        if (index >= frame->tile_count)
            break;
        now = work_on_tile(frame, index, now, &counts);
    } while (now < frame->deadline);
    share_counts(frame, &counts);
}

size_t frame_work(struct frame *frame, double slice_ms, helio_frame_info *info)
{
    helio_context *context = frame->renderer->context;
    double start = frame_milliseconds();
    uint64_t primary_before = frame->primary_ns, shade_before = frame->shade_ns;
    frame->deadline = start + slice_ms;
    context_parallel_for(context, helio_context_threads(context), work, frame);
    double elapsed = frame_milliseconds() - start;
    double primary = (double)(frame->primary_ns - primary_before), shade = (double)(frame->shade_ns - shade_before);
    double share = primary > 0.0 ? primary / (primary + shade) : 0.0;
    info->primary_ms += elapsed * share;
    info->shade_ms += elapsed * (1.0 - share);
    return frame->next_tile < frame->tile_count ? frame->next_tile : frame->tile_count;
}

/* ---- frames that stopped ---- */

typedef struct stopped_frame {
    const struct frame *frame;
    size_t tiles_done;
} stopped_frame;

static void finish_tile(void *data, size_t index)
{
    const stopped_frame *stopped = data;
    const struct frame *frame = stopped->frame;
    const struct film *film = &frame->renderer->film;
    struct tile tile = frame_tile(frame, index);
    bool is_done = index < stopped->tiles_done;
    if (is_done && frame->step.is_last)
        return; /* in the picture already */
    bool has_samples = is_done || !frame->step.is_first;
    double weight = is_done ? frame->weight : frame->weight - frame->step.samples;
    for (uint32_t row = tile.y0; row < tile.y1; row++)
        for (uint32_t column = tile.x0; column < tile.x1; column++) {
            size_t pixel = (size_t)row * film->width + column;
            film_pixel sums = {0};
            if (has_samples)
                film_load(film, pixel, &sums);
            film_develop(film, pixel, &sums, weight);
        }
}

void frame_finish(struct frame *frame, size_t tiles_done)
{
    stopped_frame stopped = {frame, tiles_done};
    context_parallel_for(frame->renderer->context, frame->tile_count, finish_tile, &stopped);
}
