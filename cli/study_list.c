/* SPDX-License-Identifier: MIT */
#include "study_list.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static bool goes_on(const char *word)
{
    size_t length = strcspn(word, ","), name = 0;
    char *end;
    while (isalpha((unsigned char)word[name]))
        name++;
    if (name > 0 && word[name] == '=')
        return true;
    (void)strtod(word, &end);
    return length > 0 && end == word + length;
}

/* Takes length bytes, and what separates them from the rest. */
static bool take(const char **rest, size_t length, char *item, size_t size)
{
    const char *start = *rest;
    *rest = start[length] != 0 ? start + length + 1 : NULL;
    if (length == 0 || length >= size)
        return false;
    memcpy(item, start, length);
    item[length] = 0;
    return true;
}

static const char *separator_of(const char *text)
{
    return strchr(text, ';') != NULL ? ";" : ",";
}

bool study_list_take(const char *text, const char **rest, char *item, size_t size)
{
    const char *start = *rest, *separator = separator_of(text);
    size_t length = strcspn(start, separator);
    while (start[length] == ',' && goes_on(start + length + 1))
        length += 1 + strcspn(start + length + 1, separator);
    return take(rest, length, item, size);
}

bool study_list_take_plain(const char *text, const char **rest, char *item, size_t size)
{
    return take(rest, strcspn(*rest, separator_of(text)), item, size);
}
