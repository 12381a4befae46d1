/* SPDX-License-Identifier: MIT */
#include "frame_label.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

void frame_label_make(const helio_source_frame *frame, char label[FRAME_LABEL_SIZE])
{
    if (frame->sky == NULL || isnan(frame->hours)) {
        snprintf(label, FRAME_LABEL_SIZE, "frame %" PRIu64, frame->index);
        return;
    }
    unsigned minutes = (unsigned)floor(fmin(fmax(frame->hours, 0), 24) * 60 + 0.5);
    snprintf(label, FRAME_LABEL_SIZE, "%02u:%02u", minutes / 60, minutes % 60);
}
