/* SPDX-License-Identifier: MIT
 * overlap_draft.h - the overlaps of a quarter of a face as their generator writes them, texel by texel. */
#ifndef HELIOSTAT_SRC_OVERLAP_DRAFT_H
#define HELIOSTAT_SRC_OVERLAP_DRAFT_H

#include "env/overlap.h"

typedef struct overlap_draft {
    uint32_t half; /* texels along an edge */
    overlap_run *runs;
    float *weights;
    size_t *row_runs, *row_weights;   /* [half + 1]: where those of each row of texels begin */
    uint32_t *run_ends, *weight_ends; /* [half][half]: where those of each texel end, counted from there */
} overlap_draft;

typedef struct draft_texel {
    const overlap_run *runs;
    const float *weights;
    size_t run_count, weight_count;
} draft_texel;

helio_status overlap_draft_create(helio_context *context, uint32_t size, overlap_generator generate,
                                  const void *geometry, overlap_draft *draft);
void overlap_draft_release(helio_context *context, overlap_draft *draft); /* also if it could not be created */

static inline draft_texel overlap_draft_texel(const overlap_draft *draft, uint32_t row, uint32_t column)
{
    const size_t texel = (size_t)row * draft->half + column;
    const size_t run = column > 0 ? draft->run_ends[texel - 1] : 0;
    const size_t weight = column > 0 ? draft->weight_ends[texel - 1] : 0;
    return (draft_texel){draft->runs + draft->row_runs[row] + run, draft->weights + draft->row_weights[row] + weight,
                         draft->run_ends[texel] - run, draft->weight_ends[texel] - weight};
}

#endif
