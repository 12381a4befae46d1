/* SPDX-License-Identifier: MIT
 * stats.h - the JSON that --stats writes. */
#ifndef HELIOSTAT_CLI_STATS_H
#define HELIOSTAT_CLI_STATS_H

#include <stddef.h>
#include <stdint.h>

typedef struct stats_frame {
    uint32_t index;
    double source_ms, cube_ms, tables_ms, pools_ms, primary_ms, shade_ms, write_ms;
    double total_ms; /* of the frame: source to written picture, without the scene, which is loaded once */
    uint64_t samples, samples_useful;
    uint64_t nan, infinite, negative; /* pixels of the source as stored */
    uint64_t out_of_gamut;            /* pixels that became negative when their colours were converted */
    double flux;                      /* of the whole map, before --intensity */
} stats_frame;

typedef struct stats_summary {
    const char *strategy, *isa;
    uint32_t spp, width, height, threads, passes;
    double ev; /* stops that a PNG of the last frame gets */
} stats_summary;

/* Writes under a temporary name and renames. fps and samples_per_second are by the sum of total_ms. Returns
 * EXIT_CODE_OK, or EXIT_CODE_FAILED after one sentence on stderr. */
int stats_write(const char *path, const stats_frame *frames, size_t count, const stats_summary *summary);

#endif
