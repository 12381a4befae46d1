/* SPDX-License-Identifier: MIT */
#include "picture_list.h"

#include "message.h"
#include "numbered_path.h"
#include "output_file.h"

#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- the list ------------------------------------------------------------------------------ */

static int fail_for_memory(const picture_list *list)
{
    return message_failure("no memory for the names of %s", list->word);
}

/* folder: its first bytes of that length. */
static int add(picture_list *list, const char *folder, size_t length, const char *name, uint64_t number)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity > 0 ? 2 * list->capacity : 64;
        listed_picture *pictures = realloc(list->pictures, capacity * sizeof *pictures);
        if (pictures == NULL)
            return fail_for_memory(list);
        list->pictures = pictures;
        list->capacity = capacity;
    }
    char *path = malloc(length + strlen(name) + 1);
    if (path == NULL)
        return fail_for_memory(list);
    memcpy(path, folder, length);
    strcpy(path + length, name);
    listed_picture *added = &list->pictures[list->count++];
    added->path = path;
    added->number = number;
    return EXIT_CODE_OK;
}

void picture_list_release(picture_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->pictures[i].path);
    free(list->pictures);
    *list = (picture_list){0};
}

static int compare_numbers(const void *a, const void *b)
{
    uint64_t x = ((const listed_picture *)a)->number, y = ((const listed_picture *)b)->number;
    return (x > y) - (x < y);
}

static int compare_paths(const void *a, const void *b)
{
    return strverscmp(((const listed_picture *)a)->path, ((const listed_picture *)b)->path);
}

static void sort_by_path(picture_list *list)
{
    if (list->count > 0)
        qsort(list->pictures, list->count, sizeof *list->pictures, compare_paths);
    for (size_t i = 0; i < list->count; i++)
        list->pictures[i].number = i;
}

/* ---- where pictures are -------------------------------------------------------------------- */

static bool is_picture_name(const char *name)
{
    static const char *const extensions[] = {"exr", "pfm", "png", "hdr", "jpg", "jpeg"};
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++)
        if (name[0] != '.' && output_file_has_extension(name, extensions[i]))
            return true;
    return false;
}

/* Adds what of a folder the names have, or, without names, all pictures. before: the folder as it is written, with its
 * slash, of that length. */
static int add_folder(picture_list *list, const char *before, size_t length, const numbered_path *names)
{
    char folder[4096];
    snprintf(folder, sizeof folder, "%.*s", length > 0 ? (int)length : 1, length > 0 ? before : ".");
    DIR *stream = length < sizeof folder ? opendir(folder) : NULL;
    if (stream == NULL)
        return message_failure("the folder %s cannot be opened: %s", folder, strerror(errno));
    int code = EXIT_CODE_OK;
    for (struct dirent *entry; code == EXIT_CODE_OK && (entry = readdir(stream)) != NULL;) {
        uint64_t number = 0;
        if (names != NULL ? numbered_path_read(names, entry->d_name, &number) : is_picture_name(entry->d_name))
            code = add(list, before, length, entry->d_name, number);
    }
    closedir(stream);
    return code;
}

static int find_numbered(picture_list *list, const numbered_path *names)
{
    list->kind = LIST_NUMBERED;
    int code = add_folder(list, list->word, output_file_folder_length(list->word), names);
    if (code == EXIT_CODE_OK && list->count > 0)
        qsort(list->pictures, list->count, sizeof *list->pictures, compare_numbers);
    return code;
}

static int find_in_folder(picture_list *list)
{
    char folder[4096];
    size_t length = strlen(list->word);
    int needed = snprintf(folder, sizeof folder, "%s%s", list->word, list->word[length - 1] == '/' ? "" : "/");
    list->kind = LIST_FOLDER;
    if ((size_t)needed >= sizeof folder)
        return message_failure("%s is too long a name", list->word);
    int code = add_folder(list, folder, (size_t)needed, NULL);
    sort_by_path(list);
    return code;
}

static int find_glob(picture_list *list)
{
    glob_t found;
    int result = glob(list->word, GLOB_NOSORT, NULL, &found), code = EXIT_CODE_OK;
    list->kind = LIST_GLOB;
    for (size_t i = 0; result == 0 && code == EXIT_CODE_OK && i < found.gl_pathc; i++)
        code = add(list, "", 0, found.gl_pathv[i], 0);
    if (result == GLOB_NOSPACE)
        code = fail_for_memory(list);
    globfree(&found);
    sort_by_path(list);
    return code;
}

static int find_all(picture_list *list)
{
    struct stat status;
    numbered_path names;
    bool exists = stat(list->word, &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return find_in_folder(list);
    if (!exists && numbered_path_parse(list->word, &names))
        return find_numbered(list, &names);
    if (!exists && strpbrk(list->word, "*?[") != NULL)
        return find_glob(list);
    if (!exists)
        return message_failure("%s cannot be read: %s", list->word, strerror(errno));
    list->kind = LIST_FILE;
    return add(list, "", 0, list->word, 0);
}

/* ---- which of them ------------------------------------------------------------------------- */

static void keep_range(picture_list *list, const frame_range *frames)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        listed_picture picture = list->pictures[i];
        if (picture.number >= frames->first && picture.number <= frames->last)
            list->pictures[kept++] = picture;
        else
            free(picture.path);
    }
    list->count = kept;
}

int picture_list_find(picture_list *list, const char *word, const frame_range *frames)
{
    *list = (picture_list){.word = word};
    int code = find_all(list);
    if (code == EXIT_CODE_OK && list->count == 0)
        code = list->kind == LIST_FOLDER ? message_failure("the folder %s holds no pictures", word)
                                         : message_failure("no file has a name that fits %s", word);
    if (code != EXIT_CODE_OK || !frames->is_given || list->kind == LIST_FILE)
        return code;
    keep_range(list, frames);
    if (list->count > 0)
        return EXIT_CODE_OK;
    return message_failure("%s has no frame from %" PRIu32 " to %" PRIu32 ", which --frames asks for", word,
                           frames->first, frames->last);
}

/* ---- pairs --------------------------------------------------------------------------------- */

/* Length of the last part of a path without its ending. */
static size_t stem_length(const char *part)
{
    const char *dot = strrchr(part, '.');
    return dot != NULL ? (size_t)(dot - part) : strlen(part);
}

static bool has_same_stem(const char *path, const char *other)
{
    const char *part = path + output_file_folder_length(path), *other_part = other + output_file_folder_length(other);
    size_t length = stem_length(part);
    return length == stem_length(other_part) && memcmp(part, other_part, length) == 0;
}

static const listed_picture *find_number(const picture_list *list, uint64_t number)
{
    const listed_picture wanted = {.number = number};
    return bsearch(&wanted, list->pictures, list->count, sizeof *list->pictures, compare_numbers);
}

static int match_numbers(const picture_list *list, const picture_list *partners, size_t i, const char **path)
{
    uint64_t number = list->pictures[i].number;
    const listed_picture *partner = find_number(partners, number);
    if (partner == NULL)
        return message_failure("%s has no frame %" PRIu64 ", which %s has; take those that both have by --frames",
                               partners->word, number, list->word);
    *path = partner->path;
    return EXIT_CODE_OK;
}

static int match_places(const picture_list *list, const picture_list *partners, size_t i, const char **path)
{
    if (list->count != partners->count)
        return message_failure("%s has %zu picture%s, but %s has %zu; give two sequences of one length, or take a part "
                               "of them by --frames",
                               list->word, list->count, list->count == 1 ? "" : "s", partners->word, partners->count);
    *path = partners->pictures[i].path;
    if (list->kind == LIST_FOLDER && partners->kind == LIST_FOLDER && !has_same_stem(list->pictures[i].path, *path))
        return message_failure("%s and %s stand in the same place of their folders, but have different names; give "
                               "patterns such as '%s/*.exr' to compare them all the same",
                               list->pictures[i].path, *path, list->word);
    return EXIT_CODE_OK;
}

int picture_list_partner(const picture_list *list, const picture_list *partners, size_t i, const char **path)
{
    if (partners->kind == LIST_FILE) {
        *path = partners->pictures[0].path;
        return EXIT_CODE_OK;
    }
    bool has_numbers = list->kind == LIST_NUMBERED && partners->kind == LIST_NUMBERED;
    return has_numbers ? match_numbers(list, partners, i, path) : match_places(list, partners, i, path);
}
