/* SPDX-License-Identifier: MIT */
#include "study_file.h"

#include "message.h"
#include "options.h"

#include <errno.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Text and numbers as they are written; NULL for what is neither. */
static const char *write_value(const json_t *value, char *text, size_t size)
{
    if (json_is_string(value))
        return json_string_value(value);
    if (json_is_integer(value))
        snprintf(text, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_real(value))
        snprintf(text, size, "%.17g", json_real_value(value));
    else
        return NULL;
    return text;
}

/* --key=value, with items of a list separated by semicolons. NULL if there is no memory, or for a value that no option
 * can have: then *is_bad. To be freed. */
static char *make_word(const char *key, const json_t *value, bool *is_bad)
{
    char *word = NULL, number[64];
    size_t length, count = json_is_array(value) ? json_array_size(value) : 1;
    FILE *stream = open_memstream(&word, &length);
    if (stream == NULL)
        return NULL;
    fprintf(stream, "--%s", key);
    *is_bad = count == 0;
    for (size_t i = 0; i < count && !json_is_true(value); i++) {
        const json_t *item = json_is_array(value) ? json_array_get(value, i) : value;
        const char *text = write_value(item, number, sizeof number);
        *is_bad = *is_bad || text == NULL;
        fprintf(stream, "%s%s", i > 0 ? ";" : "=", text != NULL ? text : "");
    }
    if (fclose(stream) == 0 && !*is_bad)
        return word;
    free(word);
    return NULL;
}

/* Keys are options, but people who write a file should hear of their file. */
static int fail_with_key(const char *path, const char *key)
{
    const char *suggestion = option_suggest(COMMAND_STUDY, key);
    if (suggestion != NULL)
        return message_usage("%s: there is no key \"%s\"; did you mean \"%s\"?", path, key, suggestion);
    return message_usage("%s: there is no key \"%s\"; keys are the options that heliostat study --help shows", path,
                         key);
}

static int add_word(study_file *file, const char *path, const char *key, const json_t *value)
{
    bool is_bad = false;
    if (json_is_false(value))
        return EXIT_CODE_OK;
    if (strcmp(key, "study") == 0)
        return message_usage("%s names another study file; put all options into one", path);
    if (!option_exists(COMMAND_STUDY, key))
        return fail_with_key(path, key);
    char *word = make_word(key, value, &is_bad);
    if (word != NULL) {
        file->words[file->owned++] = word;
        return EXIT_CODE_OK;
    }
    return is_bad ? message_usage("%s: \"%s\" takes text, a number, true, or an array of text and numbers", path, key)
                  : message_failure("no memory for the options in %s", path);
}

static json_t *load(const char *path)
{
    json_error_t error;
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        message_failure("%s cannot be read: %s", path, strerror(errno));
        return NULL;
    }
    json_t *object = json_loadf(stream, JSON_REJECT_DUPLICATES, &error);
    fclose(stream);
    if (object == NULL && error.line > 0)
        message_failure("%s is no study file: line %d, %s", path, error.line, error.text);
    else if (object == NULL)
        message_failure("%s cannot be read: %s", path, error.text);
    else if (!json_is_object(object))
        message_failure("%s is no study file: it holds no object such as {\"spp\": [4, 16]}", path);
    if (json_is_object(object))
        return object;
    json_decref(object);
    return NULL;
}

int study_file_read(study_file *file, const char *path, int count, char **words)
{
    const char *key;
    json_t *value, *object = load(path);
    int code = EXIT_CODE_OK;
    *file = (study_file){0};
    if (object == NULL)
        return EXIT_CODE_FAILED;
    file->words = calloc(json_object_size(object) + (size_t)count + 1, sizeof *file->words);
    if (file->words == NULL) {
        json_decref(object);
        return message_failure("no memory for the options in %s", path);
    }
    json_object_foreach(object, key, value)
    {
        if (code == EXIT_CODE_OK)
            code = add_word(file, path, key, value);
    }
    for (int i = 0; code == EXIT_CODE_OK && i < count; i++)
        file->words[file->owned + i] = words[i];
    file->count = file->owned + count;
    json_decref(object);
    return code;
}

void study_file_release(study_file *file)
{
    for (int i = 0; i < file->owned; i++)
        free(file->words[i]);
    free(file->words);
    *file = (study_file){0};
}
