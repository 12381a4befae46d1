/* SPDX-License-Identifier: MIT */
#include "image/video_reader.h"
#include "core/context.h"
#include "core/error.h"
#include "image/video_convert.h"
#include "image/video_input.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define DEFAULT_MAX_PIXELS (UINT64_C(1) << 26) /* as for pictures */

enum { MOST_FAULTS = 64 }; /* more than decoders hold frames */

struct helio_video_reader {
    helio_context *context;
    char *path;
    video_log log;
    video_input input;
    bool is_device;
    helio_transfer wanted;
    uint64_t max_pixels;
    AVPacket *packet;
    AVFrame *frame;
    video_converter converter;
    helio_video_info info;
    uint64_t packets, frames; /* read and given out so far */
    int64_t first_time;       /* of the first frame, in the stream's unit */
    bool has_time, warned;
    bool is_webp_animation;
    bool is_draining;    /* nothing more to read */
    unsigned faults;     /* since then */
    bool is_ended;       /* nothing more to give */
    char complaint[512]; /* why reading ended too early, to be said after the frames before it; "" if it did not */
};

/* ---- turning ---- */

/* -1, 0 or 1, or 2 where the entry is neither nothing nor as large as the matrix's largest. */
static int unit_of(int32_t entry, double greatest)
{
    double share = entry / greatest;
    return fabs(share) < 0.01 ? 0 : share > 0.99 ? 1 : share < -0.99 ? -1 : 2;
}

static bool turn_from_matrix(const int32_t m[9], video_turn *turn)
{
    double greatest = fmax(fmax(fabs((double)m[0]), fabs((double)m[1])), fmax(fabs((double)m[3]), fabs((double)m[4])));
    if (!(greatest > 0))
        return false;
    *turn = (video_turn){unit_of(m[0], greatest), unit_of(m[1], greatest), unit_of(m[3], greatest),
                         unit_of(m[4], greatest)};
    bool upright = abs(turn->a) == 1 && turn->b == 0 && turn->c == 0 && abs(turn->d) == 1;
    bool sideways = turn->a == 0 && abs(turn->b) == 1 && abs(turn->c) == 1 && turn->d == 0;
    return upright || sideways;
}

static helio_status find_turn(const helio_video_reader *reader, const AVFrame *frame, video_turn *turn)
{
    const int32_t *matrix = video_input_display_matrix(&reader->input);
    const AVFrameSideData *data = frame != NULL ? av_frame_get_side_data(frame, AV_FRAME_DATA_DISPLAYMATRIX) : NULL;
    if (matrix == NULL && data != NULL && data->size >= 9 * sizeof *matrix)
        matrix = (const int32_t *)(const void *)data->data;
    *turn = (video_turn){1, 0, 0, 1};
    if (matrix == NULL || turn_from_matrix(matrix, turn))
        return HELIO_OK;
    return fail(HELIO_ERR_UNSUPPORTED,
                "%s is to be shown turned by what is no multiple of 90 degrees; turn it with FFmpeg", reader->path);
}

/* ---- opening ---- */

/* PNG files are sRGB, as those of a single picture are taken. */
static enum AVColorTransferCharacteristic known_transfer(enum AVColorTransferCharacteristic tag, enum AVCodecID codec)
{
    bool is_srgb = codec == AV_CODEC_ID_APNG || codec == AV_CODEC_ID_PNG;
    return is_srgb && tag == AVCOL_TRC_UNSPECIFIED ? AVCOL_TRC_IEC61966_2_1 : tag;
}

static video_tags stream_tags(const AVCodecParameters *stream)
{
    return (video_tags){.format = stream->format,
                        .width = stream->width,
                        .height = stream->height,
                        .range = stream->color_range,
                        .primaries = stream->color_primaries,
                        .transfer = known_transfer(stream->color_trc, stream->codec_id),
                        .matrix = stream->color_space};
}

static video_tags frame_tags(const AVFrame *frame, enum AVCodecID codec)
{
    return (video_tags){.format = frame->format,
                        .width = frame->width,
                        .height = frame->height,
                        .range = frame->color_range,
                        .primaries = frame->color_primaries,
                        .transfer = known_transfer(frame->color_trc, codec),
                        .matrix = frame->colorspace};
}

/* The number of pictures in the index of MP4 and MOV, which is exact, or 0. */
static uint64_t index_count(const video_input *input)
{
    bool is_mov = strstr(input->format->iformat->name, "mp4") != NULL;
    int count = is_mov ? avformat_index_get_entries_count(input->stream) : 0;
    return count > 0 ? (uint64_t)count : 0;
}

static double stream_rate(const video_input *input)
{
    AVRational rate = input->stream->avg_frame_rate;
    if (rate.num <= 0 || rate.den <= 0)
        rate = av_guess_frame_rate(input->format, input->stream, NULL);
    double fps = rate.den > 0 ? av_q2d(rate) : 0;
    return fps > 0 && fps < 1e4 ? fps : 0;
}

static uint64_t stream_count(const video_input *input, double fps)
{
    uint64_t count = index_count(input);
    if (count > 0)
        return count;
    if (input->stream->nb_frames > 0)
        return (uint64_t)input->stream->nb_frames;
    bool is_known = input->format->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE;
    double seconds = input->stream->duration > 0 ? (double)input->stream->duration * av_q2d(input->stream->time_base)
                                                 : (double)input->format->duration / AV_TIME_BASE;
    return is_known && seconds > 0 && seconds * fps < 1e9 ? (uint64_t)(seconds * fps + 0.5) : 0;
}

static helio_status describe(helio_video_reader *reader)
{
    const AVCodecParameters *stream = reader->input.stream->codecpar;
    video_tags tags = stream_tags(stream);
    video_turn turn;
    HELIO_TRY(find_turn(reader, NULL, &turn));
    helio_video_info *info = &reader->info;
    info->width = (uint32_t)(turn.a != 0 ? stream->width : stream->height);
    info->height = (uint32_t)(turn.a != 0 ? stream->height : stream->width);
    info->fps = stream_rate(&reader->input);
    info->frame_count = stream_count(&reader->input, info->fps);
    info->transfer = video_colour_transfer(&tags, reader->wanted);
    info->codec = avcodec_get_name(stream->codec_id);
    return HELIO_OK;
}

static helio_status open_reader(helio_video_reader *reader, const char *device)
{
    video_log_enter(&reader->log);
    helio_status status = video_input_open(&reader->input, &reader->log, reader->path, device, reader->max_pixels,
                                           helio_context_threads(reader->context));
    if (status == HELIO_OK)
        status = describe(reader);
    if (status == HELIO_OK &&
        ((reader->packet = av_packet_alloc()) == NULL || (reader->frame = av_frame_alloc()) == NULL))
        status = fail(HELIO_ERR_MEMORY, "no memory to decode %s", reader->path);
    video_log_leave(&reader->log);
    return status;
}

helio_status helio_video_open(helio_context *context, const char *path, const helio_video_read_desc *given,
                              helio_video_reader **out)
{
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_video_open needs a place for the reader");
    *out = NULL;
    if (context == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_video_open needs a context and a path");
    helio_video_read_desc desc = given != NULL ? *given : (helio_video_read_desc){0};
    if ((unsigned)desc.transfer > HELIO_TRANSFER_LINEAR)
        return fail(HELIO_ERR_ARGUMENT, "transfer %d for %s is unknown; use HELIO_TRANSFER_AUTO to _LINEAR",
                    (int)desc.transfer, path);
    helio_video_reader *reader = context_allocate(context, 1, sizeof *reader);
    if (reader == NULL)
        return HELIO_ERR_MEMORY;
    reader->context = reader->converter.context = context;
    reader->is_device = desc.device != NULL;
    reader->wanted = desc.transfer;
    reader->max_pixels = desc.max_pixels != 0 && desc.max_pixels <= INT64_MAX ? desc.max_pixels : DEFAULT_MAX_PIXELS;
    video_log_begin(&reader->log, context);
    reader->input.descriptor = -1;
    reader->path = context_allocate(context, strlen(path) + 1, 1);
    helio_status status = HELIO_ERR_MEMORY;
    if (reader->path != NULL) {
        strcpy(reader->path, path);
        status = open_reader(reader, desc.device);
    }
    if (status == HELIO_OK)
        *out = reader;
    else
        helio_video_close(reader);
    return status;
}

void helio_video_close(helio_video_reader *reader)
{
    if (reader == NULL)
        return;
    video_log_enter(&reader->log);
    av_packet_free(&reader->packet);
    av_frame_free(&reader->frame);
    video_input_close(&reader->input);
    video_log_leave(&reader->log);
    video_log_end(&reader->log);
    video_converter_clear(&reader->converter);
    context_release(reader->context, reader->path);
    context_release(reader->context, reader);
}

bool video_reader_plays_png(void)
{
    return av_find_input_format("apng") != NULL && avcodec_find_decoder(AV_CODEC_ID_APNG) != NULL;
}

void video_reader_heed(helio_video_reader *reader, const atomic_bool *stopping)
{
    reader->input.stopping = stopping;
}

helio_video_info helio_video_get_info(const helio_video_reader *reader)
{
    return reader != NULL ? reader->info : (helio_video_info){0};
}

/* ---- reading ---- */

static int read_packet_patiently(helio_video_reader *reader)
{
    const struct timespec nap = {0, 2000000};
    video_input_be_patient(&reader->input);
    for (;;) {
        int code = av_read_frame(reader->input.format, reader->packet);
        if (code != AVERROR(EAGAIN))
            return code;
        if (video_input_is_late(&reader->input))
            return AVERROR(ETIMEDOUT);
        nanosleep(&nap, NULL);
    }
}

/* What is wrong with an end that av_read_frame() reports. Where a file has no index, an end that the reader of its
 * format complained about is one that came too early. */
static void judge_end(helio_video_reader *reader, int code)
{
    bool is_short = reader->packets < index_count(&reader->input);
    if (code == AVERROR_EOF && reader->log.error[0] == 0 && !is_short)
        return;
    const char *reason = code == AVERROR_EOF && reader->log.error[0] == 0 ? "its index announces more"
                                                                          : video_log_reason(&reader->log, code);
    snprintf(reader->complaint, sizeof reader->complaint, "%s", reason);
}

/* Some FFmpegs find nothing in these, and say nothing. */
static bool is_webp_animation(const helio_video_reader *reader)
{
    enum { FLAGS = 20, ANIMATION = 2 }; /* behind the file's head of 12 bytes and the chunk's of 8 */
    const AVPacket *packet = reader->packet;
    return reader->input.stream->codecpar->codec_id == AV_CODEC_ID_WEBP && packet->size > FLAGS &&
           memcmp(packet->data + 12, "VP8X", 4) == 0 && packet->data[FLAGS] & ANIMATION;
}

static void read_packet(helio_video_reader *reader)
{
    reader->log.error[0] = 0;
    int code = read_packet_patiently(reader);
    bool is_ours = code >= 0 && reader->packet->stream_index == reader->input.stream->index;
    /* Half a picture at the end of a file is none. In the middle of one, broadcasts have such and go on. */
    if (is_ours && reader->packet->flags & AV_PKT_FLAG_CORRUPT && reader->input.io != NULL &&
        avio_feof(reader->input.io)) {
        snprintf(reader->complaint, sizeof reader->complaint, "the next is cut off");
        code = AVERROR_EOF;
    } else if (code < 0) {
        judge_end(reader, code);
    }
    reader->is_draining = code < 0;
    reader->packets += is_ours;
    reader->is_webp_animation = reader->is_webp_animation || (is_ours && is_webp_animation(reader));
    if (code < 0)
        avcodec_send_packet(reader->input.codec, NULL);
}

/* HELIO_ERR_DATA for a packet that cannot be decoded; the next one may be good. */
static helio_status send_packet(helio_video_reader *reader)
{
    read_packet(reader);
    int code = 0;
    if (!reader->is_draining && reader->packet->stream_index == reader->input.stream->index)
        code = avcodec_send_packet(reader->input.codec, reader->packet);
    av_packet_unref(reader->packet);
    return code >= 0 ? HELIO_OK
                     : fail(HELIO_ERR_DATA, "%s is damaged after %" PRIu64 " frames: %s", reader->path, reader->frames,
                            video_log_reason(&reader->log, code));
}

/* The end, which is told once if it came too early. */
static helio_status end(helio_video_reader *reader)
{
    reader->is_ended = true;
    if (reader->complaint[0] == 0 && reader->frames > 0)
        return HELIO_OK;
    if (reader->frames == 0 && reader->is_webp_animation)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s is an animated WebP picture, which the FFmpeg here cannot decode; convert it to PNG or a video",
                    reader->path);
    if (reader->is_device)
        return fail(HELIO_ERR_IO, "the device %s gave no more than %" PRIu64 " frames: %s", reader->path,
                    reader->frames, reader->complaint[0] != 0 ? reader->complaint : "it has ended");
    return fail(HELIO_ERR_DATA, "%s ends after %" PRIu64 " frames: %s", reader->path, reader->frames,
                reader->complaint[0] != 0 ? reader->complaint : "nothing in it can be decoded");
}

static double frame_time(helio_video_reader *reader)
{
    int64_t time = reader->frame->best_effort_timestamp;
    if (time != AV_NOPTS_VALUE && !reader->has_time) {
        reader->first_time = time;
        reader->has_time = true;
    }
    if (time != AV_NOPTS_VALUE)
        return ((double)time - (double)reader->first_time) * av_q2d(reader->input.stream->time_base);
    return reader->info.fps > 0 ? (double)reader->frames / reader->info.fps : 0;
}

/* Decoders patch damage up where they can. Which frame it was is not known for sure, as they work on several at once.
 */
static void warn_of_damage(helio_video_reader *reader)
{
    char complaint[256];
    bool complained = video_log_take_complaint(&reader->log, complaint);
    if (reader->warned || (!complained && reader->frame->decode_error_flags == 0))
        return;
    reader->warned = true;
    context_log(reader->context, HELIO_LOG_WARNING,
                "%s is damaged at frame %" PRIu64 " or near it, and maybe later: %s; what FFmpeg made of it is used",
                reader->path, reader->frames, complained ? complaint : "some blocks are missing");
}

static helio_status deliver(helio_video_reader *reader, helio_video_frame *out)
{
    const AVFrame *frame = reader->frame;
    video_tags tags = frame_tags(frame, reader->input.stream->codecpar->codec_id);
    video_colour colour;
    video_turn turn;
    helio_video_frame result = {0};
    HELIO_TRY(video_input_check_size(reader->path, frame->width, frame->height, reader->max_pixels));
    HELIO_TRY(video_colour_resolve(reader->path, &tags, reader->wanted, &colour));
    HELIO_TRY(find_turn(reader, frame, &turn));
    HELIO_TRY(video_convert(&reader->converter, frame, &colour, &turn, &result.bad));
    warn_of_damage(reader);
    result.width = (uint32_t)(turn.a != 0 ? frame->width : frame->height);
    result.height = (uint32_t)(turn.a != 0 ? frame->height : frame->width);
    result.rgb = reader->converter.rgb;
    result.seconds = frame_time(reader);
    reader->frames++;
    *out = result;
    return HELIO_OK;
}

static helio_status next(helio_video_reader *reader, helio_video_frame *out)
{
    while (!reader->is_ended) {
        int code = avcodec_receive_frame(reader->input.codec, reader->frame);
        if (code == 0) {
            helio_status status = deliver(reader, out);
            av_frame_unref(reader->frame);
            return status;
        }
        if (code == AVERROR_EOF || reader->faults > MOST_FAULTS) {
            HELIO_TRY(end(reader));
        } else if (code == AVERROR(EAGAIN) && !reader->is_draining) {
            HELIO_TRY(send_packet(reader));
        } else {
            reader->faults += reader->is_draining;
            return fail(HELIO_ERR_DATA, "%s is damaged after %" PRIu64 " frames: %s", reader->path, reader->frames,
                        video_log_reason(&reader->log, code));
        }
    }
    *out = (helio_video_frame){0};
    return HELIO_OK;
}

helio_status helio_video_next(helio_video_reader *reader, helio_video_frame *frame)
{
    if (reader == NULL || frame == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_video_next needs a reader and a place for the frame");
    video_log_enter(&reader->log);
    helio_status status = next(reader, frame);
    video_log_leave(&reader->log);
    return status;
}
