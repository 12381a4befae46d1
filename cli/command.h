/* SPDX-License-Identifier: MIT
 * command.h - the commands of the program. */
#ifndef HELIOSTAT_CLI_COMMAND_H
#define HELIOSTAT_CLI_COMMAND_H

#include "options.h"

typedef struct cli_command {
    const char *name;
    unsigned bit;
    const char *usage;   /* what follows "heliostat" */
    const char *summary; /* one sentence without full stop */
    int (*run)(const cli_options *options);
} cli_command;

extern const cli_command command_table[];
extern const size_t command_count;

/* The command of that name. NULL, after one sentence on stderr, if there is none. */
const cli_command *command_find(const char *name);

/* Each does its work and returns the exit code. */
int command_render(const cli_options *options);
int command_bench(const cli_options *options);
int command_convert(const cli_options *options);
int command_inspect(const cli_options *options);
int command_samples(const cli_options *options);
int command_compare(const cli_options *options);
int command_study(const cli_options *options);
int command_reference(const cli_options *options);
int command_info(const cli_options *options);
int command_help(const cli_options *options);

#endif
