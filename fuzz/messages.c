/* SPDX-License-Identifier: MIT */
#include "messages.h"

#include "fuzz.h"
#include "message.h"

#include <stdarg.h>
#include <stdio.h>

static size_t count;

size_t messages_take(void)
{
    size_t taken = count;
    count = 0;
    return taken;
}

/* Puts the sentence together, as printing it would. */
static void hear(const char *format, va_list arguments)
{
    char sentence[8192];
    FUZZ_EXPECT(vsnprintf(sentence, sizeof sentence, format, arguments) > 0);
    count++;
}

int message_usage(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    hear(format, arguments);
    va_end(arguments);
    return EXIT_CODE_USAGE;
}

int message_failure(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    hear(format, arguments);
    va_end(arguments);
    return EXIT_CODE_FAILED;
}

void message_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    hear(format, arguments);
    va_end(arguments);
}

void message_note(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    hear(format, arguments);
    va_end(arguments);
}
