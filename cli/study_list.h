/* SPDX-License-Identifier: MIT
 * study_list.h - lists of study, whose items are paths and specifications that may hold commas. */
#ifndef HELIOSTAT_CLI_STUDY_LIST_H
#define HELIOSTAT_CLI_STUDY_LIST_H

#include <stdbool.h>
#include <stddef.h>

/* Takes the item that begins at *rest, within the list text, and moves *rest behind it, or to NULL after the last one.
 * Where the list has a semicolon, items are separated by these. Otherwise by commas, of which those belong to an item
 * that a number or key=value follows, as in "constant:1,1,1,sky:lat=44,date=2026-06-21,a.exr". False if the item is
 * empty or too long. */
bool study_list_take(const char *text, const char **rest, char *item, size_t size);

/* The same for lists whose items hold no commas: each comma ends one. */
bool study_list_take_plain(const char *text, const char **rest, char *item, size_t size);

#endif
