/* SPDX-License-Identifier: MIT
 * convert_plan.h - the options of convert, checked and understood. */
#ifndef HELIOSTAT_CLI_CONVERT_PLAN_H
#define HELIOSTAT_CLI_CONVERT_PLAN_H

#include "map_shape.h"
#include "numbered_path.h"
#include "options.h"

#include <heliostat/heliostat.h>

enum { CONVERT_PATH_SIZE = 4096 };

typedef struct convert_plan {
    const cli_options *options;
    helio_layout to; /* AUTO: that of the input */
    helio_map_write_desc write;
    numbered_path names;
    bool is_numbered; /* one map for each frame */
    bool is_png;
    bool has_made_folder; /* of numbered maps; to be removed if nothing comes into it */
} convert_plan;

/* Checks what the command line tells; touches no file but to see whether --out is a folder. Returns EXIT_CODE_OK, or
 * EXIT_CODE_USAGE after one sentence on stderr. */
int convert_plan_make(convert_plan *plan, const cli_options *options);

/* The same once the source is known, of which many frames may come. Makes the last folder of numbered maps; returns
 * EXIT_CODE_FAILED as well. */
int convert_plan_settle(convert_plan *plan, const helio_source_info *source);

/* Removes the folder that was made, if nothing came into it. */
void convert_plan_release(const convert_plan *plan);

/* The map that is made from one of shape from. Returns an exit code as above. */
int convert_plan_shape(const convert_plan *plan, const map_shape *from, map_shape *to);

/* Where the map of this frame goes: looks whether it can be written there, without replacing a file of the
 * source. Returns an exit code as above, or EXIT_CODE_FAILED. */
int convert_plan_path(const convert_plan *plan, helio_source *source, const helio_source_frame *frame,
                      char path[CONVERT_PATH_SIZE]);

#endif
