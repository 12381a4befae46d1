/* SPDX-License-Identifier: MIT */
#include "env/source_files.h"

#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "env/source_names.h"
#include "image/faces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int compare_files(const void *a, const void *b)
{
    const source_file *x = a, *y = b;
    if (x->device != y->device)
        return x->device < y->device ? -1 : 1;
    return (x->inode > y->inode) - (x->inode < y->inode);
}

static helio_status add_identity(helio_context *context, source_files *files, const struct stat *status)
{
    if (files->count == files->capacity) {
        size_t capacity = files->capacity ? 2 * files->capacity : 64;
        source_file *list = context_allocate(context, capacity, sizeof *list);
        if (list == NULL)
            return HELIO_ERR_MEMORY;
        if (files->count > 0)
            memcpy(list, files->list, files->count * sizeof *list);
        context_release(context, files->list);
        files->list = list;
        files->capacity = capacity;
    }
    files->list[files->count++] = (source_file){.device = status->st_dev, .inode = status->st_ino};
    return HELIO_OK;
}

/* Six of them that are not complete cannot be read, so nothing is lost. */
static helio_status add_faces(helio_context *context, source_files *files, const char *path)
{
    face_files faces;
    struct stat status;
    if (faces_find(path, &faces) != HELIO_OK)
        return HELIO_OK;
    for (int i = 0; i < FACE_COUNT; i++) {
        char name[FACE_FOLDER_SIZE + FACE_NAME_SIZE];
        snprintf(name, sizeof name, "%s%s", faces.folder, faces.names[i]);
        if (stat(name, &status) == 0)
            HELIO_TRY(add_identity(context, files, &status));
    }
    return HELIO_OK;
}

static helio_status add_path(helio_context *context, const helio_source_desc *desc, source_files *files,
                             const char *path)
{
    struct stat status;
    if (faces_are_meant(path, desc->layout == HELIO_LAYOUT_FACES))
        return add_faces(context, files, path);
    return stat(path, &status) == 0 ? add_identity(context, files, &status) : HELIO_OK;
}

static helio_status add_names(helio_context *context, const char *pattern, const helio_source_desc *desc,
                              source_files *files)
{
    glob_t names;
    HELIO_TRY(source_names_find(pattern, &names));
    helio_status status = HELIO_OK;
    for (size_t i = 0; i < names.gl_pathc && status == HELIO_OK; i++)
        status = add_path(context, desc, files, names.gl_pathv[i]);
    globfree(&names);
    return status;
}

static helio_status add_numbers(helio_context *context, const source_pattern *pattern, const helio_source_desc *desc,
                                source_files *files)
{
    source_numbers numbers;
    char path[SOURCE_PATH_SIZE];
    HELIO_TRY(source_numbers_find(context, pattern, &numbers));
    helio_status status = HELIO_OK;
    for (size_t i = 0; i < numbers.count && status == HELIO_OK; i++)
        if (source_pattern_format(pattern, numbers.numbers[i], path))
            status = add_path(context, desc, files, path);
    context_release(context, numbers.numbers);
    return status;
}

/* All files that fit, also those that no frame was asked of: nobody means to replace them. */
static helio_status add_all(helio_context *context, const source_specification *s, const helio_source_desc *desc,
                            source_files *files)
{
    switch (s->kind) {
    case HELIO_SOURCE_FILE:
    case HELIO_SOURCE_VIDEO: return add_path(context, desc, files, s->path);
    case HELIO_SOURCE_SEQUENCE:
        return s->is_shell_pattern ? add_names(context, s->path, desc, files)
                                   : add_numbers(context, &s->pattern, desc, files);
    case HELIO_SOURCE_DEVICE:
    case HELIO_SOURCE_CONSTANT:
    case HELIO_SOURCE_SKY:
    case HELIO_SOURCE_SKY_DAY:
    case HELIO_SOURCE_CALLBACK: break;
    }
    return HELIO_OK;
}

helio_status source_files_find(helio_context *context, const source_specification *specification,
                               const helio_source_desc *desc, source_files *files)
{
    helio_status status = add_all(context, specification, desc, files);
    if (status != HELIO_OK) {
        source_files_release(context, files);
        return status;
    }
    if (files->count > 1)
        qsort(files->list, files->count, sizeof *files->list, compare_files);
    files->is_complete = true;
    return HELIO_OK;
}

void source_files_release(helio_context *context, source_files *files)
{
    context_release(context, files->list);
    *files = (source_files){0};
}

/* ---- looking up ---- */

static bool is_same_folder(const char *path, const char *other_path)
{
    const char *const paths[] = {path, other_path};
    struct stat status[2];
    for (int i = 0; i < 2; i++) {
        char folder[SOURCE_PATH_SIZE + 2];
        if (snprintf(folder, sizeof folder, "%.*s.", file_folder_length(paths[i]), paths[i]) >= (int)sizeof folder ||
            stat(folder, &status[i]) != 0)
            return false;
    }
    return status[0].st_dev == status[1].st_dev && status[0].st_ino == status[1].st_ino;
}

/* A frame that is not there yet would be read all the same once it is. */
static bool is_frame_name(const source_pattern *pattern, const helio_source_desc *desc, const char *path)
{
    const char *part = path + file_folder_length(path), *before = pattern->before + file_folder_length(pattern->before);
    size_t length = strlen(before);
    char name[SOURCE_PATH_SIZE];
    if (strchr(pattern->after, '/') != NULL || strncmp(part, before, length) != 0)
        return false;
    unsigned long long number = strtoull(part + length, NULL, 10);
    bool is_wanted = number <= UINT32_MAX && (!desc->has_frames || (number >= desc->first && number <= desc->last));
    return is_wanted && source_pattern_format(pattern, (uint32_t)number, name) &&
           strcmp(name + file_folder_length(name), part) == 0 && is_same_folder(pattern->before, path);
}

bool source_files_has(const source_files *files, const source_specification *specification,
                      const helio_source_desc *desc, const char *path)
{
    struct stat status;
    bool has_pattern = specification->kind == HELIO_SOURCE_SEQUENCE && !specification->is_shell_pattern;
    if (has_pattern && is_frame_name(&specification->pattern, desc, path))
        return true;
    if (stat(path, &status) != 0)
        return false;
    const source_file file = {.device = status.st_dev, .inode = status.st_ino};
    return files->count > 0 && bsearch(&file, files->list, files->count, sizeof file, compare_files) != NULL;
}
