/* SPDX-License-Identifier: MIT */
#include "env/overlap.h"

#include "core/context.h"
#include "core/error.h"

/* ---- the writer ---- */

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
        writer->runs[writer->run_count - 1].last = true;
    }
    writer->texel_run = writer->run_count;
    writer->texel_weight = writer->weight_count;
    writer->area = 0;
}

/* ---- lists ---- */

/* Small enough for the cache, but some tiles for each thread. */
static uint32_t tile_size(uint32_t half)
{
    enum { LARGEST = 32, LEAST_COUNT = 8 };
    uint32_t size = (half + LEAST_COUNT - 1) / LEAST_COUNT;
    return size < LARGEST ? size : LARGEST;
}

static helio_status create_tiles(helio_context *context, uint32_t size, overlap_list *list)
{
    uint32_t half = (size + 1) / 2, step = tile_size(half), columns = (half + step - 1) / step;
    list->tile_count = (size_t)columns * columns;
    list->tiles = context_allocate(context, list->tile_count, sizeof *list->tiles);
    if (list->tiles == NULL)
        return HELIO_ERR_MEMORY;
    for (uint32_t i = 0; i < list->tile_count; i++) {
        uint32_t row = i / columns * step, column = i % columns * step;
        list->tiles[i] = (overlap_tile){.first_row = row,
                                        .end_row = row + step < half ? row + step : half,
                                        .first_column = column,
                                        .end_column = column + step < half ? column + step : half};
    }
    return HELIO_OK;
}

typedef struct list_filling {
    overlap_generator generate;
    const void *geometry;
    overlap_list *list;
} list_filling;

static void generate_tile(const list_filling *work, const overlap_tile *tile, overlap_writer *writer)
{
    for (uint32_t row = tile->first_row; row < tile->end_row; row++)
        work->generate(work->geometry, row, tile->first_column, tile->end_column, writer);
}

static void count_tile(void *data, size_t index)
{
    const list_filling *work = data;
    overlap_tile *tile = &work->list->tiles[index];
    overlap_writer writer = {0};
    generate_tile(work, tile, &writer);
    tile->run = writer.run_count;
    tile->weight = writer.weight_count;
}

static void fill_tile(void *data, size_t index)
{
    const list_filling *work = data;
    overlap_tile *tile = &work->list->tiles[index];
    overlap_writer writer = {.runs = work->list->runs + tile->run, .weights = work->list->weights + tile->weight};
    generate_tile(work, tile, &writer);
    tile->least_map_row = UINT16_MAX;
    for (size_t i = 0; i < writer.run_count; i++) {
        uint16_t first = writer.runs[i].row, last = (uint16_t)(first + writer.runs[i].more_rows);
        tile->least_map_row = first < tile->least_map_row ? first : tile->least_map_row;
        tile->greatest_map_row = last > tile->greatest_map_row ? last : tile->greatest_map_row;
    }
}

helio_status overlap_list_create(helio_context *context, uint32_t size, overlap_generator generate,
                                 const void *geometry, overlap_list *list)
{
    list_filling work = {generate, geometry, list};
    HELIO_TRY(create_tiles(context, size, list));
    context_parallel_for(context, list->tile_count, count_tile, &work);
    size_t runs = 0, weights = 0;
    for (size_t i = 0; i < list->tile_count; i++) {
        overlap_tile *tile = &list->tiles[i];
        size_t tile_runs = tile->run, tile_weights = tile->weight;
        tile->run = runs;
        tile->weight = weights;
        runs += tile_runs;
        weights += tile_weights;
    }
    list->runs = context_allocate(context, runs + OVERLAP_AHEAD, sizeof *list->runs);
    list->weights = context_allocate(context, weights, sizeof *list->weights);
    if (list->runs == NULL || list->weights == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, list->tile_count, fill_tile, &work);
    return HELIO_OK;
}

void overlap_list_release(helio_context *context, overlap_list *list)
{
    context_release(context, list->weights);
    context_release(context, list->runs);
    context_release(context, list->tiles);
}

void overlap_geometry_release(helio_context *context, overlap_geometry *geometry)
{
    context_release(context, geometry->column_sines);
    context_release(context, geometry->cosines);
    context_release(context, geometry->borders);
}
