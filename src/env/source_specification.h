/* SPDX-License-Identifier: MIT
 * source_specification.h - what the text that names a source says, before any file is looked at. */
#ifndef HELIOSTAT_SRC_SOURCE_SPECIFICATION_H
#define HELIOSTAT_SRC_SOURCE_SPECIFICATION_H

#include "env/sky_specification.h"
#include "env/source_pattern.h"

#include <heliostat/source.h>

typedef struct source_specification {
    helio_source_kind kind; /* of a file: as its name says */
    const char *text;
    const char *device;    /* FFmpeg's name of it, for HELIO_SOURCE_DEVICE */
    const char *path;      /* what the device opens, or the text itself */
    bool is_shell_pattern; /* of a sequence; else it has the pattern below */
    bool is_wrong_pattern; /* percent signs that mean nothing: right only if a file has this name */
    bool is_surely_video;  /* its name says so, or how it begins */
    source_pattern pattern;
    float constant[3];
    sky_specification sky; /* of both kinds of sky */
    helio_source_callback callback;
    void *user; /* of the callback */
} source_specification;

/* HELIO_ERR_ARGUMENT for mistakes. The specification points into the text. */
helio_status source_specification_parse(const char *text, source_specification *specification);

/* The file is there, whatever its name looks like: no pattern is meant. */
void source_specification_take_as_file(source_specification *specification);

/* Does the path have the extension of a picture that can be read? */
bool source_specification_is_picture(const source_specification *specification);

#endif
