/* SPDX-License-Identifier: MIT
 * machine.h - the machine that the program runs on: its clock, its processor. */
#ifndef HELIOSTAT_CLI_MACHINE_H
#define HELIOSTAT_CLI_MACHINE_H

#include <stddef.h>

/* Of a monotonic clock. */
double machine_milliseconds(void);

/* Logical cores that this process may use, at least 1. */
unsigned machine_cores(void);

/* The processor's name, as its maker gives it; "unknown processor" where the system does not tell. */
void machine_processor(char *name, size_t size);

#endif
