/* SPDX-License-Identifier: MIT */
#include "bench_memcpy.h"

#include "message.h"

#include <stdlib.h>
#include <string.h>

int bench_memcpy_create(bench_team *team, size_t bytes, bench_memcpy *copy)
{
    *copy = (bench_memcpy){.team = team, .bytes = bytes, .from = malloc(bytes), .to = malloc(bytes)};
    if (copy->from == NULL || copy->to == NULL) {
        bench_memcpy_destroy(copy);
        return message_failure("no memory for two times %zu bytes to copy", bytes);
    }
    memset(copy->from, 1, bytes); /* so that the system gives each page its memory now */
    memset(copy->to, 0, bytes);
    return EXIT_CODE_OK;
}

void bench_memcpy_destroy(bench_memcpy *copy)
{
    free(copy->from);
    free(copy->to);
    *copy = (bench_memcpy){0};
}

static void copy_piece(void *data, uint32_t index, uint32_t threads)
{
    const bench_memcpy *copy = data;
    size_t first = copy->bytes / threads * index;
    size_t end = index + 1 == threads ? copy->bytes : copy->bytes / threads * (index + 1);
    memcpy(copy->to + first, copy->from + first, end - first);
}

int bench_memcpy_run(void *data, double *times)
{
    bench_memcpy *copy = data;
    (void)times;
    bench_team_run(copy->team, copy_piece, copy);
    return EXIT_CODE_OK;
}
