/* SPDX-License-Identifier: MIT
 * bench_json.h - the JSON that bench writes. */
#ifndef HELIOSTAT_CLI_BENCH_JSON_H
#define HELIOSTAT_CLI_BENCH_JSON_H

#include "bench.h"

/* To the file that --json names, or to standard output. Returns an exit code. */
int bench_json_write(const bench *b);

#endif
