/* SPDX-License-Identifier: MIT */
#include "core/name_list.h"

#include "core/error.h"

#include <stdio.h>
#include <string.h>

const char *name_list_get(const name_list *list, int value)
{
    return value >= 0 && value < list->count ? list->names[value] : "unknown";
}

/* "a, b or c" */
static void join_names(const name_list *list, char *text, size_t size)
{
    size_t length = 0;
    for (int i = 0; i < list->count && length < size; i++) {
        const char *separator = i == 0 ? "" : i + 1 < list->count ? ", " : " or ";
        length += (size_t)snprintf(text + length, size - length, "%s%s", separator, list->names[i]);
    }
}

helio_status name_list_find(const name_list *list, const char *text, int *value)
{
    if (text == NULL || value == NULL)
        return fail(HELIO_ERR_ARGUMENT, "a %s needs a name and a place for the result", list->what);
    for (int i = 0; i < list->count; i++)
        if (strcmp(text, list->names[i]) == 0) {
            *value = i;
            return HELIO_OK;
        }
    char names[300];
    join_names(list, names, sizeof names);
    return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\" is unknown; use %s", list->what, text, names);
}

helio_status name_list_check(const name_list *list, int value)
{
    if (value >= 0 && value < list->count)
        return HELIO_OK;
    char names[300];
    join_names(list, names, sizeof names);
    return fail(HELIO_ERR_ARGUMENT, "%s %d is unknown; use the value of %s", list->what, value, names);
}
