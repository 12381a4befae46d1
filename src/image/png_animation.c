/* SPDX-License-Identifier: MIT */
#include "image/png_animation.h"

#include <string.h>

enum { SIGNATURE = 8, HEAD = 8 /* length and name */, CHECKSUM = 4, MOST_CHUNKS = 10000 };

static uint32_t read_number(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

uint32_t png_animation_frames(png_animation_read read, const void *file)
{
    unsigned char bytes[HEAD + 4];
    uint64_t at = SIGNATURE;
    if (read(file, 0, bytes, SIGNATURE) != SIGNATURE || memcmp(bytes, "\x89PNG\r\n\x1a\n", SIGNATURE) != 0)
        return 0;
    for (int chunk = 0; chunk < MOST_CHUNKS && read(file, at, bytes, sizeof bytes) == sizeof bytes; chunk++) {
        if (memcmp(bytes + 4, "acTL", 4) == 0)
            return read_number(bytes + HEAD);
        if (memcmp(bytes + 4, "IDAT", 4) == 0)
            return 0;
        at += HEAD + (uint64_t)read_number(bytes) + CHECKSUM;
    }
    return 0;
}
