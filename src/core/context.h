/* SPDX-License-Identifier: MIT
 * context.h - memory, log and parallel loops for the rest of the library. */
#ifndef HELIOSTAT_SRC_CONTEXT_H
#define HELIOSTAT_SRC_CONTEXT_H

#include "core/isa.h"

#include <heliostat/core.h>

enum { CONTEXT_ALIGNMENT = 64 }; /* a cache line, and the widest vector register */

/* Zeroed memory for count elements, or NULL with the last error set. count x size may overflow: that is an error too.
 */
void *context_allocate(helio_context *context, size_t count, size_t size);
void context_release(helio_context *context, void *memory); /* NULL is fine */

void context_log(helio_context *context, helio_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Messages above this level are not shown. */
helio_log_level context_log_level(const helio_context *context);

/* The instruction set of the kernels. */
isa context_isa(const helio_context *context);

/* Runs body for every index in [0, count) and waits for all. */
void context_parallel_for(helio_context *context, size_t count, helio_loop_body body, void *data);

#endif
