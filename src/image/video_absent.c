/* SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "image/video_reader.h"

static helio_status fail_without_ffmpeg(const char *path)
{
    return fail(HELIO_ERR_UNSUPPORTED,
                "%s needs FFmpeg, as all video does, and this build has none; build with it or use pictures",
                path != NULL ? path : "this");
}

helio_status helio_video_open(helio_context *context, const char *path, const helio_video_read_desc *desc,
                              helio_video_reader **reader)
{
    (void)context;
    (void)desc;
    if (reader != NULL)
        *reader = NULL;
    return fail_without_ffmpeg(path);
}

void helio_video_close(helio_video_reader *reader)
{
    (void)reader;
}

bool video_reader_plays_png(void)
{
    return false;
}

void video_reader_heed(helio_video_reader *reader, const atomic_bool *stopping)
{
    (void)reader;
    (void)stopping;
}

helio_video_info helio_video_get_info(const helio_video_reader *reader)
{
    (void)reader;
    return (helio_video_info){0};
}

helio_status helio_video_next(helio_video_reader *reader, helio_video_frame *frame)
{
    (void)reader;
    (void)frame;
    return fail_without_ffmpeg(NULL);
}

helio_status helio_video_check_path(const char *path, const helio_video_write_desc *desc)
{
    (void)desc;
    return fail_without_ffmpeg(path);
}

helio_status helio_video_create(helio_context *context, const char *path, const helio_video_write_desc *desc,
                                helio_video_writer **writer)
{
    (void)context;
    (void)desc;
    if (writer != NULL)
        *writer = NULL;
    return fail_without_ffmpeg(path);
}

helio_status helio_video_add(helio_video_writer *writer, const helio_picture *picture)
{
    (void)writer;
    (void)picture;
    return fail_without_ffmpeg(NULL);
}

helio_status helio_video_finish(helio_video_writer *writer, bool keep)
{
    (void)writer;
    (void)keep;
    return fail_without_ffmpeg(NULL);
}
