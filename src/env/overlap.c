/* SPDX-License-Identifier: MIT */
#include "env/overlap.h"

#include "core/context.h"

/* Whether a run of one row goes on where the latest one of the same texel ends. */
static bool continues(const overlap_writer *writer, const overlap_run *run)
{
    const overlap_run *latest = &writer->latest;
    unsigned rows = latest->more_rows + 1u;
    return writer->run_count > writer->texel_run && run->column == latest->column && run->count == latest->count &&
           run->quarter == latest->quarter && run->row == latest->row + rows &&
           (rows + 1) * run->count <= OVERLAP_RUN_LIMIT;
}

static void write_run(overlap_writer *writer, overlap_run run, const double *areas)
{
    if (continues(writer, &run))
        writer->latest.more_rows = (writer->latest.more_rows + 1) & 31;
    else
        writer->latest = run, writer->run_count++;
    if (writer->runs != NULL) {
        writer->runs[writer->run_count - 1] = writer->latest;
        for (uint32_t i = 0; i < run.count; i++) {
            float area = (float)areas[i];
            writer->weights[writer->weight_count + i] = area;
            writer->area += (double)area;
        }
    }
    writer->weight_count += run.count;
}

void overlap_write(overlap_writer *writer, overlap_run begin, const double *areas, uint32_t count)
{
    for (uint32_t first = 0, end; first < count; first = end) {
        end = first + 1;
        if (!(areas[first] > 0))
            continue;
        while (end < count && areas[end] > 0)
            end++;
        overlap_run run = begin;
        run.column += first;
        run.count = (uint8_t)(end - first);
        write_run(writer, run, areas + first);
    }
}

/* Areas become shares of their sum, so that they sum to 1 whatever was rounded. */
void overlap_end_texel(overlap_writer *writer)
{
    if (writer->runs != NULL) {
        for (size_t i = writer->texel_weight; i < writer->weight_count; i++)
            writer->weights[i] = (float)((double)writer->weights[i] / writer->area);
        writer->run_ends[writer->texel] = (uint32_t)writer->run_count;
        writer->weight_ends[writer->texel] = (uint32_t)writer->weight_count;
    }
    writer->texel++;
    writer->texel_run = writer->run_count;
    writer->texel_weight = writer->weight_count;
    writer->area = 0;
}

void overlap_geometry_release(helio_context *context, overlap_geometry *geometry)
{
    context_release(context, geometry->column_sines);
    context_release(context, geometry->cosines);
    context_release(context, geometry->borders);
}
