/* SPDX-License-Identifier: MIT
 * picture_file.h - pictures that somebody rendered, and the masks that go with them. */
#ifndef HELIOSTAT_CLI_PICTURE_FILE_H
#define HELIOSTAT_CLI_PICTURE_FILE_H

#include <heliostat/image.h>

/* As helio_image_read(), with colours that are premultiplied by alpha whatever the file holds. max_pixels: 0 means the
 * default. */
helio_status picture_file_read(helio_context *context, const char *path, uint64_t max_pixels, helio_image **image);

/* A mask: [height][width], read as it is written there. */
typedef struct picture_mask {
    helio_image *image; /* to be destroyed; NULL: there is none */
    const float *mask;  /* in memory of the image */
} picture_mask;

/* The coverage of the object, the layer object.A, where the file has it and it can be read. */
void picture_file_read_object(helio_context *context, const char *path, uint64_t max_pixels, picture_mask *mask);

/* What a file says as a mask: the coverage of the object where it has it, else its alpha where that is not 1
 * everywhere, else its brightness, of which half of a PNG's white is 0.5. */
helio_status picture_file_read_mask(helio_context *context, const char *path, uint64_t max_pixels, picture_mask *mask);

#endif
