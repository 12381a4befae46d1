/* SPDX-License-Identifier: MIT
 * study_plan.h - what study compares: the options, checked and taken apart. */
#ifndef HELIOSTAT_CLI_STUDY_PLAN_H
#define HELIOSTAT_CLI_STUDY_PLAN_H

#include "study_strategy.h"

#include <heliostat/heliostat.h>

enum { STUDY_LIST = 16, STUDY_NAME = 4096 };

typedef struct study_material {
    char name[STUDY_NAME]; /* as it was given */
    bool is_of_mesh;       /* "file" */
    helio_material material;
} study_material;

/* A map, or something that moves. */
typedef struct study_environment {
    char *specification; /* SRC */
    char *name;          /* what tables call it: of a file the name without folder and ending */
} study_environment;

typedef struct study_plan {
    const cli_options *options;
    char mesh[STUDY_NAME];    /* path */
    helio_source_desc source; /* how environments are read */
    helio_ground ground;
    helio_tonemap tonemap;

    study_strategy strategies[STUDY_LIST];
    uint32_t strategy_count;
    uint32_t spp[STUDY_LIST]; /* rising */
    uint32_t spp_count;
    bool is_shown[STUDY_LIST]; /* which spp have pictures and flicker */
    study_material *materials;
    uint32_t material_count;
    study_environment *environments;
    uint32_t environment_count;
    uint32_t sequence; /* frames whose flicker is measured; 1: none is */
} study_plan;

/* One point of the study. */
typedef struct study_point {
    uint32_t environment, material, strategy, spp; /* each counts from 0 in the plan's list */
} study_point;

/* Finds files, but reads none. The options must outlive the plan. Returns EXIT_CODE_OK, or another exit code after one
 * sentence on stderr. Release it in any case. */
int study_plan_make(study_plan *plan, const cli_options *options);
void study_plan_release(study_plan *plan);

/* All points, and the one with this number: materials within environments, then strategies, then spp. */
size_t study_plan_count(const study_plan *plan);
study_point study_plan_point(const study_plan *plan, size_t index);
size_t study_plan_index(const study_plan *plan, const study_point *point);

/* The place of a strategy of this name, options of its own included. False: there is none. */
bool study_plan_find(const study_plan *plan, const char *name, uint32_t *strategy);

/* Is this pair of environment and material shown in pictures? */
bool study_plan_shows(const study_plan *plan, uint32_t environment, uint32_t material);

/* Are references made by quadrature? */
bool study_plan_has_quadrature(const study_plan *plan);

/* What references are made by, in words. */
enum { STUDY_PLAN_REFERENCE = 64 };
void study_plan_describe_reference(const study_plan *plan, char text[STUDY_PLAN_REFERENCE]);

/* The frame of a sequence that is studied, of so many. */
uint32_t study_plan_still(uint32_t frames);

#endif
