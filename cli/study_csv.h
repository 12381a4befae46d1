/* SPDX-License-Identifier: MIT
 * study_csv.h - the points of a study as a table: the numbers of study.json, one line for each point. */
#ifndef HELIOSTAT_CLI_STUDY_CSV_H
#define HELIOSTAT_CLI_STUDY_CSV_H

#include "study_record.h"

/* Returns an exit code; one sentence on stderr tells of a failure. Numbers that there are not are left empty. */
int study_csv_write(const study_record *record, const char *path);

#endif
