/* SPDX-License-Identifier: MIT */
#include "env/overlap_draft.h"

#include "core/context.h"

typedef struct drafting {
    overlap_generator generate;
    const void *geometry;
    overlap_draft *draft;
} drafting;

static void count_row(void *data, size_t row)
{
    const drafting *work = data;
    overlap_writer writer = {0};
    work->generate(work->geometry, (uint32_t)row, 0, work->draft->half, &writer);
    work->draft->row_runs[row] = writer.run_count;
    work->draft->row_weights[row] = writer.weight_count;
}

static void fill_row(void *data, size_t row)
{
    const drafting *work = data;
    const overlap_draft *draft = work->draft;
    overlap_writer writer = {.runs = draft->runs + draft->row_runs[row],
                             .weights = draft->weights + draft->row_weights[row],
                             .run_ends = draft->run_ends + row * draft->half,
                             .weight_ends = draft->weight_ends + row * draft->half};
    work->generate(work->geometry, (uint32_t)row, 0, draft->half, &writer);
}

/* Counts become places, and the last of them the sum of all. */
static void add_up(size_t *counts, uint32_t count)
{
    size_t sum = 0;
    for (uint32_t i = 0; i <= count; i++) {
        size_t own = counts[i];
        counts[i] = sum;
        sum += own;
    }
}

helio_status overlap_draft_create(helio_context *context, uint32_t size, overlap_generator generate,
                                  const void *geometry, overlap_draft *draft)
{
    const uint32_t half = (size + 1) / 2;
    drafting work = {generate, geometry, draft};
    *draft = (overlap_draft){.half = half};
    draft->row_runs = context_allocate(context, half + 1u, sizeof *draft->row_runs);
    draft->row_weights = context_allocate(context, half + 1u, sizeof *draft->row_weights);
    draft->run_ends = context_allocate(context, (size_t)half * half, sizeof *draft->run_ends);
    draft->weight_ends = context_allocate(context, (size_t)half * half, sizeof *draft->weight_ends);
    if (!draft->row_runs || !draft->row_weights || !draft->run_ends || !draft->weight_ends)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, half, count_row, &work);
    add_up(draft->row_runs, half);
    add_up(draft->row_weights, half);
    draft->runs = context_allocate(context, draft->row_runs[half], sizeof *draft->runs);
    draft->weights = context_allocate(context, draft->row_weights[half], sizeof *draft->weights);
    if (draft->runs == NULL || draft->weights == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, half, fill_row, &work);
    return HELIO_OK;
}

void overlap_draft_release(helio_context *context, overlap_draft *draft)
{
    context_release(context, draft->weights);
    context_release(context, draft->runs);
    context_release(context, draft->weight_ends);
    context_release(context, draft->run_ends);
    context_release(context, draft->row_weights);
    context_release(context, draft->row_runs);
}
