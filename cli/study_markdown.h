/* SPDX-License-Identifier: MIT
 * study_markdown.h - the means of a study, and how strategies stand against each other, as tables in Markdown. */
#ifndef HELIOSTAT_CLI_STUDY_MARKDOWN_H
#define HELIOSTAT_CLI_STUDY_MARKDOWN_H

#include "study_record.h"

/* Returns an exit code; one sentence on stderr tells of a failure. */
int study_markdown_write(const study_record *record, const char *path);

#endif
