/* SPDX-License-Identifier: MIT */
#include "json_file.h"

#include "message.h"
#include "output_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_whole(uint64_t value)
{
    return json_integer((json_int_t)value);
}

json_t *json_text(const char *text)
{
    json_t *string = text != NULL ? json_string(text) : NULL;
    return string != NULL ? string : json_null();
}

static int fail_to_write(const char *option, const char *path)
{
    return message_failure("%s cannot be written: %s; give --%s another FILE", path, strerror(errno), option);
}

int json_file_write(const char *option, const char *path, const json_t *object)
{
    if (object == NULL)
        return message_failure("%s cannot be written: no memory", path);
    char temporary[4096];
    FILE *stream = output_file_open(path, temporary, sizeof temporary);
    if (stream == NULL)
        return fail_to_write(option, path);
    bool good = json_dumpf(object, stream, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) == 0;
    good = fputc('\n', stream) != EOF && good;
    good = fclose(stream) == 0 && good;
    if (good && rename(temporary, path) == 0)
        return EXIT_CODE_OK;
    int code = fail_to_write(option, path);
    unlink(temporary);
    return code;
}

bool json_file_is_printed(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

int json_file_write_or_print(const char *option, const char *path, const json_t *object)
{
    if (!json_file_is_printed(path))
        return json_file_write(option, path, object);
    if (json_dumpf(object, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) != 0)
        return message_failure("standard output cannot be written");
    printf("\n");
    return EXIT_CODE_OK;
}
