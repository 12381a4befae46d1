/* SPDX-License-Identifier: MIT */
#include "env/overlap_list.h"

#include "core/context.h"
#include "env/overlap_draft.h"

/* How much of a list there is, or where something goes. */
typedef struct list_place {
    size_t tile, window, span, batch, part, weight;
} list_place;

/* Rectangles of up to OVERLAP_RUN_LIMIT pixels have so many shapes; batches are for the first parts of texels or for
 * others. */
enum { SHAPES = 119, BATCH_KEYS = SHAPES * 2 };

/* Makes some tiles, or counts what they have. */
typedef struct list_maker {
    const overlap_draft *draft;
    const overlap_list *list; /* NULL: to count only */
    list_place at;

    overlap_window window;                      /* in the making */
    uint16_t row_begins[OVERLAP_WINDOW_PIXELS]; /* columns of the window that are wanted, by its rows */
    uint16_t row_ends[OVERLAP_WINDOW_PIXELS];
    overlap_batch batches[BATCH_KEYS]; /* of a row of texels in it, by their keys */
    size_t next_part[BATCH_KEYS], next_weight[BATCH_KEYS];
} list_maker;

static uint32_t lesser_of(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t greater_of(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* ---- what texels see ---- */

/* A rectangle of texels, or of pixels in a quarter of the map. */
typedef struct area {
    uint32_t first_row, end_row, first_column, end_column;
    unsigned quarter;
} area;

/* Makes an area hold a run, too. Returns false, and leaves it, if there is no such window. */
static bool widen(area *seen, const overlap_run *run)
{
    area wider = {run->row, run->row + run->more_rows + 1u, run->column, run->column + run->count, run->quarter};
    if (seen->end_row > 0) {
        wider.first_row = lesser_of(wider.first_row, seen->first_row);
        wider.end_row = greater_of(wider.end_row, seen->end_row);
        wider.first_column = lesser_of(wider.first_column, seen->first_column);
        wider.end_column = greater_of(wider.end_column, seen->end_column);
        if (run->quarter != seen->quarter)
            return false;
    }
    if ((uint64_t)(wider.end_row - wider.first_row) * (wider.end_column - wider.first_column) > OVERLAP_WINDOW_PIXELS)
        return false;
    *seen = wider;
    return true;
}

/* Makes an area hold the runs of a texel from one on. Returns how many it can hold. */
static size_t widen_by_texel(area *seen, const draft_texel *texel)
{
    size_t count = 0;
    while (count < texel->run_count && widen(seen, &texel->runs[count]))
        count++;
    return count;
}

/* ---- parts ---- */

/* A pixel more in each view costs about a third of what a part costs by itself. */
enum { PIXELS_FOR_A_PART = 3 };

/* The rectangle around all runs of a texel, if that is better than the runs. */
static bool find_rectangle(const draft_texel *texel, overlap_run *rectangle)
{
    area seen = {0};
    if (texel->run_count == 1 || texel->run_count > OVERLAP_RUN_LIMIT ||
        widen_by_texel(&seen, texel) < texel->run_count)
        return false;
    size_t rows = seen.end_row - seen.first_row, columns = seen.end_column - seen.first_column;
    if (rows * columns > OVERLAP_RUN_LIMIT ||
        rows * columns > texel->weight_count + PIXELS_FOR_A_PART * (texel->run_count - 1))
        return false;
    *rectangle = (overlap_run){.column = seen.first_column,
                               .row = (uint16_t)seen.first_row,
                               .count = (uint8_t)columns,
                               .quarter = seen.quarter & 3,
                               .more_rows = (rows - 1) & 31};
    return true;
}

static void fill_rectangle(const draft_texel *texel, const overlap_run *rectangle, float *weights)
{
    const float *from = texel->weights;
    for (size_t i = 0; i < texel->run_count; i++) {
        const overlap_run *run = &texel->runs[i];
        for (unsigned row = 0; row <= run->more_rows; row++) {
            float *to =
                weights + (run->row + row - rectangle->row) * rectangle->count + run->column - rectangle->column;
            for (unsigned k = 0; k < run->count; k++)
                to[k] = *from++;
        }
    }
}

typedef void (*part_visitor)(list_maker *maker, uint32_t place, const overlap_run *run, const float *weights,
                             bool adds);

/* Visits the parts of a texel. adds: it had some before. */
static void visit_texel(list_maker *maker, const draft_texel *texel, uint32_t place, bool adds, part_visitor visit)
{
    overlap_run rectangle;
    if (find_rectangle(texel, &rectangle)) {
        float weights[OVERLAP_RUN_LIMIT] = {0};
        fill_rectangle(texel, &rectangle, weights);
        visit(maker, place, &rectangle, weights, adds);
        return;
    }
    const float *weights = texel->weights;
    for (size_t i = 0; i < texel->run_count; i++) {
        visit(maker, place, &texel->runs[i], weights, adds || i > 0);
        weights += texel->runs[i].count * (texel->runs[i].more_rows + 1u);
    }
}

static overlap_batch batch_of(const overlap_run *run, bool adds)
{
    return (overlap_batch){.rows = (uint8_t)(run->more_rows + 1), .columns = run->count, .adds = adds};
}

static unsigned key_of(const overlap_batch *batch)
{
    unsigned shape = batch->columns - 1u;
    for (unsigned rows = 1; rows < batch->rows; rows++)
        shape += OVERLAP_RUN_LIMIT / rows;
    return (batch->adds ? SHAPES : 0) + shape;
}

static void count_part(list_maker *maker, uint32_t place, const overlap_run *run, const float *weights, bool adds)
{
    overlap_batch batch = batch_of(run, adds), *found = &maker->batches[key_of(&batch)];
    (void)place;
    (void)weights;
    batch.count = (uint16_t)(found->count + 1);
    *found = batch;
    const uint32_t column = run->column - maker->window.column, row = run->row - maker->window.row;
    for (uint32_t i = row; i <= row + run->more_rows; i++) {
        maker->row_begins[i] = (uint16_t)lesser_of(maker->row_begins[i], column);
        maker->row_ends[i] = (uint16_t)greater_of(maker->row_ends[i], column + run->count);
    }
}

static void place_part(list_maker *maker, uint32_t place, const overlap_run *run, const float *weights, bool adds)
{
    const overlap_batch batch = batch_of(run, adds);
    const unsigned key = key_of(&batch), count = (unsigned)batch.rows * batch.columns;
    const overlap_window *window = &maker->window;
    const uint32_t pixel = (run->row - window->row) * window->pitch + run->column - window->column;
    maker->list->parts[maker->next_part[key]++] = (overlap_part){(uint16_t)pixel, (uint16_t)place};
    for (unsigned i = 0; i < count; i++)
        maker->list->weights[maker->next_weight[key]++] = weights[i];
}

/* ---- windows ---- */

/* Finds where the batches that were counted go. */
static void begin_batches(list_maker *maker)
{
    overlap_batch *last = NULL;
    for (unsigned key = 0; key < BATCH_KEYS; key++) {
        overlap_batch *batch = &maker->batches[key];
        if (batch->count == 0)
            continue;
        last = batch;
        maker->next_part[key] = maker->at.part;
        maker->next_weight[key] = maker->at.weight;
        maker->at.part += batch->count;
        maker->at.weight += (size_t)batch->count * batch->rows * batch->columns;
    }
    last->last = true;
}

static void write_batches(list_maker *maker)
{
    for (unsigned key = 0; key < BATCH_KEYS; key++) {
        if (maker->batches[key].count == 0)
            continue;
        if (maker->list != NULL)
            maker->list->batches[maker->at.batch] = maker->batches[key];
        maker->at.batch++;
        maker->batches[key].count = 0;
    }
}

/* Some texels of a row; of a large texel its runs in this window. */
typedef struct texel_row {
    const draft_texel *large; /* or NULL */
    bool adds;                /* the large one had runs before */
    uint32_t row, first_column, end_column;
} texel_row;

static void visit_row(list_maker *maker, const texel_row *texels, part_visitor visit)
{
    if (texels->large != NULL) {
        visit_texel(maker, texels->large, 0, texels->adds, visit);
        return;
    }
    for (uint32_t column = texels->first_column; column < texels->end_column; column++) {
        draft_texel texel = overlap_draft_texel(maker->draft, texels->row, column);
        visit_texel(maker, &texel, column - texels->first_column, false, visit);
    }
}

static void make_row(list_maker *maker, const texel_row *texels)
{
    visit_row(maker, texels, count_part);
    begin_batches(maker);
    if (maker->list != NULL)
        visit_row(maker, texels, place_part);
    write_batches(maker);
}

static void begin_window(list_maker *maker, const area *seen)
{
    maker->window = (overlap_window){.row = seen->first_row,
                                     .column = seen->first_column,
                                     .pitch = (uint16_t)(seen->end_column - seen->first_column),
                                     .quarter = (uint8_t)seen->quarter,
                                     .span = maker->at.span,
                                     .batch = maker->at.batch,
                                     .part = maker->at.part,
                                     .weight = maker->at.weight};
    for (uint32_t row = 0; row < seen->end_row - seen->first_row; row++) {
        maker->row_begins[row] = maker->window.pitch;
        maker->row_ends[row] = 0;
    }
}

static void end_window(list_maker *maker, const area *seen)
{
    for (uint32_t row = 0; row < seen->end_row - seen->first_row; row++) {
        uint16_t begin = maker->row_begins[row], end = maker->row_ends[row];
        if (begin >= end)
            continue;
        if (maker->list != NULL)
            maker->list->spans[maker->at.span] = (overlap_span){(uint16_t)row, begin, (uint16_t)(end - begin)};
        maker->at.span++;
    }
    maker->window.span_count = (uint32_t)(maker->at.span - maker->window.span);
    if (maker->list != NULL)
        maker->list->windows[maker->at.window] = maker->window;
    maker->at.window++;
}

/* ---- tiles ---- */

static void end_tile(list_maker *maker, const area *texels, size_t first_window, const area *seen, bool deep)
{
    if (maker->list != NULL)
        maker->list->tiles[maker->at.tile] = (overlap_tile){.first_row = texels->first_row,
                                                            .end_row = texels->end_row,
                                                            .first_column = texels->first_column,
                                                            .end_column = texels->end_column,
                                                            .window_count = (uint32_t)(maker->at.window - first_window),
                                                            .window = first_window,
                                                            .least_map_row = seen->first_row,
                                                            .greatest_map_row = seen->end_row - 1,
                                                            .deep = deep};
    maker->at.tile++;
}

/* A texel that sees more than one window. */
static void make_large_texel(list_maker *maker, const area *texels)
{
    draft_texel left = overlap_draft_texel(maker->draft, texels->first_row, texels->first_column);
    const size_t first_window = maker->at.window;
    const bool deep = left.weight_count > OVERLAP_SHALLOW;
    area all = {.first_row = UINT32_MAX};
    for (bool adds = false; left.run_count > 0; adds = true) {
        area seen = {0};
        draft_texel here = left;
        here.run_count = widen_by_texel(&seen, &left);
        here.weight_count = 0;
        for (size_t i = 0; i < here.run_count; i++)
            here.weight_count += left.runs[i].count * (left.runs[i].more_rows + 1u);
        begin_window(maker, &seen);
        make_row(maker, &(texel_row){.large = &here, .adds = adds});
        end_window(maker, &seen);
        left = (draft_texel){left.runs + here.run_count, left.weights + here.weight_count,
                             left.run_count - here.run_count, left.weight_count - here.weight_count};
        all.first_row = lesser_of(all.first_row, seen.first_row);
        all.end_row = greater_of(all.end_row, seen.end_row);
    }
    end_tile(maker, texels, first_window, &all, deep);
}

static void make_tile(list_maker *maker, const area *texels, const area *seen, bool deep)
{
    const size_t first_window = maker->at.window;
    begin_window(maker, seen);
    for (uint32_t row = texels->first_row; row < texels->end_row; row++)
        make_row(maker,
                 &(texel_row){.row = row, .first_column = texels->first_column, .end_column = texels->end_column});
    end_window(maker, seen);
    end_tile(maker, texels, first_window, seen, deep);
}

/* Whether texels see no more than a window. */
static bool find_window(const overlap_draft *draft, const area *texels, area *seen, bool *deep)
{
    *seen = (area){0};
    *deep = false;
    for (uint32_t row = texels->first_row; row < texels->end_row; row++)
        for (uint32_t column = texels->first_column; column < texels->end_column; column++) {
            draft_texel texel = overlap_draft_texel(draft, row, column);
            if (widen_by_texel(seen, &texel) < texel.run_count)
                return false;
            *deep = *deep || texel.weight_count > OVERLAP_SHALLOW;
        }
    return true;
}

/* Halves an area until each part sees no more than a window. */
static void make_tiles(list_maker *maker, const area *texels)
{
    const uint32_t rows = texels->end_row - texels->first_row, columns = texels->end_column - texels->first_column;
    area seen, first = *texels, second = *texels;
    bool deep;
    if (find_window(maker->draft, texels, &seen, &deep)) {
        make_tile(maker, texels, &seen, deep);
        return;
    }
    if (rows == 1 && columns == 1) {
        make_large_texel(maker, texels);
        return;
    }
    if (rows >= columns)
        first.end_row = second.first_row = texels->first_row + rows / 2;
    else
        first.end_column = second.first_column = texels->first_column + columns / 2;
    make_tiles(maker, &first);
    make_tiles(maker, &second);
}

/* ---- lists ---- */

typedef struct list_making {
    const overlap_draft *draft;
    const overlap_list *list;
    uint32_t high, wide, across; /* texels of a block, which becomes a tile or several; blocks side by side */
    list_place *places;          /* of each block; while counting, what it has */
} list_making;

static void make_block(const list_making *work, size_t index, list_maker *maker)
{
    uint32_t row = (uint32_t)(index / work->across) * work->high;
    uint32_t column = (uint32_t)(index % work->across) * work->wide;
    area texels = {row, lesser_of(row + work->high, work->draft->half), column,
                   lesser_of(column + work->wide, work->draft->half), 0};
    make_tiles(maker, &texels);
}

static void count_block(void *data, size_t index)
{
    const list_making *work = data;
    list_maker maker = {.draft = work->draft};
    make_block(work, index, &maker);
    work->places[index] = maker.at;
}

static void fill_block(void *data, size_t index)
{
    const list_making *work = data;
    list_maker maker = {.draft = work->draft, .list = work->list, .at = work->places[index]};
    make_block(work, index, &maker);
}

/* Counts become places. Returns what all have. */
static list_place place_blocks(list_place *places, size_t count)
{
    list_place end = {0};
    for (size_t i = 0; i < count; i++) {
        list_place own = places[i];
        places[i] = end;
        end = (list_place){end.tile + own.tile,   end.window + own.window, end.span + own.span,
                           end.batch + own.batch, end.part + own.part,     end.weight + own.weight};
    }
    return end;
}

static helio_status allocate_list(helio_context *context, const list_place *size, overlap_list *list)
{
    list->tile_count = size->tile;
    list->tiles = context_allocate(context, size->tile, sizeof *list->tiles);
    list->windows = context_allocate(context, size->window, sizeof *list->windows);
    list->spans = context_allocate(context, size->span, sizeof *list->spans);
    list->batches = context_allocate(context, size->batch, sizeof *list->batches);
    list->parts = context_allocate(context, size->part, sizeof *list->parts);
    list->weights = context_allocate(context, size->weight, sizeof *list->weights);
    return list->tiles && list->windows && list->spans && list->batches && list->parts && list->weights
               ? HELIO_OK
               : HELIO_ERR_MEMORY;
}

/* Blocks are wide, as a row has a batch for each shape, and what a row of the map has for them is read at once; and
 * there are some for each thread. */
static helio_status fill_list(helio_context *context, const overlap_draft *draft, overlap_list *list)
{
    enum { ROWS = 16, LEAST_COUNT = 8 };
    list_making work = {.draft = draft, .list = list};
    work.wide = lesser_of(draft->half, OVERLAP_TILE_COLUMNS);
    work.high = lesser_of((draft->half + LEAST_COUNT - 1) / LEAST_COUNT, ROWS);
    work.across = (draft->half + work.wide - 1) / work.wide;
    const size_t count = (size_t)work.across * ((draft->half + work.high - 1) / work.high);
    work.places = context_allocate(context, count, sizeof *work.places);
    if (work.places == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, count, count_block, &work);
    list_place size = place_blocks(work.places, count);
    helio_status status = allocate_list(context, &size, list);
    if (status == HELIO_OK)
        context_parallel_for(context, count, fill_block, &work);
    context_release(context, work.places);
    return status;
}

helio_status overlap_list_create(helio_context *context, uint32_t size, overlap_generator generate,
                                 const void *geometry, overlap_list *list)
{
    overlap_draft draft;
    helio_status status = overlap_draft_create(context, size, generate, geometry, &draft);
    if (status == HELIO_OK)
        status = fill_list(context, &draft, list);
    overlap_draft_release(context, &draft);
    return status;
}

void overlap_list_release(helio_context *context, overlap_list *list)
{
    context_release(context, list->weights);
    context_release(context, list->parts);
    context_release(context, list->batches);
    context_release(context, list->spans);
    context_release(context, list->windows);
    context_release(context, list->tiles);
}
