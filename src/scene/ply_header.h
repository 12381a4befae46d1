/* SPDX-License-Identifier: MIT
 * ply_header.h - what the first lines of a PLY file say about the others. */
#ifndef HELIOSTAT_SRC_PLY_HEADER_H
#define HELIOSTAT_SRC_PLY_HEADER_H

#include "scene/ply_stream.h"

/* More than any mesh has; headers with more are not understood. */
enum { PLY_MAX_ELEMENTS = 16, PLY_MAX_PROPERTIES = 256, PLY_NAME_SIZE = 32 };

typedef enum ply_format {
    PLY_ASCII,
    PLY_LITTLE_ENDIAN,
    PLY_BIG_ENDIAN,
} ply_format;

/* A number, or a list of numbers after their count. */
typedef struct ply_property {
    unsigned char size;       /* bytes of a number in binary files */
    unsigned char count_size; /* bytes of the count; 0: it is no list */
    bool count_is_signed;
} ply_property;

typedef struct ply_element {
    char name[PLY_NAME_SIZE]; /* "vertex", "face", or anything: not printable for certain */
    uint64_t count;
    uint32_t first_property, property_count;
} ply_element;

typedef struct ply_header {
    ply_format format;
    uint32_t element_count, property_count; /* of all elements together */
    ply_element elements[PLY_MAX_ELEMENTS];
    ply_property properties[PLY_MAX_PROPERTIES];
} ply_header;

/* Reads to the end of the header. False if the file is no PLY, or one that we do not understand: then it is for the
 * importer to say what is wrong with it, if anything is. */
bool ply_header_read(ply_stream *stream, ply_header *header);

#endif
