/* SPDX-License-Identifier: MIT */
#include "image/video_encoder.h"

#include "core/error.h"
#include "core/file.h"
#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <libavutil/dict.h>
#include <libavutil/mastering_display_metadata.h>

/* ---- containers ---- */

typedef struct container {
    const char *extension, *muxer;
    const char *sdr[6], *hdr[6]; /* codecs, the best first: the default is the first that is there */
} container;

static const container CONTAINERS[] = {
    {"mp4", "mp4", {"h264", "hevc", "av1", "vp9"}, {"hevc", "av1", "vp9"}},
    {"mov", "mov", {"h264", "hevc"}, {"hevc"}},
    {"mkv", "matroska", {"ffv1", "h264", "hevc", "av1", "vp9"}, {"hevc", "av1", "vp9", "ffv1"}},
    {"webm", "webm", {"av1", "vp9"}, {"av1", "vp9"}},
};

static const container *find_container(const char *path)
{
    for (size_t i = 0; path != NULL && i < sizeof CONTAINERS / sizeof *CONTAINERS; i++)
        if (file_has_extension(path, CONTAINERS[i].extension))
            return &CONTAINERS[i];
    return NULL;
}

/* ---- codecs ---- */

typedef struct library {
    const char *codec, *name;
    int least_edge;
    enum AVPixelFormat sdr, hdr;
    float crf[2];        /* at quality 0 and 1; 0: lossless, no such setting */
    const char *options; /* key=value:key=value */
} library;

/* For each codec the one that is taken first is first. Speeds at which encoding keeps up with rendering. */
static const library LIBRARIES[] = {
    {"h264", "libx264", 2, AV_PIX_FMT_YUV420P, AV_PIX_FMT_NONE, {40, 12}, "preset=medium"},
    {"hevc", "libx265", 16, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10, {42, 14}, "preset=fast"},
    {"av1", "libsvtav1", 64, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10, {63, 18}, "preset=8"},
    {"av1", "libaom-av1", 2, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10, {63, 18}, "cpu-used=6:row-mt=1"},
    {"vp9", "libvpx-vp9", 2, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10, {63, 18}, "deadline=good:cpu-used=4:row-mt=1"},
    {"ffv1", "ffv1", 1, AV_PIX_FMT_0RGB32, AV_PIX_FMT_GBRP10, {0, 0}, "level=3:g=1:slicecrc=1"},
};

static const library *library_of(const AVCodec *codec)
{
    size_t i = 0;
    while (strcmp(LIBRARIES[i].name, codec->name) != 0)
        i++;
    return &LIBRARIES[i];
}

/* The first encoder of a codec that is there and takes such pictures. */
static const AVCodec *find_library(const char *codec, const helio_video_write_desc *desc)
{
    uint32_t edge = desc->width < desc->height ? desc->width : desc->height;
    for (size_t i = 0; i < sizeof LIBRARIES / sizeof *LIBRARIES; i++) {
        const library *candidate = &LIBRARIES[i];
        bool fits = strcmp(candidate->codec, codec) == 0 && (edge == 0 || edge >= (uint32_t)candidate->least_edge) &&
                    (!desc->hdr || candidate->hdr != AV_PIX_FMT_NONE);
        const AVCodec *found = fits ? avcodec_find_encoder_by_name(candidate->name) : NULL;
        if (found != NULL)
            return found;
    }
    return NULL;
}

static void list_names(const char *const names[6], char *list, size_t size)
{
    list[0] = 0;
    for (int i = 0; names[i] != NULL; i++) {
        size_t length = strlen(list);
        snprintf(list + length, size - length, "%s%s", i > 0 ? ", " : "", names[i]);
    }
}

helio_status video_encoder_find(const char *path, const helio_video_write_desc *desc, video_encoder *encoder)
{
    const container *box = find_container(path);
    if (box == NULL)
        return fail(HELIO_ERR_ARGUMENT, "%s ends in none of .mp4, .mov, .mkv and .webm, so its kind is unknown",
                    path != NULL ? path : "a video without a path");
    const char *const *names = desc->hdr ? box->hdr : box->sdr;
    const AVCodec *found = NULL;
    bool is_listed = false;
    for (int i = 0; found == NULL && names[i] != NULL; i++)
        if (desc->codec == NULL || strcmp(desc->codec, names[i]) == 0) {
            is_listed = true;
            found = find_library(names[i], desc);
        }
    char list[64];
    list_names(names, list, sizeof list);
    if (!is_listed)
        return fail(HELIO_ERR_ARGUMENT, "%s cannot hold %s%s; use one of %s", path, desc->codec,
                    desc->hdr ? " in HDR" : "", list);
    if (found == NULL)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s cannot be written: the FFmpeg here has no encoder for %s in this size; try another of %s", path,
                    desc->codec != NULL ? desc->codec : "any of its codecs", list);
    const library *choice = library_of(found);
    *encoder =
        (video_encoder){found, desc->hdr ? choice->hdr : choice->sdr, box->muxer, (int)desc->width, (int)desc->height};
    if (encoder->format == AV_PIX_FMT_YUV420P || encoder->format == AV_PIX_FMT_YUV420P10) {
        encoder->width += encoder->width & 1;
        encoder->height += encoder->height & 1;
    }
    return HELIO_OK;
}

helio_status video_encoder_resolve(const char *path, const helio_video_write_desc *given, helio_video_write_desc *desc)
{
    *desc = given != NULL ? *given : (helio_video_write_desc){0};
    if (desc->fps == 0)
        desc->fps = 24;
    if (desc->quality == 0)
        desc->quality = 0.8f;
    if (!(desc->fps >= 0.01 && desc->fps <= 1000))
        return fail(HELIO_ERR_ARGUMENT, "%g frames per second for %s are out of range; use 0.01 to 1000", desc->fps,
                    path);
    if (!(desc->quality > 0 && desc->quality <= 1))
        return fail(HELIO_ERR_ARGUMENT, "the quality %g for %s is out of range; use 0 to 1", (double)desc->quality,
                    path);
    if (!isfinite(desc->exposure))
        return fail(HELIO_ERR_ARGUMENT, "the exposure for %s is no finite number", path);
    if ((unsigned)desc->tonemap > HELIO_TONEMAP_REINHARD)
        return fail(HELIO_ERR_ARGUMENT, "tone map %d for %s is unknown; use HELIO_TONEMAP_CLIP or _REINHARD",
                    (int)desc->tonemap, path);
    if (desc->width > IMAGE_EDGE_LIMIT || desc->height > IMAGE_EDGE_LIMIT)
        return fail(HELIO_ERR_ARGUMENT, "the video %s is %u x %u pixels; each must be 1 to %d", path, desc->width,
                    desc->height, IMAGE_EDGE_LIMIT);
    return HELIO_OK;
}

helio_status helio_video_check_path(const char *path, const helio_video_write_desc *given)
{
    helio_video_write_desc desc;
    video_encoder encoder;
    HELIO_TRY(video_encoder_resolve(path != NULL ? path : "a video", given, &desc));
    return video_encoder_find(path, &desc, &encoder);
}

/* ---- settings ---- */

AVRational video_encoder_rate(double fps)
{
    double thousands = fps * 1.001;
    if (fabs(thousands - floor(thousands + 0.5)) < 0.002 && fabs(fps - floor(fps + 0.5)) > 0.002)
        return (AVRational){(int)(thousands + 0.5) * 1000, 1001};
    return av_d2q(fps, 1000000);
}

/* Colour-managed players decode the sRGB curve that is named; those that look at no tags show the values as they are,
 * as they do for a PNG. */
static void set_colour(AVCodecContext *codec, bool hdr)
{
    bool is_rgb = codec->pix_fmt == AV_PIX_FMT_0RGB32 || codec->pix_fmt == AV_PIX_FMT_GBRP10;
    codec->color_primaries = hdr ? AVCOL_PRI_BT2020 : AVCOL_PRI_BT709;
    codec->color_trc = hdr ? AVCOL_TRC_SMPTE2084 : AVCOL_TRC_IEC61966_2_1;
    codec->colorspace = is_rgb ? AVCOL_SPC_RGB : hdr ? AVCOL_SPC_BT2020_NCL : AVCOL_SPC_BT709;
    codec->color_range = is_rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    if (!is_rgb)
        codec->chroma_sample_location = AVCHROMA_LOC_LEFT;
}

/* The display that HDR10 is mostly made on: P3, white D65, 1000 cd/m^2; in units of 0.00002 and 0.0001 cd/m^2. */
#define MASTERING_DISPLAY "G(13250,34500)B(7500,3000)R(34000,16000)WP(15635,16450)L(10000000,1)"

/* options is to be freed also after a failure. */
static int set_options(AVDictionary **options, const helio_video_write_desc *desc, const library *choice)
{
    int code = av_dict_parse_string(options, choice->options, "=", ":", 0);
    if (code >= 0 && choice->crf[0] > 0) {
        float crf = choice->crf[0] + desc->quality * (choice->crf[1] - choice->crf[0]);
        code = av_dict_set_int(options, "crf", (int64_t)(crf + 0.5f), 0);
    }
    if (code >= 0 && strcmp(choice->name, "libx265") == 0)
        code = av_dict_set(options, "x265-params",
                           desc->hdr ? "log-level=error:hdr10=1:repeat-headers=1:master-display=" MASTERING_DISPLAY
                                       ":max-cll=0,0"
                                     : "log-level=error",
                           0);
    return code;
}

helio_status video_encoder_open(const video_encoder *encoder, const char *path, const helio_video_write_desc *desc,
                                uint32_t threads, bool global_header, video_log *log, AVCodecContext **out)
{
    AVCodecContext *codec = *out = avcodec_alloc_context3(encoder->library);
    if (codec == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to encode %s", path);
    AVRational rate = video_encoder_rate(desc->fps);
    codec->width = encoder->width;
    codec->height = encoder->height;
    codec->pix_fmt = encoder->format;
    codec->framerate = rate;
    codec->time_base = av_inv_q(rate);
    codec->sample_aspect_ratio = (AVRational){1, 1};
    codec->bit_rate = 0; /* quality decides */
    codec->thread_count = threads < 16 ? (int)threads : 16;
    codec->opaque = log;
    if (global_header)
        codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_colour(codec, desc->hdr);
    AVDictionary *options = NULL;
    int code = set_options(&options, desc, library_of(encoder->library));
    if (code >= 0)
        code = avcodec_open2(codec, encoder->library, &options);
    av_dict_free(&options);
    return code >= 0 ? HELIO_OK
                     : fail(HELIO_ERR_UNSUPPORTED, "%s cannot be encoded by %s: %s", path, encoder->library->name,
                            video_log_reason(log, code));
}

static void fill_mastering(AVMasteringDisplayMetadata *display)
{
    static const int PRIMARIES[3][2] = {{34000, 16000}, {13250, 34500}, {7500, 3000}};
    for (int i = 0; i < 6; i++)
        display->display_primaries[i / 2][i % 2] = (AVRational){PRIMARIES[i / 2][i % 2], 50000};
    display->white_point[0] = (AVRational){15635, 50000};
    display->white_point[1] = (AVRational){16450, 50000};
    display->max_luminance = (AVRational){10000000, 10000};
    display->min_luminance = (AVRational){1, 10000};
    display->has_primaries = display->has_luminance = 1;
}

static bool add_mastering(AVStream *stream)
{
    AVMasteringDisplayMetadata *display = av_mastering_display_metadata_alloc();
    if (display == NULL)
        return false;
    fill_mastering(display);
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 30, 100)
    AVCodecParameters *parameters = stream->codecpar;
    bool good = av_packet_side_data_add(&parameters->coded_side_data, &parameters->nb_coded_side_data,
                                        AV_PKT_DATA_MASTERING_DISPLAY_METADATA, display, sizeof *display, 0) != NULL;
#else
    bool good = av_stream_add_side_data(stream, AV_PKT_DATA_MASTERING_DISPLAY_METADATA, (uint8_t *)display,
                                        sizeof *display) >= 0;
#endif
    if (!good)
        av_free(display);
    return good;
}

helio_status video_encoder_describe(const helio_video_write_desc *desc, const AVCodecContext *codec, AVStream *stream)
{
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    if (avcodec_parameters_from_context(stream->codecpar, codec) < 0 || (desc->hdr && !add_mastering(stream)))
        return fail(HELIO_ERR_MEMORY, "no memory for the headers of a video");
    if (codec->codec_id == AV_CODEC_ID_HEVC)
        stream->codecpar->codec_tag = MKTAG('h', 'v', 'c', '1'); /* the spelling that Apple's players want */
    return HELIO_OK;
}
