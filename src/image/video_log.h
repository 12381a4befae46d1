/* SPDX-License-Identifier: MIT
 * video_log.h - what FFmpeg has to say, which has one log for the whole process, to the contexts that it concerns. */
#ifndef HELIOSTAT_SRC_IMAGE_VIDEO_LOG_H
#define HELIOSTAT_SRC_IMAGE_VIDEO_LOG_H

#include <heliostat/core.h>

/* One for each reader and writer. AVCodecContext.opaque points to it, so that its decoding threads are heard too. */
typedef struct video_log {
    struct video_log *next; /* in the list of all; guarded by its mutex */
    helio_context *context;
    struct video_log *outer; /* that this thread was in before video_log_enter() */
    char error[256];         /* the last error in the thread that is inside, printable; "" if there was none */
    char complaint[256];     /* the last error of its codec in any thread; guarded by the list's mutex */
} video_log;

/* Before the first and after the last use of FFmpeg. From the first begin on, the process's log is ours: messages that
 * are of none of these go to FFmpeg's own. */
void video_log_begin(video_log *log, helio_context *context);
void video_log_end(video_log *log);

/* What FFmpeg says in this thread until leave belongs to this log. Enter forgets the last error. */
void video_log_enter(video_log *log);
void video_log_leave(video_log *log);

/* Why a function failed that returned code: FFmpeg's last error message, or what the code stands for. Valid until the
 * next call with this log. */
const char *video_log_reason(video_log *log, int code);

/* What its codec complained about since this was asked last, in any thread; false if it did not. */
bool video_log_take_complaint(video_log *log, char complaint[256]);

#endif
