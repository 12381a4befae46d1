/* SPDX-License-Identifier: MIT
 * digest.h - a number that tells whether data is the same as before (64-bit FNV-1a, over words of 8 bytes). */
#ifndef HELIOSTAT_CLI_DIGEST_H
#define HELIOSTAT_CLI_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#define DIGEST_START UINT64_C(0xcbf29ce484222325)

/* Goes on from the digest of what came before. */
uint64_t digest_add(uint64_t digest, const void *data, size_t bytes);

#endif
