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

bool study_list_take(const char *text, const char **rest, char *item, size_t size)
{
    const char *start = *rest, *separator = strchr(text, ';') != NULL ? ";" : ",";
    size_t length = strcspn(start, separator);
    bool is_list_of_numbers = strspn(text, "0123456789,") == strlen(text);
    while (start[length] == ',' && !is_list_of_numbers && goes_on(start + length + 1))
        length += 1 + strcspn(start + length + 1, separator);
    *rest = start[length] != 0 ? start + length + 1 : NULL;
    if (length == 0 || length >= size)
        return false;
    memcpy(item, start, length);
    item[length] = 0;
    return true;
}
