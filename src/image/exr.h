/* SPDX-License-Identifier: MIT
 * exr.h - what the files that read OpenEXR share. */
#ifndef HELIOSTAT_SRC_IMAGE_EXR_H
#define HELIOSTAT_SRC_IMAGE_EXR_H

#include "image/image.h"

#include <openexr.h>

/* HELIO_ERR_DATA if an attribute claims more bytes than the file has left: the C++ side of the library would take
 * memory for them first. What the attributes hold is left to the library. */
helio_status exr_head_check(const image_file *file);

/* The part of the file that is read, and its channels. */
typedef struct exr_channels {
    int part;
    const char *names[4];  /* for R, G, B and A: owned by the library. G and B NULL: grey; A NULL: no alpha */
    bool luminance_chroma; /* Y with RY and BY: only the C++ library puts them together */
    bool has_layer;        /* the names have a prefix: the C++ library's C interface does not find them */
    bool has_float;        /* at least one of them is of type float */
} exr_channels;

/* Finds the first part with R, G and B, with Y, or with a layer that has R, G and B; or the layer that the file is to
 * be read for. HELIO_ERR_DATA, with a list of the channels that are there, if no part has them. */
helio_status exr_channels_find(const image_file *file, exr_const_context_t library, exr_channels *channels);

/* Where the pixels of a chunk go: what decoding_user_data of a decoding pipeline points to. */
typedef struct exr_unpacking {
    const exr_channels *channels;
    const helio_image *image;
    size_t column, row; /* of the chunk's first pixel */
} exr_unpacking;

/* The pipeline's unpack_and_convert_fn. The library's own writes through null pointers and reads too far if a part has
 * three or four channels of which some are subsampled or not wanted (seen in 3.1.5). */
exr_result_t exr_unpack(exr_decode_pipeline_t *pipeline);

/* Fills image, which is as large as the data window, through the C++ library's interface for half floats. It reads
 * what OpenEXRCore 3.1 does not: DWAA, DWAB and luminance with chroma. */
helio_status exr_rgba_read(const image_file *file, const exr_channels *channels, exr_attr_box2i_t window,
                           helio_image *image);

/* Brings image from the data window to the display window: black outside, cropped where it is larger. Windows that
 * make no sense together are left alone with a warning. */
helio_status exr_window_fit(const image_file *file, exr_attr_box2i_t data, exr_attr_box2i_t display,
                            helio_image *image);

#endif
