/* SPDX-License-Identifier: MIT */
#include "vulkan/map.h"

#include "core/context.h"
#include "core/error.h"
#include "env/overlap_table.h"
#include "env/resampler_plan.h"

#include <stddef.h>
#include <string.h>

enum {
    THREADS = 128,
    COUNTED_PIXELS = 16, /* by a thread */
    LARGE_THREADS = 32,  /* that share a texel with more weights than one should add up */
    MANY_WEIGHTS = 32,
};
_Static_assert(sizeof(overlap_patch) == sizeof(struct layout_patch) &&
                   offsetof(overlap_patch, shape) == offsetof(struct layout_patch, shape),
               "patches go as they are");

/* ---- shapes ------------------------------------------------------------------------------- */

static map_shape shape_of(const helio_environment *environment, const map_pixels *pixels)
{
    const environment_map *map = &environment->map;
    const uint32_t channels = pixels->pixel_bytes / map_number_bytes(pixels->numbers);
    return (map_shape){map->width, map->height, channels, pixels->numbers, map->layout};
}

static bool is_same(const map_shape *a, const map_shape *b)
{
    return a->width == b->width && a->height == b->height && a->layout == b->layout && a->channels == b->channels &&
           a->numbers == b->numbers;
}

static uint64_t row_bytes_of(const map_shape *shape)
{
    return (uint64_t)shape->width * shape->channels * map_number_bytes(shape->numbers);
}

/* Whole words, as shaders read them. */
static uint64_t bytes_of(const map_shape *shape)
{
    return (row_bytes_of(shape) * shape->height + 3) / 4 * 4;
}

static void release_shape(vulkan_map *map)
{
    vulkan_buffer *const all[] = {&map->starts, &map->patches, &map->weights, &map->large, NULL};
    buffers_destroy(map->device, all);
    for (int i = 0; i < MAP_COPIES; i++) {
        buffer_destroy(map->device, &map->copies[i].staging);
        buffer_destroy(map->device, &map->slots[i].pixels);
        map->copies[i].frame = 0;
        map->slots[i].sent = NULL;
    }
}

static helio_status upload_new(vulkan_map *map, vulkan_buffer *buffer, const void *data, uint64_t count, uint64_t size,
                               const char *name)
{
    HELIO_TRY(buffer_create(map->device, BUFFER_ON_DEVICE, count, size, name, buffer));
    return count > 0 ? commands_upload(&map->commands, buffer, data, count * size) : HELIO_OK;
}

static bool is_large(const overlap_table *table, size_t place)
{
    size_t weights = 0;
    for (uint32_t i = table->starts[place]; i < table->starts[place + 1]; i++)
        weights += (size_t)(table->patches[i].shape >> 8) * (table->patches[i].shape & 255);
    return weights > MANY_WEIGHTS;
}

/* Which of the shader's views a view is. */
static uint32_t view_index(const resampler *plan, const quarter_view *view)
{
    const int64_t texels = (int64_t)plan->size * plan->size;
    return (uint32_t)(view->texel / texels) * 4 + (view->texel_row_step < 0 ? 2 : 0) +
           (view->texel_column_step < 0 ? 1 : 0);
}

/* Appends the large texels of a view. large: NULL to count them only. */
static void find_large_texels(const resampler *plan, const overlap_table *table, const overlap_list *list,
                              const quarter_view *view, struct layout_large *large, size_t *count)
{
    const uint32_t half = table->half;
    const size_t first = (size_t)(list - plan->lists) * half * half;
    for (uint32_t row = 0; row < half; row++)
        for (uint32_t column = 0; column < half; column++) {
            const size_t place = first + (size_t)row * half + column;
            if (!is_large(table, place) || !quarter_view_has_row(plan, view, row) ||
                !quarter_view_has_column(plan, view, column))
                continue;
            const int64_t texel = view->texel + row * view->texel_row_step + column * view->texel_column_step;
            if (large != NULL)
                large[*count] = (struct layout_large){(uint32_t)texel, view_index(plan, view), (uint32_t)place};
            ++*count;
        }
}

static size_t find_all_large_texels(const resampler *plan, const overlap_table *table, struct layout_large *large)
{
    size_t count = 0;
    for (int i = 0; i < plan->group_count * GROUP_VIEWS; i++) {
        const view_group *group = &plan->groups[i / GROUP_VIEWS];
        find_large_texels(plan, table, group->list, &group->views[i % GROUP_VIEWS], large, &count);
    }
    return count;
}

/* From the last on, as what is large hangs on the start of the next. */
static void mark_large_texels(overlap_table *table, size_t texels)
{
    for (size_t i = texels; i-- > 0;) {
        const uint32_t end = table->starts[i + 1];
        table->starts[i + 1] = end & ~LAYOUT_IS_LARGE;
        const bool large = is_large(table, i);
        table->starts[i + 1] = end;
        table->starts[i] |= large ? LAYOUT_IS_LARGE : 0;
    }
}

static helio_status upload_large_texels(vulkan_map *map, const resampler *plan, overlap_table *table)
{
    helio_context *context = map->sink.environment->context;
    map->large_count = find_all_large_texels(plan, table, NULL);
    struct layout_large *large = context_allocate(context, map->large_count + 1, sizeof *large);
    if (large == NULL)
        return HELIO_ERR_MEMORY;
    find_all_large_texels(plan, table, large);
    mark_large_texels(table, (size_t)plan->list_count * table->half * table->half);
    helio_status status =
        upload_new(map, &map->large, large, map->large_count, sizeof *large, "the texels with many pixels");
    context_release(context, large);
    return status;
}

static helio_status upload_table(vulkan_map *map, const resampler *plan)
{
    helio_context *context = map->sink.environment->context;
    const uint32_t quarter_width = (plan->width << plan->part_shift) / MAP_QUARTERS;
    overlap_table table;
    HELIO_TRY(overlap_table_create(context, plan->lists, plan->list_count, plan->size, quarter_width, &table));
    const size_t texels = (size_t)plan->list_count * table.half * table.half;
    helio_status status = upload_large_texels(map, plan, &table);
    if (status == HELIO_OK)
        status =
            upload_new(map, &map->starts, table.starts, texels + 1, sizeof *table.starts, "the places of overlaps");
    if (status == HELIO_OK)
        status = upload_new(map, &map->patches, table.patches, table.patch_count, sizeof *table.patches,
                            "the overlaps of pixels and texels");
    if (status == HELIO_OK)
        status = upload_new(map, &map->weights, table.weights, table.weight_count, sizeof *table.weights,
                            "the weights of pixels");
    overlap_table_release(context, &table);
    return status;
}

static struct layout_map describe(const vulkan_map *map, const resampler *plan, const map_slot *slot)
{
    const uint32_t edge = (plan->size + 1) / 2;
    struct layout_map layout = {
        .pixels = slot->pixels.address,
        .starts = map->starts.address,
        .patches = map->patches.address,
        .weights = map->weights.address,
        .large = map->large.address,
        .faults = map->faults.address,
        .width = plan->width,
        .height = plan->height,
        .channels = map->shape.channels,
        .part_shift = (uint32_t)plan->part_shift,
        .edge = edge,
    };
    for (int i = 0; i < plan->group_count * GROUP_VIEWS; i++) {
        const view_group *group = &plan->groups[i / GROUP_VIEWS];
        const quarter_view *view = &group->views[i % GROUP_VIEWS];
        layout.views[view_index(plan, view)] =
            (struct layout_view){(int32_t)view->row_offset, (int32_t)view->row_sign, (int32_t)view->column_offset,
                                 (int32_t)view->column_sign, (uint32_t)(group->list - plan->lists) * edge * edge};
    }
    return layout;
}

static helio_status create_slot(vulkan_map *map, map_slot *slot, uint64_t bytes)
{
    const resampler *plan = map->sink.environment->map.resampler;
    HELIO_TRY(buffer_create(map->device, BUFFER_SHARED, bytes, 1, "the map", &slot->pixels));
    const struct layout_map layout = describe(map, plan, slot);
    return commands_upload(&map->commands, &slot->map, &layout, sizeof layout);
}

static helio_status create_passes(vulkan_map *map)
{
    const uint32_t numbers = map->shape.numbers;
    const pipeline_desc count = {"faults", 3, {THREADS, numbers, COUNTED_PIXELS}};
    const pipeline_desc resample = {"resample", 2, {THREADS, numbers}};
    const pipeline_desc resample_large = {"resample_large", 2, {LARGE_THREADS, numbers}};
    if (map->count[numbers] == VK_NULL_HANDLE)
        HELIO_TRY(pipeline_create(map->device, &count, &map->count[numbers]));
    if (map->resample[numbers] == VK_NULL_HANDLE)
        HELIO_TRY(pipeline_create(map->device, &resample, &map->resample[numbers]));
    if (map->large_count == 0 || map->resample_large[numbers] != VK_NULL_HANDLE)
        return HELIO_OK;
    return pipeline_create(map->device, &resample_large, &map->resample_large[numbers]);
}

/* The staging is where the CPU may read the map, too. */
static helio_status create_shape(vulkan_map *map)
{
    const uint64_t bytes = bytes_of(&map->shape);
    HELIO_TRY(upload_table(map, map->sink.environment->map.resampler));
    for (int i = 0; i < MAP_COPIES; i++) {
        HELIO_TRY(buffer_create(map->device, BUFFER_READBACK, bytes, 1, "the map on its way", &map->copies[i].staging));
        HELIO_TRY(create_slot(map, &map->slots[i], bytes));
    }
    return create_passes(map);
}

static helio_status reshape(vulkan_map *map)
{
    const helio_device *device = map->device;
    HELIO_TRY(vulkan_check(device->vk.QueueWaitIdle(device->upload_queue), "waiting for uploads"));
    HELIO_TRY(vulkan_check(device->vk.QueueWaitIdle(device->queue), "waiting for work"));
    release_shape(map);
    return create_shape(map);
}

/* Says once where there is no memory. */
static bool has_shape(vulkan_map *map, const map_shape *shape)
{
    if (is_same(&map->shape, shape))
        return !map->is_refused;
    map->shape = *shape;
    map->is_refused = reshape(map) != HELIO_OK;
    if (map->is_refused) {
        release_shape(map);
        context_log(map->sink.environment->context, HELIO_LOG_INFO, "the CPU makes the cube of maps of %ux%u: %s",
                    shape->width, shape->height, helio_last_error());
    }
    return !map->is_refused;
}

/* ---- maps that come ----------------------------------------------------------------------- */

typedef struct copying {
    const map_pixels *from;
    unsigned char *to;
    uint32_t height, rows; /* rows: of a piece */
    size_t row_bytes;
} copying;

static void copy_rows(void *data, size_t piece)
{
    const copying *work = data;
    const uint32_t first = (uint32_t)piece * work->rows;
    for (uint32_t row = first; row < work->height && row < first + work->rows; row++)
        memcpy(work->to + row * work->row_bytes, map_pixels_at(work->from, row, 0), work->row_bytes);
}

static void copy_map(const vulkan_map *map, const map_pixels *pixels, map_copy *copy)
{
    enum { PIECE = 1 << 18 };
    copying work = {.from = pixels, .to = copy->staging.mapped, .height = map->shape.height};
    work.row_bytes = row_bytes_of(&map->shape);
    work.rows = (uint32_t)(1 + PIECE / work.row_bytes);
    context_parallel_for(map->sink.environment->context, (work.height + work.rows - 1) / work.rows, copy_rows, &work);
    copy->pixels = *pixels;
    copy->pixels.first = copy->staging.mapped;
    copy->pixels.row_bytes = (ptrdiff_t)work.row_bytes;
}

/* Uploads that read the copy may be on their way: they are short, and of the frame before the last. */
static helio_status wait_for_readers(const vulkan_map *map, const map_copy *copy)
{
    for (int i = 0; i < MAP_COPIES; i++)
        if (map->slots[i].sent == copy)
            HELIO_TRY(commands_wait(map->slots[i].upload));
    return HELIO_OK;
}

static bool take(void *owner, const map_pixels *pixels, map_pixels *kept)
{
    vulkan_map *map = owner;
    const helio_environment *environment = map->sink.environment;
    const map_shape shape = shape_of(environment, pixels);
    const uint32_t index = (map->latest + 1) % MAP_COPIES;
    map_copy *copy = &map->copies[index];
    if (!has_shape(map, &shape) || wait_for_readers(map, copy) != HELIO_OK)
        return false;
    copy_map(map, pixels, copy);
    copy->frame = environment->frame + 1;
    map->latest = index;
    *kept = copy->pixels;
    return true;
}

static const sky_parts *take_sky(void *owner, const sky_parts *parts)
{
    vulkan_map *map = owner;
    const helio_environment *environment = map->sink.environment;
    return vulkan_sky_take(&map->sky, environment->context, parts, environment->frame + 1);
}

bool map_is_sky(const vulkan_map *map)
{
    const helio_environment *environment = map->sink.environment;
    return environment != NULL && vulkan_sky_is_here(&map->sky, environment->frame);
}

bool map_is_here(const vulkan_map *map)
{
    const helio_environment *environment = map->sink.environment;
    return environment != NULL && map->copies[map->latest].frame == environment->frame;
}

/* ---- life --------------------------------------------------------------------------------- */

static helio_status create_parts(vulkan_map *map, vulkan_commands *const *uploads)
{
    const uint64_t faults = sizeof(struct layout_faults), layout = sizeof(struct layout_map);
    HELIO_TRY(commands_create(map->device, false, &map->commands));
    HELIO_TRY(buffer_create(map->device, BUFFER_ON_DEVICE, 1, faults, "bad pixels", &map->faults));
    for (int i = 0; i < MAP_COPIES; i++) {
        map_slot *slot = &map->slots[i];
        slot->upload = uploads[i];
        HELIO_TRY(buffer_create(map->device, BUFFER_ON_DEVICE, 1, layout, "the map's shape", &slot->map));
        HELIO_TRY(buffer_create(map->device, BUFFER_READBACK, 1, faults, "bad pixels", &slot->faults_back));
    }
    return HELIO_OK;
}

helio_status map_create(helio_device *device, helio_environment *environment, vulkan_commands *const *uploads,
                        vulkan_map *map)
{
    *map = (vulkan_map){.device = device, .sink = {.owner = map, .take = take, .take_sky = take_sky}};
    vulkan_sky_begin(device, environment->size, uploads, &map->sky);
    helio_status status = create_parts(map, uploads);
    if (status == HELIO_OK)
        map_sink_join(&map->sink, environment);
    else
        map_destroy(map);
    return status;
}

void map_destroy(vulkan_map *map)
{
    if (map->device == NULL)
        return;
    map_sink_leave(&map->sink);
    release_shape(map);
    vulkan_sky_end(&map->sky);
    for (int i = 0; i < MAP_COPIES; i++) {
        buffer_destroy(map->device, &map->slots[i].map);
        buffer_destroy(map->device, &map->slots[i].faults_back);
    }
    buffer_destroy(map->device, &map->faults);
    for (int numbers = 0; numbers < MAP_KINDS_OF_NUMBERS; numbers++) {
        pipeline_destroy(map->device, &map->count[numbers]);
        pipeline_destroy(map->device, &map->resample[numbers]);
        pipeline_destroy(map->device, &map->resample_large[numbers]);
    }
    commands_destroy(&map->commands);
    *map = (vulkan_map){0};
}

/* ---- a frame ------------------------------------------------------------------------------ */

void map_record_send(vulkan_map *map, uint32_t slot)
{
    map_slot *own = &map->slots[slot];
    own->sent = &map->copies[map->latest];
    commands_copy(own->upload, &own->sent->staging, &own->pixels, bytes_of(&map->shape));
}

static void push_map(const map_slot *slot, struct layout_push *push)
{
    push->step[0] = (uint32_t)slot->map.address;
    push->step[1] = (uint32_t)(slot->map.address >> 32);
}

void map_record_cube(vulkan_map *map, vulkan_commands *commands, uint32_t slot, struct layout_push push,
                     uint32_t cube_size)
{
    map_slot *own = &map->slots[slot];
    const map_numbers numbers = map->shape.numbers;
    const uint64_t pixels = (uint64_t)map->shape.width * map->shape.height, counted = THREADS * COUNTED_PIXELS;
    push_map(own, &push);
    push.parameter[0] = (uint32_t)map->large_count;
    commands_label(commands, "map into cube");
    commands_clear(commands, &map->faults);
    commands_barrier(commands);
    commands_dispatch(commands, map->count[numbers], &push, (pixels + counted - 1) / counted);
    commands_dispatch(commands, map->resample[numbers], &push, (uint64_t)CUBE_FACES * cube_size);
    if (map->large_count > 0)
        commands_dispatch(commands, map->resample_large[numbers], &push, map->large_count);
    commands_barrier(commands);
    commands_copy(commands, &map->faults, &own->faults_back, sizeof(struct layout_faults));
    commands_label_end(commands);
}

helio_bad_pixels map_bad_pixels(const vulkan_map *map, uint32_t slot)
{
    const struct layout_faults *faults = map->slots[slot].faults_back.mapped;
    return (helio_bad_pixels){.nan = faults->nan, .infinite = faults->infinite, .negative = faults->negative};
}
