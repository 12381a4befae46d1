/* SPDX-License-Identifier: MIT
 * image.h - what the readers of the picture formats share: the file in memory and the picture that they fill. */
#ifndef HELIOSTAT_SRC_IMAGE_IMAGE_H
#define HELIOSTAT_SRC_IMAGE_IMAGE_H

#include <heliostat/image.h>

/* Wider or higher pictures are refused: they overflow the formats' own fields, and no environment map is so large. */
enum { IMAGE_EDGE_LIMIT = 1 << 20 };

/* A file that was read into memory and now is to be decoded. */
typedef struct image_file {
    helio_context *context;
    const char *path; /* for sentences */
    const unsigned char *bytes;
    size_t size;
    uint64_t max_pixels;
    const char *way_out; /* for pictures of more pixels, as the end of a sentence; default: to raise max_pixels */
    uint32_t max_edge;   /* pixels each way; default: IMAGE_EDGE_LIMIT */
    bool without_alpha;
    const char *layer; /* of an OpenEXR file, see helio_image_read_desc; NULL: the picture */

    /* NULL for linear floats. Else only PNG and JPEG are read, and image_create() puts memory here: for RGBA of 8 bits
     * each, as stored, in place of the picture's own arrays. Who gives it releases it, also after a failure. */
    uint8_t **texels;
} image_file;

/* Do the first bytes of a file, 16 or all, tell of a picture of a kind that is known here? */
bool image_is_picture(const unsigned char *bytes, size_t size);

/* Reads the picture that the file holds; its first bytes tell the kind. */
helio_status image_decode(const image_file *file, helio_image **image);

/* HELIO_ERR_DATA if a picture of this size is empty or too large, or if the file has fewer than least_bytes, the bytes
 * that the format needs at the very least for so many pixels. Call before memory is taken. */
helio_status image_check_size(const image_file *file, uint64_t width, uint64_t height, uint64_t least_bytes);

/* Checks as above and makes a black picture. */
helio_status image_create(const image_file *file, uint64_t width, uint64_t height, bool alpha, uint64_t least_bytes,
                          helio_image **image);

/* Replaces what is no printable ASCII, for words of a damaged file that go into a sentence. A tab becomes a blank. */
void image_make_printable(char *text);

/* Sets bad_in_file from the pixels as they are now. */
void image_count_bad(helio_image *image);

helio_status exr_read(const image_file *file, helio_image **image);
helio_status jpeg_read(const image_file *file, helio_image **image);
helio_status pfm_read(const image_file *file, helio_image **image);
helio_status png_read(const image_file *file, helio_image **image);
helio_status radiance_read(const image_file *file, helio_image **image);

#endif
