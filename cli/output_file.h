/* SPDX-License-Identifier: MIT
 * output_file.h - files that will be written when the work is done, looked at before it begins. */
#ifndef HELIOSTAT_CLI_OUTPUT_FILE_H
#define HELIOSTAT_CLI_OUTPUT_FILE_H

#include <stdio.h>

/* Can the file that --option names be written, without replacing an input? inputs: paths, of which some may be empty,
 * ended by NULL. Returns EXIT_CODE_OK, or EXIT_CODE_FAILED after one sentence on stderr. */
int output_file_check(const char *option, const char *path, const char *const *inputs);

/* Opens a new file beside path, to be renamed when it is complete; its name stays within temporary. NULL, with errno,
 * if that cannot be. */
FILE *output_file_open(const char *path, char *temporary, size_t size);

#endif
