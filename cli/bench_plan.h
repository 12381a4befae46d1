/* SPDX-License-Identifier: MIT
 * bench_plan.h - the options of bench, checked: what to measure, and at which values. */
#ifndef HELIOSTAT_CLI_BENCH_PLAN_H
#define HELIOSTAT_CLI_BENCH_PLAN_H

#include "light_source.h"
#include "list.h"
#include "options.h"

#include <heliostat/heliostat.h>

typedef enum bench_stage {
    BENCH_MACHINE, /* memcpy and multiply-adds */
    BENCH_CUBE,
    BENCH_TABLES,
    BENCH_POOLS,
    BENCH_ESTIMATE,
    BENCH_SCENE,
    BENCH_RAYS,
    BENCH_FRAME,
    BENCH_DEVICE, /* frames on a graphics processor */
    BENCH_STAGES
} bench_stage;

enum { BENCH_LIST = 16 };

/* The first value is where everything is measured that walks through another list. */
typedef struct bench_numbers {
    uint32_t count, values[BENCH_LIST];
} bench_numbers;

typedef struct bench_sizes {
    uint32_t count, values[BENCH_LIST][2]; /* width, height */
} bench_sizes;

typedef struct bench_material {
    char name[LIST_ITEM];
    helio_material material;
} bench_material;

typedef struct bench_plan {
    const cli_options *options;
    bool stages[BENCH_STAGES];
    uint32_t repeat, least_repeats;
    double job_ms; /* what takes longer in all is repeated less often, but least_repeats */
    bench_numbers threads, env_sizes, spp, mesh_sizes;
    bench_sizes map_sizes;
    uint32_t isa_count, strategy_count, material_count;
    const char *isas[BENCH_LIST]; /* names of helio_isa_name() */
    helio_strategy strategies[BENCH_LIST];
    bench_material materials[BENCH_LIST];
    light_source light;
    helio_layout layout;
    char mesh[4096];       /* a file; empty: one that is made */
    const char *mesh_name; /* without folders */
} bench_plan;

/* Reads and writes no file. Returns EXIT_CODE_OK, or another exit code after one sentence on stderr. */
int bench_plan_make(bench_plan *plan, const cli_options *options);

/* How meshes that are made are called. */
#define BENCH_MADE_MESH "bumpy torus"

/* As --stages takes it. */
const char *bench_stage_name(bench_stage stage);

#endif
