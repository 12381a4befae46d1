/* SPDX-License-Identifier: MIT */
#include "bench_result.h"

#include "message.h"

#include <stdlib.h>
#include <string.h>

int bench_results_add(bench_results *results, const bench_result *items, size_t count)
{
    bench_result *grown = realloc(results->items, (results->count + count) * sizeof *grown);
    if (grown == NULL)
        return message_failure("no memory for %zu results", results->count + count);
    memcpy(grown + results->count, items, count * sizeof *items);
    results->items = grown;
    results->count += count;
    return EXIT_CODE_OK;
}

void bench_results_release(bench_results *results)
{
    free(results->items);
    *results = (bench_results){0};
}
