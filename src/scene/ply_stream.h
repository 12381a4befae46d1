/* SPDX-License-Identifier: MIT
 * ply_stream.h - the bytes of a PLY file one piece after the other, be they in a file or in memory. */
#ifndef HELIOSTAT_SRC_PLY_STREAM_H
#define HELIOSTAT_SRC_PLY_STREAM_H

#include <heliostat/core.h>

#include <stdio.h>

typedef struct ply_stream {
    FILE *file;                      /* NULL: all bytes are in memory */
    uint64_t unread;                 /* bytes of the file that follow those in memory */
    const unsigned char *next, *end; /* bytes in memory */
    bool failed;                     /* the file could not be read as far as its size says */
    unsigned char buffer[16384];
} ply_stream;

/* Neither is taken over, and both must stay until the stream is no longer used. file: at its start. */
void ply_stream_open_file(ply_stream *stream, FILE *file, uint64_t size);
void ply_stream_open_memory(ply_stream *stream, const unsigned char *bytes, size_t size);

/* Bytes that are still to come. */
uint64_t ply_stream_left(const ply_stream *stream);

/* Makes at least one byte available at next; false at the end. */
bool ply_stream_fill(ply_stream *stream);

/* False, and at the end, if there are not as many bytes. */
bool ply_stream_take(ply_stream *stream, unsigned char *bytes, size_t count);
bool ply_stream_skip(ply_stream *stream, uint64_t count);

/* Goes behind the end of this line; false if the file ends before it. */
bool ply_stream_skip_line(ply_stream *stream);

/* Copies a line without its end, as a text, and goes behind it. Of a line that is too long its start is copied. False
 * if no line ends before the file does. */
bool ply_stream_read_line(ply_stream *stream, char *line, size_t size, bool *whole);

#endif
