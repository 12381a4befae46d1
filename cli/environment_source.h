/* SPDX-License-Identifier: MIT
 * environment_source.h - what --env names, and the pixels that come from it. */
#ifndef HELIOSTAT_CLI_ENVIRONMENT_SOURCE_H
#define HELIOSTAT_CLI_ENVIRONMENT_SOURCE_H

#include <heliostat/image.h>

typedef struct environment_source {
    char path[4096];   /* empty for a constant */
    const char *label; /* how messages call it */
    float constant[3];
} environment_source;

/* Understands a SRC, or the shipped map where it is NULL. Reads nothing. Returns EXIT_CODE_OK, or another exit code
 * after one sentence on stderr. */
int environment_source_parse(const char *specification, environment_source *source);

/* One map. rgb: [height][width][3], belongs to image or to the source. */
typedef struct environment_pixels {
    uint32_t width, height;
    const float *rgb;
    helio_layout layout;  /* what metadata says, else AUTO */
    helio_bad_pixels bad; /* as in helio_image */
    helio_image *image;   /* NULL for a constant */
} environment_pixels;

/* max_pixels: as in helio_image_read_desc. */
helio_status environment_source_read(const environment_source *source, helio_context *context, uint64_t max_pixels,
                                     environment_pixels *pixels);
void environment_pixels_release(environment_pixels *pixels, helio_context *context);

#endif
