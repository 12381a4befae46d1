/* SPDX-License-Identifier: MIT
 * finished_frame.h - pictures of frames that an earlier run has written, for --resume. */
#ifndef HELIOSTAT_CLI_FINISHED_FRAME_H
#define HELIOSTAT_CLI_FINISHED_FRAME_H

#include <heliostat/image.h>

typedef struct finished_frame {
    helio_image *image; /* premultiplied; to be destroyed. NULL: there is none, or it is damaged */
    bool is_shown;      /* exposure and tone map are in it already */
} finished_frame;

/* Reads the picture. Returns an exit code: a whole picture of another size comes from a run with other options, and one
 * sentence on stderr tells so. */
int finished_frame_read(helio_context *context, const char *name, uint32_t width, uint32_t height,
                        finished_frame *frame);

#endif
