/* SPDX-License-Identifier: MIT */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"

#include <inttypes.h>

bool source_slot_is_end(const source_slot *slot)
{
    return slot->frame.rgb == NULL && slot->frame.sky == NULL && !slot->frame.is_held;
}

void *source_reader_allocate(const source_opening *opening, size_t size, const source_reader_kind *kind)
{
    source_reader *reader = context_allocate(opening->context, 1, size);
    if (reader == NULL)
        return NULL;
    reader->kind = kind;
    reader->context = opening->context;
    reader->desc = *opening->desc;
    reader->label = opening->specification->text;
    reader->stopping = opening->stopping;
    return reader;
}

helio_status source_limit_frames(const helio_source_desc *desc, const char *label, uint64_t *first, uint64_t *count)
{
    *first = 0;
    if (!desc->has_frames)
        return HELIO_OK;
    if (desc->first >= *count)
        return fail(HELIO_ERR_ARGUMENT,
                    "frames %" PRIu32 "..%" PRIu32 " of %s were asked for, but it has only %" PRIu64 ", counted from 0",
                    desc->first, desc->last, label, *count);
    *first = desc->first;
    *count = (*count <= desc->last ? *count : (uint64_t)desc->last + 1) - *first;
    return HELIO_OK;
}

helio_status source_read_picture(const source_reader *reader, const char *path, source_slot *slot)
{
    const helio_image_read_desc desc = {
        .max_pixels = reader->desc.max_pixels, .without_alpha = true, .layout = reader->desc.layout};
    helio_image *image;
    HELIO_TRY(helio_image_read(reader->context, path, &desc, &image));
    helio_layout hint = reader->desc.layout != HELIO_LAYOUT_AUTO ? reader->desc.layout : image->layout;
    helio_layout layout;
    helio_status status = helio_layout_guess(image->width, image->height, hint, &layout);
    if (status != HELIO_OK) {
        helio_image_destroy(reader->context, image);
        return fail(status, "%s: %s", path, helio_last_error());
    }
    slot->image = image;
    slot->frame.rgb = image->rgb;
    slot->frame.width = image->width;
    slot->frame.height = image->height;
    slot->frame.layout = layout;
    slot->frame.bad = image->bad;
    return HELIO_OK;
}
