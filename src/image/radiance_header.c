/* SPDX-License-Identifier: MIT */
#include "image/radiance_header.h"

#include "core/error.h"
#include "image/number.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Lines that matter are short; longer ones hold the history of commands and are cut. */
enum { LINE_LENGTH = 511 };

/* Copies the next line without its end. false at the end of the file: the line is not complete. */
static bool next_line(const image_file *file, size_t *at, char line[LINE_LENGTH + 1])
{
    const unsigned char *start = file->bytes + *at;
    const unsigned char *end = memchr(start, '\n', file->size - *at);
    if (end == NULL)
        return false;
    *at += (size_t)(end - start) + 1;
    if (end > start && end[-1] == '\r')
        end--;
    size_t length = (size_t)(end - start) < LINE_LENGTH ? (size_t)(end - start) : LINE_LENGTH;
    memcpy(line, start, length);
    line[length] = 0;
    image_make_printable(line);
    return true;
}

/* If the line is "name=...", points value behind the sign. */
static bool has_name(const char *line, const char *name, const char **value)
{
    size_t length = strlen(name);
    if (strncmp(line, name, length) != 0 || line[length] != '=')
        return false;
    *value = line + length + 1;
    return true;
}

static bool read_numbers(const char *text, int count, double *numbers)
{
    for (int i = 0; i < count; i++)
        if (!number_read(&text, &numbers[i]) || !isfinite(numbers[i]))
            return false;
    return true;
}

static bool are_zero(const double *numbers, int count)
{
    while (count > 0 && numbers[count - 1] == 0.0)
        count--;
    return count == 0;
}

static helio_status parse_format(const image_file *file, const char *value, radiance_header *header)
{
    while (*value == ' ')
        value++;
    size_t length = strcspn(value, " \t");
    const char *const rgbe = "32-bit_rle_rgbe", *const xyze = "32-bit_rle_xyze";
    header->xyz = length == strlen(xyze) && strncmp(value, xyze, length) == 0;
    if (!header->xyz && (length != strlen(rgbe) || strncmp(value, rgbe, length) != 0))
        return fail(HELIO_ERR_DATA, "%s has the Radiance format \"%.40s\", which is neither %s nor %s", file->path,
                    value, rgbe, xyze);
    return HELIO_OK;
}

/* Too long a one is another comment. */
static void copy_comment(const char *comment, char layout[LAYOUT_COMMENT_SIZE])
{
    if (strlen(comment) < LAYOUT_COMMENT_SIZE)
        strcpy(layout, comment);
}

static helio_status parse_line(const image_file *file, const char *line, radiance_header *header)
{
    const char *value;
    double numbers[8];
    if (has_name(line, "FORMAT", &value))
        return parse_format(file, value, header);
    if (strncmp(line, "# layout: ", 10) == 0)
        copy_comment(line + 2, header->layout);
    if (has_name(line, "EXPOSURE", &value)) {
        if (!read_numbers(value, 1, numbers) || !(numbers[0] > 0))
            return fail(HELIO_ERR_DATA, "%s has a bad line \"%.60s\": one positive number belongs there", file->path,
                        line);
        for (int c = 0; c < 3; c++)
            header->divisor[c] *= numbers[0];
    } else if (has_name(line, "COLORCORR", &value)) {
        if (!read_numbers(value, 3, numbers) || !(numbers[0] > 0 && numbers[1] > 0 && numbers[2] > 0))
            return fail(HELIO_ERR_DATA, "%s has a bad line \"%.60s\": three positive numbers belong there", file->path,
                        line);
        for (int c = 0; c < 3; c++)
            header->divisor[c] *= numbers[c];
    } else if (has_name(line, "PRIMARIES", &value)) {
        if (!read_numbers(value, 8, numbers))
            return fail(HELIO_ERR_DATA, "%s has a bad line \"%.60s\": eight numbers belong there", file->path, line);
        header->has_primaries = !are_zero(numbers, 8);
        header->primaries = (chromaticities){
            {numbers[0], numbers[1]}, {numbers[2], numbers[3]}, {numbers[4], numbers[5]}, {numbers[6], numbers[7]}};
    }
    return HELIO_OK;
}

/* "-Y", "+Y", "-X" or "+X" and a number. */
static bool parse_axis(const char **text, char *axis, bool *minus, uint32_t *size)
{
    const char *at = *text;
    while (*at == ' ')
        at++;
    if ((at[0] != '-' && at[0] != '+') || (at[1] != 'X' && at[1] != 'Y'))
        return false;
    *minus = at[0] == '-';
    *axis = at[1];
    at += 2;
    if (!number_read_size(&at, size))
        return false;
    *text = at;
    return true;
}

static bool parse_resolution(const char *line, radiance_header *header)
{
    char axes[2];
    bool minus[2];
    if (!parse_axis(&line, &axes[0], &minus[0], &header->line_count) ||
        !parse_axis(&line, &axes[1], &minus[1], &header->line_length) || axes[0] == axes[1])
        return false;
    header->lines_are_columns = axes[0] == 'X';
    header->x_minus = minus[header->lines_are_columns ? 0 : 1];
    header->y_plus = !minus[header->lines_are_columns ? 1 : 0];
    return line[strspn(line, " \t")] == 0;
}

helio_status radiance_header_parse(const image_file *file, radiance_header *header)
{
    char line[LINE_LENGTH + 1];
    size_t at = 0;
    *header = (radiance_header){.divisor = {1, 1, 1}};
    do {
        if (!next_line(file, &at, line))
            return fail(HELIO_ERR_DATA, "%s is not a whole Radiance picture: its head has no end", file->path);
        HELIO_TRY(parse_line(file, line, header));
    } while (line[0] != 0);
    if (!next_line(file, &at, line))
        return fail(HELIO_ERR_DATA, "%s is not a whole Radiance picture: its head has no resolution", file->path);
    if (!parse_resolution(line, header))
        return fail(HELIO_ERR_DATA, "%s has the resolution \"%.60s\", where something like -Y 512 +X 1024 belongs",
                    file->path, line);
    for (int c = 0; c < 3; c++)
        if (!(header->divisor[c] >= (double)FLT_MIN) || !(header->divisor[c] <= (double)FLT_MAX))
            return fail(HELIO_ERR_DATA, "%s has the exposure %g, which is out of range", file->path,
                        header->divisor[c]);
    header->length = at;
    return HELIO_OK;
}
