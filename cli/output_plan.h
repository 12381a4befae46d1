/* SPDX-License-Identifier: MIT
 * output_plan.h - the options of render that say what is written, and where. */
#ifndef HELIOSTAT_CLI_OUTPUT_PLAN_H
#define HELIOSTAT_CLI_OUTPUT_PLAN_H

#include "render_plan.h"

/* The first three belong to render_plan_make() and render_plan_settle(). Exit codes as theirs. */
int output_plan_check(render_plan *plan);

/* Decides what is written where --out was not given, looks at what is there already, and makes the last folder of
 * numbered pictures. */
int output_plan_settle(render_plan *plan, helio_source *source);

/* Tells of options that change nothing. */
void output_plan_warn(const render_plan *plan);

/* ---- parts of them, for commands that write something else ---- */

/* Does --frames name a single frame? */
bool output_plan_is_one_frame(const render_plan *plan);

/* Can plan->out, one file or numbered ones by plan->sink, be written without replacing an input? */
int output_plan_check_names(const render_plan *plan, helio_source *source);

/* What goes beside the frames must be none of them, and no input. path may be NULL. */
int output_plan_check_beside(const render_plan *plan, const char *option, const char *path, helio_source *source);

#endif
