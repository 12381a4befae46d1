/* SPDX-License-Identifier: MIT
 * resampler_plan.h - what a resampler knows of its layout, found once and used for each frame.
 *
 * All layouts are symmetric: of the overlaps (overlap.h) of a face only one quarter is kept, and faces that differ by
 * where they are in the map share it. Each quarter of each face sees the map through a transformation of rows and
 * columns, its view. Four views, mirror images of each other, are summed together: what is read from a list serves all
 * four, and their pixels lie side by side in wide registers. */
#ifndef HELIOSTAT_SRC_RESAMPLER_PLAN_H
#define HELIOSTAT_SRC_RESAMPLER_PLAN_H

#include "env/cube.h"
#include "env/overlap_list.h"
#include "env/resampler.h"

enum { MAX_LISTS = 6, GROUP_VIEWS = 4, MAX_GROUPS = CUBE_FACES, MAP_QUARTERS = 4 };

/* Where the pixels of a list are in the map, and its texels in the cube. Row of the map: offset + sign x row of the
 * list; columns likewise, and wrapped around. */
typedef struct quarter_view {
    int64_t row_offset, row_sign;
    int64_t column_offset, column_sign;
    int64_t texel, texel_row_step, texel_column_step;
} quarter_view;

/* Mirror images: views[0] reads rows and columns of the list onwards, views[1] columns backwards, views[2] rows
 * backwards, views[3] both. */
typedef struct view_group {
    const overlap_list *list;
    unsigned filled; /* bit i: views[i] is there */
    quarter_view views[GROUP_VIEWS];
} view_group;

/* Where one thread sums. A pixel has the numbers of all views, each red, green, blue and one that nobody looks at. */
typedef struct resampling_space {
    float pixels[OVERLAP_WINDOW_PIXELS][GROUP_VIEWS * 4];
    float texels[OVERLAP_TILE_COLUMNS][GROUP_VIEWS * 4];
    double deep_texels[OVERLAP_TILE_COLUMNS][GROUP_VIEWS * 4]; /* of tiles that are deep */
} resampling_space;

enum { MAX_SPACES = 64 };

struct resampler {
    uint32_t size;          /* R */
    uint32_t width, height; /* of the map, pixels */
    int part_shift;         /* each pixel of a row is cut into 1 << part_shift columns, see plan_latlong() */
    bool sees_all;          /* every pixel of the map is under some texel */
    overlap_list lists[MAX_LISTS];
    int list_count, group_count;
    view_group groups[MAX_GROUPS];
    resampling_space *spaces; /* [space_count], for as many threads */
    uint32_t space_count;
};

/* A place in a list. */
typedef struct overlap_cursor {
    const overlap_batch *batch;
    const overlap_part *part;
    const float *weight;
} overlap_cursor;

static inline overlap_cursor overlap_cursor_at(const overlap_list *list, const overlap_window *window)
{
    return (overlap_cursor){list->batches + window->batch, list->parts + window->part, list->weights + window->weight};
}

/* Of a face with an odd number of rows or columns the middle ones are in two views: one of them has them. */
static inline bool quarter_view_has_row(const resampler *plan, const quarter_view *view, uint32_t row)
{
    return view->texel_row_step > 0 || 2 * row + 1 != plan->size;
}

static inline bool quarter_view_has_column(const resampler *plan, const quarter_view *view, uint32_t column)
{
    return view->texel_column_step > 0 || 2 * column + 1 != plan->size;
}

/* Column of the map, or of its parts, where a view sees a column of a quarter. */
static inline int64_t quarter_view_column(const resampler *plan, const quarter_view *view, int64_t quarter,
                                          int64_t column)
{
    int64_t width = (int64_t)plan->width << plan->part_shift;
    int64_t found = view->column_offset + view->column_sign * (quarter * (width / MAP_QUARTERS) + column);
    return (found + 2 * width) % width;
}

#endif
