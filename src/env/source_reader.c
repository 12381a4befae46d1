/* SPDX-License-Identifier: MIT */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"
#include "image/faces.h"

#include <inttypes.h>

bool source_slot_is_end(const source_slot *slot)
{
    const helio_source_frame *frame = &slot->frame;
    return frame->rgb == NULL && frame->pixels.data == NULL && frame->sky == NULL && !frame->is_held;
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

helio_status source_check_faces(const helio_source_desc *desc, const char *path)
{
    switch (desc->layout) {
    case HELIO_LAYOUT_AUTO:
    case HELIO_LAYOUT_FACES:
    case HELIO_LAYOUT_STRIP:
    case HELIO_LAYOUT_STRIP_OPENEXR: return HELIO_OK;
    default: break;
    }
    if (!faces_are_meant(path, false))
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT, "%s means the six faces of a cube, whose layout cannot be %s; leave the layout out",
                path, helio_layout_name(desc->layout));
}

/* helio_layout_guess() knows nothing of the name. */
static helio_status fail_without_layout(helio_status status, const char *path, const helio_image *image)
{
    bool may_be_face = image->width == image->height && faces_is_named_like_one(path);
    return fail(status, "%s: %s%s", path, helio_last_error(),
                may_be_face ? "; if this is one of the six files of a cube, it is faces" : "");
}

helio_status source_read_picture(const source_reader *reader, const char *path, source_slot *slot)
{
    const helio_image_read_desc desc = {
        .max_pixels = reader->desc.max_pixels, .without_alpha = true, .layout = reader->desc.layout};
    helio_image *image;
    HELIO_TRY(source_check_faces(&reader->desc, path));
    HELIO_TRY(helio_image_read(reader->context, path, &desc, &image));
    helio_layout hint = reader->desc.layout != HELIO_LAYOUT_AUTO ? reader->desc.layout : image->layout;
    helio_layout layout;
    helio_status status = helio_layout_guess(image->width, image->height, hint, &layout);
    if (status != HELIO_OK) {
        status = fail_without_layout(status, path, image);
        helio_image_destroy(reader->context, image);
        return status;
    }
    slot->image = image;
    slot->frame.rgb = image->rgb;
    slot->frame.width = image->width;
    slot->frame.height = image->height;
    slot->frame.layout = layout;
    slot->frame.bad = image->bad;
    return HELIO_OK;
}
