/* SPDX-License-Identifier: MIT
 *
 * video.h - video files and devices through FFmpeg: frames of linear light in, finished pictures out.
 */
#ifndef HELIOSTAT_VIDEO_H
#define HELIOSTAT_VIDEO_H

#include <heliostat/image.h>

/* FFmpeg has one log for the whole process. From the first reader or writer on it is ours: what concerns one of these
 * goes to the log of its context, at debug level, and all else to av_log_default_callback(). */

#ifdef __cplusplus
extern "C" {
#endif

/* What the code values of a video stand for. docs/video.md has the formulas. */
typedef enum helio_transfer {
    HELIO_TRANSFER_AUTO = 0, /* what the stream says; SDR where it says nothing */
    HELIO_TRANSFER_SDR,      /* BT.1886: V^2.4, 1 = white */
    HELIO_TRANSFER_SRGB,     /* IEC 61966-2-1, 1 = white */
    HELIO_TRANSFER_PQ,       /* BT.2100 PQ, display light, 1 = 203 cd/m^2 */
    HELIO_TRANSFER_HLG,      /* BT.2100 HLG, scene light by the inverse OETF, 1 = 75 % signal */
    HELIO_TRANSFER_LINEAR,   /* as they are */
} helio_transfer;

HELIO_API const char *helio_transfer_name(helio_transfer transfer); /* "auto" "sdr" "srgb" "pq" "hlg" "linear" */
HELIO_API helio_status helio_transfer_parse(const char *name, helio_transfer *transfer);

typedef struct helio_video_reader helio_video_reader;

typedef struct helio_video_read_desc {
    helio_transfer transfer; /* overrules the stream; default: AUTO */
    uint64_t max_pixels;     /* of one frame; larger ones are refused before memory is taken. Default: 2^26 */
    const char *device; /* name of the FFmpeg device or virtual device that path belongs to ("v4l2", "lavfi"); default:
                           path is a file */
} helio_video_read_desc;

typedef struct helio_video_info {
    uint32_t width, height; /* as displayed; 0 where only the frames tell */
    double fps;             /* 0 where the stream does not say */
    uint64_t frame_count;   /* exact in MP4 and MOV; elsewhere what the header's duration comes to; 0 if nobody knows */
    helio_transfer transfer; /* never AUTO */
    const char *codec;       /* static */
} helio_video_info;

/* Opens the best video stream of a file. HELIO_ERR_UNSUPPORTED in builds without FFmpeg. A file is a regular file, and
 * others that it refers to are not opened. A reader belongs to one thread at a time; it decodes in threads of FFmpeg's,
 * as many as the context has, and converts in the calling one, without the context's loops. desc may be NULL. */
HELIO_API helio_status helio_video_open(helio_context *context, const char *path, const helio_video_read_desc *desc,
                                        helio_video_reader **reader);
HELIO_API void helio_video_close(helio_video_reader *reader);
HELIO_API helio_video_info helio_video_get_info(const helio_video_reader *reader);

typedef struct helio_video_frame {
    uint32_t width, height; /* may change from frame to frame */
    const float *rgb;       /* [height][width][3], linear Rec. 709, may be negative out of gamut; NULL at the end */
    double seconds;         /* presentation time since the first frame */
    helio_bad_pixels bad;   /* as stored; only formats of floating-point numbers can have such */
} helio_video_frame;

/* The next frame, valid until the next call. HELIO_ERR_DATA where one cannot be decoded: the call after that tries the
 * next one. HELIO_ERR_DATA, once, after the last good frame of a file that ends too early: "FILE ends after N frames".
 * HELIO_ERR_IO where a device is gone or shows nothing for ten seconds. Then, as after the last frame of a good file,
 * rgb is NULL. */
HELIO_API helio_status helio_video_next(helio_video_reader *reader, helio_video_frame *frame);

/* ---- writing --------------------------------------------------------------------- */

/* SDR shows the sRGB values of a PNG of the same picture. FFV1 has exactly these; other codecs lose some in converting
 * to Y'CbCr, in halving the chroma and in compressing. */
typedef struct helio_video_writer helio_video_writer;

typedef struct helio_video_write_desc {
    /* Required. Where the codec wants even sizes, as all but FFV1 do, the last column or row is repeated. */
    uint32_t width, height;
    double fps;        /* default 24 */
    const char *codec; /* "h264", "hevc", "av1", "vp9", "ffv1"; default: by the extension, see docs/video.md */
    float quality;     /* 0..1; default 0.8; FFV1 has no loss */
    bool hdr;          /* PQ, BT.2020, 10 bit (HDR10) in place of the tone map: 1 = 203 cd/m^2 */
    float exposure;    /* stops */
    helio_tonemap tonemap;
} helio_video_write_desc;

/* HELIO_OK if path ends in .mp4, .mkv, .mov or .webm and this build can write it; else the reason. */
HELIO_API helio_status helio_video_check_path(const char *path, const helio_video_write_desc *desc);

/* Does path end in one of these, in any case? The same in all builds; path may be NULL. */
HELIO_API bool helio_video_has_extension(const char *path);

/* The file is made under a temporary name in the same directory, or under none. */
HELIO_API helio_status helio_video_create(helio_context *context, const char *path, const helio_video_write_desc *desc,
                                          helio_video_writer **writer);
/* rgba over black, or shown, which is to be made without alpha and has an exposure and a tone map of its own; 8 bits
 * are what SDR videos hold. HDR takes rgba alone. */
HELIO_API helio_status helio_video_add(helio_video_writer *writer, const helio_picture *picture);
/* Finishes the file and renames it. With keep false, and where this fails or helio_video_add() failed before, as on a
 * full disk, nothing new is left: an older file of that name stays as it was. Destroys the writer in any case. */
HELIO_API helio_status helio_video_finish(helio_video_writer *writer, bool keep);

#ifdef __cplusplus
}
#endif
#endif
