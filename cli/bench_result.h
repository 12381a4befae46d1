/* SPDX-License-Identifier: MIT
 * bench_result.h - one line of the table, one object of the JSON: a figure and the parameters that belong to it. */
#ifndef HELIOSTAT_CLI_BENCH_RESULT_H
#define HELIOSTAT_CLI_BENCH_RESULT_H

#include "bench_series.h"

#include <stddef.h>

enum { BENCH_PARTS = 6 };

/* What a result does not have is 0 or NULL, and stays out of the JSON. Texts are the caller's and must outlive it. */
typedef struct bench_result {
    const char *stage;
    char label[48], note[48]; /* in the table: before and after the figure */

    const char *isa, *strategy, *material, *mesh;
    const char *visibility;  /* none, ray */
    const char *camera_rays; /* kept, traced */
    uint32_t threads, map[2], env_size, spp, size[2], triangles;
    double coverage; /* part of the pixels that show the mesh */

    const char *unit;
    bench_spread value;
    double ratio_to_memcpy; /* time / time of memcpy of as many bytes, on as many threads */
    double flops_per_sample, share_of_fma_peak;
    double samples_per_second;
    const char *part_names[BENCH_PARTS]; /* medians of the parts of a frame, ms */
    bench_spread parts[BENCH_PARTS];
} bench_result;

typedef struct bench_results {
    bench_result *items;
    size_t count;
} bench_results;

int bench_results_add(bench_results *results, const bench_result *items, size_t count); /* an exit code */
void bench_results_release(bench_results *results);

/* Prints a table: a line for each, with bars as long as the figures. */
void bench_table_print(const char *title, const bench_result *results, size_t count);

#endif
