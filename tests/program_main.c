/* SPDX-License-Identifier: MIT
 * The program's main(), by a name that leaves room for that of the tests. */
#include "program.h"

#define main heliostat_main
#include "../cli/main.c"
