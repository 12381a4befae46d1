/* SPDX-License-Identifier: MIT */
#include "env/source_pattern.h"

#include "core/context.h"
#include "core/error.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_WIDTH = 20 };

/* ---- patterns and names ---- */

/* Reads what follows a percent sign; returns what follows the conversion, or NULL. */
static const char *parse_conversion(const char *at, source_pattern *pattern, source_pattern_kind *kind)
{
    if (*at == 's') {
        *kind = PATTERN_FACES;
        return at + 1;
    }
    pattern->zeros = *at == '0';
    pattern->width = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        pattern->width = pattern->width * 10 + (*at - '0');
        if (pattern->width > MAX_WIDTH)
            return NULL;
    }
    if (*at != 'd' && *at != 'i' && *at != 'u')
        return NULL;
    *kind = PATTERN_NUMBER;
    return at + 1;
}

source_pattern_kind source_pattern_parse(const char *text, source_pattern *pattern)
{
    source_pattern_kind kind = PATTERN_NONE;
    size_t length = 0;
    char *part = pattern->before;
    for (const char *at = text; *at != 0;) {
        if (at[0] == '%' && at[1] != '%') {
            if (kind != PATTERN_NONE)
                return PATTERN_WRONG;
            at = parse_conversion(at + 1, pattern, &kind);
            if (at == NULL)
                return PATTERN_WRONG;
            part[length] = 0;
            part = pattern->after;
            length = 0;
        } else {
            part[length++] = *at;
            at += *at == '%' ? 2 : 1;
        }
    }
    part[length] = 0;
    return kind;
}

bool source_pattern_format(const source_pattern *pattern, uint32_t number, char path[SOURCE_PATH_SIZE])
{
    int length = snprintf(path, SOURCE_PATH_SIZE, pattern->zeros ? "%s%0*u%s" : "%s%*u%s", pattern->before,
                          pattern->width, number, pattern->after);
    return length > 0 && length < SOURCE_PATH_SIZE;
}

/* ---- what is in the directory ---- */

typedef struct number_search {
    helio_context *context;
    const source_pattern *pattern;
    size_t folder_length; /* of the part of pattern->before that names the directory, with its slash */
    source_numbers found;
    size_t capacity;
} number_search;

/* The number in the pattern's place. */
static bool read_number(const char *text, size_t length, uint32_t *number)
{
    uint64_t value = 0;
    for (size_t i = 0; i < length; i++) {
        if (text[i] == ' ')
            continue;
        if (text[i] < '0' || text[i] > '9')
            return false;
        value = value * 10 + (uint64_t)(text[i] - '0');
        if (value > UINT32_MAX)
            return false;
    }
    *number = (uint32_t)value;
    return length > 0;
}

/* Does the entry of the directory fit? It is compared with what the pattern makes of the number, so that frame_7.exr is
 * not taken for frame_%04d.exr. */
static bool match_entry(const number_search *search, const char *entry, uint32_t *number)
{
    const source_pattern *pattern = search->pattern;
    size_t length = strlen(entry), before = strlen(pattern->before + search->folder_length);
    size_t after = strcspn(pattern->after, "/");
    char path[SOURCE_PATH_SIZE];
    if (length < before + after || !read_number(entry + before, length - before - after, number) ||
        !source_pattern_format(pattern, *number, path))
        return false;
    const char *name = path + search->folder_length;
    if (strncmp(name, entry, length) != 0)
        return false;
    /* Folders may follow, as in shot_%d/map.exr: then only the file system knows. */
    return name[length] == 0 || (name[length] == '/' && access(path, F_OK) == 0);
}

static helio_status add_number(number_search *search, uint32_t number)
{
    source_numbers *found = &search->found;
    if (found->count == search->capacity) {
        size_t capacity = search->capacity ? 2 * search->capacity : 256;
        uint32_t *numbers = context_allocate(search->context, capacity, sizeof *numbers);
        if (numbers == NULL)
            return HELIO_ERR_MEMORY;
        if (found->count > 0)
            memcpy(numbers, found->numbers, found->count * sizeof *numbers);
        context_release(search->context, found->numbers);
        found->numbers = numbers;
        search->capacity = capacity;
    }
    found->numbers[found->count++] = number;
    return HELIO_OK;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static helio_status search_directory(number_search *search, DIR *directory)
{
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        uint32_t number;
        if (match_entry(search, entry->d_name, &number))
            HELIO_TRY(add_number(search, number));
    }
    if (search->found.count == 0)
        return fail(HELIO_ERR_IO, "there is no file whose name is \"%s\", a number and \"%s\"", search->pattern->before,
                    search->pattern->after);
    qsort(search->found.numbers, search->found.count, sizeof *search->found.numbers, compare_numbers);
    return HELIO_OK;
}

helio_status source_numbers_find(helio_context *context, const source_pattern *pattern, source_numbers *numbers)
{
    number_search search = {.context = context, .pattern = pattern};
    const char *slash = strrchr(pattern->before, '/');
    search.folder_length = slash ? (size_t)(slash - pattern->before) + 1 : 0;
    char folder[SOURCE_PATH_SIZE] = ".";
    if (slash != NULL)
        snprintf(folder, sizeof folder, "%.*s", (int)search.folder_length, pattern->before);
    DIR *directory = opendir(folder);
    if (directory == NULL)
        return fail(HELIO_ERR_IO, "the folder %s cannot be opened: %s", folder, strerror(errno));
    helio_status status = search_directory(&search, directory);
    closedir(directory);
    if (status != HELIO_OK) {
        context_release(context, search.found.numbers);
        return status;
    }
    *numbers = search.found;
    return HELIO_OK;
}

size_t source_numbers_from(const source_numbers *numbers, uint64_t number)
{
    size_t low = 0, high = numbers->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (numbers->numbers[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
