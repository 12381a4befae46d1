/* SPDX-License-Identifier: MIT
 * layout_comment.h - the words "layout: NAME", by which files tell how their map is laid out where the format has no
 * way of its own. */
#ifndef HELIOSTAT_SRC_IMAGE_LAYOUT_COMMENT_H
#define HELIOSTAT_SRC_IMAGE_LAYOUT_COMMENT_H

#include <heliostat/image.h>

enum { LAYOUT_COMMENT_SIZE = 32 };

void layout_comment_format(helio_layout layout, char comment[LAYOUT_COMMENT_SIZE]);

/* What a comment says of a picture of this shape. AUTO if it is another comment, or if the shape does not fit: programs
 * keep comments of pictures that they cut. */
helio_layout layout_comment_read(const char *comment, uint32_t width, uint32_t height);

#endif
