/* SPDX-License-Identifier: MIT
 * analyzer.h - read before each file that clang-tidy analyzes: tells it that fail() never returns HELIO_OK. It cannot
 * see that from another file, and would follow paths that do not exist. */
#include "../src/core/error.h"

#define fail(status, ...) (fail(status, __VA_ARGS__), (status))
