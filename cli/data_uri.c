/* SPDX-License-Identifier: MIT */
#include "data_uri.h"

static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/* Three bytes become four digits (RFC 4648); what lacks at the end becomes =. */
static void write_group(FILE *stream, const unsigned char bytes[3], size_t count)
{
    unsigned long bits = (unsigned long)bytes[0] << 16 | (unsigned long)bytes[1] << 8 | bytes[2];
    for (size_t i = 0; i < 4; i++)
        fputc(i <= count ? DIGITS[bits >> (18 - 6 * i) & 63] : '=', stream);
}

bool data_uri_write(FILE *stream, const char *media_type, const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return false;
    fprintf(stream, "data:%s;base64,", media_type);
    for (;;) {
        unsigned char bytes[3] = {0};
        size_t count = fread(bytes, 1, sizeof bytes, file);
        if (count > 0)
            write_group(stream, bytes, count);
        if (count < sizeof bytes)
            break;
    }
    fclose(file);
    return true;
}
