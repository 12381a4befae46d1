/* SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "image/exr.h"

#include <string.h>

enum { FIRST_HEADER = 8, MULTI_PART = 0x1000 };

typedef struct head_reader {
    const unsigned char *bytes;
    size_t size, at;
} head_reader;

/* Steps over text and the zero that ends it; false if there is none. */
static bool skip_text(head_reader *reader)
{
    const unsigned char *end = memchr(reader->bytes + reader->at, 0, reader->size - reader->at);
    if (end == NULL)
        return false;
    reader->at = (size_t)(end - reader->bytes) + 1;
    return true;
}

static bool skip_bytes(head_reader *reader, size_t count)
{
    if (count > reader->size - reader->at)
        return false;
    reader->at += count;
    return true;
}

static uint32_t read_word(const unsigned char *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool is_end(const head_reader *reader)
{
    return reader->at < reader->size && reader->bytes[reader->at] == 0;
}

/* Name, type, size, and as many bytes. */
static bool skip_attribute(head_reader *reader)
{
    bool has_name = skip_text(reader);
    if (!has_name || !skip_text(reader) || !skip_bytes(reader, 4))
        return false;
    return skip_bytes(reader, read_word(reader->bytes + reader->at - 4));
}

/* An empty name ends a header; with several parts, an empty header ends them all. */
static bool skip_headers(head_reader *reader, bool multi_part)
{
    do {
        while (!is_end(reader))
            if (!skip_attribute(reader))
                return false;
        reader->at++;
    } while (multi_part && !is_end(reader));
    return true;
}

helio_status exr_head_check(const image_file *file)
{
    head_reader reader = {.bytes = file->bytes, .size = file->size, .at = FIRST_HEADER};
    if (file->size > FIRST_HEADER && skip_headers(&reader, (read_word(file->bytes + 4) & MULTI_PART) != 0))
        return HELIO_OK;
    return fail(HELIO_ERR_DATA, "%s cannot be read as OpenEXR: its head is truncated or damaged", file->path);
}
