/* SPDX-License-Identifier: MIT
 * input_source.h - the SRC that a command reads, with the options that say how; and that which follows convert and
 * inspect. */
#ifndef HELIOSTAT_CLI_INPUT_SOURCE_H
#define HELIOSTAT_CLI_INPUT_SOURCE_H

#include "frame_warnings.h"
#include "options.h"

#include <heliostat/heliostat.h>

/* Is there one, and does its specification make sense? Touches no file. Returns EXIT_CODE_OK, or another exit code
 * after one sentence on stderr. */
int input_source_check(const cli_options *options, const char *command_name);

/* A context that says warnings on stderr, and with --verbose more. warnings: start from {0}; it lives longer. */
helio_status input_source_context(const cli_options *options, frame_warnings *warnings, helio_context **context);

/* What the options say of how a source is read. Returns an exit code as above. */
int input_source_describe(const cli_options *options, helio_source_desc *desc);

/* Returns an exit code as above, EXIT_CODE_FAILED where files are the reason. */
int input_source_open(const cli_options *options, helio_context *context, helio_source **source);

/* Warns of pixels that are no light, if there are any. label: what messages call the frame. light: what the environment
 * saw of the same frame. */
void input_source_warn(frame_warnings *warnings, const char *label, const helio_source_frame *frame,
                       const helio_environment_info *light);

#endif
