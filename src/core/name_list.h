/* SPDX-License-Identifier: MIT
 * name_list.h - the names of an enum's values, as people write them on command lines and read them in messages. */
#ifndef HELIOSTAT_SRC_NAME_LIST_H
#define HELIOSTAT_SRC_NAME_LIST_H

#include <heliostat/core.h>

typedef struct name_list {
    const char *what; /* "layout", say, for messages */
    const char *const *names;
    int count; /* names of the values 0 ... count - 1 */
} name_list;

/* NAME_LIST("layout", LAYOUT_NAMES) */
#define NAME_LIST(what, array)                                                                                         \
    {                                                                                                                  \
        what, array, sizeof(array) / sizeof *(array)                                                                   \
    }

/* "unknown" for a value that is not in the list. */
const char *name_list_get(const name_list *list, int value);

/* HELIO_ERR_ARGUMENT, with all names, if the text is none of them. */
helio_status name_list_find(const name_list *list, const char *text, int *value);

/* HELIO_ERR_ARGUMENT, with all names, if the value has none: for enums that come from a caller. */
helio_status name_list_check(const name_list *list, int value);

#endif
