/* SPDX-License-Identifier: MIT */
#include "image/video_output.h"

#include "core/error.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <libavutil/mem.h>

enum { BUFFER_SIZE = 1 << 16 };

static int error_code(void)
{
    return errno != 0 ? AVERROR(errno) : AVERROR(EIO);
}

#if LIBAVFORMAT_VERSION_MAJOR >= 61
static int write_bytes(void *opaque, const uint8_t *bytes, int size)
#else
static int write_bytes(void *opaque, uint8_t *bytes, int size)
#endif
{
    video_output *output = opaque;
    errno = 0;
    return fwrite(bytes, 1, (size_t)size, output->file.stream) == (size_t)size ? size : error_code();
}

static int64_t seek(void *opaque, int64_t offset, int whence)
{
    video_output *output = opaque;
    struct stat status;
    errno = 0;
    if (whence & AVSEEK_SIZE)
        return fflush(output->file.stream) == 0 && fstat(fileno(output->file.stream), &status) == 0
                   ? (int64_t)status.st_size
                   : error_code();
    return fseeko(output->file.stream, (off_t)offset, whence & ~AVSEEK_FORCE) == 0
               ? (int64_t)ftello(output->file.stream)
               : error_code();
}

/* ---- reading what was written: MP4 moves its pictures to make room for the index before them ---- */

typedef struct reread {
    video_output *output;
    off_t place;
} reread;

static int reread_bytes(void *opaque, uint8_t *bytes, int size)
{
    reread *state = opaque;
    errno = 0;
    if (fflush(state->output->file.stream) != 0)
        return error_code();
    ssize_t count = pread(fileno(state->output->file.stream), bytes, (size_t)size, state->place);
    if (count <= 0)
        return count == 0 ? AVERROR_EOF : error_code();
    state->place += count;
    return (int)count;
}

static int64_t reread_seek(void *opaque, int64_t offset, int whence)
{
    reread *state = opaque;
    struct stat status;
    if (whence & AVSEEK_SIZE)
        return fstat(fileno(state->output->file.stream), &status) == 0 ? (int64_t)status.st_size : AVERROR(errno);
    whence &= ~AVSEEK_FORCE;
    if (whence != SEEK_SET && whence != SEEK_CUR)
        return AVERROR(EINVAL);
    state->place = (off_t)offset + (whence == SEEK_CUR ? state->place : 0);
    return (int64_t)state->place;
}

/* The file may have no name, so it is opened anew through its descriptor. */
static int open_again(AVFormatContext *format, AVIOContext **io, const char *url, int flags, AVDictionary **options)
{
    (void)url;
    (void)options;
    if (flags & AVIO_FLAG_WRITE)
        return AVERROR(EACCES);
    reread *state = av_mallocz(sizeof *state);
    unsigned char *buffer = av_malloc(BUFFER_SIZE);
    *io = state != NULL && buffer != NULL
              ? avio_alloc_context(buffer, BUFFER_SIZE, 0, state, reread_bytes, NULL, reread_seek)
              : NULL;
    if (*io == NULL) {
        av_free(state);
        av_free(buffer);
        return AVERROR(ENOMEM);
    }
    state->output = format->opaque;
    return 0;
}

static int close_again(AVFormatContext *format, AVIOContext *io)
{
    (void)format;
    av_freep(&io->opaque);
    av_freep(&io->buffer);
    avio_context_free(&io);
    return 0;
}

/* ---- */

static helio_status open_format(video_output *output, const char *muxer)
{
    unsigned char *buffer = av_malloc(BUFFER_SIZE);
    if (buffer == NULL || avformat_alloc_output_context2(&output->format, NULL, muxer, output->file.path) < 0) {
        av_free(buffer);
        return fail(HELIO_ERR_UNSUPPORTED, "%s cannot be written: the FFmpeg here has no %s", output->file.path, muxer);
    }
    output->format->opaque = output;
    output->format->io_open = open_again;
    output->format->io_close2 = close_again;
    output->format->pb = avio_alloc_context(buffer, BUFFER_SIZE, 1, output, NULL, write_bytes, seek);
    if (output->format->pb == NULL) {
        av_free(buffer);
        return fail(HELIO_ERR_MEMORY, "no memory to write %s", output->file.path);
    }
    output->format->flags |= AVFMT_FLAG_CUSTOM_IO;
    return HELIO_OK;
}

helio_status video_output_open(video_output *output, const char *path, const char *muxer)
{
    *output = (video_output){0};
    HELIO_TRY(file_writer_open(&output->file, path));
    return open_format(output, muxer);
}

helio_status video_output_close(video_output *output, bool commit)
{
    if (output->format != NULL && output->format->pb != NULL) {
        avio_flush(output->format->pb);
        if (output->format->pb->error < 0 && commit) {
            errno = AVUNERROR(output->format->pb->error);
            fail(HELIO_ERR_IO, "%s cannot be written: %s", output->file.path, strerror(errno));
            commit = false;
        }
        av_freep(&output->format->pb->buffer);
        avio_context_free(&output->format->pb);
    }
    avformat_free_context(output->format);
    output->format = NULL;
    if (commit)
        return file_writer_commit(&output->file);
    file_writer_abandon(&output->file);
    return HELIO_ERR_IO;
}
