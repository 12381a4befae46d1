/* SPDX-License-Identifier: MIT */
#include "numbered_path.h"

#include "output_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char DIGITS[] = "0123456789";
enum { MOST_DIGITS = 19 };

/* Folders may have any name. */
static const char *last_part(const char *path)
{
    return path + output_file_folder_length(path);
}

bool numbered_path_is_pattern(const char *path)
{
    for (const char *percent = strchr(last_part(path), '%'); percent != NULL; percent = strchr(percent + 1, '%'))
        if (percent[1 + strspn(percent + 1, DIGITS)] == 'd')
            return true;
    return false;
}

/* percent: in the pattern, where the number should be. */
static bool parse_number(const char *pattern, const char *percent, numbered_path *path)
{
    size_t length = strspn(percent + 1, DIGITS);
    bool has_width = percent[1] == '0' && length >= 2 && length <= 3;
    unsigned digits = has_width ? (unsigned)strtoul(percent + 1, NULL, 10) : 1;
    if (percent[1 + length] != 'd' || (length > 0 && !has_width) || digits < 1 || digits > MOST_DIGITS)
        return false;
    *path = (numbered_path){.pattern = pattern, .start = (size_t)(percent - pattern), .digits = digits};
    path->end = path->start + 1 + length + 1;
    return true;
}

bool numbered_path_parse(const char *pattern, numbered_path *path)
{
    const char *percent = strchr(last_part(pattern), '%');
    return percent != NULL && strchr(percent + 1, '%') == NULL && parse_number(pattern, percent, path);
}

bool numbered_path_parse_faces(const char *pattern, numbered_path *path)
{
    const char *first = strchr(last_part(pattern), '%'), *second = first != NULL ? strchr(first + 1, '%') : NULL;
    if (second == NULL || strchr(second + 1, '%') != NULL || (first[1] == 's') == (second[1] == 's'))
        return false;
    return parse_number(pattern, first[1] == 's' ? second : first, path);
}

bool numbered_path_makes(const numbered_path *path, const char *part)
{
    const char *before = last_part(path->pattern), *after = path->pattern + path->end;
    size_t length = (size_t)(path->pattern + path->start - before);
    if (strncmp(part, before, length) != 0)
        return false;
    const char *number = part + length;
    size_t digits = strspn(number, DIGITS);
    /* The end may begin with digits, too. */
    size_t after_length = strlen(after), rest = strlen(number);
    if (rest < after_length || strcmp(number + rest - after_length, after) != 0 || digits < rest - after_length)
        return false;
    digits = rest - after_length;
    return digits == path->digits || (digits > path->digits && number[0] != '0');
}

bool numbered_path_read(const numbered_path *path, const char *part, uint64_t *number)
{
    if (!numbered_path_makes(path, part))
        return false;
    const char *digits = part + (path->pattern + path->start - last_part(path->pattern));
    char text[MOST_DIGITS + 1];
    size_t length = strlen(digits) - strlen(path->pattern + path->end);
    if (length > MOST_DIGITS)
        return false;
    memcpy(text, digits, length);
    text[length] = 0;
    *number = strtoull(text, NULL, 10);
    return true;
}

bool numbered_path_format(const numbered_path *path, uint64_t number, char *name, size_t size)
{
    int length = snprintf(name, size, "%.*s%0*" PRIu64 "%s", (int)path->start, path->pattern, (int)path->digits, number,
                          path->pattern + path->end);
    return length >= 0 && (size_t)length < size;
}
