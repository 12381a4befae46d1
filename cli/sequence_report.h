/* SPDX-License-Identifier: MIT
 * sequence_report.h - what is told of a sequence when it has ended. */
#ifndef HELIOSTAT_CLI_SEQUENCE_REPORT_H
#define HELIOSTAT_CLI_SEQUENCE_REPORT_H

#include "render_sequence.h"

/* Writes contact sheet and statistics, and prints one sentence about what was rendered, or why it ended early. Returns
 * the exit code of all. */
int sequence_report_write(const render_sequence *sequence);

#endif
