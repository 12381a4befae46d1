/* SPDX-License-Identifier: MIT
 * help.h - the help and the manual page, both printed to stdout from the tables of commands and options. */
#ifndef HELIOSTAT_CLI_HELP_H
#define HELIOSTAT_CLI_HELP_H

#include "command.h"

/* heliostat --help */
void help_program(void);

/* heliostat COMMAND --help */
void help_command(const cli_command *command);

/* The manual page, as troff. */
void help_manual(void);

/* ---- texts that help and manual share ------------------------------------------------ */

/* A form that a value may have, or a command line, and what it means. */
typedef struct help_entry {
    const char *term, *text;
} help_entry;

typedef struct help_section {
    const char *title;
    const help_entry *entries;
    size_t count;
    unsigned commands; /* whose help shows it */
} help_section;

extern const char help_tagline[];
extern const help_section help_forms[]; /* of values */
extern const size_t help_form_count;
extern const help_section help_examples, help_exit_codes, help_variables;

/* The help of an option with its choices and its default. */
void help_sentence(const cli_option *option, char *text, size_t size);

#endif
