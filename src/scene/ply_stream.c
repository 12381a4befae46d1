/* SPDX-License-Identifier: MIT */
#include "scene/ply_stream.h"

#include <string.h>

void ply_stream_open_file(ply_stream *stream, FILE *file, uint64_t size)
{
    stream->file = file;
    stream->unread = size;
    stream->next = stream->end = stream->buffer;
    stream->failed = false;
}

void ply_stream_open_memory(ply_stream *stream, const unsigned char *bytes, size_t size)
{
    stream->file = NULL;
    stream->unread = 0;
    stream->next = bytes;
    stream->end = bytes + size;
    stream->failed = false;
}

static uint64_t left_in_memory(const ply_stream *stream)
{
    return (uint64_t)(stream->end - stream->next);
}

uint64_t ply_stream_left(const ply_stream *stream)
{
    return left_in_memory(stream) + stream->unread;
}

static void fail_to_read(ply_stream *stream)
{
    stream->failed = true;
    stream->unread = 0;
}

bool ply_stream_fill(ply_stream *stream)
{
    if (stream->next < stream->end)
        return true;
    if (stream->unread == 0)
        return false;
    size_t wanted = stream->unread < sizeof stream->buffer ? (size_t)stream->unread : sizeof stream->buffer;
    size_t got = fread(stream->buffer, 1, wanted, stream->file);
    stream->next = stream->buffer;
    stream->end = stream->buffer + got;
    stream->unread -= got;
    if (got < wanted)
        fail_to_read(stream);
    return got > 0;
}

bool ply_stream_take(ply_stream *stream, unsigned char *bytes, size_t count)
{
    while (count > 0 && ply_stream_fill(stream)) {
        size_t part = left_in_memory(stream) < count ? (size_t)left_in_memory(stream) : count;
        memcpy(bytes, stream->next, part);
        stream->next += part;
        bytes += part;
        count -= part;
    }
    return count == 0;
}

bool ply_stream_skip(ply_stream *stream, uint64_t count)
{
    bool enough = count <= ply_stream_left(stream);
    if (!enough)
        count = ply_stream_left(stream);
    if (count <= left_in_memory(stream)) {
        stream->next += count;
        return enough;
    }
    count -= left_in_memory(stream);
    stream->next = stream->end;
    stream->unread -= count;
    if (fseeko(stream->file, (off_t)count, SEEK_CUR) != 0)
        fail_to_read(stream);
    return enough && !stream->failed;
}

/* The part of the line that is in memory. Returns whether its end is. */
static bool skip_part_of_line(ply_stream *stream)
{
    const unsigned char *newline = memchr(stream->next, '\n', (size_t)left_in_memory(stream));
    stream->next = newline ? newline + 1 : stream->end;
    return newline != NULL;
}

bool ply_stream_skip_line(ply_stream *stream)
{
    while (ply_stream_fill(stream))
        if (skip_part_of_line(stream))
            return true;
    return false;
}

bool ply_stream_read_line(ply_stream *stream, char *line, size_t size, bool *whole)
{
    size_t length = 0;
    bool ended = false;
    *whole = true;
    while (!ended && ply_stream_fill(stream)) {
        const unsigned char *start = stream->next;
        ended = skip_part_of_line(stream);
        size_t part = (size_t)(stream->next - start) - ended, room = size - 1 - length;
        if (part > room) {
            part = room;
            *whole = false;
        }
        memcpy(line + length, start, part);
        length += part;
    }
    if (*whole && length > 0 && line[length - 1] == '\r')
        length--;
    line[length] = 0;
    return ended;
}
