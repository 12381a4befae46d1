/* SPDX-License-Identifier: MIT
 * checkpoint.h - the file that holds an unfinished reference: what it is of, how far it is, and the sums of each pixel.
 *
 * Little-endian: a head of CHECKPOINT_HEAD bytes, then width x height records of doubles. Both have a checksum, so that
 * a damaged file is told from a good one; the size of the file must be what the head says.
 *
 *   0 "HELIOREF"   8 format   12 version   16 width   20 height   24 numbers   28 zero   32 isa
 *   48 digests of map, scene, view and settings   80 pieces
 *   88 checksum of the records: digest_word() of their numbers, one after the other
 *   96 checksum of the head: digest_bytes() of the bytes before */
#ifndef HELIOSTAT_SRC_CHECKPOINT_H
#define HELIOSTAT_SRC_CHECKPOINT_H

#include <heliostat/core.h>

enum {
    CHECKPOINT_FORMAT = 1,    /* to be raised with every change of the head or of the records */
    CHECKPOINT_HEAD = 104,    /* bytes */
    CHECKPOINT_EDGE = 16384,  /* pixels each way */
    CHECKPOINT_NUMBERS = 24,  /* in a record, at most */
    CHECKPOINT_ISA_SIZE = 16, /* bytes of the name, with a zero at its end */
};

/* What a reference is of, as digests. */
typedef struct checkpoint_subject {
    uint64_t map, scene, view, settings;
} checkpoint_subject;

typedef struct checkpoint_head {
    uint32_t version;       /* HELIO_VERSION of the library that wrote it */
    uint32_t width, height; /* pixels, 1..CHECKPOINT_EDGE each */
    uint32_t numbers;       /* in a record, 1..CHECKPOINT_NUMBERS */
    char isa[CHECKPOINT_ISA_SIZE];
    checkpoint_subject subject;
    uint64_t pieces; /* of the reference that are done */
} checkpoint_head;

/* Fills the record of a pixel: [head.numbers] */
typedef void (*checkpoint_get)(const void *user, size_t pixel, double *record);

/* Writes it under a temporary name and renames. */
helio_status checkpoint_write(const char *path, const checkpoint_head *head, checkpoint_get get, const void *user);

/* How a checkpoint is read. */
typedef struct checkpoint_reader {
    /* Looks at the head of a file whose sizes fit together, before any record is read. A failure ends the reading. */
    helio_status (*check)(void *user, const checkpoint_head *head);
    /* Takes the record of a pixel, one after the other. Records come before their checksum is known, but are finite. */
    void (*put)(void *user, size_t pixel, const double *record);
    void *user;
} checkpoint_reader;

/* Takes no memory. HELIO_ERR_IO if the file cannot be read, HELIO_ERR_DATA if it is damaged or no checkpoint, after
 * which records may have been put; or what check() says. */
helio_status checkpoint_read(const char *path, const checkpoint_reader *reader);

#endif
