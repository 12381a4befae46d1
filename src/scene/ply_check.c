/* SPDX-License-Identifier: MIT
 *
 * assimp makes up what an ASCII file lacks, as triangles without area, and reads beyond the end of a binary one. */
#include "scene/ply_check.h"

#include "core/error.h"
#include "image/image.h"
#include "scene/ply_header.h"

#include <inttypes.h>
#include <string.h>

/* ---- ASCII ------------------------------------------------------------------------------ */

/* To the first byte of the next line that is not blank; false if there is none. */
static bool find_line(ply_stream *stream)
{
    while (ply_stream_fill(stream)) {
        for (; stream->next < stream->end; stream->next++)
            if (strchr(" \t\r\n\v\f", *stream->next) == NULL || *stream->next == 0)
                return true;
    }
    return false;
}

/* A line for each instance, as assimp has it. Returns how many there are, and passes them. */
static uint64_t pass_lines(ply_stream *stream, const ply_element *element)
{
    uint64_t present = 0;
    if (element->property_count == 0) /* these are blank */
        return element->count;
    while (present < element->count && find_line(stream)) {
        bool last = present + 1 == element->count;
        if (!ply_stream_skip_line(stream) && !last) /* it may have been cut */
            break;
        present++;
    }
    return present;
}

/* ---- binary ----------------------------------------------------------------------------- */

/* Negative counts become large ones, as in assimp. */
static bool take_list_count(ply_stream *stream, const ply_property *property, ply_format format, uint32_t *count)
{
    unsigned char bytes[4];
    size_t size = property->count_size;
    if (!ply_stream_take(stream, bytes, size))
        return false;
    bool negative = property->count_is_signed && bytes[format == PLY_BIG_ENDIAN ? 0 : size - 1] >= 0x80;
    *count = negative ? UINT32_MAX : 0;
    for (size_t i = 0; i < size; i++)
        *count = *count << 8 | bytes[format == PLY_BIG_ENDIAN ? i : size - 1 - i];
    return true;
}

static bool pass_instance(ply_stream *stream, const ply_header *header, const ply_element *element)
{
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ply_property *property = &header->properties[element->first_property + i];
        uint32_t count = 1;
        if (property->count_size != 0 && !take_list_count(stream, property, header->format, &count))
            return false;
        if (!ply_stream_skip(stream, (uint64_t)count * property->size))
            return false;
    }
    return true;
}

/* Bytes of each instance, or 0 if they have lists, or nothing at all. */
static uint64_t fixed_size(const ply_header *header, const ply_element *element)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ply_property *property = &header->properties[element->first_property + i];
        if (property->count_size != 0)
            return 0;
        size += property->size;
    }
    return size;
}

static uint64_t pass_instances(ply_stream *stream, const ply_header *header, const ply_element *element)
{
    uint64_t size = fixed_size(header, element), present = 0;
    if (element->property_count == 0)
        return element->count;
    if (size != 0) {
        present = ply_stream_left(stream) / size;
        present = present < element->count ? present : element->count;
        ply_stream_skip(stream, present * size);
        return present;
    }
    while (present < element->count && pass_instance(stream, header, element))
        present++;
    return present;
}

/* ---- both ------------------------------------------------------------------------------- */

/* "3 faces", or "1 of \"material\"" */
static void describe(const ply_element *element, char *text, size_t size)
{
    bool one = element->count == 1;
    if (strcmp(element->name, "vertex") == 0)
        snprintf(text, size, "%" PRIu64 " %s", element->count, one ? "vertex" : "vertices");
    else if (strcmp(element->name, "face") == 0)
        snprintf(text, size, "%" PRIu64 " %s", element->count, one ? "face" : "faces");
    else
        snprintf(text, size, "%" PRIu64 " of \"%s\"", element->count, element->name);
    image_make_printable(text);
}

static bool is_geometry(const ply_element *element)
{
    return strcmp(element->name, "vertex") == 0 || strcmp(element->name, "face") == 0 ||
           strcmp(element->name, "tristrips") == 0;
}

/* What follows the geometry, edges for example, is of no use; assimp drops it. */
static uint32_t count_needed(const ply_header *header)
{
    uint32_t count = header->element_count;
    while (count > 0 && !is_geometry(&header->elements[count - 1]))
        count--;
    return count;
}

helio_status ply_check(ply_stream *stream, const char *path)
{
    ply_header header;
    uint32_t needed = ply_header_read(stream, &header) ? count_needed(&header) : 0;
    for (uint32_t i = 0; i < needed; i++) {
        const ply_element *element = &header.elements[i];
        uint64_t present =
            header.format == PLY_ASCII ? pass_lines(stream, element) : pass_instances(stream, &header, element);
        if (stream->failed)
            break;
        if (present < element->count) {
            char announced[64];
            describe(element, announced, sizeof announced);
            return fail(HELIO_ERR_DATA,
                        "%s ends too early: its header announces %s, and there are %" PRIu64
                        "; copy or download it again",
                        path, announced, present);
        }
    }
    return stream->failed ? fail(HELIO_ERR_IO, "%s cannot be read to its end", path) : HELIO_OK;
}
