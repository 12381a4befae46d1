/* SPDX-License-Identifier: MIT */
#include "image/number.h"

#include <locale.h>
#include <stdlib.h>

bool number_read(const char **text, double *value)
{
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0)
        return false;
    locale_t before = uselocale(plain);
    char *end;
    *value = strtod(*text, &end);
    uselocale(before);
    freelocale(plain);
    bool found = end != *text;
    *text = end;
    return found;
}

bool number_read_size(const char **text, uint32_t *value)
{
    const char *at = *text;
    while (*at == ' ' || *at == '\t')
        at++;
    if (*at < '0' || *at > '9')
        return false;
    uint64_t number = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        number = number * 10 + (uint64_t)(*at - '0');
        if (number > UINT32_MAX)
            return false;
    }
    *text = at;
    *value = (uint32_t)number;
    return true;
}
