/* SPDX-License-Identifier: MIT
 * picture.h - what the writers of the picture formats share. */
#ifndef HELIOSTAT_SRC_IMAGE_PICTURE_H
#define HELIOSTAT_SRC_IMAGE_PICTURE_H

#include "core/file.h"

#include <heliostat/image.h>

/* Each writes to writer->stream and leaves commit and abandon to the caller. picture and desc have been checked. */
helio_status exr_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);
helio_status pfm_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);
helio_status png_write(helio_context *context, file_writer *writer, const helio_picture *picture,
                       const helio_picture_write_desc *desc);

#endif
