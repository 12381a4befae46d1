/* SPDX-License-Identifier: MIT
 * sheet_labels.h - the words on a contact sheet. */
#ifndef HELIOSTAT_CLI_SHEET_LABELS_H
#define HELIOSTAT_CLI_SHEET_LABELS_H

#include <stddef.h>
#include <stdint.h>

#ifdef HELIO_WITH_CAIRO
enum { SHEET_LABEL_HEIGHT = 22 };
#else
enum { SHEET_LABEL_HEIGHT = 0 };
#endif

typedef struct sheet_label {
    const char *text;
    double middle, top; /* pixels */
} sheet_label;

/* Draws them in a light grey. rgba: [height][width][4]. A build without cairo draws nothing. */
void sheet_labels_draw(const sheet_label *labels, size_t count, uint32_t width, uint32_t height, float *rgba);

#endif
