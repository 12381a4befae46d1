/* SPDX-License-Identifier: MIT
 * source_files.h - the files that a source reads, so that none of them is replaced by what is made of it. */
#ifndef HELIOSTAT_SRC_SOURCE_FILES_H
#define HELIOSTAT_SRC_SOURCE_FILES_H

#include "env/source_specification.h"

#include <sys/types.h>

/* By this a file is known whatever its name is. */
typedef struct source_file {
    dev_t device;
    ino_t inode;
} source_file;

typedef struct source_files {
    source_file *list; /* sorted */
    size_t count, capacity;
    bool is_complete;
} source_files;

/* Fills an empty list. */
helio_status source_files_find(helio_context *context, const source_specification *specification,
                               const helio_source_desc *desc, source_files *files);
void source_files_release(helio_context *context, source_files *files);

/* Is path one of them, or has it the name of a frame that is missing? */
bool source_files_has(const source_files *files, const source_specification *specification,
                      const helio_source_desc *desc, const char *path);

#endif
