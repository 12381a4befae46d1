/* SPDX-License-Identifier: MIT
 * compare_plan.h - the options of compare, checked, and the files that they name. */
#ifndef HELIOSTAT_CLI_COMPARE_PLAN_H
#define HELIOSTAT_CLI_COMPARE_PLAN_H

#include "comparison_report.h"
#include "numbered_path.h"
#include "picture_list.h"

#include <heliostat/heliostat.h>

typedef struct compare_plan {
    const cli_options *options;
    helio_tonemap tonemap;
    helio_error_map map;
    numbered_path out;                        /* where has_numbers */
    bool has_numbers;                         /* --out has a place for them */
    bool is_drawn;                            /* --out is a figure, and not the errors themselves */
    picture_list pictures, references, masks; /* masks: empty without --mask */
    compared_frame *frames;                   /* [pictures.count]: number and paths; mask: what --mask says */
} compare_plan;

/* Finds the files and reads none. Returns an exit code; one sentence on stderr tells what is wrong. Release the plan in
 * any case. */
int compare_plan_make(compare_plan *plan, const cli_options *options);
void compare_plan_release(compare_plan *plan);

/* The file that the errors of a frame go to. Returns an exit code, as above. */
enum { COMPARE_PATH_SIZE = 4096 };
int compare_plan_name(const compare_plan *plan, uint64_t number, char path[COMPARE_PATH_SIZE]);

#endif
