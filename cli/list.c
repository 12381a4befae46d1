/* SPDX-License-Identifier: MIT */
#include "list.h"

#include <ctype.h>
#include <string.h>

/* Takes length bytes. */
static bool take(const char **list, size_t length, char item[LIST_ITEM])
{
    const char *start = *list;
    *list = start[length] == ',' ? start + length + 1 : NULL;
    if (length == 0 || length >= LIST_ITEM)
        return false;
    memcpy(item, start, length);
    item[length] = 0;
    return true;
}

bool list_take(const char **list, char item[LIST_ITEM])
{
    return take(list, strcspn(*list, ","), item);
}

static bool begins_specification(const char *word)
{
    size_t name = strcspn(word, ":=,");
    return isalpha((unsigned char)word[0]) && word[name] != '=';
}

bool list_take_specification(const char **list, char item[LIST_ITEM])
{
    size_t length = strcspn(*list, ",");
    while ((*list)[length] == ',' && !begins_specification(*list + length + 1))
        length += 1 + strcspn(*list + length + 1, ",");
    return take(list, length, item);
}
