/* SPDX-License-Identifier: MIT
 * bench_light.h - lat-long maps of any size, and what is made from them: cubes and tables. */
#ifndef HELIOSTAT_CLI_BENCH_LIGHT_H
#define HELIOSTAT_CLI_BENCH_LIGHT_H

#include <heliostat/heliostat.h>

typedef struct bench_map {
    uint32_t width, height;
    float *rgb; /* [height][width][3] */
} bench_map;

/* Looks up the source in the direction of each pixel, turned by so many degrees. Returns an exit code. */
int bench_map_create(const helio_environment *source, const uint32_t size[2], float turn, bench_map *map);
void bench_map_destroy(bench_map *map);

/* A context of its own, with an environment and tables that are up to date. */
typedef struct bench_light {
    const char *isa;
    uint32_t threads, env_size;
    bench_map map;
    helio_context *context;
    helio_environment *environment;
    helio_tables *tables;
    struct bench_light *next;
} bench_light;

typedef struct bench_light_list {
    bench_light *first;
} bench_light_list;

/* The light of the list that is like this, made if there is none yet. Returns an exit code. */
int bench_light_find(bench_light_list *list, const helio_environment *source, const char *isa, uint32_t threads,
                     const uint32_t map_size[2], uint32_t env_size, bench_light **light);
void bench_light_list_release(bench_light_list *list);

#endif
