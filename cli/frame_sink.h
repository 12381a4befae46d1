/* SPDX-License-Identifier: MIT
 * frame_sink.h - where rendered frames go: one picture, numbered pictures or a video. Sequences are written on a thread
 * of their own, while the next frame is rendered. */
#ifndef HELIOSTAT_CLI_FRAME_SINK_H
#define HELIOSTAT_CLI_FRAME_SINK_H

#include "numbered_path.h"

#include <heliostat/heliostat.h>

#include <pthread.h>

enum { SINK_PATH_SIZE = 4096, SINK_ERROR_SIZE = 4096 };

typedef enum frame_sink_kind {
    SINK_PICTURE,
    SINK_NUMBERED,
    SINK_VIDEO,
} frame_sink_kind;

/* What a path means by its name, and by the folders that there are. */
frame_sink_kind frame_sink_kind_of(const char *path);

/* Is it a folder, or named like one? Then numbered pictures go there. */
bool frame_sink_is_folder(const char *path);

typedef struct frame_sink_desc {
    frame_sink_kind kind;
    const char *path;                 /* of the picture or the video, or the pattern of names; stays the caller's */
    helio_picture_write_desc picture; /* exposure and tone map hold for a video too */
    helio_video_write_desc video;     /* without these two */
} frame_sink_desc;

typedef struct frame_sink {
    helio_context *context;
    frame_sink_desc desc;
    numbered_path names;
    helio_video_writer *video;
    uint64_t written; /* frames; to be read after frame_sink_flush() */
    uint64_t lost;    /* frames of a video that could not be finished, which are not among those */

    /* The frame that is being written, or waits for it. */
    helio_picture picture; /* its layers are in memory of the sink where has_thread */
    uint64_t index;
    float *memory;
    uint8_t *shown;

    bool has_thread;
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool is_full, is_closing; /* guarded by mutex, as are written, status and error while the thread runs */
    helio_status status;
    char error[SINK_ERROR_SIZE]; /* one sentence */
} frame_sink;

/* Begins the video, if it is one. HELIO_ERR_... with helio_last_error(). A sink that was not opened, or not
 * successfully, may be closed. */
helio_status frame_sink_open(frame_sink *sink, helio_context *context, const frame_sink_desc *desc);

/* Name of the file that the frame goes to. False if it does not fit. */
bool frame_sink_name(const frame_sink *sink, uint64_t index, char name[SINK_PATH_SIZE]);

/* Writes the frame, from its shown where that is there, or copies it and has it written. A failure may be one of the
 * frame before. sink->error tells. */
helio_status frame_sink_add(frame_sink *sink, uint64_t index, const helio_picture *picture);

/* Waits until all frames are written. sink->error tells what failed. */
helio_status frame_sink_flush(frame_sink *sink);

/* Waits as well; a video is finished if it has frames, else removed, and so is one that cannot be
 * finished: its frames are lost. */
helio_status frame_sink_close(frame_sink *sink);

#endif
