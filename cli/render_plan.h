/* SPDX-License-Identifier: MIT
 * render_plan.h - the options of render, checked and turned into what the library takes. */
#ifndef HELIOSTAT_CLI_RENDER_PLAN_H
#define HELIOSTAT_CLI_RENDER_PLAN_H

#include "environment_source.h"
#include "options.h"

#include <heliostat/heliostat.h>

typedef struct render_plan {
    const cli_options *options;
    environment_source source;
    char mesh[4096];
    helio_layout layout;
    bool has_material; /* else what the mesh brings */
    helio_material material;
    helio_ground ground;
    helio_strategy strategy;
    helio_weighting weighting;
    helio_background background;
    helio_tonemap tonemap;
    bool alpha; /* the background lets alpha below 1 happen */
} render_plan;

/* Reads and writes no file. Returns EXIT_CODE_OK, or another exit code after one sentence on stderr. */
int render_plan_make(render_plan *plan, const cli_options *options);

/* Width / height. */
float render_plan_aspect(const render_plan *plan);

#endif
