/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/video_encoder.h"
#include "image/video_output.h"
#include "image/video_pixels.h"

#include <string.h>

struct helio_video_writer {
    helio_context *context;
    char *path;
    helio_video_write_desc desc; /* resolved; its codec is not kept */
    video_log log;
    video_encoder encoder;
    video_output output;
    AVCodecContext *codec;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
    video_pixels pixels;
    int64_t frames;
    bool has_failed;
};

static helio_status fail_to_write(helio_video_writer *writer, int code)
{
    return fail(code == AVERROR(ENOMEM) ? HELIO_ERR_MEMORY : HELIO_ERR_IO, "%s cannot be written: %s", writer->path,
                video_log_reason(&writer->log, code));
}

/* ---- beginning ---- */

static helio_status write_header(helio_video_writer *writer)
{
    AVDictionary *options = NULL;
    if (strcmp(writer->encoder.muxer, "mp4") == 0 || strcmp(writer->encoder.muxer, "mov") == 0)
        av_dict_set(&options, "movflags", "+faststart+write_colr", 0);
    int code = avformat_write_header(writer->output.format, &options);
    av_dict_free(&options);
    return code >= 0 ? HELIO_OK : fail_to_write(writer, code);
}

static helio_status begin(helio_video_writer *writer)
{
    HELIO_TRY(video_output_open(&writer->output, writer->path, writer->encoder.muxer));
    AVFormatContext *format = writer->output.format;
    HELIO_TRY(video_encoder_open(&writer->encoder, writer->path, &writer->desc, helio_context_threads(writer->context),
                                 (format->oformat->flags & AVFMT_GLOBALHEADER) != 0, &writer->log, &writer->codec));
    HELIO_TRY(video_pixels_begin(&writer->pixels, writer->context, &writer->desc, writer->encoder.width));
    writer->stream = avformat_new_stream(format, NULL);
    writer->frame = av_frame_alloc();
    writer->packet = av_packet_alloc();
    if (writer->stream == NULL || writer->frame == NULL || writer->packet == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to write %s", writer->path);
    HELIO_TRY(video_encoder_describe(&writer->desc, writer->codec, writer->stream));
    return write_header(writer);
}

static void release(helio_video_writer *writer)
{
    avcodec_free_context(&writer->codec);
    av_frame_free(&writer->frame);
    av_packet_free(&writer->packet);
    video_log_leave(&writer->log);
    video_log_end(&writer->log);
    video_pixels_end(&writer->pixels);
    context_release(writer->context, writer->path);
    context_release(writer->context, writer);
}

helio_status helio_video_create(helio_context *context, const char *path, const helio_video_write_desc *given,
                                helio_video_writer **out)
{
    helio_video_write_desc desc;
    video_encoder encoder;
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_video_create needs a place for the writer");
    *out = NULL;
    if (context == NULL || path == NULL || given == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_video_create needs a context, a path and a desc");
    if (given->width == 0 || given->height == 0)
        return fail(HELIO_ERR_ARGUMENT, "the video %s needs a size", path);
    HELIO_TRY(video_encoder_resolve(path, given, &desc));
    HELIO_TRY(video_encoder_find(path, &desc, &encoder));
    helio_video_writer *writer = context_allocate(context, 1, sizeof *writer);
    if (writer == NULL)
        return HELIO_ERR_MEMORY;
    desc.codec = NULL;
    writer->context = writer->pixels.context = context;
    writer->desc = desc;
    writer->encoder = encoder;
    video_log_begin(&writer->log, context);
    video_log_enter(&writer->log);
    helio_status status = HELIO_ERR_MEMORY;
    writer->path = context_allocate(context, strlen(path) + 1, 1);
    if (writer->path != NULL) {
        strcpy(writer->path, path);
        status = begin(writer);
    }
    if (status == HELIO_OK) {
        video_log_leave(&writer->log);
        *out = writer;
        return HELIO_OK;
    }
    video_output_close(&writer->output, false);
    release(writer);
    return status;
}

/* ---- frames ---- */

/* Writes what the encoder has ready. */
static helio_status drain(helio_video_writer *writer)
{
    for (;;) {
        int code = avcodec_receive_packet(writer->codec, writer->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF)
            return HELIO_OK;
        if (code >= 0) {
            if (writer->packet->duration == 0)
                writer->packet->duration = 1;
            av_packet_rescale_ts(writer->packet, writer->codec->time_base, writer->stream->time_base);
            writer->packet->stream_index = writer->stream->index;
            code = av_interleaved_write_frame(writer->output.format, writer->packet);
        }
        if (code < 0)
            return fail_to_write(writer, code);
    }
}

static helio_status encode(helio_video_writer *writer, const helio_picture *picture)
{
    AVFrame *frame = writer->frame;
    frame->format = writer->codec->pix_fmt;
    frame->width = writer->codec->width;
    frame->height = writer->codec->height;
    frame->color_range = writer->codec->color_range;
    frame->color_primaries = writer->codec->color_primaries;
    frame->color_trc = writer->codec->color_trc;
    frame->colorspace = writer->codec->colorspace;
    frame->chroma_location = writer->codec->chroma_sample_location;
    frame->pts = writer->frames;
    if (av_frame_get_buffer(frame, 0) < 0)
        return fail(HELIO_ERR_MEMORY, "no memory for a frame of %s", writer->path);
    video_pixels_fill(&writer->pixels, picture, frame);
    int code = avcodec_send_frame(writer->codec, frame);
    return code >= 0 ? drain(writer) : fail_to_write(writer, code);
}

helio_status helio_video_add(helio_video_writer *writer, const helio_picture *picture)
{
    if (writer == NULL || picture == NULL || (picture->rgba == NULL && (writer->desc.hdr || picture->shown == NULL)))
        return fail(HELIO_ERR_ARGUMENT, "helio_video_add needs a writer and a picture with rgba, or but for HDR shown");
    if (picture->width != writer->desc.width || picture->height != writer->desc.height)
        return fail(HELIO_ERR_ARGUMENT, "a frame of %u x %u pixels cannot be added to %s, which has %u x %u",
                    picture->width, picture->height, writer->path, writer->desc.width, writer->desc.height);
    if (writer->has_failed)
        return fail(HELIO_ERR_IO, "%s could not be written before; no frame can follow", writer->path);
    video_log_enter(&writer->log);
    helio_status status = encode(writer, picture);
    av_frame_unref(writer->frame);
    av_packet_unref(writer->packet);
    video_log_leave(&writer->log);
    writer->has_failed = status != HELIO_OK;
    writer->frames += status == HELIO_OK;
    return status;
}

/* ---- end ---- */

static helio_status complete(helio_video_writer *writer)
{
    if (writer->has_failed)
        return fail(HELIO_ERR_IO, "%s could not be written and is removed", writer->path);
    if (writer->frames == 0)
        return fail(HELIO_ERR_ARGUMENT, "%s got no frames and is not written", writer->path);
    int code = avcodec_send_frame(writer->codec, NULL);
    if (code < 0)
        return fail_to_write(writer, code);
    HELIO_TRY(drain(writer));
    code = av_write_trailer(writer->output.format);
    return code >= 0 ? HELIO_OK : fail_to_write(writer, code);
}

helio_status helio_video_finish(helio_video_writer *writer, bool keep)
{
    if (writer == NULL)
        return keep ? fail(HELIO_ERR_ARGUMENT, "helio_video_finish needs a writer") : HELIO_OK;
    video_log_enter(&writer->log);
    helio_status status = keep ? complete(writer) : HELIO_OK;
    if (keep && status == HELIO_OK)
        status = video_output_close(&writer->output, true);
    else
        video_output_close(&writer->output, false);
    release(writer);
    return status;
}
