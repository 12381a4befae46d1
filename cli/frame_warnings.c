/* SPDX-License-Identifier: MIT */
#include "frame_warnings.h"

#include "message.h"

#include <inttypes.h>

enum { MOST_TOLD = 3, MOST_LOG_TOLD = 6 };

/* count: with this one. */
static bool is_told(const frame_warnings *warnings, uint64_t count, uint64_t most)
{
    return warnings->tells_all || count <= most;
}

void frame_warnings_size(frame_warnings *warnings, const char *label, const helio_source_frame *frame)
{
    bool changes = warnings->width != 0 && (warnings->width != frame->width || warnings->height != frame->height);
    if (changes && is_told(warnings, ++warnings->size_changes, MOST_TOLD))
        message_warning("%s is %" PRIu32 "x%" PRIu32 " pixels, where the frame before it was %" PRIu32 "x%" PRIu32,
                        label, frame->width, frame->height, warnings->width, warnings->height);
    warnings->width = frame->width;
    warnings->height = frame->height;
}

void frame_warnings_bad_pixels(frame_warnings *warnings, const char *label, const stats_frame *frame)
{
    uint64_t bad = frame->nan + frame->infinite + frame->negative + frame->out_of_gamut;
    if (bad == 0)
        return;
    warnings->bad_pixels += bad;
    if (is_told(warnings, ++warnings->bad_frames, MOST_TOLD))
        message_warning("%s has %" PRIu64 " bad pixel%s: %" PRIu64 " NaN and %" PRIu64 " infinite (taken as black), "
                        "%" PRIu64 " negative and %" PRIu64 " out of gamut (negative channels taken as 0)",
                        label, bad, bad == 1 ? "" : "s", frame->nan, frame->infinite, frame->negative,
                        frame->out_of_gamut);
}

void frame_warnings_log(frame_warnings *warnings, const char *message)
{
    if (is_told(warnings, atomic_fetch_add(&warnings->log, 1) + 1, MOST_LOG_TOLD))
        message_warning("%s", message);
}

void frame_warnings_end(const frame_warnings *warnings)
{
    if (!is_told(warnings, warnings->bad_frames, MOST_TOLD))
        message_warning("%" PRIu64 " frames in all have bad pixels, %" PRIu64
                        " of them together; --verbose tells of each",
                        warnings->bad_frames, warnings->bad_pixels);
    if (!is_told(warnings, warnings->size_changes, MOST_TOLD))
        message_warning("the size of the frames changed %" PRIu64 " times in all", warnings->size_changes);
    uint64_t log = atomic_load(&warnings->log);
    if (!is_told(warnings, log, MOST_LOG_TOLD))
        message_warning("%" PRIu64 " more warnings were not shown; --verbose shows all", log - MOST_LOG_TOLD);
}
