/* SPDX-License-Identifier: MIT
 * gzip.h - what a gzipped mesh holds. */
#ifndef HELIOSTAT_SRC_GZIP_H
#define HELIOSTAT_SRC_GZIP_H

#include <heliostat/core.h>

/* Reads and unpacks a file; *bytes is memory of the context. Neither the file nor what it holds may have more than
 * max_bytes, and what holds far more than the file itself, as no mesh does, is refused earlier. */
helio_status gzip_read(helio_context *context, const char *path, size_t max_bytes, unsigned char **bytes, size_t *size);

#endif
