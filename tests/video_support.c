/* SPDX-License-Identifier: MIT */
#include "video_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>

/* What the leak sanitizer is to overlook: x265 does not free all that it takes. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);

const char *__lsan_default_suppressions(void)
{
    return "leak:libx265\n";
}

void join(char path[TEST_PATH_SIZE], const char *directory, const char *name)
{
    assert_true(snprintf(path, TEST_PATH_SIZE, "%s/%s", directory, name) < TEST_PATH_SIZE);
}

bool has_encoder(const char *name)
{
    return avcodec_find_encoder_by_name(name) != NULL;
}

unsigned char *load_bytes(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    *size = (size_t)ftell(stream);
    rewind(stream);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, stream), *size);
    fclose(stream);
    return bytes;
}

void save_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static void fill_frame(const video_clip *clip, int number, AVFrame *frame)
{
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(clip->format);
    uint16_t *line = calloc((size_t)clip->width, sizeof *line);
    for (int i = 0; i < AV_NUM_DATA_POINTERS && frame->buf[i] != NULL; i++)
        memset(frame->buf[i]->data, 0, frame->buf[i]->size); /* as av_write_image_line2() adds to what is there */
    for (int c = 0; c < format->nb_components; c++) {
        bool is_chroma = (c == 1 || c == 2) && !(format->flags & AV_PIX_FMT_FLAG_RGB);
        int width = is_chroma ? AV_CEIL_RSHIFT(clip->width, format->log2_chroma_w) : clip->width;
        int height = is_chroma ? AV_CEIL_RSHIFT(clip->height, format->log2_chroma_h) : clip->height;
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++)
                line[x] = (uint16_t)clip->code(clip, number, c, x, y);
            av_write_image_line2(line, frame->data, frame->linesize, format, 0, y, c, width, sizeof *line);
        }
    }
    free(line);
}

static AVCodecContext *open_encoder(const video_clip *clip, const AVCodec *encoder, bool global_header)
{
    AVCodecContext *codec = avcodec_alloc_context3(encoder);
    codec->width = clip->width;
    codec->height = clip->height;
    codec->pix_fmt = clip->format;
    codec->time_base = (AVRational){1, 25};
    codec->framerate = (AVRational){25, 1};
    codec->color_range = clip->range;
    codec->color_primaries = clip->primaries;
    codec->color_trc = clip->transfer;
    codec->colorspace = clip->matrix;
    codec->chroma_sample_location = clip->location;
    codec->strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;
    codec->thread_count = 1;
    codec->max_b_frames = 0;
    if (clip->codec == AV_CODEC_ID_FFV1)
        codec->level = 3;
    if (clip->key_distance > 0)
        codec->gop_size = clip->key_distance;
    if (global_header)
        codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (strcmp(encoder->name, "libx265") == 0)
        av_opt_set(codec->priv_data, "x265-params", "log-level=error", 0);
    assert_true(avcodec_open2(codec, encoder, NULL) >= 0);
    return codec;
}

static void set_display(AVStream *stream, const int32_t *display)
{
    size_t size = 9 * sizeof *display;
    void *copy = av_memdup(display, size);
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 30, 100)
    assert_non_null(av_packet_side_data_add(&stream->codecpar->coded_side_data, &stream->codecpar->nb_coded_side_data,
                                            AV_PKT_DATA_DISPLAYMATRIX, copy, size, 0));
#else
    assert_true(av_stream_add_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, copy, size) >= 0);
#endif
}

static void move_packets(AVCodecContext *codec, AVFormatContext *format)
{
    AVPacket *packet = av_packet_alloc();
    while (avcodec_receive_packet(codec, packet) >= 0) {
        packet->duration = 1;
        av_packet_rescale_ts(packet, codec->time_base, format->streams[0]->time_base);
        assert_true(av_interleaved_write_frame(format, packet) >= 0);
    }
    av_packet_free(&packet);
}

void write_clip(const char *path, const video_clip *clip)
{
    const AVCodec *encoder = avcodec_find_encoder(clip->codec);
    AVFormatContext *format = NULL;
    av_log_set_level(AV_LOG_ERROR);
    if (encoder == NULL || avformat_alloc_output_context2(&format, NULL, clip->muxer, path) < 0) {
        print_message("skipped: this FFmpeg cannot write %s in %s\n", avcodec_get_name(clip->codec), clip->muxer);
        skip();
    }
    AVCodecContext *codec = open_encoder(clip, encoder, (format->oformat->flags & AVFMT_GLOBALHEADER) != 0);
    AVStream *stream = avformat_new_stream(format, NULL);
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    assert_true(avcodec_parameters_from_context(stream->codecpar, codec) >= 0);
    if (clip->display != NULL)
        set_display(stream, clip->display);
    assert_true(avio_open(&format->pb, path, AVIO_FLAG_WRITE) >= 0);
    assert_true(avformat_write_header(format, NULL) >= 0);
    for (int i = 0; i < clip->frames; i++) {
        AVFrame *frame = av_frame_alloc();
        frame->format = clip->format;
        frame->width = clip->width;
        frame->height = clip->height;
        frame->pts = i;
        assert_true(av_frame_get_buffer(frame, 0) >= 0);
        fill_frame(clip, i, frame);
        assert_true(avcodec_send_frame(codec, frame) >= 0);
        av_frame_free(&frame);
        move_packets(codec, format);
    }
    assert_true(avcodec_send_frame(codec, NULL) >= 0);
    move_packets(codec, format);
    assert_true(av_write_trailer(format) >= 0);
    avcodec_free_context(&codec);
    avio_closep(&format->pb);
    avformat_free_context(format);
}
