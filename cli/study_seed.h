/* SPDX-License-Identifier: MIT
 * study_seed.h - random samples that no two renders of a study share. */
#ifndef HELIOSTAT_CLI_STUDY_SEED_H
#define HELIOSTAT_CLI_STUDY_SEED_H

#include <stdint.h>

/* The finaliser of MurmurHash3. */
static inline uint32_t study_seed(uint32_t seed, uint32_t index)
{
    uint32_t hash = seed * 0x9e3779b1u ^ index;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

#endif
