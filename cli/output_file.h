/* SPDX-License-Identifier: MIT
 * output_file.h - files that will be written when the work is done, looked at before it begins. */
#ifndef HELIOSTAT_CLI_OUTPUT_FILE_H
#define HELIOSTAT_CLI_OUTPUT_FILE_H

#include <heliostat/source.h>

#include <stdio.h>

/* Can the file that --option names be written, without replacing an input? Those are all files of the source, which may
 * be NULL, and inputs: paths, of which some may be empty, ended by NULL. Returns EXIT_CODE_OK, or EXIT_CODE_FAILED
 * after one sentence on stderr. */
int output_file_check(const char *option, const char *path, helio_source *source, const char *const *inputs);

/* Is it the same name in the same folder, however the folder is written? */
bool output_file_is_same(const char *path, const char *other_path);
bool output_file_is_same_folder(const char *path, const char *other_path);

/* Does path end in ".extension", in any case? */
bool output_file_has_extension(const char *path, const char *extension);

/* Length of the part up to the last slash, the slash included. */
size_t output_file_folder_length(const char *path);

/* What follows it; all of the path where nothing does. */
const char *output_file_last_part(const char *path);

/* Makes the last folder of a path to files that --option names, unless it is there: only the last one, as a path that
 * is mistyped should not become a tree. *is_made: this made it. Returns an exit code, as above. */
int output_file_make_folder(const char *option, const char *path, bool *is_made);

/* Removes the last folder of a path, if nothing came into it. */
void output_file_remove_folder(const char *path);

/* Opens a new file beside path, to be renamed when it is complete; its name stays within temporary. NULL, with errno,
 * if that cannot be. */
FILE *output_file_open(const char *path, char *temporary, size_t size);

/* Closes it and gives it its name. Returns an exit code; after a failure, of which one sentence tells, the file is
 * gone.
 */
int output_file_finish(FILE *stream, const char *temporary, const char *path);

#endif
