/* SPDX-License-Identifier: MIT */
#include "core/file.h"

#include "core/context.h"
#include "core/error.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static helio_status measure(FILE *stream, const char *path, uint64_t *size)
{
    struct stat status;
    if (fstat(fileno(stream), &status) != 0)
        return fail(HELIO_ERR_IO, "%s cannot be read: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return fail(HELIO_ERR_IO, "%s is not a file", path);
    *size = (uint64_t)status.st_size;
    return HELIO_OK;
}

helio_status file_open(const char *path, FILE **stream, uint64_t *size)
{
    /* Without O_NONBLOCK the opening of a named pipe could wait for ever. */
    int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    *stream = descriptor < 0 ? NULL : fdopen(descriptor, "rb");
    if (*stream == NULL) {
        if (descriptor >= 0)
            close(descriptor);
        return fail(HELIO_ERR_IO, "%s cannot be opened: %s", path, strerror(errno));
    }
    helio_status status = measure(*stream, path, size);
    if (status != HELIO_OK)
        fclose(*stream);
    return status;
}

static helio_status read_stream(helio_context *context, FILE *stream, const char *path, size_t length,
                                unsigned char **bytes)
{
    unsigned char *memory = context_allocate(context, length + 1, 1);
    if (memory == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to read %s (%zu bytes)", path, length);
    if (fread(memory, 1, length, stream) != length) {
        context_release(context, memory);
        return fail(HELIO_ERR_IO, "%s cannot be read to its end", path);
    }
    *bytes = memory;
    return HELIO_OK;
}

helio_status file_read(helio_context *context, const char *path, size_t max_bytes, unsigned char **bytes, size_t *size)
{
    FILE *stream;
    uint64_t length;
    HELIO_TRY(file_open(path, &stream, &length));
    helio_status status;
    if (length > max_bytes)
        status =
            fail(HELIO_ERR_DATA, "%s is too large: %" PRIu64 " bytes, where %zu are allowed", path, length, max_bytes);
    else
        status = read_stream(context, stream, path, (size_t)length, bytes);
    fclose(stream);
    if (status == HELIO_OK)
        *size = (size_t)length;
    return status;
}

/* Gives a name to a file that has none. */
static int link_unnamed(int descriptor, const char *name)
{
    char link[32];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    return linkat(AT_FDCWD, link, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

/* Takes a name beside path that nobody else has: for the file that has none, or, where unnamed is -1, for a new one,
 * whose descriptor it returns. -1, with errno, if that cannot be done. */
static int take_name(file_writer *writer, int unnamed)
{
    for (unsigned attempt = 0; attempt < 1000; attempt++) {
        int length = snprintf(writer->temporary, sizeof writer->temporary, "%.*s.heliostat-%ld-%u",
                              file_folder_length(writer->path), writer->path, (long)getpid(), attempt);
        if (length < 0 || (size_t)length >= sizeof writer->temporary) {
            errno = ENAMETOOLONG;
            break;
        }
        int result = unnamed >= 0 ? link_unnamed(unnamed, writer->temporary)
                                  : open(writer->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (result >= 0)
            return result;
        if (errno != EEXIST)
            break;
    }
    writer->temporary[0] = 0;
    return -1;
}

/* A file in the directory of path that has no name, or -1 where there is no such thing. */
static int make_unnamed(const char *path)
{
#ifdef O_TMPFILE
    char directory[sizeof((file_writer *)0)->temporary];
    int length = file_folder_length(path);
    if ((size_t)length >= sizeof directory)
        return -1;
    snprintf(directory, sizeof directory, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".");
    return open(directory, O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
#else
    (void)path;
    return -1;
#endif
}

/* The same, if it can be given a name later. Only another such file, which gets one, can tell: there may be no /proc,
 * the file system may have no links, or they may be forbidden. */
static int open_unnamed(file_writer *writer)
{
    int other = make_unnamed(writer->path);
    if (other < 0)
        return -1;
    bool has_name = take_name(writer, other) >= 0;
    close(other);
    if (!has_name)
        return -1;
    unlink(writer->temporary);
    writer->temporary[0] = 0;
    return make_unnamed(writer->path);
}

helio_status file_writer_open(file_writer *writer, const char *path)
{
    *writer = (file_writer){.path = path};
    struct stat existing;
    bool exists = stat(path, &existing) == 0;
    if (!exists && errno != ENOENT) /* a name that is too long, say: found now, not when all work is done */
        return fail(HELIO_ERR_IO, "%s cannot be written: %s", path, strerror(errno));
    if (exists && !S_ISREG(existing.st_mode))
        return fail(HELIO_ERR_IO, "%s is %s; name a file to write", path,
                    S_ISDIR(existing.st_mode) ? "a directory" : "a device or pipe, which cannot be replaced");
    int descriptor = open_unnamed(writer);
    if (descriptor < 0)
        descriptor = take_name(writer, -1);
    if (descriptor < 0)
        return fail(HELIO_ERR_IO, "%s cannot be written: %s", path, strerror(errno));
    writer->stream = fdopen(descriptor, "w+b");
    if (writer->stream == NULL) {
        close(descriptor);
        file_writer_abandon(writer);
        return fail(HELIO_ERR_IO, "%s cannot be written: %s", path, strerror(errno));
    }
    return HELIO_OK;
}

helio_status file_writer_commit(file_writer *writer)
{
    errno = 0;
    bool good = ferror(writer->stream) == 0 && fflush(writer->stream) == 0;
    if (good && writer->temporary[0] == 0)
        good = take_name(writer, fileno(writer->stream)) >= 0;
    good = fclose(writer->stream) == 0 && good;
    writer->stream = NULL;
    if (good && rename(writer->temporary, writer->path) == 0) {
        writer->temporary[0] = 0;
        return HELIO_OK;
    }
    const char *reason = errno ? strerror(errno) : "the disk may be full";
    helio_status status = fail(HELIO_ERR_IO, "%s cannot be written: %s", writer->path, reason);
    file_writer_abandon(writer);
    return status;
}

void file_writer_abandon(file_writer *writer)
{
    if (writer->stream != NULL)
        fclose(writer->stream);
    if (writer->temporary[0] != 0)
        unlink(writer->temporary);
    writer->stream = NULL;
    writer->temporary[0] = 0;
}

int file_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

bool file_has_extension(const char *path, const char *extension)
{
    size_t path_length = strlen(path), length = strlen(extension);
    return path_length > length && path[path_length - length - 1] == '.' &&
           strcasecmp(path + path_length - length, extension) == 0;
}
