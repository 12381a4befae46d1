/* SPDX-License-Identifier: MIT
 * sanitized.h - is this a build with address or thread sanitizer? */
#ifndef HELIOSTAT_SRC_CORE_SANITIZED_H
#define HELIOSTAT_SRC_CORE_SANITIZED_H

#include <stdbool.h>

#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || __has_feature(address_sanitizer) ||               \
    __has_feature(thread_sanitizer)
enum { SANITIZED = true };
#else
enum { SANITIZED = false };
#endif

#endif
