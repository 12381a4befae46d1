/* SPDX-License-Identifier: MIT
 * bench.h - a run of bench: what its stages share, and how they measure.
 *
 * Functions that return int return an exit code: EXIT_CODE_OK, or another one after one sentence on stderr (none where
 * a signal stopped the work). */
#ifndef HELIOSTAT_CLI_BENCH_H
#define HELIOSTAT_CLI_BENCH_H

#include "bench_light.h"
#include "bench_mesh.h"
#include "bench_plan.h"
#include "bench_result.h"
#include "message.h"

typedef struct bench {
    const bench_plan *plan;
    bench_stage stage;         /* that is at work */
    helio_device *device;      /* for --backend vulkan; else NULL */
    helio_context *context;    /* with the first instruction set and number of threads */
    helio_environment *source; /* --env as it is: maps of other sizes are made from it */
    bench_mesh mesh;           /* --mesh; empty until a stage needs it */
    bench_light_list lights;   /* of this stage */
    bench_results results;
    double fma_peak_gflops; /* at the first instruction set and number of threads */
    double memcpy_gb_per_s; /* of the bytes of the first cube, with the first number of threads */
    bool shows_table, shows_progress;
} bench;

/* ---- points and axes: where things are measured ------------------------------------------ */

typedef enum bench_scenario {
    BENCH_KEPT,   /* no shadow rays; camera rays of the first frame hold for all */
    BENCH_TRACED, /* no shadow rays; camera rays traced each frame */
    BENCH_SHADOW, /* a shadow ray for each useful sample; camera rays kept. A quarter of the pixels */
} bench_scenario;

typedef struct bench_point {
    const char *isa;
    uint32_t threads, map[2], env_size, spp;
    uint32_t triangles; /* of a mesh that is made; 0: --mesh */
    helio_strategy strategy;
    const bench_material *material;
    bench_scenario scenario;
} bench_point;

/* The first value of each list. */
bench_point bench_first_point(const bench *b);

/* What a curve walks along. */
typedef enum bench_axis {
    BENCH_BY_ISA,
    BENCH_BY_THREADS,
    BENCH_BY_MAP,
    BENCH_BY_CUBE,
    BENCH_BY_SPP,
    BENCH_BY_STRATEGY,
    BENCH_BY_MESH,     /* --mesh, then those that are made */
    BENCH_BY_SCENARIO, /* without shadow rays */
} bench_axis;

/* Values on an axis. */
uint32_t bench_axis_count(const bench *b, bench_axis axis);

/* Moves the point to the index-th value and names it. */
void bench_axis_move(const bench *b, bench_axis axis, uint32_t index, bench_point *point, char *label, size_t size);

/* ---- measuring ------------------------------------------------------------------------ */

enum { BENCH_TIMES = 7, BENCH_JOBS = 2 };

/* Something whose time is taken. Where time_count is 0 the time of the call is taken, many calls at once if it is
 * short; else run itself writes so many times into times, in ms. */
typedef struct bench_job {
    int (*run)(void *data, double *times);
    void *data;
    uint32_t time_count;
    uint32_t loops;                   /* calls in a repetition, found by bench_measure() */
    bench_series series[BENCH_TIMES]; /* ms of a call */
} bench_job;

/* Measures these side by side: the first repetition of each, the second of each, and so on, so that what disturbs the
 * machine disturbs all of them alike. One run of each beforehand does not count. Jobs without run are left out. */
int bench_measure(bench *b, const char *title, bench_job *jobs, size_t count);

/* Spread of a time of the job, ms. */
bench_spread bench_time(const bench_job *job, uint32_t index);

/* How many times as long jobs[0] takes as jobs[1]: the median over the repetitions, each compared with its neighbour.
 */
double bench_time_ratio(const bench_job *jobs);

/* What a stage measures at a point. */
typedef struct bench_subject {
    const char *title, *unit;
    size_t size; /* of a work */

    /* Makes what the jobs need; work is zeroed. jobs: [BENCH_JOBS], what is measured and, if there is one, what it is
     * compared with. Whatever comes back, release follows. */
    int (*create)(bench *b, const bench_point *point, void *work, bench_job *jobs);

    /* Writes the value, the note and what else the result has of its own. */
    void (*fill)(const void *work, const bench_job *jobs, bench_result *result);
    void (*release)(void *work);
} bench_subject;

/* Measures the subject at all values of an axis, all of them side by side, elsewhere at the point; keeps the results
 * and shows them. */
int bench_curve(bench *b, const bench_subject *subject, const bench_point *point, bench_axis axis);

/* Curves along several axes from the first point: the first axis in any case, others if they have several values. */
int bench_curves(bench *b, const bench_subject *subject, const bench_axis *axes, size_t count);

/* ---- help for stages -------------------------------------------------------------------- */

/* EXIT_CODE_OK for HELIO_OK, else a failure with the library's sentence. */
int bench_check(helio_status status);

/* Where a signal came: the exit code for it; else EXIT_CODE_OK. */
int bench_interrupted(void);

/* The light at a point, shared by all works of the stage. */
int bench_light_at(bench *b, const bench_point *point, bench_light **light);

/* The mesh of a point, which bench_mesh_release() takes back; that of --mesh is shared by all. */
int bench_mesh_at(bench *b, const bench_point *point, bench_mesh *mesh);

/* Keeps the results and shows them. */
int bench_publish(bench *b, const char *title, const bench_result *results, size_t count);

/* A result with what all have. */
bench_result bench_result_begin(const bench *b, const char *isa, uint32_t threads, const char *unit);

/* Of a cube of 6 faces of RGB floats. */
size_t bench_cube_bytes(uint32_t env_size);

/* ---- stages --------------------------------------------------------------------------- */

int bench_run_machine(bench *b);
int bench_run_cube(bench *b);
int bench_run_tables(bench *b);
int bench_run_pools(bench *b);
int bench_run_estimate(bench *b);
int bench_run_scene(bench *b);
int bench_run_rays(bench *b);
int bench_run_frame(bench *b);
int bench_run_device(bench *b);

#endif
