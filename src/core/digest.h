/* SPDX-License-Identifier: MIT
 * digest.h - 64 bits that stand for any number of bytes: equal bytes give equal digests on every machine, others almost
 * surely do not. It finds damage and mistakes, but is no guard against somebody who wants two to be equal. */
#ifndef HELIOSTAT_SRC_DIGEST_H
#define HELIOSTAT_SRC_DIGEST_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline uint64_t digest_word(uint64_t digest, uint64_t word)
{
    uint64_t x = digest ^ word; /* the finaliser of MurmurHash3, for each word */
    x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
    x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
    return (x ^ x >> 33) + UINT64_C(0x9e3779b97f4a7c15);
}

/* Up to eight bytes, the first one lowest. */
static inline uint64_t digest_load(const unsigned char *bytes, size_t count)
{
    uint64_t word = 0;
    for (size_t i = 0; i < count; i++)
        word |= (uint64_t)bytes[i] << (8 * i);
    return word;
}

/* Goes on from a digest, which is 0 to begin with. */
static inline uint64_t digest_bytes(uint64_t digest, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    size_t left = size;
    for (; left >= 8; left -= 8, at += 8)
        digest = digest_word(digest, digest_load(at, 8));
    return digest_word(digest_word(digest, digest_load(at, left)), size);
}

static inline uint64_t digest_float(uint64_t digest, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return digest_word(digest, bits);
}

static inline uint64_t digest_double(uint64_t digest, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return digest_word(digest, bits);
}

static inline uint64_t digest_floats(uint64_t digest, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        digest = digest_float(digest, values[i]);
    return digest_word(digest, count);
}

#endif
