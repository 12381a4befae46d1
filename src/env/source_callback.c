/* SPDX-License-Identifier: MIT
 *
 * Maps in the caller's memory. */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"

#include <inttypes.h>

typedef struct callback_reader {
    source_reader base;
    helio_source_callback callback;
    void *user;
    uint64_t first, next, end;
} callback_reader;

static bool is_plain(const helio_source_map *map)
{
    return map->pixels.format == HELIO_PIXELS_RGB_FLOAT &&
           (map->pixels.row_bytes == 0 || map->pixels.row_bytes == (ptrdiff_t)(map->width * 3 * sizeof(float)));
}

static helio_status fill_slot(const source_reader *reader, const helio_source_map *map, source_slot *slot)
{
    helio_layout hint = map->layout != HELIO_LAYOUT_AUTO ? map->layout : reader->desc.layout;
    if (helio_layout_guess(map->width, map->height, hint, &slot->frame.layout) != HELIO_OK)
        return fail(HELIO_ERR_ARGUMENT, "frame %" PRIu64 " of %s: %s", slot->frame.index, reader->label,
                    helio_last_error());
    slot->frame.pixels = map->pixels;
    slot->frame.rgb = is_plain(map) ? map->pixels.data : NULL;
    slot->frame.width = map->width;
    slot->frame.height = map->height;
    return HELIO_OK;
}

static helio_status read_callback(source_reader *reader, source_slot *slot)
{
    callback_reader *self = (callback_reader *)reader;
    helio_source_map map = {0};
    if (self->next == self->end)
        return HELIO_OK;
    slot->frame.index = self->next++;
    slot->frame.seconds = (double)(slot->frame.index - self->first) / reader->desc.fps;
    helio_status status = self->callback(self->user, slot->frame.index, &map);
    if (status != HELIO_OK)
        return fail(status, "frame %" PRIu64 " of %s cannot be had: its callback returned %s", slot->frame.index,
                    reader->label, helio_status_name(status));
    return map.pixels.data != NULL ? fill_slot(reader, &map, slot) : HELIO_OK;
}

static void destroy_callback(source_reader *reader)
{
    context_release(reader->context, reader);
}

static const source_reader_kind CALLBACK_KIND = {read_callback, destroy_callback};

helio_status source_callback_open(const source_opening *opening, source_reader **reader)
{
    callback_reader *self = source_reader_allocate(opening, sizeof *self, &CALLBACK_KIND);
    if (self == NULL)
        return HELIO_ERR_MEMORY;
    self->callback = opening->specification->callback;
    self->user = opening->specification->user;
    self->end = UINT64_MAX;
    if (opening->desc->has_frames) {
        self->first = self->next = opening->desc->first;
        self->end = (uint64_t)opening->desc->last + 1;
    }
    *reader = &self->base;
    return HELIO_OK;
}
