/* SPDX-License-Identifier: MIT */
#include "image/layout_comment.h"

#include <stdio.h>
#include <string.h>

static const char START[] = "layout: ";

void layout_comment_format(helio_layout layout, char comment[LAYOUT_COMMENT_SIZE])
{
    snprintf(comment, LAYOUT_COMMENT_SIZE, "%s%s", START, helio_layout_name(layout));
}

helio_layout layout_comment_read(const char *comment, uint32_t width, uint32_t height)
{
    if (strncmp(comment, START, strlen(START)) != 0)
        return HELIO_LAYOUT_AUTO;
    for (int i = HELIO_LAYOUT_LATLONG; i <= HELIO_LAYOUT_MIRRORBALL; i++) {
        helio_layout fitting;
        if (strcmp(comment + strlen(START), helio_layout_name((helio_layout)i)) == 0 &&
            helio_layout_guess(width, height, (helio_layout)i, &fitting) == HELIO_OK)
            return (helio_layout)i;
    }
    return HELIO_LAYOUT_AUTO;
}
