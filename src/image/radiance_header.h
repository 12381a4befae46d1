/* SPDX-License-Identifier: MIT
 * radiance_header.h - the text at the start of a Radiance picture. */
#ifndef HELIOSTAT_SRC_IMAGE_RADIANCE_HEADER_H
#define HELIOSTAT_SRC_IMAGE_RADIANCE_HEADER_H

#include "image/colour.h"
#include "image/image.h"
#include "image/layout_comment.h"

typedef struct radiance_header {
    bool xyz;                 /* FORMAT=32-bit_rle_xyze */
    double divisor[3];        /* product of all EXPOSURE and COLORCORR lines */
    bool has_primaries;       /* PRIMARIES was there, and not all zero */
    chromaticities primaries; /* valid if so */

    char layout[LAYOUT_COMMENT_SIZE]; /* the comment about it; "" if there is none */

    /* The resolution line "-Y 512 +X 1024" has the scan lines first. */
    uint32_t line_count, line_length;
    bool lines_are_columns; /* it starts with X */
    bool x_minus, y_plus;   /* -X: columns run from right to left; +Y: rows run from the bottom to the top */
    size_t length;          /* bytes before the first scan line */
} radiance_header;

helio_status radiance_header_parse(const image_file *file, radiance_header *header);

#endif
