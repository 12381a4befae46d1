/* SPDX-License-Identifier: MIT */
#include "message.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>

enum { LINE_WIDTH = 78 };

static atomic_bool line_is_drawn;

/* Names and texts of files may hold control characters, ASCII's and U+0080 to U+009F, which a terminal would obey. */
static void clean(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c != 0; c++)
        if (*c < ' ' || *c == 0x7f)
            *c = '?';
        else if (*c == 0xc2 && c[1] >= 0x80 && c[1] <= 0x9f)
            *c = c[1] = '?';
}

/* Padded to full width, so that nothing of a longer line stays behind it. */
void message_draw_line(const char *text)
{
    atomic_store(&line_is_drawn, true);
    fprintf(stderr, "\r%-*.*s", LINE_WIDTH, LINE_WIDTH, text);
    fflush(stderr);
}

void message_clear_line(void)
{
    if (atomic_exchange(&line_is_drawn, false)) {
        fprintf(stderr, "\r%*s\r", LINE_WIDTH, "");
        fflush(stderr);
    }
}

/* One call of fprintf for the whole line, so that lines of different threads do not mix. */
static void print_line(const char *kind, const char *format, va_list arguments)
{
    char sentence[8192];
    vsnprintf(sentence, sizeof sentence, format, arguments);
    clean(sentence);
    message_clear_line();
    fprintf(stderr, "heliostat: %s%s\n", kind, sentence);
}

int message_usage(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
    return EXIT_CODE_USAGE;
}

int message_failure(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
    return EXIT_CODE_FAILED;
}

void message_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("warning: ", format, arguments);
    va_end(arguments);
}

void message_note(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
}
