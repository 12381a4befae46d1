/* SPDX-License-Identifier: MIT
 * picture.h - what the writers of the picture formats share. */
#ifndef HELIOSTAT_SRC_IMAGE_PICTURE_H
#define HELIOSTAT_SRC_IMAGE_PICTURE_H

#include "core/file.h"

#include <heliostat/image.h>

/* Linear colours, whose alpha is 1 where there is none. */
typedef struct picture_pixels {
    uint32_t width, height;
    const float *colours; /* [height][width][channels] */
    size_t channels;      /* 3 or 4 */
    const uint8_t *shown; /* [height][width][4], or NULL: see helio_picture */
} picture_pixels;

/* Each writes to writer->stream and leaves commit and abandon to the caller. picture and desc have been checked. */
helio_status exr_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);
helio_status pfm_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);
helio_status png_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);

helio_status pfm_write_pixels(helio_context *context, file_writer *writer, const picture_pixels *pixels);
helio_status png_write_pixels(helio_context *context, file_writer *writer, const picture_pixels *pixels,
                              const helio_picture_write_desc *desc);

#endif
