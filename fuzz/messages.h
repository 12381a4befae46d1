/* SPDX-License-Identifier: MIT
 * messages.h - what the parsers of the program said: messages.c stands in for cli/message.c, which prints it. */
#ifndef HELIOSTAT_FUZZ_MESSAGES_H
#define HELIOSTAT_FUZZ_MESSAGES_H

#include <stddef.h>

/* How many sentences came since the last call. */
size_t messages_take(void);

#endif
