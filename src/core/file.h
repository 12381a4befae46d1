/* SPDX-License-Identifier: MIT
 * file.h - whole files in, whole files out. */
#ifndef HELIOSTAT_SRC_FILE_H
#define HELIOSTAT_SRC_FILE_H

#include <heliostat/core.h>

#include <stdio.h>

/* Opens a regular file for reading. */
helio_status file_open(const char *path, FILE **stream, uint64_t *size);

/* Reads a regular file into memory of the context; refuses more than max_bytes before memory is taken. */
helio_status file_read(helio_context *context, const char *path, size_t max_bytes, unsigned char **bytes, size_t *size);

/* A file that appears under its path only when it is complete. */
typedef struct file_writer {
    const char *path;
    char temporary[4096]; /* in the same directory, so that the rename is atomic; "" while the file has no name */
    FILE *stream;
} file_writer;

/* Opens the temporary file. Where the system has files without a name (Linux, on most file systems), it is one of these
 * until it is complete, so that a process that is killed leaves nothing. HELIO_ERR_IO if the directory cannot be
 * written. */
helio_status file_writer_open(file_writer *writer, const char *path);

/* Flushes, checks for errors of all writes so far (disk full) and renames. The temporary file is gone either way. */
helio_status file_writer_commit(file_writer *writer);

/* Gives up: removes the temporary file. Fine after commit or a failed open. */
void file_writer_abandon(file_writer *writer);

/* Length of the part of a path up to the last slash, the slash included: an int, as printf wants it for %.*s. */
int file_folder_length(const char *path);

/* Does path end in ".extension", in any case? */
bool file_has_extension(const char *path, const char *extension);

#endif
