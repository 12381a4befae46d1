/* SPDX-License-Identifier: MIT */
#include "output_file.h"

#include "message.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Is this input the file that would be replaced, by whatever name? */
static bool is_same_file(const char *input, const struct stat *output)
{
    struct stat status;
    return input[0] != 0 && stat(input, &status) == 0 && status.st_dev == output->st_dev &&
           status.st_ino == output->st_ino;
}

bool output_file_has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL && strcasecmp(dot + 1, extension) == 0;
}

size_t output_file_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? (size_t)(slash - path) + 1 : 0;
}

const char *output_file_last_part(const char *path)
{
    const char *part = path + output_file_folder_length(path);
    return part[0] != 0 ? part : path;
}

bool output_file_is_same_folder(const char *path, const char *other_path)
{
    const char *const paths[] = {path, other_path};
    struct stat status[2];
    for (int i = 0; i < 2; i++) {
        char folder[4096 + 2];
        if (snprintf(folder, sizeof folder, "%.*s.", (int)output_file_folder_length(paths[i]), paths[i]) >=
                (int)sizeof folder ||
            stat(folder, &status[i]) != 0)
            return false;
    }
    return status[0].st_dev == status[1].st_dev && status[0].st_ino == status[1].st_ino;
}

bool output_file_is_same(const char *path, const char *other_path)
{
    return strcmp(path, other_path) == 0 ||
           (strcmp(path + output_file_folder_length(path), other_path + output_file_folder_length(other_path)) == 0 &&
            output_file_is_same_folder(path, other_path));
}

/* By what the source reads, and by the paths. */
static int check_inputs(const char *option, const char *path, helio_source *source, const char *const *inputs)
{
    struct stat existing;
    if (source != NULL && helio_source_check_output(source, path) != HELIO_OK)
        return message_failure("%s; give --%s another path", helio_last_error(), option);
    for (bool exists = stat(path, &existing) == 0; exists && *inputs != NULL; inputs++)
        if (is_same_file(*inputs, &existing))
            return message_failure("%s would replace an input; give --%s another path", path, option);
    return EXIT_CODE_OK;
}

int output_file_check(const char *option, const char *path, helio_source *source, const char *const *inputs)
{
    int code = check_inputs(option, path, source, inputs);
    if (code != EXIT_CODE_OK)
        return code;
    struct stat existing;
    bool exists = stat(path, &existing) == 0;
    if (!exists && errno != ENOENT)
        return message_failure("%s cannot be written: %s; give --%s another path", path, strerror(errno), option);
    if (exists && !S_ISREG(existing.st_mode))
        return message_failure("%s is %s; give --%s the name of a file", path,
                               S_ISDIR(existing.st_mode) ? "a directory" : "a device or pipe, which cannot be replaced",
                               option);
    char directory[4096] = ".";
    const char *slash = strrchr(path, '/');
    if (slash != NULL && (size_t)(slash - path) + 1 < sizeof directory)
        snprintf(directory, sizeof directory, "%.*s", (int)(slash - path) + 1, path);
    if (access(directory, F_OK) != 0)
        return message_failure("%s cannot be written: there is no folder %s; make it, or give --%s another path", path,
                               directory, option);
    if (access(directory, W_OK | X_OK) != 0)
        return message_failure("%s cannot be written: no permission to write in %s; give --%s another path", path,
                               directory, option);
    return EXIT_CODE_OK;
}

/* "" where the path has none, or one that is too long. */
static void last_folder(const char *path, char folder[4096])
{
    size_t length = output_file_folder_length(path);
    snprintf(folder, 4096, "%.*s", length < 4096 ? (int)length : 0, path);
}

int output_file_make_folder(const char *option, const char *path, bool *is_made)
{
    char folder[4096];
    last_folder(path, folder);
    *is_made = folder[0] != 0 && mkdir(folder, 0777) == 0;
    if (folder[0] == 0 || *is_made || errno == EEXIST)
        return EXIT_CODE_OK;
    return message_failure("%s cannot be written: the folder %s cannot be made: %s; give --%s another path", path,
                           folder, strerror(errno), option);
}

void output_file_remove_folder(const char *path)
{
    char folder[4096];
    last_folder(path, folder);
    rmdir(folder);
}

FILE *output_file_open(const char *path, char *temporary, size_t size)
{
    const char *slash = strrchr(path, '/');
    int directory_length = slash ? (int)(slash - path) + 1 : 0;
    int length =
        snprintf(temporary, size, "%.*s.%s.%ld", directory_length, path, path + directory_length, (long)getpid());
    if (length < 0 || (size_t)length >= size) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    int descriptor = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor < 0 ? NULL : fdopen(descriptor, "w");
}

int output_file_finish(FILE *stream, const char *temporary, const char *path)
{
    bool good = !ferror(stream);
    good = fclose(stream) == 0 && good;
    if (good && rename(temporary, path) == 0)
        return EXIT_CODE_OK;
    int code = message_failure("%s cannot be written: %s", path, strerror(errno));
    unlink(temporary);
    return code;
}
