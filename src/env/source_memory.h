/* SPDX-License-Identifier: MIT
 * source_memory.h - the memory of frames, which is used again for the frames that follow. */
#ifndef HELIOSTAT_SRC_SOURCE_MEMORY_H
#define HELIOSTAT_SRC_SOURCE_MEMORY_H

#include <heliostat/core.h>

typedef struct source_memory source_memory;

/* keep: blocks that are given back stay here, for the next that fits; else they go back to the parent at once. */
helio_status source_memory_create(helio_context *parent, bool keep, source_memory **memory);

/* All blocks must have been given back. */
void source_memory_destroy(source_memory *memory);

/* A context for the thread that reads: its memory is this one, its log that of the parent, and its loops run in the
 * thread itself, so that the parent's parallel_for stays with the parent's users. */
helio_context *source_memory_context(source_memory *memory);

/* Gives back what is not in use. */
void source_memory_trim(source_memory *memory);

#endif
