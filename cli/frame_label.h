/* SPDX-License-Identifier: MIT
 * frame_label.h - what a frame of a sequence is called where many are shown together. */
#ifndef HELIOSTAT_CLI_FRAME_LABEL_H
#define HELIOSTAT_CLI_FRAME_LABEL_H

#include <heliostat/source.h>

enum { FRAME_LABEL_SIZE = 32 };

/* The time of day of a sky, such as 17:30, else its number. */
void frame_label_make(const helio_source_frame *frame, char label[FRAME_LABEL_SIZE]);

#endif
