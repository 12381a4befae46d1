/* SPDX-License-Identifier: MIT
 *
 * Frames of video files and devices. */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"
#include "image/video_reader.h"

#include <inttypes.h>
#include <string.h>

typedef struct video {
    source_reader base;
    helio_video_reader *stream;
    uint64_t next;  /* number of the frame that the stream gives next */
    double started; /* time of the first frame that is wanted */
} video;

/* The stream's pixels live until its next call, those of a slot until they were shown. */
static helio_status copy_frame(const source_reader *reader, const helio_video_frame *from, source_slot *slot)
{
    size_t floats = 3 * (size_t)from->width * from->height;
    if (slot->copy_floats < floats) {
        context_release(reader->context, slot->copy);
        slot->copy_floats = 0;
        slot->copy = context_allocate(reader->context, floats, sizeof *slot->copy);
        if (slot->copy == NULL)
            return HELIO_ERR_MEMORY;
        slot->copy_floats = floats;
    }
    memcpy(slot->copy, from->rgb, floats * sizeof *slot->copy);
    slot->frame.rgb = slot->copy;
    slot->frame.width = from->width;
    slot->frame.height = from->height;
    slot->frame.bad = from->bad;
    return HELIO_OK;
}

/* The stream has come to its end. */
static helio_status finish_video(const video *self)
{
    const helio_source_desc *desc = &self->base.desc;
    if (self->next == 0)
        return fail(HELIO_ERR_DATA, "%s has not one frame that can be decoded", self->base.label);
    if (desc->has_frames && self->next <= desc->first)
        return fail(HELIO_ERR_ARGUMENT,
                    "frames %" PRIu32 "..%" PRIu32 " of %s were asked for, but it has only %" PRIu64 ", counted from 0",
                    desc->first, desc->last, self->base.label, self->next);
    return HELIO_OK;
}

/* What cannot be decoded has no number that could be held, so that to hold is to skip. */
static bool may_skip(const video *self, helio_status status)
{
    if (status != HELIO_ERR_DATA || self->base.desc.on_missing == HELIO_ON_MISSING_STOP)
        return false;
    context_log(self->base.context, HELIO_LOG_WARNING, "what cannot be decoded is skipped: %s", helio_last_error());
    return true;
}

/* The next frame that is wanted: its pixels are NULL at the end. */
static helio_status read_wanted(video *self, helio_video_frame *frame)
{
    const helio_source_desc *desc = &self->base.desc;
    *frame = (helio_video_frame){0};
    while (!atomic_load(self->base.stopping) && !(desc->has_frames && self->next > desc->last)) {
        helio_status status = helio_video_next(self->stream, frame);
        if (may_skip(self, status))
            continue;
        if (status != HELIO_OK)
            return status;
        if (frame->rgb == NULL)
            return finish_video(self);
        uint64_t index = self->next++;
        if (!desc->has_frames || index >= desc->first)
            return HELIO_OK;
        *frame = (helio_video_frame){0};
    }
    return HELIO_OK;
}

static helio_status read_video(source_reader *reader, source_slot *slot)
{
    video *self = (video *)reader;
    const uint64_t first = reader->desc.has_frames ? reader->desc.first : 0;
    helio_video_frame frame;
    HELIO_TRY(read_wanted(self, &frame));
    if (frame.rgb == NULL)
        return HELIO_OK;
    if (helio_layout_guess(frame.width, frame.height, reader->desc.layout, &slot->frame.layout) != HELIO_OK)
        return fail(HELIO_ERR_DATA, "frame %" PRIu64 " of %s: %s", self->next - 1, reader->label, helio_last_error());
    HELIO_TRY(copy_frame(reader, &frame, slot));
    slot->frame.index = self->next - 1;
    if (slot->frame.index == first)
        self->started = frame.seconds;
    slot->frame.seconds = frame.seconds - self->started;
    return HELIO_OK;
}

static void destroy_video(source_reader *reader)
{
    helio_video_close(((video *)reader)->stream);
    context_release(reader->context, reader);
}

static const source_reader_kind VIDEO_KIND = {read_video, destroy_video};

static helio_status describe_video(video *self, helio_source_info *info)
{
    const helio_video_info stream = helio_video_get_info(self->stream);
    if (stream.fps > 0)
        info->fps = stream.fps;
    uint64_t first;
    info->frame_count = stream.frame_count;
    return stream.frame_count == 0
               ? HELIO_OK
               : source_limit_frames(&self->base.desc, self->base.label, &first, &info->frame_count);
}

helio_status source_video_open(const source_opening *opening, source_reader **reader)
{
    video *self = source_reader_allocate(opening, sizeof *self, &VIDEO_KIND);
    if (self == NULL)
        return HELIO_ERR_MEMORY;
    const helio_video_read_desc desc = {.transfer = opening->desc->transfer,
                                        .max_pixels = opening->desc->max_pixels,
                                        .device = opening->specification->device};
    helio_status status = helio_video_open(opening->context, opening->specification->path, &desc, &self->stream);
    if (status == HELIO_OK) {
        video_reader_heed(self->stream, opening->stopping);
        status = describe_video(self, opening->info);
    }
    if (status != HELIO_OK) {
        destroy_video(&self->base);
        return status;
    }
    *reader = &self->base;
    return HELIO_OK;
}
