/* SPDX-License-Identifier: MIT
 * source_reader.h - one way to get frames for each kind of source; mostly used by a thread of its own. */
#ifndef HELIOSTAT_SRC_SOURCE_READER_H
#define HELIOSTAT_SRC_SOURCE_READER_H

#include "env/source_specification.h"

#include <heliostat/source.h>

#include <stdatomic.h>

enum { SOURCE_SENTENCE_SIZE = 1024 };

/* A frame and the memory that it is in. */
typedef struct source_slot {
    helio_source_frame frame;
    helio_image *image;          /* where frame.rgb belongs to a picture */
    float *copy;                 /* where it was copied */
    size_t copy_floats;          /* that there is room for */
    helio_sky_desc sky;          /* where frame.sky points to */
    char name[SOURCE_PATH_SIZE]; /* where frame.name may point to */
    helio_status status;         /* of the reading; else there is a frame, or the end */
    char error[SOURCE_SENTENCE_SIZE];
} source_slot;

/* No frame here: neither pixels nor sky, and none that is held. */
bool source_slot_is_end(const source_slot *slot);

typedef struct source_reader source_reader;

typedef struct source_reader_kind {
    /* Fills an empty slot with the next frame, or leaves it empty at the end. A held frame has is_held set and no
     * pixels, which are those of the frame before. */
    helio_status (*read)(source_reader *reader, source_slot *slot);
    void (*destroy)(source_reader *reader);
} source_reader_kind;

/* What each reader starts with. */
struct source_reader {
    const source_reader_kind *kind;
    helio_context *context; /* of the source's own memory */
    helio_source_desc desc; /* with defaults resolved */
    const char *label;
    const atomic_bool *stopping; /* nobody wants more: give up soon */
};

/* The common arguments of all readers' create functions. */
typedef struct source_opening {
    helio_context *context;
    const helio_source_desc *desc;
    const source_specification *specification; /* for the time of the call; its text lives as long as the reader */
    const atomic_bool *stopping;
    helio_source_info *info; /* frame_count and fps are written */
} source_opening;

/* Memory for a reader that starts with a source_reader; NULL if there is none. */
void *source_reader_allocate(const source_opening *opening, size_t size, const source_reader_kind *kind);

helio_status source_file_open(const source_opening *opening, source_reader **reader);
helio_status source_constant_open(const source_opening *opening, source_reader **reader);
helio_status source_sequence_open(const source_opening *opening, source_reader **reader);
helio_status source_video_open(const source_opening *opening, source_reader **reader);
helio_status source_sky_open(const source_opening *opening, source_reader **reader);
helio_status source_callback_open(const source_opening *opening, source_reader **reader);

/* HELIO_ERR_ARGUMENT where path means six faces, but desc wants a layout that these cannot be. */
helio_status source_check_faces(const helio_source_desc *desc, const char *path);

/* Reads a picture into the slot and finds its layout. */
helio_status source_read_picture(const source_reader *reader, const char *path, source_slot *slot);

/* Cuts frames 0 ... *count - 1 down to those that desc wants. HELIO_ERR_ARGUMENT if there is none of them. */
helio_status source_limit_frames(const helio_source_desc *desc, const char *label, uint64_t *first, uint64_t *count);

#endif
