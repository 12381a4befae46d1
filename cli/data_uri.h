/* SPDX-License-Identifier: MIT
 * data_uri.h - files within a page: data:image/png;base64,... */
#ifndef HELIOSTAT_CLI_DATA_URI_H
#define HELIOSTAT_CLI_DATA_URI_H

#include <stdbool.h>
#include <stdio.h>

/* Writes the file at path as a URI of this media type. False, and nothing written, if it cannot be opened. */
bool data_uri_write(FILE *stream, const char *media_type, const char *path);

#endif
