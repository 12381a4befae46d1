/* SPDX-License-Identifier: MIT
 * reference_plan.h - the options of reference, checked: what is computed, when to stop, where it goes. */
#ifndef HELIOSTAT_CLI_REFERENCE_PLAN_H
#define HELIOSTAT_CLI_REFERENCE_PLAN_H

#include "options.h"

#include <heliostat/reference.h>

typedef struct reference_plan {
    cli_options render; /* the options as those of render, to open the scene with */
    helio_reference_method method;
    uint32_t spp;   /* to stop at; 0: whatever it takes */
    double seconds; /* likewise */
    double error;   /* likewise; of QUADRATURE the tolerance, 0: the usual one */
    double save_ms; /* between checkpoints, at least */
    bool resume, keep_checkpoint;
} reference_plan;

/* Returns EXIT_CODE_OK, or EXIT_CODE_USAGE after one sentence on stderr. */
int reference_plan_make(reference_plan *plan, const cli_options *options);

/* What the samples are called, or the sum. */
const char *reference_plan_name(const reference_plan *plan);

#endif
