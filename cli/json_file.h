/* SPDX-License-Identifier: MIT
 * json_file.h - JSON in files: complete, or not there at all. */
#ifndef HELIOSTAT_CLI_JSON_FILE_H
#define HELIOSTAT_CLI_JSON_FILE_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* JSON has no word for what is not finite: null. */
json_t *json_number(double value);
json_t *json_whole(uint64_t value);

/* Null where there is none, or where it is no UTF-8, as names of files may be. */
json_t *json_text(const char *text);

/* Writes under a temporary name and renames. option: the one that named the path, for the sentence that tells of a
 * failure. object may be NULL: there was no memory for it. Returns an exit code. */
int json_file_write(const char *option, const char *path, const json_t *object);

/* Does path, which may be NULL, stand for standard output? It does where it is "-". */
bool json_file_is_printed(const char *path);

/* The same, but to standard output where the path stands for it. */
int json_file_write_or_print(const char *option, const char *path, const json_t *object);

#endif
