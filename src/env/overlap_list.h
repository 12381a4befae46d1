/* SPDX-License-Identifier: MIT
 * overlap_list.h - the overlaps of a quarter of a face, in the order in which frames are summed.
 *
 * Texels come in tiles. Of the map a tile sees a window, whose pixels are brought together once for all of its texels;
 * a texel larger than any window has several. Texels of a row with pixels in rectangles of the same shape are a batch,
 * so that a frame is summed by loops of a length that is known beforehand. */
#ifndef HELIOSTAT_SRC_OVERLAP_LIST_H
#define HELIOSTAT_SRC_OVERLAP_LIST_H

#include "env/overlap.h"

#include <stdbool.h>

enum {
    OVERLAP_WINDOW_PIXELS = 2048, /* at most */
    OVERLAP_TILE_COLUMNS = 64,    /* at most */
    OVERLAP_SHALLOW = 64,         /* weights of a texel that floats are long enough for */
};

/* A rectangle of pixels of a window, under one texel. */
typedef struct overlap_part {
    uint16_t pixel; /* the first: row x pitch + column of the window */
    uint16_t texel; /* counted from the tile's first column */
} overlap_part;

/* Parts of the same shape. Their weights follow each other, each rectangle's in rows; a weight is 0 where pixels of a
 * texel were made a rectangle by others. */
typedef struct overlap_batch {
    uint16_t count; /* parts, >= 1 */
    uint8_t rows, columns;
    bool adds; /* to what texels had in batches before; else these parts are the first */
    bool last; /* of its row of texels */
} overlap_batch;

/* Pixels of a row that a window holds. Those between them and the window's edges are under none of its texels. */
typedef struct overlap_span {
    uint16_t row, column; /* in the window */
    uint16_t count;
} overlap_span;

/* A rectangle of the map, in one of its quarters; and where its spans, batches, parts and weights begin, the latter in
 * rows of texels. */
typedef struct overlap_window {
    uint32_t row, column; /* of the first pixel, in the quarter */
    uint16_t pitch;       /* pixels from a row of the window to the next */
    uint8_t quarter;
    uint32_t span_count;
    size_t span, batch, part, weight;
} overlap_window;

/* A rectangle of texels; a single texel, if there are several windows. */
typedef struct overlap_tile {
    uint32_t first_row, end_row, first_column, end_column;
    uint32_t window_count;
    size_t window;
    uint32_t least_map_row, greatest_map_row;
    bool deep; /* some texels have more weights than OVERLAP_SHALLOW */
} overlap_tile;

/* The texels with u <= 0 and v <= 0. */
typedef struct overlap_list {
    size_t tile_count;
    overlap_tile *tiles;
    overlap_window *windows;
    overlap_span *spans;
    overlap_batch *batches;
    overlap_part *parts;
    float *weights;
} overlap_list;

helio_status overlap_list_create(helio_context *context, uint32_t size, overlap_generator generate,
                                 const void *geometry, overlap_list *list);
void overlap_list_release(helio_context *context, overlap_list *list); /* {0} is fine */

#endif
