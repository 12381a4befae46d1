/* SPDX-License-Identifier: MIT
 *
 * source.h - where environment maps come from, one frame after the other: files, sequences, video, devices, skies.
 *
 * helio_source_next() waits for the next frame and gives it; meanwhile the one after it is read and decoded on another
 * thread. helio_source_apply() makes it the environment's frame.
 */
#ifndef HELIOSTAT_SOURCE_H
#define HELIOSTAT_SOURCE_H

#include <heliostat/environment.h>
#include <heliostat/sky.h>
#include <heliostat/video.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What happens where a file of a sequence is missing or cannot be read, or where its shape does not tell the layout;
 * and where a part of a video cannot be decoded, which HOLD skips as well. */
typedef enum helio_on_missing {
    HELIO_ON_MISSING_STOP = 0, /* helio_source_next() fails */
    HELIO_ON_MISSING_SKIP,     /* the next frame that can be read takes its turn; a warning in the log */
    HELIO_ON_MISSING_HOLD,     /* the last good frame is given again (before the first one: SKIP); a warning. Both fail
                                  at the end if not one frame could be read. */
} helio_on_missing;

HELIO_API const char *helio_on_missing_name(helio_on_missing value); /* "stop", "skip", "hold" */
HELIO_API helio_status helio_on_missing_parse(const char *name, helio_on_missing *value);

typedef enum helio_source_kind {
    HELIO_SOURCE_FILE = 0, /* one picture, or six faces */
    HELIO_SOURCE_SEQUENCE, /* pictures, or six faces each, by a printf pattern or a glob */
    HELIO_SOURCE_VIDEO,    /* a video file */
    HELIO_SOURCE_DEVICE,   /* v4l2: or lavfi:, which may never end */
    HELIO_SOURCE_CONSTANT,
    HELIO_SOURCE_SKY,     /* one moment */
    HELIO_SOURCE_SKY_DAY, /* from sunrise to sunset */
    HELIO_SOURCE_CALLBACK /* maps in memory, see helio_source_open_callback() */
} helio_source_kind;

typedef struct helio_source_desc {
    helio_layout layout;     /* of all frames; default: guessed for each, see helio_layout_guess() */
    helio_transfer transfer; /* of video; default: what the stream says */
    helio_on_missing on_missing;
    bool has_frames;      /* take frames first ... last only, else all */
    uint32_t first, last; /* sequence by pattern: numbers in the names; otherwise counted from 0, last may be beyond
                             the end */
    double fps;           /* frames a second where the source does not say, at most 1e4; default 24 */
    uint32_t frames;      /* sky:day: how many from sunrise to sunset, at most 1e6; default 240 (10 s at 24) */
    uint64_t max_pixels;  /* of one frame, see helio_image_read_desc */
    uint32_t queue;       /* frames read ahead, 1..16; default 2 */
} helio_source_desc;

typedef struct helio_source helio_source;

typedef struct helio_source_info {
    helio_source_kind kind;
    const char *label;    /* the specification, for messages; lives as long as the source */
    uint64_t frame_count; /* that will come if all files that are there can be read; 0 where nobody knows */
    double fps;           /* of video and devices as they say; else desc.fps */
    bool is_dynamic;      /* more than one frame may come */
} helio_source_info;

typedef struct helio_source_frame {
    uint64_t index;      /* number in the file's name, or counted from 0 */
    double seconds;      /* since the first frame */
    double hours;        /* of a sky: local time, 0..24; NaN where the sun's place was given in place of a time */
    const char *name;    /* the file, or the source's label, for messages; of a held frame: the file that is missing */
    const float *rgb;    /* [height][width][3], linear Rec. 709; NULL for a sky, and for pixels of another kind */
    helio_pixels pixels; /* the same, or what the callback gave; data is NULL for a sky */
    uint32_t width, height;
    helio_layout layout;       /* never AUTO */
    helio_bad_pixels bad;      /* as stored, before colour conversion; 0 where a callback gave the pixels */
    const helio_sky_desc *sky; /* NULL but for a sky */
    bool is_held;              /* the frame before, once more */
    double read_ms;            /* reading and decoding, on the other thread */
} helio_source_frame;

/* SRC as docs/sources.md and `heliostat render --help` tell: a file; six faces as a directory or a pattern with %s; a
 * printf pattern (%04d) or a glob; a video; sky:KEY=VALUE,... or sky:day[,KEY=VALUE...]; lavfi:GRAPH; v4l2:DEVICE;
 * constant:R,G,B. Files that exist win over patterns. Mistakes in the specification, and a file that does not exist,
 * are told here; HELIO_ERR_ARGUMENT for the former. desc may be NULL.
 *
 * Sequences, videos and devices have a thread of their own, which reads desc.queue frames ahead from now on. It calls
 * the context's allocate, release and log, but not its parallel_for. Memory: queue + 1 frames, and what reading one
 * takes; it is used again for each frame. */
HELIO_API helio_status helio_source_open(helio_context *context, const char *specification,
                                         const helio_source_desc *desc, helio_source **source);

/* A map in the caller's memory. */
typedef struct helio_source_map {
    helio_pixels pixels; /* linear Rec. 709; data NULL: there are no more frames */
    uint32_t width, height;
    helio_layout layout; /* default: that of the source's desc, else guessed */
} helio_source_map;

/* Gives frame number index. *map is {0} before. Its pixels are read where they lie, by helio_source_apply(); they must
 * stay until the next call of helio_source_next() or helio_source_close(). Any status but HELIO_OK ends the source. */
typedef helio_status (*helio_source_callback)(void *user, uint64_t index, helio_source_map *map);

/* Frames from whoever has them in memory: a renderer, a camera's driver, a decoder. helio_source_next() calls callback
 * in its own thread, for frames 0, 1, 2 and so on, or those that desc wants; no thread is made, and no pixel copied but
 * into the cube. Shape, format and layout may change from frame to frame. label: what messages call the source;
 * default "callback". Who needs no common interface calls helio_environment_update_pixels() instead. */
HELIO_API helio_status helio_source_open_callback(helio_context *context, const char *label,
                                                  helio_source_callback callback, void *user,
                                                  const helio_source_desc *desc, helio_source **source);

/* At any time; the thread ends after the picture that it is amid. The frame that was given last is gone. */
HELIO_API void helio_source_close(helio_source *source);

/* The same checks of the specification alone: touches no file, so that anything that could be the name of one passes.
 * *kind is what the name alone tells; helio_source_open() goes by what it finds. kind may be NULL. */
HELIO_API helio_status helio_source_check(const char *specification, helio_source_kind *kind);

HELIO_API helio_source_info helio_source_get_info(const helio_source *source);

/* May a file be written here while the source is read? HELIO_ERR_ARGUMENT for the files that it reads, by whatever
 * name, and for names of frames that are missing. Looks through the folders at the first call. */
HELIO_API helio_status helio_source_check_output(helio_source *source, const char *path);

/* The next frame, valid until the next call; waits where it is not read yet. At the end pixels.data and sky are NULL.
 * After a failure that a sequence or a video cannot get over (a truncated file, a device that went away) the source
 * stays at its end. */
HELIO_API helio_status helio_source_next(helio_source *source, helio_source_frame *frame);

/* Makes the frame that of the environment, whose map takes the frame's shape and layout first if they differ: then
 * memory is taken, and a line of level HELIO_LOG_INFO says so. Memory is also taken for the first sky. info may be
 * NULL. */
HELIO_API helio_status helio_source_apply(helio_source *source, const helio_source_frame *frame,
                                          helio_environment *environment, helio_environment_info *info);

#ifdef __cplusplus
}
#endif
#endif
