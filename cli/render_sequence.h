/* SPDX-License-Identifier: MIT
 * render_sequence.h - all frames of a source, one after the other, from light to file. */
#ifndef HELIOSTAT_CLI_RENDER_SEQUENCE_H
#define HELIOSTAT_CLI_RENDER_SEQUENCE_H

#include "contact_sheet.h"
#include "frame_sink.h"
#include "render_job.h"
#include "stats.h"

typedef struct render_sequence {
    render_job *job;
    frame_sink sink;
    contact_sheet sheet;
    stats_list stats;
    double started;                /* milliseconds */
    uint64_t frames;               /* that came */
    uint64_t skipped;              /* that an earlier run had written */
    float exposure;                /* stops, of all frames */
    helio_picture_write_desc look; /* of the frame in hand */
    bool failed;                   /* in the frame that came last, or a signal stopped it */
    char error[SINK_ERROR_SIZE];   /* why; "" where a sentence on stderr has told it, or a signal came */
} render_sequence;

/* Renders and writes what comes, then statistics and contact sheet, also where the sequence ends early. Returns an exit
 * code; one sentence on stderr tells why it ended early, and what was written. */
int render_sequence_run(render_job *job);

#endif
