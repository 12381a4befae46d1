/* SPDX-License-Identifier: MIT */
#include "env/source_names.h"

#include "core/error.h"

#include <stdlib.h>
#include <string.h>

bool source_names_is_pattern(const char *text)
{
    const char *bracket = strchr(text, '[');
    return strpbrk(text, "*?") != NULL || (bracket != NULL && strchr(bracket, ']') != NULL);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Both stand on a number of any length: moves them behind it. */
static int compare_digits(const char **a, const char **b)
{
    const char *x = *a + strspn(*a, "0"), *y = *b + strspn(*b, "0");
    size_t x_length = strspn(x, "0123456789"), y_length = strspn(y, "0123456789");
    *a = x + x_length;
    *b = y + y_length;
    if (x_length != y_length)
        return x_length < y_length ? -1 : 1;
    return memcmp(x, y, x_length);
}

int source_names_compare(const char *a, const char *b)
{
    const char *x = a, *y = b;
    while (*x != 0 && *y != 0) {
        int order = is_digit(*x) && is_digit(*y) ? compare_digits(&x, &y) : (unsigned char)*x++ - (unsigned char)*y++;
        if (order != 0)
            return order;
    }
    /* frame1 and frame01 are equal as numbers, but their order must not be left to chance. */
    return *x != *y ? (unsigned char)*x - (unsigned char)*y : strcmp(a, b);
}

static int compare_entries(const void *a, const void *b)
{
    return source_names_compare(*(char *const *)a, *(char *const *)b);
}

helio_status source_names_find(const char *pattern, glob_t *names)
{
    *names = (glob_t){0};
    int result = glob(pattern, GLOB_NOSORT, NULL, names);
    if (result == 0 && names->gl_pathc > 0) {
        qsort(names->gl_pathv, names->gl_pathc, sizeof *names->gl_pathv, compare_entries);
        return HELIO_OK;
    }
    globfree(names);
    *names = (glob_t){0};
    if (result == GLOB_NOSPACE)
        return fail(HELIO_ERR_MEMORY, "no memory for the names that fit %s", pattern);
    return fail(HELIO_ERR_IO, "no file has a name that fits %s", pattern);
}
