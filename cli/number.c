/* SPDX-License-Identifier: MIT */
#include "number.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* strtod and strtoull alone would also take blanks, words such as "nan" and hexadecimal. */
static bool only_holds(const char *text, const char *characters)
{
    return text[0] != 0 && text[strspn(text, characters)] == 0;
}

bool number_parse_whole(const char *text, double minimum, double maximum, uint32_t *number)
{
    if (!only_holds(text, "0123456789"))
        return false;
    errno = 0;
    unsigned long long parsed = strtoull(text, NULL, 10);
    if (errno != 0 || (double)parsed < minimum || (double)parsed > maximum || parsed > UINT32_MAX)
        return false;
    *number = (uint32_t)parsed;
    return true;
}

bool number_parse(const char *text, double minimum, double maximum, double *number)
{
    if (!only_holds(text, "+-.0123456789eE"))
        return false;
    char *end = NULL;
    double parsed = strtod(text, &end);
    if (end == text || *end != 0 || !(parsed >= minimum && parsed <= maximum))
        return false;
    *number = parsed;
    return true;
}
