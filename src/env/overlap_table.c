/* SPDX-License-Identifier: MIT */
#include "env/overlap_table.h"

#include "core/context.h"
#include "core/error.h"

#include <string.h>

/* A table in the making: patches are counted, then placed. */
typedef struct table_maker {
    overlap_table *table;
    uint32_t quarter_width;
    size_t first_texel, first_weight; /* of the list in hand */
    bool places;
} table_maker;

static void visit_part(const table_maker *maker, const overlap_window *window, const overlap_batch *batch,
                       const overlap_part *part, size_t texel, size_t weight)
{
    uint32_t *start = &maker->table->starts[maker->first_texel + texel];
    if (!maker->places) {
        start[1]++; /* behind it, until places are known */
        return;
    }
    maker->table->patches[(*start)++] = (overlap_patch){
        .weight = (uint32_t)(maker->first_weight + weight),
        .row = window->row + part->pixel / window->pitch,
        .column = window->quarter * maker->quarter_width + window->column + part->pixel % window->pitch,
        .shape = batch->rows * UINT32_C(256) + batch->columns,
    };
}

/* Returns where the weights of the window end in the list. */
static size_t visit_window(const table_maker *maker, const overlap_list *list, const overlap_tile *tile,
                           const overlap_window *window)
{
    const overlap_batch *batch = list->batches + window->batch;
    const overlap_part *part = list->parts + window->part;
    size_t weight = window->weight;
    for (uint32_t row = tile->first_row; row < tile->end_row; row += batch->last, batch++)
        for (uint32_t i = 0; i < batch->count; i++, part++, weight += (size_t)batch->rows * batch->columns)
            visit_part(maker, window, batch, part, (size_t)row * maker->table->half + tile->first_column + part->texel,
                       weight);
    return weight;
}

/* Returns how many weights the list has. */
static size_t visit_list(const table_maker *maker, const overlap_list *list)
{
    size_t count = 0;
    for (size_t t = 0; t < list->tile_count; t++) {
        const overlap_tile *tile = &list->tiles[t];
        for (uint32_t i = 0; i < tile->window_count; i++) {
            size_t end = visit_window(maker, list, tile, &list->windows[tile->window + i]);
            count = end > count ? end : count;
        }
    }
    return count;
}

static void visit_all(table_maker *maker, const overlap_list *lists, int list_count)
{
    const size_t texels = (size_t)maker->table->half * maker->table->half;
    maker->first_texel = maker->first_weight = 0;
    for (int i = 0; i < list_count; i++) {
        const size_t count = visit_list(maker, &lists[i]);
        if (maker->places)
            memcpy(maker->table->weights + maker->first_weight, lists[i].weights, count * sizeof *lists[i].weights);
        maker->first_texel += texels;
        maker->first_weight += count;
    }
    maker->table->weight_count = maker->first_weight;
}

/* Counts behind the texels become places; placing makes each a texel's end, which is the next one's place. */
static void find_places(overlap_table *table, size_t texels)
{
    size_t sum = 0;
    for (size_t i = 0; i < texels; i++) {
        sum += table->starts[i + 1];
        table->starts[i + 1] = (uint32_t)sum;
    }
    table->patch_count = sum;
}

static void restore_places(overlap_table *table, size_t texels)
{
    memmove(table->starts + 1, table->starts, texels * sizeof *table->starts);
    table->starts[0] = 0;
}

static helio_status fill(helio_context *context, const overlap_list *lists, int list_count, table_maker *maker)
{
    overlap_table *table = maker->table;
    const size_t texels = (size_t)list_count * table->half * table->half;
    table->starts = context_allocate(context, texels + 1, sizeof *table->starts);
    if (table->starts == NULL)
        return HELIO_ERR_MEMORY;
    visit_all(maker, lists, list_count);
    find_places(table, texels);
    if (table->patch_count > INT32_MAX || table->weight_count > UINT32_MAX)
        return fail(HELIO_ERR_MEMORY, "%zu overlaps of pixels and texels are more than a device counts",
                    table->weight_count);
    table->patches = context_allocate(context, table->patch_count, sizeof *table->patches);
    table->weights = context_allocate(context, table->weight_count, sizeof *table->weights);
    if (table->patches == NULL || table->weights == NULL)
        return HELIO_ERR_MEMORY;
    maker->places = true;
    visit_all(maker, lists, list_count);
    restore_places(table, texels);
    return HELIO_OK;
}

helio_status overlap_table_create(helio_context *context, const overlap_list *lists, int list_count, uint32_t size,
                                  uint32_t quarter_width, overlap_table *table)
{
    *table = (overlap_table){.half = (size + 1) / 2};
    table_maker maker = {.table = table, .quarter_width = quarter_width};
    helio_status status = fill(context, lists, list_count, &maker);
    if (status != HELIO_OK)
        overlap_table_release(context, table);
    return status;
}

void overlap_table_release(helio_context *context, overlap_table *table)
{
    context_release(context, table->weights);
    context_release(context, table->patches);
    context_release(context, table->starts);
    *table = (overlap_table){0};
}
