/* SPDX-License-Identifier: MIT */
#include "image/video_log.h"

#include "core/context.h"
#include "image/image.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include <libavcodec/avcodec.h>
#include <libavutil/log.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static video_log *all; /* guarded by mutex */
static _Thread_local video_log *current;

/* One line without its newline; false if nothing is left. */
static bool format_line(void *source, int level, const char *format, va_list arguments, char *line, size_t size)
{
    int with_prefix = 0;
    av_log_format_line2(source, level, format, arguments, line, (int)size, &with_prefix);
    line[strcspn(line, "\r\n")] = 0;
    image_make_printable(line);
    return line[0] != 0;
}

/* The codec that a message is about: some are about a part of it. */
static const AVCodecContext *find_codec(void *source)
{
    while (source != NULL) {
        const AVClass *class = *(const AVClass **)source;
        if (class == NULL || class == avcodec_get_class())
            return class != NULL ? source : NULL;
        if (class->parent_log_context_offset == 0)
            return NULL;
        source = *(void **)((unsigned char *)source + class->parent_log_context_offset);
    }
    return NULL;
}

/* The log of a codec, whatever thread it works in; to be called with the mutex. */
static video_log *find_log(void *source)
{
    const AVCodecContext *codec = find_codec(source);
    video_log *log = codec != NULL ? all : NULL;
    while (log != NULL && log != codec->opaque)
        log = log->next;
    return log;
}

static void on_message(void *source, int level, const char *format, va_list arguments)
{
    char line[sizeof current->error] = "";
    bool is_worth = level <= AV_LOG_INFO;
    pthread_mutex_lock(&mutex);
    video_log *owner = find_log(source), *log = current != NULL ? current : owner;
    if (log != NULL && is_worth && format_line(source, level, format, arguments, line, sizeof line) &&
        level <= AV_LOG_ERROR) {
        if (owner != NULL)
            memcpy(owner->complaint, line, sizeof line);
        if (current != NULL)
            memcpy(current->error, line, sizeof line);
    }
    pthread_mutex_unlock(&mutex);
    if (line[0] != 0) /* the log stays: its codec is closed, which waits for its threads, before video_log_end() */
        context_log(log->context, HELIO_LOG_DEBUG, "FFmpeg: %s", line);
    if (log == NULL)
        av_log_default_callback(source, level, format, arguments);
}

static void take_log(void)
{
    av_log_set_callback(on_message);
}

void video_log_begin(video_log *log, helio_context *context)
{
    pthread_once(&once, take_log);
    *log = (video_log){.context = context};
    pthread_mutex_lock(&mutex);
    log->next = all;
    all = log;
    pthread_mutex_unlock(&mutex);
}

void video_log_end(video_log *log)
{
    pthread_mutex_lock(&mutex);
    video_log **link = &all;
    while (*link != NULL && *link != log)
        link = &(*link)->next;
    if (*link != NULL)
        *link = log->next;
    pthread_mutex_unlock(&mutex);
}

void video_log_enter(video_log *log)
{
    log->error[0] = 0;
    log->outer = current;
    current = log;
}

void video_log_leave(video_log *log)
{
    current = log->outer;
}

const char *video_log_reason(video_log *log, int code)
{
    if (log->error[0] == 0 && av_strerror(code, log->error, sizeof log->error) < 0)
        snprintf(log->error, sizeof log->error, "error %d", code);
    return log->error;
}

bool video_log_take_complaint(video_log *log, char complaint[256])
{
    pthread_mutex_lock(&mutex);
    memcpy(complaint, log->complaint, sizeof log->complaint);
    log->complaint[0] = 0;
    pthread_mutex_unlock(&mutex);
    return complaint[0] != 0;
}
