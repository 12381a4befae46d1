/* SPDX-License-Identifier: MIT
 * list.h - values of options that hold several things, separated by commas. */
#ifndef HELIOSTAT_CLI_LIST_H
#define HELIOSTAT_CLI_LIST_H

#include <stdbool.h>
#include <stddef.h>

enum { LIST_ITEM = 160 }; /* most bytes of an item, the terminating zero included */

/* Takes the item that begins at *list, up to the next comma, and moves *list behind that comma, or to NULL after the
 * last one. false if it is empty or too long. */
bool list_take(const char **list, char item[LIST_ITEM]);

/* The same for specifications, which hold commas themselves: another one begins after a comma where a word is neither a
 * number nor key=value, as in "diffuse:0.8,0.2,0.1,phong:kd=0.5,n=120,ggx". */
bool list_take_specification(const char **list, char item[LIST_ITEM]);

#endif
