/* SPDX-License-Identifier: MIT
 * stats.h - the JSON that --stats writes. */
#ifndef HELIOSTAT_CLI_STATS_H
#define HELIOSTAT_CLI_STATS_H

#include <heliostat/image.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct stats_frame {
    uint64_t index;
    double read_ms; /* reading and decoding, which goes on while earlier frames are rendered */
    /* What the frame took of the time of all: source_ms and write_ms are waits, for reading and writing, which go on
     * beside the rendering of sequences. */
    double source_ms, cube_ms, tables_ms, pools_ms, primary_ms, shade_ms, write_ms;
    bool has_device;                /* a graphics processor has rendered; these are by its clock, as are tables, pools
                                       and shading: */
    double upload_ms, read_back_ms; /* cube and points to it, and the picture back */
    double total_ms;                /* source to written picture, without the scene, which is loaded once */
    uint64_t samples, samples_useful;
    uint64_t nan, infinite, negative; /* pixels of the source as stored */
    uint64_t out_of_gamut;            /* pixels that became negative when their colours were converted */
    double flux;                      /* of the whole map, before --intensity */
    bool has_error;                   /* --reference was given */
    double relmse, lab_mean;          /* against it; NaN: there is none */
    double error_ms;                  /* what measuring these took, which is no part of total_ms */
} stats_frame;

/* stored: as the source has them. seen: by the environment, where what colour conversion made negative has come to
 * them. */
void stats_note_bad_pixels(stats_frame *frame, const helio_bad_pixels *stored, const helio_bad_pixels *seen);

typedef struct stats_summary {
    const char *strategy, *isa;
    uint32_t spp, width, height, threads, passes;
    double ev;          /* stops that PNG and video get */
    uint64_t skipped;   /* frames that an earlier run had made */
    const char *device; /* graphics processor that has rendered; NULL: the CPU has */
    const char *error;  /* why the sequence ended early; NULL: it did not */
} stats_summary;

/* Grows by one entry for each frame. Start from {0}. */
typedef struct stats_list {
    stats_frame *frames;
    size_t count, capacity;
} stats_list;

/* False where there is no memory. */
bool stats_list_add(stats_list *list, const stats_frame *frame);
void stats_list_release(stats_list *list);

/* Writes under a temporary name and renames, or prints where path is "-". fps and samples_per_second are by the sum of
 * total_ms. Returns EXIT_CODE_OK, or EXIT_CODE_FAILED after one sentence on stderr. */
int stats_write(const char *path, const stats_list *list, const stats_summary *summary);

#endif
