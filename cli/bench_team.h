/* SPDX-License-Identifier: MIT
 * bench_team.h - threads that wait for work: for what is measured beside the library, which has threads of its own. */
#ifndef HELIOSTAT_CLI_BENCH_TEAM_H
#define HELIOSTAT_CLI_BENCH_TEAM_H

#include <stdint.h>

typedef struct bench_team bench_team;

/* One piece of work for each thread: index in [0, threads). */
typedef void (*bench_team_body)(void *data, uint32_t index, uint32_t threads);

/* The calling thread is one of them. Returns EXIT_CODE_OK, or EXIT_CODE_FAILED after one sentence on stderr. */
int bench_team_create(uint32_t threads, bench_team **team);
void bench_team_destroy(bench_team *team); /* NULL is fine */

uint32_t bench_team_threads(const bench_team *team);

/* Returns when all are done. */
void bench_team_run(bench_team *team, bench_team_body body, void *data);

#endif
