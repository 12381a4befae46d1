/* SPDX-License-Identifier: MIT */
#include "message.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { USUAL_WIDTH = 79, GREATEST_WIDTH = 120 };

static atomic_uint drawn_width; /* of the line that is on the terminal; 0: there is none */

/* Names and texts of files may hold control characters, ASCII's and U+0080 to U+009F, which a terminal would obey. */
static void clean(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c != 0; c++)
        if (*c < ' ' || *c == 0x7f)
            *c = '?';
        else if (*c == 0xc2 && c[1] >= 0x80 && c[1] <= 0x9f)
            *c = c[1] = '?';
}

unsigned message_line_width(void)
{
    struct winsize size;
    bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    unsigned width = is_known ? size.ws_col - 1U : USUAL_WIDTH;
    return width < GREATEST_WIDTH ? width : GREATEST_WIDTH;
}

/* Padded, so that nothing of a longer line stays behind it; but a terminal may have become narrower since. */
static void draw_line(const char *text, unsigned before, unsigned width, const char *end)
{
    int padded = (int)(before < width ? before : width);
    fprintf(stderr, "\r%-*.*s%s", padded, (int)width, text, end);
    fflush(stderr);
}

void message_draw_line(const char *text)
{
    unsigned width = message_line_width(), length = (unsigned)strlen(text);
    unsigned before = atomic_exchange(&drawn_width, length < width ? length : width);
    draw_line(text, before, width, "");
}

void message_clear_line(void)
{
    unsigned before = atomic_exchange(&drawn_width, 0);
    if (before > 0)
        draw_line("", before, message_line_width(), "\r");
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
