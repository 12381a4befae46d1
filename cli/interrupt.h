/* SPDX-License-Identifier: MIT
 * interrupt.h - Ctrl-C and termination, turned into a question that the work asks now and then. */
#ifndef HELIOSTAT_CLI_INTERRUPT_H
#define HELIOSTAT_CLI_INTERRUPT_H

/* From here on the first SIGINT, SIGTERM or SIGHUP is only remembered; a second one ends the program at once. */
void interrupt_install(void);

/* The number of the signal that came, or 0. */
int interrupt_signal(void);

#endif
