/* SPDX-License-Identifier: MIT */
#include "frame_warnings.h"

#include "message.h"

#include <inttypes.h>
#include <stdio.h>

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

/* Only what is there. */
static void describe_bad_pixels(const stats_frame *frame, char text[160])
{
    char nan[32] = "", infinite[32] = "", negative[64] = "";
    bool has_black = frame->nan + frame->infinite > 0;
    if (frame->nan > 0)
        snprintf(nan, sizeof nan, "%" PRIu64 " NaN", frame->nan);
    if (frame->infinite > 0)
        snprintf(infinite, sizeof infinite, "%" PRIu64 " infinite", frame->infinite);
    if (frame->negative > 0)
        snprintf(negative, sizeof negative, "%s%" PRIu64 " negative (those channels taken as 0)", has_black ? ", " : "",
                 frame->negative);
    snprintf(text, 160, "%s%s%s%s%s", nan, frame->nan > 0 && frame->infinite > 0 ? " and " : "", infinite,
             has_black ? " (taken as black)" : "", negative);
}

/* Colours that are right, but wider than what light is computed in. */
static void warn_of_gamut(frame_warnings *warnings, const char *label, uint64_t pixels)
{
    if (pixels == 0)
        return;
    warnings->gamut_pixels += pixels;
    if (is_told(warnings, ++warnings->gamut_frames, MOST_TOLD))
        message_warning("%s: %" PRIu64 " pixel%s %s outside of Rec. 709 and lost %s negative channels", label, pixels,
                        pixels == 1 ? "" : "s", pixels == 1 ? "was" : "were", pixels == 1 ? "its" : "their");
}

void frame_warnings_bad_pixels(frame_warnings *warnings, const char *label, const stats_frame *frame)
{
    uint64_t bad = frame->nan + frame->infinite + frame->negative;
    warn_of_gamut(warnings, label, frame->out_of_gamut);
    if (bad == 0)
        return;
    char text[160];
    describe_bad_pixels(frame, text);
    warnings->bad_pixels += bad;
    if (is_told(warnings, ++warnings->bad_frames, MOST_TOLD))
        message_warning("%s has %" PRIu64 " bad pixel%s: %s", label, bad, bad == 1 ? "" : "s", text);
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
    if (!is_told(warnings, warnings->gamut_frames, MOST_TOLD))
        message_warning("%" PRIu64 " frames in all have pixels outside of Rec. 709, %" PRIu64
                        " of them together; --verbose tells of each",
                        warnings->gamut_frames, warnings->gamut_pixels);
    if (!is_told(warnings, warnings->size_changes, MOST_TOLD))
        message_warning("the size of the frames changed %" PRIu64 " times in all", warnings->size_changes);
    uint64_t log = atomic_load(&warnings->log);
    if (!is_told(warnings, log, MOST_LOG_TOLD))
        message_warning("%" PRIu64 " more warnings were not shown; --verbose shows all", log - MOST_LOG_TOLD);
}
