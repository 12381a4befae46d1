/* SPDX-License-Identifier: MIT */
#include "options.h"

#include "message.h"
#include "number.h"
#include "suggestion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The name need not end after length. */
static const cli_option *find_option(unsigned command, const char *name, size_t length)
{
    for (size_t i = 0; i < option_count; i++) {
        const cli_option *option = &option_table[i];
        if ((option->commands & command) && strlen(option->name) == length && strncmp(option->name, name, length) == 0)
            return option;
    }
    return NULL;
}

static const cli_option *find_letter(unsigned command, char letter)
{
    for (size_t i = 0; i < option_count; i++)
        if ((option_table[i].commands & command) && option_table[i].letter == letter)
            return &option_table[i];
    return NULL;
}

bool option_exists(unsigned command, const char *name)
{
    return find_option(command, name, strlen(name)) != NULL;
}

const char *option_suggest(unsigned command, const char *name)
{
    word_suggestion suggestion = {.word = name};
    for (size_t i = 0; i < option_count; i++)
        if (option_table[i].commands & command)
            suggestion_consider(&suggestion, option_table[i].name);
    return suggestion.best;
}

static int unknown_option(unsigned command, const char *command_name, const char *argument)
{
    char name[64];
    const char *start = argument + strspn(argument, "-");
    snprintf(name, sizeof name, "%.*s", (int)strcspn(start, "="), start);
    const char *suggestion = option_suggest(command, name);
    if (suggestion != NULL)
        return message_usage("%s has no option %s; did you mean --%s?", command_name, argument, suggestion);
    return message_usage("%s has no option %s; heliostat %s --help shows those that it has", command_name, argument,
                         command_name);
}

void option_choices(const cli_option *option, char *text, size_t size)
{
    size_t used = 0;
    for (const char *word = option->choices; used < size;) {
        size_t length = strcspn(word, " ");
        bool first = word == option->choices, last = word[length] == 0;
        used += (size_t)snprintf(text + used, size - used, "%s%.*s",
                                 first  ? ""
                                 : last ? " or "
                                        : ", ",
                                 (int)length, word);
        if (last)
            return;
        word += length + 1;
    }
}

static bool is_choice(const char *choices, const char *value)
{
    size_t value_length = strlen(value);
    for (const char *word = choices;; word++) {
        size_t length = strcspn(word, " ");
        if (length == value_length && strncmp(word, value, length) == 0)
            return true;
        word += length;
        if (*word == 0)
            return false;
    }
}

static int bad_value(const cli_option *option, const char *value)
{
    char choices[256] = "";
    double minimum = option->minimum, maximum = option->maximum;
    switch (option->kind) {
    case OPTION_CHOICE:
        option_choices(option, choices, sizeof choices);
        return message_usage("--%s takes %s, not '%s'", option->name, choices, value);
    case OPTION_WHOLE:
        return message_usage("--%s takes a whole number from %.0f to %.0f, not '%s'", option->name, minimum, maximum,
                             value);
    case OPTION_POWER:
        return message_usage("--%s takes a power of two from %.0f to %.0f, not '%s'", option->name, minimum, maximum,
                             value);
    case OPTION_NUMBER:
        return message_usage("--%s takes a number from %g to %g, not '%s'", option->name, minimum, maximum, value);
    case OPTION_EXPOSURE:
        return message_usage("--%s takes auto or a number of stops from %g to %g, not '%s'", option->name, minimum,
                             maximum, value);
    case OPTION_SIZE:
        return message_usage("--%s takes width x height, such as 1280x720, each from %.0f to %.0f, not '%s'",
                             option->name, minimum, maximum, value);
    case OPTION_RANGE:
        return message_usage(
            "--%s takes first..last, such as 10..20, or one number, each from %.0f to %.0f and the last not before the "
            "first, not '%s'",
            option->name, minimum, maximum, value);
    case OPTION_TEXT: return message_usage("--%s takes a value that is not empty", option->name);
    case OPTION_FLAG: break;
    }
    return message_usage("--%s takes no value; leave ='%s' away", option->name, value);
}

static bool parse_power(const char *text, double minimum, double maximum, uint32_t *number)
{
    uint32_t parsed;
    if (!number_parse_whole(text, minimum, maximum, &parsed) || (parsed & (parsed - 1)) != 0)
        return false;
    *number = parsed;
    return true;
}

static bool parse_size(const char *text, double minimum, double maximum, uint32_t size[2])
{
    char width[16];
    size_t length = strcspn(text, "x");
    if (length >= sizeof width || text[length] != 'x')
        return false;
    snprintf(width, sizeof width, "%.*s", (int)length, text);
    uint32_t parsed[2];
    if (!number_parse_whole(width, minimum, maximum, &parsed[0]) ||
        !number_parse_whole(text + length + 1, minimum, maximum, &parsed[1]))
        return false;
    memcpy(size, parsed, sizeof parsed);
    return true;
}

static bool parse_range(const char *text, double minimum, double maximum, frame_range *range)
{
    char first[16];
    const char *dots = strstr(text, "..");
    frame_range one = {.is_given = true};
    if (dots == NULL && number_parse_whole(text, minimum, maximum, &one.first)) {
        one.last = one.first;
        *range = one;
        return true;
    }
    if (dots == NULL || (size_t)(dots - text) >= sizeof first)
        return false;
    snprintf(first, sizeof first, "%.*s", (int)(dots - text), text);
    frame_range parsed = {.is_given = true};
    if (!number_parse_whole(first, minimum, maximum, &parsed.first) ||
        !number_parse_whole(dots + 2, minimum, maximum, &parsed.last) || parsed.last < parsed.first)
        return false;
    *range = parsed;
    return true;
}

/* Puts the value where it belongs; false if it is not one that the option takes. */
static bool store_value(const cli_option *option, const char *value, cli_options *options)
{
    void *member = (char *)options + option->offset;
    switch (option->kind) {
    case OPTION_FLAG: *(bool *)member = true; return true;
    case OPTION_TEXT: *(const char **)member = value; return value[0] != 0;
    case OPTION_CHOICE: *(const char **)member = value; return is_choice(option->choices, value);
    case OPTION_WHOLE: return number_parse_whole(value, option->minimum, option->maximum, member);
    case OPTION_POWER: return parse_power(value, option->minimum, option->maximum, member);
    case OPTION_EXPOSURE:
        if (strcmp(value, "auto") == 0) {
            *(double *)member = (double)NAN;
            return true;
        }
        return number_parse(value, option->minimum, option->maximum, member);
    case OPTION_NUMBER: return number_parse(value, option->minimum, option->maximum, member);
    case OPTION_SIZE: return parse_size(value, option->minimum, option->maximum, member);
    case OPTION_RANGE: return parse_range(value, option->minimum, option->maximum, member);
    }
    return false;
}

static void set_defaults(cli_options *options)
{
    *options = (cli_options){0};
    for (size_t i = 0; i < option_count; i++)
        if (option_table[i].initial != NULL)
            store_value(&option_table[i], option_table[i].initial, options);
}

const char *option_default(const cli_option *option)
{
    return option->shown != NULL ? option->shown : option->initial;
}

/* Takes the option at arguments[*index] and, where it is the next argument, its value; moves *index to the last one. */
static int take_option(cli_options *options, unsigned command, const char *command_name, int count, char **arguments,
                       int *index)
{
    const char *argument = arguments[*index];
    bool is_long = argument[1] == '-';
    size_t length = is_long ? strcspn(argument + 2, "=") : 0;
    const cli_option *option = is_long                           ? find_option(command, argument + 2, length)
                               : argument[1] && argument[2] == 0 ? find_letter(command, argument[1])
                                                                 : NULL;
    if (option == NULL)
        return unknown_option(command, command_name, argument);

    const char *value = is_long && argument[2 + length] == '=' ? argument + 2 + length + 1 : NULL;
    if (option->kind == OPTION_FLAG) {
        if (value != NULL)
            return bad_value(option, value);
    } else if (value == NULL) {
        const char *next = *index + 1 < count ? arguments[*index + 1] : NULL;
        if (option->bare != NULL && (next == NULL || strncmp(next, "--", 2) == 0))
            return store_value(option, option->bare, options) ? EXIT_CODE_OK : bad_value(option, option->bare);
        if (next == NULL)
            return message_usage("--%s needs a value: --%s %s", option->name, option->name, option->argument);
        if (strncmp(next, "--", 2) == 0)
            return message_usage("--%s needs a value (--%s %s), but %s follows; if that is the value, write --%s=%s",
                                 option->name, option->name, option->argument, next, option->name, next);
        value = next;
        ++*index;
    }
    return store_value(option, value, options) ? EXIT_CODE_OK : bad_value(option, value);
}

static int take_word(cli_options *options, unsigned command, const char *command_name, const char *word)
{
    if (command == COMMAND_HELP && options->topic == NULL) {
        options->topic = word;
        return EXIT_CODE_OK;
    }
    if ((command & (COMMAND_CONVERT | COMMAND_INSPECT)) && options->input == NULL) {
        options->input = word;
        return EXIT_CODE_OK;
    }
    if (command & (COMMAND_CONVERT | COMMAND_INSPECT))
        return message_usage(
            "%s takes one input, but both %s and %s are given; put a pattern such as '*.exr' in quotes", command_name,
            options->input, word);
    if (command == COMMAND_COMPARE && (options->input == NULL || options->reference == NULL)) {
        *(options->input == NULL ? &options->input : &options->reference) = word;
        return EXIT_CODE_OK;
    }
    if (command == COMMAND_COMPARE)
        return message_usage("compare takes a picture and its reference, but %s is given as well; put patterns such as "
                             "'out/*.exr' in quotes",
                             word);
    if (command & COMMANDS_OF_SCENES)
        return message_usage("%s does not know what '%s' is; write --mesh or --env before a file's name", command_name,
                             word);
    return message_usage("%s does not know what '%s' is; heliostat %s --help shows what it takes", command_name, word,
                         command_name);
}

int options_parse(cli_options *options, unsigned command, const char *command_name, int count, char **arguments)
{
    set_defaults(options);
    options->word_count = count;
    options->words = arguments;
    for (int i = 0; i < count; i++) {
        int code = arguments[i][0] == '-' ? take_option(options, command, command_name, count, arguments, &i)
                                          : take_word(options, command, command_name, arguments[i]);
        if (code != EXIT_CODE_OK)
            return code;
    }
    return EXIT_CODE_OK;
}
