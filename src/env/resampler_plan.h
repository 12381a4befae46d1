/* SPDX-License-Identifier: MIT
 * resampler_plan.h - what a resampler knows of its layout, found once and used for each frame.
 *
 * All layouts are symmetric: of the overlaps (overlap.h) of a face only one quarter is kept, and faces that differ by
 * where they are in the map share it. Each quarter of each face sees the map through a transformation of rows and
 * columns, its view. Four views, mirror images of each other, are summed together, so that what is read from a list
 * serves all four. (Four in the same direction would often need the same lines of the nearest cache: rows and quarters
 * of maps are mostly a power of two apart.) */
#ifndef HELIOSTAT_SRC_RESAMPLER_PLAN_H
#define HELIOSTAT_SRC_RESAMPLER_PLAN_H

#include "env/cube.h"
#include "env/overlap.h"
#include "env/resampler.h"

enum { MAX_LISTS = 6, GROUP_VIEWS = 4, MAX_GROUPS = CUBE_FACES, MAP_QUARTERS = 4 };

/* Where the pixels of a list's runs are in the map, and the list's texels in the cube. Row of the map: offset + sign x
 * row of the run; columns likewise, and wrapped around. */
typedef struct quarter_view {
    int64_t row_offset, row_sign;
    int64_t column_offset, column_sign;
    int64_t texel, texel_row_step, texel_column_step;
} quarter_view;

/* Mirror images: views[0] reads rows and columns of runs onwards, views[1] columns backwards, views[2] rows backwards,
 * views[3] both. */
typedef struct view_group {
    const overlap_list *list;
    unsigned filled; /* bit i: views[i] is there */
    quarter_view views[GROUP_VIEWS];
    uint8_t *readings; /* [list_rows], of this frame: row_reading that suits all views */
} view_group;

struct resampler {
    uint32_t size;          /* R */
    uint32_t width, height; /* of the map, pixels */
    int part_shift;         /* each pixel of a row is cut into 1 << part_shift columns, see plan_latlong() */
    uint32_t list_rows;     /* that the rows of runs are among */
    overlap_list lists[MAX_LISTS];
    int list_count, group_count;
    view_group groups[MAX_GROUPS];
    uint8_t *readings; /* [group_count][list_rows] */
};

/* A place in a list. */
typedef struct overlap_cursor {
    const overlap_run *run;
    const float *weight;
} overlap_cursor;

/* Column of the map, or of its parts, where a view sees a column of a quarter. */
static inline int64_t quarter_view_column(const resampler *plan, const quarter_view *view, int64_t quarter,
                                          int64_t column)
{
    int64_t width = (int64_t)plan->width << plan->part_shift;
    int64_t found = view->column_offset + view->column_sign * (quarter * (width / MAP_QUARTERS) + column);
    return (found + 2 * width) % width;
}

#endif
