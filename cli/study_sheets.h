/* SPDX-License-Identifier: MIT
 * study_sheets.h - the pictures of a study side by side, with their errors below: as in Figure 2 of the paper's
 * supplement. */
#ifndef HELIOSTAT_CLI_STUDY_SHEETS_H
#define HELIOSTAT_CLI_STUDY_SHEETS_H

#include "study_record.h"

/* Writes PNG and PDF files into sheets/ of the study's folder, one for each pair that is shown. Does nothing in builds
 * without cairo or PNG. Returns an exit code; one sentence on stderr tells of a failure. */
int study_sheets_write(const study_record *record);

#endif
