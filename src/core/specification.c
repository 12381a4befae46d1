/* SPDX-License-Identifier: MIT */
#include "core/specification.h"

#include "core/error.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is being read; token is the part of text up to the next comma. */
typedef struct reader {
    const char *what, *text;
    specification_field *fields;
    size_t field_count;
    const char *token;
    int token_length;
} reader;

bool specification_has_name(const char *text, const char *name)
{
    size_t length = strlen(name);
    return strncmp(text, name, length) == 0 && (text[length] == ':' || text[length] == 0);
}

/* "kd, ks, n", cut short if it is too long, for error messages. */
static void list_keys(const reader *r, char *list, size_t size)
{
    size_t used = 0;
    list[0] = 0;
    for (size_t i = 0; i < r->field_count && used < size; i++)
        used += (size_t)snprintf(list + used, size - used, "%s%s", i ? ", " : "", r->fields[i].key);
}

/* The token names no field of ours; key_length is that of its part before '=', or -1 if it has no '='. */
static helio_status fail_key(const reader *r, int key_length)
{
    char keys[200];
    list_keys(r, keys, sizeof keys);
    int length = key_length < 0 ? r->token_length : key_length;
    length = length > 60 ? 60 : length;
    if (r->field_count == 0)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": nothing may follow the name", r->what, r->text);
    if (keys[0] == 0)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": \"%.*s\" is no key here; give only numbers", r->what, r->text,
                    length, r->token);
    if (key_length < 0)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": \"%.*s\" follows no key; write key=value with one of %s",
                    r->what, r->text, length, r->token, keys);
    return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": there is no key \"%.*s\"; the keys are %s", r->what, r->text,
                length, r->token, keys);
}

static bool is_key_of(const specification_field *field, const char *token, int key_length)
{
    if (key_length <= 0)
        return key_length < 0 && field->key[0] == 0;
    return strlen(field->key) == (size_t)key_length && memcmp(field->key, token, (size_t)key_length) == 0;
}

/* The field that the token names, marked as given; NULL, with the last error set, if there is none or it was given
 * before. */
static specification_field *find_field(const reader *r, int key_length)
{
    for (size_t i = 0; i < r->field_count; i++) {
        specification_field *field = &r->fields[i];
        if (!is_key_of(field, r->token, key_length))
            continue;
        if (field->given) {
            char keys[200];
            list_keys(r, keys, sizeof keys);
            fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s is given twice; the keys are %s, each at most once", r->what,
                 r->text, field->key, keys);
            return NULL;
        }
        field->given = true;
        return field;
    }
    fail_key(r, key_length);
    return NULL;
}

/* Decimal numbers only: strtod() alone would take blanks, "nan", "inf" and hexadecimal digits as well. */
static bool read_number(const char *text, size_t length, float *number)
{
    char copy[64];
    if (length == 0 || length >= sizeof copy)
        return false;
    memcpy(copy, text, length);
    copy[length] = 0;
    if (strspn(copy, "0123456789+-.eE") != length)
        return false;
    char *end;
    *number = (float)strtod(copy, &end);
    return *end == 0 && isfinite(*number);
}

static helio_status add_text(const reader *r, const specification_field *field, const char *text, int length)
{
    if (length == 0 || length >= SPECIFICATION_TEXT_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s is \"%.*s\"; use 1 to %d characters", r->what, r->text,
                    field->key, length > 60 ? 60 : length, text, SPECIFICATION_TEXT_SIZE - 1);
    memcpy(field->text, text, (size_t)length);
    field->text[length] = 0;
    return HELIO_OK;
}

static helio_status add_number(const reader *r, const specification_field *field, uint32_t index, const char *text,
                               int length)
{
    const char *key = field->key[0] ? field->key : "its number", *to = field->no_between ? "or" : "to";
    if (index >= field->count)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s has more than %u number%s", r->what, r->text,
                    field->key[0] ? field->key : "it", field->count, field->count == 1 ? "" : "s");
    if (field->text != NULL)
        return add_text(r, field, text, length);
    float number;
    if (!read_number(text, (size_t)length, &number))
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s is \"%.*s\"; use %s%g %s %g", r->what, r->text, key,
                    length > 60 ? 60 : length, text, field->no_between ? "" : "a number from ", (double)field->least,
                    to, (double)field->greatest);
    bool is_end = number == field->least || number == field->greatest;
    if (!is_end && (field->no_between || !(number > field->least && number < field->greatest)))
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s is %.*s; use %g %s %g", r->what, r->text, key, length, text,
                    (double)field->least, to, (double)field->greatest);
    field->values[index] = number;
    return HELIO_OK;
}

static helio_status finish_field(const reader *r, const specification_field *field, uint32_t numbers)
{
    if (numbers == field->count)
        return HELIO_OK;
    if (numbers != 1 || !field->one_for_all)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.200s\": %s has %u number%s; give %s%u", r->what, r->text,
                    field->key[0] ? field->key : "it", numbers, numbers == 1 ? "" : "s",
                    field->one_for_all ? "1 or " : "", field->count);
    for (uint32_t i = 1; i < field->count; i++)
        field->values[i] = field->values[0];
    return HELIO_OK;
}

static helio_status parse_tokens(reader *r)
{
    specification_field *field = NULL;
    uint32_t numbers = 0;
    const char *next = strchr(r->text, ':');
    while (next != NULL) {
        r->token = next + 1;
        r->token_length = (int)strcspn(r->token, ",");
        next = r->token[r->token_length] == ',' ? r->token + r->token_length : NULL;

        const char *equals = memchr(r->token, '=', (size_t)r->token_length);
        const char *number = equals ? equals + 1 : r->token;
        if (equals != NULL || field == NULL) {
            if (field != NULL)
                HELIO_TRY(finish_field(r, field, numbers));
            field = find_field(r, equals ? (int)(equals - r->token) : -1);
            if (field == NULL)
                return HELIO_ERR_ARGUMENT;
            numbers = 0;
        }
        HELIO_TRY(add_number(r, field, numbers++, number, r->token_length - (int)(number - r->token)));
    }
    return field ? finish_field(r, field, numbers) : HELIO_OK;
}

helio_status specification_parse(const char *what, const char *text, specification_field *fields, size_t field_count)
{
    if (strlen(text) > 10000)
        return fail(HELIO_ERR_ARGUMENT, "%s \"%.60s...\" has more than 10000 characters", what, text);
    for (size_t i = 0; i < field_count; i++)
        fields[i].given = false;
    reader r = {.what = what, .text = text, .fields = fields, .field_count = field_count};

    /* Numbers are read, and written in error messages, with a point whatever the program's locale is. */
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0)
        return fail(HELIO_ERR_MEMORY, "no memory to read %s \"%.200s\"", what, text);
    locale_t before = uselocale(plain);
    helio_status status = parse_tokens(&r);
    uselocale(before);
    freelocale(plain);
    return status;
}
