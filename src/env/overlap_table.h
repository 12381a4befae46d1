/* SPDX-License-Identifier: MIT
 * overlap_table.h - the overlaps of lists texel by texel, for machines that have a thread for each texel. The weights
 * are those of the lists, and a texel's patches come in the order in which the CPU sums them. */
#ifndef HELIOSTAT_SRC_OVERLAP_TABLE_H
#define HELIOSTAT_SRC_OVERLAP_TABLE_H

#include "env/overlap_list.h"

/* A rectangle of pixels under a texel. Read by shaders: see layout_patch in layout.h. */
typedef struct overlap_patch {
    uint32_t weight;      /* the first of rows x columns */
    uint32_t row, column; /* of the first pixel, as the list's views count them; columns from the first quarter on */
    uint32_t shape;       /* rows x 256 + columns */
} overlap_patch;

typedef struct overlap_table {
    uint32_t half; /* texels along an edge of a quarter */
    size_t patch_count, weight_count;
    uint32_t *starts; /* [lists][half][half], and one more: where a texel's patches begin */
    overlap_patch *patches;
    float *weights;
} overlap_table;

/* quarter_width: columns of a quarter of the map, see overlap_window. HELIO_ERR_MEMORY also where there are more
 * patches than 31 bits count, or weights than 32. */
helio_status overlap_table_create(helio_context *context, const overlap_list *lists, int list_count, uint32_t size,
                                  uint32_t quarter_width, overlap_table *table);
void overlap_table_release(helio_context *context, overlap_table *table); /* {0} is fine */

#endif
