/* SPDX-License-Identifier: MIT */
#include "scene/gzip.h"

#include "core/context.h"
#include "core/error.h"
#include "core/file.h"

#include <string.h>
#include <zlib.h>

/* A gzipped mesh of this size or less is always fine. A larger one may hold MAX_RATIO times the bytes of the file: text
 * meshes reach 30, and deflate itself 1032, for zeros. */
#define MODEST_BYTES ((size_t)64 << 20)
#define MAX_RATIO 200

typedef struct byte_buffer {
    helio_context *context;
    unsigned char *bytes;
    size_t size, capacity, limit;
} byte_buffer;

/* Doubles the capacity, up to the limit. */
static helio_status buffer_grow(byte_buffer *buffer, const char *path)
{
    if (buffer->capacity == buffer->limit)
        return fail(HELIO_ERR_DATA,
                    "%s holds more than %zu bytes, which is too much for a mesh of its size; unpack it first", path,
                    buffer->limit);
    size_t capacity = buffer->capacity < buffer->limit / 2 ? 2 * buffer->capacity : buffer->limit;
    unsigned char *bytes = context_allocate(buffer->context, capacity, 1);
    if (bytes == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to unpack %s (%zu bytes)", path, capacity);
    memcpy(bytes, buffer->bytes, buffer->size);
    context_release(buffer->context, buffer->bytes);
    buffer->bytes = bytes;
    buffer->capacity = capacity;
    return HELIO_OK;
}

/* Inflates one member after the other until the file ends. */
static helio_status inflate_members(z_stream *stream, byte_buffer *buffer, const char *path)
{
    for (;;) {
        if (buffer->size == buffer->capacity)
            HELIO_TRY(buffer_grow(buffer, path));
        stream->next_out = buffer->bytes + buffer->size;
        stream->avail_out = (uInt)(buffer->capacity - buffer->size);
        int result = inflate(stream, Z_NO_FLUSH);
        buffer->size = buffer->capacity - stream->avail_out;
        if (result == Z_STREAM_END) {
            /* Whatever else follows a member is padding, which gzip ignores too. */
            if (stream->avail_in < 2 || stream->next_in[0] != 0x1f || stream->next_in[1] != 0x8b)
                return HELIO_OK;
            inflateReset(stream);
        } else if (result == Z_MEM_ERROR) {
            return fail(HELIO_ERR_MEMORY, "no memory to unpack %s", path);
        } else if (result != Z_OK && !(result == Z_BUF_ERROR && stream->avail_out == 0)) {
            return fail(HELIO_ERR_DATA, "%s is not a complete gzip file: %s", path,
                        stream->msg ? stream->msg : "it ends too early");
        }
    }
}

helio_status gzip_read(helio_context *context, const char *path, size_t max_bytes, unsigned char **bytes, size_t *size)
{
    unsigned char *packed;
    size_t packed_size;
    HELIO_TRY(file_read(context, path, max_bytes, &packed, &packed_size));

    byte_buffer buffer = {.context = context, .capacity = 4 * packed_size + 4096, .limit = MODEST_BYTES};
    if (packed_size > MODEST_BYTES / MAX_RATIO)
        buffer.limit = packed_size < max_bytes / MAX_RATIO ? packed_size * MAX_RATIO : max_bytes;
    if (buffer.capacity > buffer.limit)
        buffer.capacity = buffer.limit;
    z_stream stream = {.next_in = packed, .avail_in = (uInt)packed_size};
    helio_status status = HELIO_OK;
    buffer.bytes = context_allocate(context, buffer.capacity, 1);
    if (buffer.bytes == NULL || inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) {
        status = fail(HELIO_ERR_MEMORY, "no memory to unpack %s", path);
    } else {
        status = inflate_members(&stream, &buffer, path);
        inflateEnd(&stream);
    }
    context_release(context, packed);
    if (status != HELIO_OK) {
        context_release(context, buffer.bytes);
        return status;
    }
    *bytes = buffer.bytes;
    *size = buffer.size;
    return HELIO_OK;
}
