/* SPDX-License-Identifier: MIT */
#include "scene/ply_header.h"

#include <string.h>

/* Only comments are longer. "property list uchar int vertex_indices" has the most words. */
enum { LINE_SIZE = 256, MAX_WORDS = 5 };

typedef struct word_list {
    uint32_t count; /* at most MAX_WORDS + 1, which says that there are too many */
    char *words[MAX_WORDS];
} word_list;

static word_list split_line(char *line)
{
    word_list list = {0};
    char *rest;
    for (char *word = strtok_r(line, " \t", &rest); word != NULL; word = strtok_r(NULL, " \t", &rest)) {
        if (list.count == MAX_WORDS) {
            list.count++;
            break;
        }
        list.words[list.count++] = word;
    }
    return list;
}

static bool is_word(const word_list *list, uint32_t index, const char *word)
{
    return index < list->count && strcmp(list->words[index], word) == 0;
}

static bool read_format(const word_list *list, ply_format *format)
{
    static const char *const names[] = {
        [PLY_ASCII] = "ascii", [PLY_LITTLE_ENDIAN] = "binary_little_endian", [PLY_BIG_ENDIAN] = "binary_big_endian"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (is_word(list, 1, names[i])) {
            *format = (ply_format)i;
            return true;
        }
    return false;
}

static bool read_count(const char *text, uint64_t *count)
{
    *count = 0;
    for (const char *digit = text; *digit != 0; digit++)
        if (*digit < '0' || *digit > '9' || __builtin_mul_overflow(*count, 10, count) ||
            __builtin_add_overflow(*count, (uint64_t)(*digit - '0'), count))
            return false;
    return text[0] != 0;
}

static bool read_element(const word_list *list, ply_header *header)
{
    if (list->count != 3 || header->element_count == PLY_MAX_ELEMENTS || strlen(list->words[1]) >= PLY_NAME_SIZE)
        return false;
    ply_element *element = &header->elements[header->element_count++];
    *element = (ply_element){.first_property = header->property_count};
    strcpy(element->name, list->words[1]);
    return read_count(list->words[2], &element->count);
}

typedef struct ply_type {
    const char *name;
    unsigned char size;
    bool is_whole, is_signed;
} ply_type;

static const ply_type *find_type(const char *name)
{
    static const ply_type types[] = {
        {"char", 1, true, true},     {"int8", 1, true, true},      {"uchar", 1, true, false},
        {"uint8", 1, true, false},   {"short", 2, true, true},     {"int16", 2, true, true},
        {"ushort", 2, true, false},  {"uint16", 2, true, false},   {"int", 4, true, true},
        {"int32", 4, true, true},    {"uint", 4, true, false},     {"uint32", 4, true, false},
        {"float", 4, false, true},   {"float32", 4, false, true},  {"double", 8, false, true},
        {"float64", 8, false, true}, {"double64", 8, false, true},
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].name, name) == 0)
            return &types[i];
    return NULL;
}

/* "property float x" or "property list uchar int vertex_indices" */
static bool read_property(const word_list *list, ply_header *header)
{
    bool is_list = is_word(list, 1, "list");
    if (list->count != (is_list ? 5 : 3) || header->element_count == 0 || header->property_count == PLY_MAX_PROPERTIES)
        return false;
    const ply_type *count = is_list ? find_type(list->words[2]) : NULL;
    const ply_type *number = find_type(list->words[is_list ? 3 : 1]);
    if (number == NULL || (is_list && (count == NULL || !count->is_whole)))
        return false;
    ply_property *property = &header->properties[header->property_count++];
    *property = (ply_property){.size = number->size};
    if (is_list) {
        property->count_size = count->size;
        property->count_is_signed = count->is_signed;
    }
    header->elements[header->element_count - 1].property_count++;
    return true;
}

static bool is_comment(const char *line)
{
    return strncmp(line, "comment", 7) == 0 || strncmp(line, "obj_info", 8) == 0;
}

bool ply_header_read(ply_stream *stream, ply_header *header)
{
    char line[LINE_SIZE];
    unsigned char magic[3]; /* first, so that a large file of another format is not searched for the end of a line */
    bool whole, has_format = false;
    header->element_count = header->property_count = 0;
    if (!ply_stream_take(stream, magic, sizeof magic) || memcmp(magic, "ply", sizeof magic) != 0 ||
        !ply_stream_read_line(stream, line, sizeof line, &whole) || line[0] != 0)
        return false;
    while (ply_stream_read_line(stream, line, sizeof line, &whole)) {
        if (is_comment(line))
            continue;
        word_list list = split_line(line);
        bool good = whole;
        if (is_word(&list, 0, "end_header"))
            return good && has_format;
        if (is_word(&list, 0, "format"))
            has_format = good = good && read_format(&list, &header->format);
        else if (is_word(&list, 0, "element"))
            good = good && read_element(&list, header);
        else if (is_word(&list, 0, "property"))
            good = good && read_property(&list, header);
        else
            good = good && list.count == 0;
        if (!good)
            return false;
    }
    return false;
}
