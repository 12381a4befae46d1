/* SPDX-License-Identifier: MIT
 * resampler_plan.h - what a resampler knows of its layout, found once and used for each frame.
 *
 * All layouts are symmetric: of the overlaps (overlap.h) of a face only one quarter is kept, and faces that differ by
 * where they are in the map share it. A strip has one such list, a lat-long map two: of a side and of a pole. Each
 * quarter of each face sees the map through a transformation of rows and columns, its view. Four views, two that
 * step through the map in one direction and two in the opposite one, are summed together, so that what is read from a
 * list serves all four. (Four in the same direction would often need the same lines of the nearest cache: rows and
 * quarters of maps are mostly a power of two apart.) */
#ifndef HELIOSTAT_SRC_RESAMPLER_PLAN_H
#define HELIOSTAT_SRC_RESAMPLER_PLAN_H

#include "env/cube.h"
#include "env/overlap.h"
#include "env/resampler.h"

enum { MAX_LISTS = 2, GROUP_VIEWS = 4, MAX_GROUPS = CUBE_FACES };

/* Where the pixels of a list's runs are in the map, and the list's texels in the cube. Row of the map: offset + sign x
 * row of the run; columns likewise, and wrapped around. */
typedef struct quarter_view {
    int64_t row_offset, row_sign;
    int64_t column_offset, column_sign;
    int64_t texel, texel_row_step, texel_column_step;
} quarter_view;

/* Four views. In the first two, rows of runs go down the map; the last two step through the map backwards. */
typedef struct view_group {
    const overlap_list *list;
    int64_t column_sign; /* of the first two */
    int counts[2];       /* of the first and of the last */
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

#endif
