/* SPDX-License-Identifier: MIT */
#include "digest.h"

#include <string.h>

uint64_t digest_add(uint64_t digest, const void *data, size_t bytes)
{
    const unsigned char *next = data;
    while (bytes > 0) {
        uint64_t word = 0;
        size_t taken = bytes < sizeof word ? bytes : sizeof word;
        memcpy(&word, next, taken);
        digest = (digest ^ word) * UINT64_C(0x100000001b3);
        digest ^= digest >> 32; /* high bits of a word must reach the low ones, too */
        next += taken;
        bytes -= taken;
    }
    return digest;
}
