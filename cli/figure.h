/* SPDX-License-Identifier: MIT
 * figure.h - figures drawn by cairo, and the files that they become: PNG, SVG or PDF from the same drawing. */
#ifndef HELIOSTAT_CLI_FIGURE_H
#define HELIOSTAT_CLI_FIGURE_H

#include <cairo.h>

typedef struct figure {
    int width, height; /* pixels, or points */
    void (*draw)(cairo_t *cairo, const void *data);
    const void *data;
} figure;

/* Writes under a temporary name and renames. The kind follows from the end of path. Returns an exit code; a sentence on
 * stderr, with the name of the option that named the path, tells of a failure. */
int figure_write(const char *option, const char *path, const figure *drawn);

#endif
