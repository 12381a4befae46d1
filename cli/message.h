/* SPDX-License-Identifier: MIT
 * message.h - what the program says on stderr, and the exit codes that go with it. */
#ifndef HELIOSTAT_CLI_MESSAGE_H
#define HELIOSTAT_CLI_MESSAGE_H

enum {
    EXIT_CODE_OK = 0,
    EXIT_CODE_FAILED = 1,  /* the command line is fine, but the work could not be done */
    EXIT_CODE_USAGE = 2,   /* the command line is wrong; nothing was read or written */
    EXIT_CODE_SIGNAL = 128 /* plus the number of the signal that stopped the program */
};

/* Each prints one sentence and returns its exit code, so that a function can say "return message_usage(...)". */
int message_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));
int message_failure(const char *format, ...) __attribute__((format(printf, 1, 2)));

void message_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
void message_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* ---- a line that is drawn again and again, such as a progress bar; messages go above it ------------------------ */

/* Columns that a drawn line may fill: those of the terminal at this moment, but for the last one, where some wrap. */
unsigned message_line_width(void);

/* Text of ASCII; what is longer than that is cut. */
void message_draw_line(const char *text);
void message_clear_line(void);

#endif
