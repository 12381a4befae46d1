/* SPDX-License-Identifier: MIT
 * output_plan.h - the options of render that say what is written, and where. */
#ifndef HELIOSTAT_CLI_OUTPUT_PLAN_H
#define HELIOSTAT_CLI_OUTPUT_PLAN_H

#include "render_plan.h"

/* All three belong to render_plan_make() and render_plan_settle(). Exit codes as theirs. */
int output_plan_check(render_plan *plan);

/* Decides what is written where --out was not given, looks at what is there already, and makes the folder that --out
 * names. */
int output_plan_settle(render_plan *plan, helio_source *source);

/* Tells of options that change nothing. */
void output_plan_warn(const render_plan *plan);

#endif
