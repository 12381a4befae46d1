/* SPDX-License-Identifier: MIT */
#include "frame_sink.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool frame_sink_is_folder(const char *path)
{
    struct stat status;
    size_t length = strlen(path);
    if (length > 0 && path[length - 1] == '/')
        return true;
    /* A folder that is called like a picture is rather a mistake. */
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode) && helio_picture_check_path(path) != HELIO_OK;
}

frame_sink_kind frame_sink_kind_of(const char *path)
{
    if (frame_sink_is_folder(path) || numbered_path_is_pattern(path))
        return SINK_NUMBERED;
    return helio_video_has_extension(path) ? SINK_VIDEO : SINK_PICTURE;
}

bool frame_sink_name(const frame_sink *sink, uint64_t index, char name[SINK_PATH_SIZE])
{
    if (sink->desc.kind == SINK_NUMBERED)
        return numbered_path_format(&sink->names, index, name, SINK_PATH_SIZE);
    return snprintf(name, SINK_PATH_SIZE, "%s", sink->desc.path) < SINK_PATH_SIZE;
}

/* ---- writing ---------------------------------------------------------------------------- */

/* The library's sentence belongs to the thread on which a function failed: it is kept for the others. */
static helio_status keep_error(frame_sink *sink, helio_status status)
{
    if (status != HELIO_OK)
        snprintf(sink->error, SINK_ERROR_SIZE, "%s", helio_last_error());
    return status;
}

static helio_status write_frame(frame_sink *sink, char error[SINK_ERROR_SIZE])
{
    char name[SINK_PATH_SIZE];
    helio_status status;
    if (sink->desc.kind == SINK_VIDEO) {
        status = helio_video_add(sink->video, &sink->picture);
    } else if (!frame_sink_name(sink, sink->index, name)) {
        snprintf(error, SINK_ERROR_SIZE, "the name of frame %" PRIu64 " by %s is too long", sink->index,
                 sink->desc.path);
        return HELIO_ERR_ARGUMENT;
    } else {
        status = helio_picture_write(sink->context, name, &sink->picture, &sink->desc.picture);
    }
    if (status != HELIO_OK)
        snprintf(error, SINK_ERROR_SIZE, "%s", helio_last_error());
    return status;
}

/* After a failure frames are taken and forgotten, so that nobody waits. */
static void *write_frames(void *data)
{
    frame_sink *sink = data;
    char error[SINK_ERROR_SIZE];
    pthread_mutex_lock(&sink->mutex);
    for (;;) {
        while (!sink->is_full && !sink->is_closing)
            pthread_cond_wait(&sink->changed, &sink->mutex);
        if (!sink->is_full)
            break;
        helio_status status = sink->status;
        if (status == HELIO_OK) {
            pthread_mutex_unlock(&sink->mutex);
            status = write_frame(sink, error);
            pthread_mutex_lock(&sink->mutex);
            sink->written += status == HELIO_OK;
            if (status != HELIO_OK)
                strcpy(sink->error, error);
            sink->status = status;
        }
        sink->is_full = false;
        pthread_cond_broadcast(&sink->changed);
    }
    pthread_mutex_unlock(&sink->mutex);
    return NULL;
}

helio_status frame_sink_flush(frame_sink *sink)
{
    if (!sink->has_thread)
        return sink->status;
    pthread_mutex_lock(&sink->mutex);
    while (sink->is_full)
        pthread_cond_wait(&sink->changed, &sink->mutex);
    pthread_mutex_unlock(&sink->mutex);
    return sink->status;
}

/* ---- frames ----------------------------------------------------------------------------- */

typedef struct picture_layer {
    const float *from;
    const float **to;
    size_t channels;
} picture_layer;

static size_t layer_floats(const helio_picture *picture, size_t channels)
{
    return (size_t)picture->width * picture->height * channels;
}

static helio_status fail_with_memory(frame_sink *sink)
{
    snprintf(sink->error, SINK_ERROR_SIZE, "no memory to write %s while the next frame is rendered", sink->desc.path);
    return HELIO_ERR_MEMORY;
}

/* Where that is there, it is all that is written. */
static helio_status copy_shown(frame_sink *sink, const helio_picture *picture)
{
    const size_t bytes = (size_t)picture->width * picture->height * 4;
    if (sink->shown == NULL)
        sink->shown = malloc(bytes);
    if (sink->shown == NULL)
        return fail_with_memory(sink);
    memcpy(sink->shown, picture->shown, bytes);
    sink->picture = (helio_picture){.width = picture->width, .height = picture->height, .shown = sink->shown};
    return HELIO_OK;
}

/* The renderer's picture lasts until its next frame. The layers are the same each time. */
static helio_status copy_picture(frame_sink *sink, const helio_picture *picture)
{
    helio_picture *copy = &sink->picture;
    if (picture->shown != NULL)
        return copy_shown(sink, picture);
    const picture_layer layers[] = {{picture->rgba, &copy->rgba, 4},
                                    {picture->object, &copy->object, 1},
                                    {picture->albedo, &copy->albedo, 3},
                                    {picture->normal, &copy->normal, 3},
                                    {picture->position, &copy->position, 3},
                                    {picture->depth, &copy->depth, 1},
                                    {picture->standard_error, &copy->standard_error, 3}};
    size_t count = sizeof layers / sizeof layers[0], channels = 0;
    for (size_t i = 0; i < count; i++)
        channels += layers[i].from != NULL ? layers[i].channels : 0;
    if (sink->memory == NULL)
        sink->memory = malloc(layer_floats(picture, channels) * sizeof sink->memory[0]);
    if (sink->memory == NULL)
        return fail_with_memory(sink);
    *copy = (helio_picture){.width = picture->width, .height = picture->height};
    float *place = sink->memory;
    for (size_t i = 0; i < count; i++) {
        if (layers[i].from == NULL)
            continue;
        size_t floats = layer_floats(picture, layers[i].channels);
        memcpy(place, layers[i].from, floats * sizeof place[0]);
        *layers[i].to = place;
        place += floats;
    }
    return HELIO_OK;
}

static helio_status add_here(frame_sink *sink, uint64_t index, const helio_picture *picture)
{
    sink->picture = *picture;
    sink->index = index;
    sink->status = write_frame(sink, sink->error);
    sink->written += sink->status == HELIO_OK;
    return sink->status;
}

helio_status frame_sink_add(frame_sink *sink, uint64_t index, const helio_picture *picture)
{
    if (!sink->has_thread)
        return add_here(sink, index, picture);
    helio_status status = frame_sink_flush(sink);
    if (status == HELIO_OK)
        status = copy_picture(sink, picture);
    if (status != HELIO_OK)
        return status;
    pthread_mutex_lock(&sink->mutex);
    sink->index = index;
    sink->is_full = true;
    pthread_cond_broadcast(&sink->changed);
    pthread_mutex_unlock(&sink->mutex);
    return HELIO_OK;
}

/* ---- opening and closing ---------------------------------------------------------------- */

/* Without a thread the sink works as well, only one after the other. */
static void start_thread(frame_sink *sink)
{
    pthread_mutex_init(&sink->mutex, NULL);
    pthread_cond_init(&sink->changed, NULL);
    sink->has_thread = pthread_create(&sink->thread, NULL, write_frames, sink) == 0;
    if (!sink->has_thread) {
        pthread_cond_destroy(&sink->changed);
        pthread_mutex_destroy(&sink->mutex);
    }
}

static void stop_thread(frame_sink *sink)
{
    if (!sink->has_thread)
        return;
    pthread_mutex_lock(&sink->mutex);
    sink->is_closing = true;
    pthread_cond_broadcast(&sink->changed);
    pthread_mutex_unlock(&sink->mutex);
    pthread_join(sink->thread, NULL);
    pthread_cond_destroy(&sink->changed);
    pthread_mutex_destroy(&sink->mutex);
    sink->has_thread = false;
}

helio_status frame_sink_open(frame_sink *sink, helio_context *context, const frame_sink_desc *desc)
{
    *sink = (frame_sink){.context = context, .desc = *desc};
    if (desc->kind == SINK_NUMBERED && !numbered_path_parse(desc->path, &sink->names)) {
        snprintf(sink->error, SINK_ERROR_SIZE, "%s is no name of numbered pictures", desc->path);
        return sink->status = HELIO_ERR_ARGUMENT;
    }
    if (desc->kind == SINK_VIDEO) {
        sink->desc.video.exposure = desc->picture.exposure;
        sink->desc.video.tonemap = desc->picture.tonemap;
        sink->status = keep_error(sink, helio_video_create(context, desc->path, &sink->desc.video, &sink->video));
        if (sink->status != HELIO_OK)
            return sink->status;
    }
    if (desc->kind != SINK_PICTURE)
        start_thread(sink);
    return HELIO_OK;
}

helio_status frame_sink_close(frame_sink *sink)
{
    stop_thread(sink);
    if (sink->video != NULL) {
        helio_status status = helio_video_finish(sink->video, sink->written > 0);
        sink->video = NULL;
        if (sink->written > 0 && status != HELIO_OK) {
            sink->lost = sink->written;
            sink->written = 0;
            if (sink->status == HELIO_OK)
                sink->status = keep_error(sink, status);
        }
    }
    free(sink->memory);
    free(sink->shown);
    sink->memory = NULL;
    sink->shown = NULL;
    return sink->status;
}
