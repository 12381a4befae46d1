/* SPDX-License-Identifier: MIT */
#include "image/video_input.h"

#include "core/clock.h"
#include "core/error.h"
#include "image/video_device.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 16, DECODED_AT_ONCE = 1 << 27 /* pixels */ };

static const double DEVICE_PATIENCE = 10; /* seconds */

/* ---- files ---- */

static int read_file(void *opaque, uint8_t *buffer, int size)
{
    ssize_t count;
    do
        count = read(((video_input *)opaque)->descriptor, buffer, (size_t)size);
    while (count < 0 && errno == EINTR);
    return count > 0 ? (int)count : count == 0 ? AVERROR_EOF : AVERROR(errno);
}

static int64_t seek_file(void *opaque, int64_t offset, int whence)
{
    int descriptor = ((video_input *)opaque)->descriptor;
    struct stat status;
    if (whence & AVSEEK_SIZE)
        return fstat(descriptor, &status) == 0 ? (int64_t)status.st_size : AVERROR(errno);
    off_t place = lseek(descriptor, (off_t)offset, whence & ~AVSEEK_FORCE);
    return place >= 0 ? (int64_t)place : AVERROR(errno);
}

/* A playlist in a file from strangers could name anything, here or elsewhere. */
static int refuse_to_open(AVFormatContext *format, AVIOContext **io, const char *url, int flags, AVDictionary **options)
{
    (void)io;
    (void)flags;
    (void)options;
    av_log(format, AV_LOG_ERROR, "it refers to %s, and other files are not opened\n", url);
    return AVERROR(EACCES);
}

static helio_status open_descriptor(video_input *input)
{
    input->descriptor = open(input->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a named pipe must not wait for ever */
    struct stat status;
    if (input->descriptor < 0 || fstat(input->descriptor, &status) != 0)
        return fail(HELIO_ERR_IO, "%s cannot be opened: %s", input->path, strerror(errno));
    return S_ISREG(status.st_mode) ? HELIO_OK : fail(HELIO_ERR_IO, "%s is not a file", input->path);
}

static helio_status open_file(video_input *input, video_log *log)
{
    HELIO_TRY(open_descriptor(input));
    unsigned char *buffer = av_malloc(BUFFER_SIZE);
    input->io = buffer != NULL ? avio_alloc_context(buffer, BUFFER_SIZE, 0, input, read_file, NULL, seek_file) : NULL;
    input->format = input->io != NULL ? avformat_alloc_context() : NULL;
    if (input->format == NULL) {
        if (input->io == NULL)
            av_free(buffer);
        return fail(HELIO_ERR_MEMORY, "no memory to open %s", input->path);
    }
    input->format->pb = input->io;
    input->format->io_open = refuse_to_open;
    int code = avformat_open_input(&input->format, input->path, NULL, NULL);
    if (code == AVERROR_INVALIDDATA && log->error[0] == 0)
        return fail(HELIO_ERR_DATA, "%s is no video that can be read", input->path);
    return code >= 0 ? HELIO_OK
                     : fail(HELIO_ERR_DATA, "%s is damaged or no video that can be read: %s", input->path,
                            video_log_reason(log, code));
}

/* ---- devices ---- */

void video_input_be_patient(video_input *input)
{
    input->deadline = clock_seconds() + DEVICE_PATIENCE;
}

bool video_input_is_late(const video_input *input)
{
    return (input->stopping != NULL && atomic_load(input->stopping)) || clock_seconds() > input->deadline;
}

static int interrupt(void *input)
{
    return video_input_is_late(input);
}

static helio_status open_device(video_input *input, video_log *log, const char *name)
{
    const AVInputFormat *device;
    HELIO_TRY(video_device_find(name, &device));
    input->format = avformat_alloc_context();
    if (input->format == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to open %s", input->path);
    input->format->flags |= AVFMT_FLAG_NONBLOCK; /* a camera without a picture must not wait for ever */
    input->format->interrupt_callback = (AVIOInterruptCB){interrupt, input};
    video_input_be_patient(input);
    int code = avformat_open_input(&input->format, input->path, device, NULL);
    return code >= 0 ? HELIO_OK
                     : fail(HELIO_ERR_IO, "the %s device %s cannot be opened: %s", name, input->path,
                            video_log_reason(log, code));
}

/* ---- the stream and its decoder ---- */

static void free_options(AVDictionary **options, unsigned count)
{
    for (unsigned i = 0; options != NULL && i < count; i++)
        av_dict_free(&options[i]);
    av_free(options);
}

helio_status video_input_check_size(const char *path, int width, int height, uint64_t max_pixels)
{
    if (width > 0 && height > 0 && (uint64_t)width * (uint64_t)height > max_pixels)
        return fail(HELIO_ERR_DATA,
                    "%s is too large: %d x %d pixels, where %" PRIu64
                    " in all are allowed; if you trust it, raise max_pixels (--max-pixels)",
                    path, width, height, max_pixels);
    return HELIO_OK;
}

/* Before probing, which forgets the size of what it cannot open. */
static helio_status check_headers(const video_input *input, uint64_t max_pixels)
{
    for (unsigned i = 0; i < input->format->nb_streams; i++) {
        const AVCodecParameters *stream = input->format->streams[i]->codecpar;
        if (stream->codec_type == AVMEDIA_TYPE_VIDEO)
            HELIO_TRY(video_input_check_size(input->path, stream->width, stream->height, max_pixels));
    }
    return HELIO_OK;
}

/* Probing decodes some frames, which shall be no larger than others. */
static int find_streams(AVFormatContext *format, uint64_t max_pixels)
{
    unsigned count = format->nb_streams;
    AVDictionary **options = av_calloc(count + 1, sizeof(void *));
    for (unsigned i = 0; options != NULL && i < count; i++)
        av_dict_set_int(&options[i], "max_pixels", (int64_t)max_pixels, 0);
    int code = options != NULL ? avformat_find_stream_info(format, options) : AVERROR(ENOMEM);
    free_options(options, count);
    return code;
}

static helio_status choose_stream(video_input *input, video_log *log, uint64_t max_pixels, const AVCodec **decoder)
{
    HELIO_TRY(check_headers(input, max_pixels));
    int code = find_streams(input->format, max_pixels);
    if (code < 0 && input->format->nb_streams == 0)
        return fail(HELIO_ERR_DATA, "%s is damaged: %s", input->path, video_log_reason(log, code));
    int index = av_find_best_stream(input->format, AVMEDIA_TYPE_VIDEO, -1, -1, NULL, 0);
    if (index < 0 || input->format->streams[index]->disposition & AV_DISPOSITION_ATTACHED_PIC)
        return fail(HELIO_ERR_DATA, "%s holds no video", input->path);
    for (unsigned i = 0; i < input->format->nb_streams; i++)
        if ((int)i != index)
            input->format->streams[i]->discard = AVDISCARD_ALL;
    input->stream = input->format->streams[index];
    const AVCodecParameters *parameters = input->stream->codecpar;
    *decoder = avcodec_find_decoder(parameters->codec_id);
    if (*decoder == NULL)
        return fail(HELIO_ERR_UNSUPPORTED, "%s is %s, which the FFmpeg here cannot decode", input->path,
                    avcodec_get_name(parameters->codec_id));
    return video_input_check_size(input->path, parameters->width, parameters->height, max_pixels);
}

/* Each thread keeps frames of its own. */
static int thread_count(const AVCodecParameters *parameters, uint32_t threads)
{
    uint64_t pixels = (uint64_t)(parameters->width > 0 ? parameters->width : 1) *
                      (uint64_t)(parameters->height > 0 ? parameters->height : 1);
    uint64_t most = DECODED_AT_ONCE / pixels;
    uint64_t count = threads < most ? threads : most;
    return count < 1 ? 1 : count > 16 ? 16 : (int)count;
}

static helio_status open_decoder(video_input *input, video_log *log, const AVCodec *decoder, uint64_t max_pixels,
                                 uint32_t threads)
{
    input->codec = avcodec_alloc_context3(decoder);
    if (input->codec == NULL || avcodec_parameters_to_context(input->codec, input->stream->codecpar) < 0)
        return fail(HELIO_ERR_MEMORY, "no memory to decode %s", input->path);
    input->codec->pkt_timebase = input->stream->time_base;
    input->codec->max_pixels = (int64_t)max_pixels;
    input->codec->opaque = log;
    input->codec->flags |= AV_CODEC_FLAG_UNALIGNED; /* else columns to be cut off on the left may stay */
    input->codec->thread_count = thread_count(input->stream->codecpar, threads);
    if (input->io == NULL)
        input->codec->thread_type = FF_THREAD_SLICE; /* frames in parallel would come late */
    int code = avcodec_open2(input->codec, decoder, NULL);
    return code >= 0 ? HELIO_OK
                     : fail(HELIO_ERR_DATA, "%s cannot be decoded: %s", input->path, video_log_reason(log, code));
}

helio_status video_input_open(video_input *input, video_log *log, const char *path, const char *device,
                              uint64_t max_pixels, uint32_t threads)
{
    const AVCodec *decoder = NULL;
    *input = (video_input){.path = path, .descriptor = -1};
    HELIO_TRY(device != NULL ? open_device(input, log, device) : open_file(input, log));
    HELIO_TRY(choose_stream(input, log, max_pixels, &decoder));
    return open_decoder(input, log, decoder, max_pixels, threads);
}

void video_input_close(video_input *input)
{
    avcodec_free_context(&input->codec);
    avformat_close_input(&input->format);
    if (input->io != NULL)
        av_freep(&input->io->buffer);
    avio_context_free(&input->io);
    if (input->descriptor >= 0)
        close(input->descriptor);
    input->descriptor = -1;
}

const int32_t *video_input_display_matrix(const video_input *input)
{
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 30, 100)
    const AVCodecParameters *parameters = input->stream->codecpar;
    const AVPacketSideData *data =
        av_packet_side_data_get(parameters->coded_side_data, parameters->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
    return data != NULL && data->size >= 9 * sizeof(int32_t) ? (const int32_t *)(const void *)data->data : NULL;
#else
    size_t size = 0;
    const uint8_t *data = av_stream_get_side_data(input->stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
    return data != NULL && size >= 9 * sizeof(int32_t) ? (const int32_t *)(const void *)data : NULL;
#endif
}
