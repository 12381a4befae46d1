/* SPDX-License-Identifier: MIT
 * compared_files.h - the pictures of one frame that is compared, and its mask. */
#ifndef HELIOSTAT_CLI_COMPARED_FILES_H
#define HELIOSTAT_CLI_COMPARED_FILES_H

#include "comparison_report.h"
#include "picture_file.h"

typedef struct compared_files {
    helio_image *picture, *reference;
    picture_mask mask;
} compared_files;

/* Reads what the frame names. Its mask becomes the file that has one: the one that is named, else the picture, else the
 * reference, else none. Returns an exit code; one sentence on stderr tells of what cannot be read, and of sizes that
 * differ. Release them in any case. */
int compared_files_read(helio_context *context, uint64_t max_pixels, compared_frame *frame, compared_files *files);
void compared_files_release(helio_context *context, compared_files *files);

#endif
