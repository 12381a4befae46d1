/* SPDX-License-Identifier: MIT
 * study_page.h - a study as one page of HTML that needs nothing beside it: curves as SVG, pictures within. */
#ifndef HELIOSTAT_CLI_STUDY_PAGE_H
#define HELIOSTAT_CLI_STUDY_PAGE_H

#include "study_job.h"

/* Returns an exit code; one sentence on stderr tells of a failure. */
int study_page_write(const study_record *record, const char *path);

#endif
