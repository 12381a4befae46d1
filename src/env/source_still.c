/* SPDX-License-Identifier: MIT
 *
 * Sources of a single frame from pixels: a picture, or a colour. */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"
#include "image/faces.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

typedef struct still {
    source_reader base;
    float constant[3];
    bool is_given;
} still;

static helio_status read_file(source_reader *reader, source_slot *slot)
{
    still *self = (still *)reader;
    if (self->is_given)
        return HELIO_OK;
    self->is_given = true;
    return source_read_picture(reader, reader->label, slot);
}

static helio_status read_constant(source_reader *reader, source_slot *slot)
{
    still *self = (still *)reader;
    if (self->is_given)
        return HELIO_OK;
    self->is_given = true;
    HELIO_TRY(helio_layout_guess(1, 1, reader->desc.layout, &slot->frame.layout));
    slot->frame.rgb = self->constant;
    slot->frame.width = slot->frame.height = 1;
    return HELIO_OK;
}

static void destroy_still(source_reader *reader)
{
    context_release(reader->context, reader);
}

static const source_reader_kind FILE_KIND = {read_file, destroy_still};
static const source_reader_kind CONSTANT_KIND = {read_constant, destroy_still};

static helio_status open_still(const source_opening *opening, const source_reader_kind *kind, source_reader **reader)
{
    uint64_t first, count = 1;
    HELIO_TRY(source_limit_frames(opening->desc, opening->specification->text, &first, &count));
    still *self = source_reader_allocate(opening, sizeof *self, kind);
    if (self == NULL)
        return HELIO_ERR_MEMORY;
    memcpy(self->constant, opening->specification->constant, sizeof self->constant);
    opening->info->frame_count = count;
    *reader = &self->base;
    return HELIO_OK;
}

helio_status source_constant_open(const source_opening *opening, source_reader **reader)
{
    return open_still(opening, &CONSTANT_KIND, reader);
}

helio_status source_file_open(const source_opening *opening, source_reader **reader)
{
    const char *path = opening->specification->path;
    face_files faces;
    struct stat status;
    HELIO_TRY(source_check_faces(opening->desc, path));
    if (faces_are_meant(path, opening->desc->layout == HELIO_LAYOUT_FACES))
        HELIO_TRY(faces_find(path, &faces));
    else if (stat(path, &status) != 0)
        return fail(HELIO_ERR_IO, "%s cannot be opened: %s", path, strerror(errno));
    return open_still(opening, &FILE_KIND, reader);
}
