/* SPDX-License-Identifier: MIT
 * bench_memcpy.h - memcpy over several threads: what merely reading and writing so many bytes takes. */
#ifndef HELIOSTAT_CLI_BENCH_MEMCPY_H
#define HELIOSTAT_CLI_BENCH_MEMCPY_H

#include "bench_team.h"

#include <stddef.h>

typedef struct bench_memcpy {
    bench_team *team; /* the caller's */
    size_t bytes;
    char *from, *to;
} bench_memcpy;

/* Takes the buffers and writes them once. Returns an exit code. */
int bench_memcpy_create(bench_team *team, size_t bytes, bench_memcpy *copy);
void bench_memcpy_destroy(bench_memcpy *copy);

/* One copy of all bytes, each thread an equal piece. data: bench_memcpy. Fits bench_job. */
int bench_memcpy_run(void *data, double *times);

#endif
