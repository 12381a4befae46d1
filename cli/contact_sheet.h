/* SPDX-License-Identifier: MIT
 * contact_sheet.h - one picture that shows a dozen frames of a sequence. */
#ifndef HELIOSTAT_CLI_CONTACT_SHEET_H
#define HELIOSTAT_CLI_CONTACT_SHEET_H

#include "frame_label.h"
#include "shown_picture.h"

enum { SHEET_COLUMNS = 4, SHEET_CELLS = 12 };

typedef struct contact_sheet_cell {
    float *rgb; /* [thumb_height][thumb_width][3], as it is shown, but linear */
    char label[FRAME_LABEL_SIZE];
} contact_sheet_cell;

typedef struct contact_sheet {
    uint32_t thumb_width, thumb_height;
    uint64_t total;  /* frames; 0 where nobody knows */
    uint64_t stride; /* where nobody knows: every so many frames one is shown; grows as they come */
    uint32_t count;
    contact_sheet_cell cells[SHEET_CELLS];
} contact_sheet;

/* For frames of this size. False where there is no memory. A sheet that is all 0 may be released. */
bool contact_sheet_make(contact_sheet *sheet, uint32_t width, uint32_t height, uint64_t total);
void contact_sheet_release(contact_sheet *sheet);

/* Is the frame shown that comes after so many others? Frames are asked for one after the other. */
bool contact_sheet_wants(const contact_sheet *sheet, uint64_t position);

/* Adds a frame that is wanted, of the size of all, with a label that stands beneath it. */
void contact_sheet_add(contact_sheet *sheet, const shown_picture *picture, const char *label);

/* Writes a PNG; there is at least one frame. HELIO_ERR_MEMORY may come without a sentence. */
helio_status contact_sheet_write(const contact_sheet *sheet, helio_context *context, const char *path);

#endif
