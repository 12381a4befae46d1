/* SPDX-License-Identifier: MIT
 * error.h - how functions inside the library report a failure. */
#ifndef HELIOSTAT_SRC_ERROR_H
#define HELIOSTAT_SRC_ERROR_H

#include <heliostat/core.h>

/* Stores the sentence for helio_last_error() of this thread and returns status, so that a function can say
 * "return fail(HELIO_ERR_ARGUMENT, ...)". Sentences name the file or argument, the value and the way out. */
helio_status fail(helio_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Returns from the calling function if the expression is not HELIO_OK. Only where nothing needs to be released. */
#define HELIO_TRY(expression)                                                                                          \
    do {                                                                                                               \
        helio_status helio_try_status = (expression);                                                                  \
        if (helio_try_status != HELIO_OK)                                                                              \
            return helio_try_status;                                                                                   \
    } while (0)

#endif
