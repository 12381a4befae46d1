/* SPDX-License-Identifier: MIT
 *
 * Runs a fuzz target over all files of the folders that are named on the command line, with any compiler: what the
 * fuzzer found once is a test from then on. Fails if a folder has no file, or if a small file takes much memory. */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

/* The most that the process may ever have taken, in KiB: far more than the sanitizers need. */
enum { MEMORY_LIMIT = 1 << 20 };

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static bool is_memory_bearable(const char *name)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    if (usage.ru_maxrss <= MEMORY_LIMIT)
        return true;
    fprintf(stderr, "%s took %ld KiB of memory\n", name, usage.ru_maxrss);
    return false;
}

static bool replay_file(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        perror(path);
        return false;
    }
    static uint8_t bytes[1 << 20];
    size_t size = fread(bytes, 1, sizeof bytes, stream);
    bool whole = !ferror(stream) && getc(stream) == EOF;
    fclose(stream);
    if (!whole) {
        fprintf(stderr, "%s cannot be read or has more than %zu bytes\n", path, sizeof bytes);
        return false;
    }
    printf("%s (%zu bytes)\n", name, size);
    fflush(stdout); /* so that a crash has a name */
    uint8_t *copy = fuzz_copy(bytes, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
    return is_memory_bearable(name);
}

static bool replay_folder(const char *folder)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, is_visible, alphasort);
    if (count < 1) {
        fprintf(stderr, "%s has no files to replay\n", folder);
        return false;
    }
    bool good = true;
    for (int i = 0; i < count; i++) {
        good &= replay_file(folder, entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
    printf("%d files of %s replayed\n", count, folder);
    return good;
}

int main(int count, char **arguments)
{
    if (count < 2) {
        fprintf(stderr, "usage: %s FOLDER...\n", arguments[0]);
        return 2;
    }
    bool good = true;
    for (int i = 1; i < count; i++)
        good &= replay_folder(arguments[i]);
    return good ? 0 : 1;
}
