/* SPDX-License-Identifier: MIT
 * reference_report.h - the JSON that reference --stats writes. */
#ifndef HELIOSTAT_CLI_REFERENCE_REPORT_H
#define HELIOSTAT_CLI_REFERENCE_REPORT_H

#include "reference_run.h"

#include <jansson.h>

/* What came of one frame, to be added to the list of all. */
json_t *reference_report_frame(const reference_run *run, uint64_t index);

/* Writes the list and what is the same for all of it. Takes the list. Returns an exit code. */
int reference_report_write(const reference_plan *plan, const render_job *job, json_t *frames);

#endif
