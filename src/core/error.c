/* SPDX-License-Identifier: MIT */
#include "core/error.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char last_error[1024];

helio_status fail(helio_status status, const char *format, ...)
{
    /* By way of a second buffer, because an argument may be the last error itself. */
    char sentence[sizeof last_error];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    snprintf(last_error, sizeof last_error, "%s", sentence);
    return status;
}

const char *helio_last_error(void)
{
    return last_error;
}

const char *helio_status_name(helio_status status)
{
    switch (status) {
    case HELIO_OK: return "HELIO_OK";
    case HELIO_ERR_ARGUMENT: return "HELIO_ERR_ARGUMENT";
    case HELIO_ERR_MEMORY: return "HELIO_ERR_MEMORY";
    case HELIO_ERR_UNSUPPORTED: return "HELIO_ERR_UNSUPPORTED";
    case HELIO_ERR_IO: return "HELIO_ERR_IO";
    case HELIO_ERR_DATA: return "HELIO_ERR_DATA";
    case HELIO_ERR_DEVICE: return "HELIO_ERR_DEVICE";
    }
    return "unknown status";
}

uint32_t helio_version(void)
{
    return HELIO_VERSION;
}
