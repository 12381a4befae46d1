/* SPDX-License-Identifier: MIT
 *
 * Command lines: the first byte chooses the command, the rest is its arguments, each ended by a newline or the end. No
 * command is run. */
#include "fuzz.h"
#include "messages.h"

#include "message.h"
#include "options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ARGUMENTS = 40 };

static int split(const uint8_t *data, size_t size, char *arguments[MAX_ARGUMENTS + 1])
{
    int count = 0;
    while (size > 0 && count < MAX_ARGUMENTS) {
        const uint8_t *end = memchr(data, '\n', size);
        size_t length = end ? (size_t)(end - data) : size;
        arguments[count++] = fuzz_text(data, length);
        size_t used = end ? length + 1 : length;
        data += used;
        size -= used;
    }
    arguments[count] = NULL;
    return count;
}

static void check_range(const cli_option *option, double value)
{
    bool is_default = option->initial == NULL && value == 0.0;
    FUZZ_EXPECT(is_default || (value >= option->minimum && value <= option->maximum));
}

static void check_frames(const cli_option *option, const frame_range *range)
{
    if (!range->is_given)
        return;
    check_range(option, range->first);
    check_range(option, range->last);
    FUZZ_EXPECT(range->first <= range->last);
}

/* The member that belongs to this option holds what its kind promises. */
static void check_option(const cli_option *option, const cli_options *options)
{
    const void *member = (const char *)options + option->offset;
    const char *text;
    char choices[256];
    switch (option->kind) {
    case OPTION_FLAG: return;
    case OPTION_TEXT:
    case OPTION_CHOICE:
        text = *(const char *const *)member;
        FUZZ_EXPECT(text == NULL ? option->initial == NULL : text[0] != 0);
        if (option->kind == OPTION_CHOICE && text != NULL) {
            option_choices(option, choices, sizeof choices);
            FUZZ_EXPECT(strstr(choices, text) != NULL);
        }
        return;
    case OPTION_WHOLE:
    case OPTION_POWER: check_range(option, *(const uint32_t *)member); return;
    case OPTION_EXPOSURE:
        if (isnan(*(const double *)member))
            return;
        check_range(option, *(const double *)member);
        return;
    case OPTION_NUMBER: check_range(option, *(const double *)member); return;
    case OPTION_RANGE: check_frames(option, member); return;
    case OPTION_SIZE:
        check_range(option, ((const uint32_t *)member)[0]);
        check_range(option, ((const uint32_t *)member)[1]);
        return;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    unsigned command = 1u << data[0] % 16 & COMMAND_ALL;
    if (command == 0)
        command = COMMAND_RENDER;
    char *arguments[MAX_ARGUMENTS + 1];
    int count = split(data + 1, size - 1, arguments);

    cli_options options;
    messages_take();
    int code = options_parse(&options, command, "command", count, arguments);
    size_t sentences = messages_take();
    FUZZ_EXPECT(code == EXIT_CODE_OK ? sentences == 0 : code == EXIT_CODE_USAGE && sentences == 1);
    for (size_t i = 0; code == EXIT_CODE_OK && i < option_count; i++)
        check_option(&option_table[i], &options);
    for (int i = 0; i < count; i++)
        free(arguments[i]);
    return 0;
}
