/* SPDX-License-Identifier: MIT
 *
 * Looks for pixels that are not light, quickly: nearly all maps have none. */
#include "image/pixel_fault.h"
#include "sampling/kernels.h"

/* Numbers from 0 to the limit have bits from 0 to some limit; beyond it the sum overflows into the sign, which all
 * others have already, -0 included. */
static bool floats_may_have_faults(const float *values, int32_t count)
{
    const float brightest = PIXEL_BRIGHTEST;
    uint32_t limit, seen = 0;
    memcpy(&limit, &brightest, sizeof limit);
#pragma omp simd reduction(| : seen)
    for (int32_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        seen |= bits | (bits + (INT32_MAX - limit));
    }
    return seen >> 31;
}

/* The same for IEEE binary16, whose finite numbers are all below the limit. */
static bool halves_may_have_faults(const uint16_t *values, int32_t count)
{
    const uint16_t largest = 0x7bff;
    uint16_t seen = 0;
#pragma omp simd reduction(| : seen)
    for (int32_t i = 0; i < count; i++)
        seen |= (uint16_t)(values[i] | (uint16_t)(values[i] + (INT16_MAX - largest)));
    return seen >> 15;
}

bool KERNEL(may_have_faults)(const void *numbers, uint32_t count, map_numbers kind)
{
    return kind == MAP_FLOATS   ? floats_may_have_faults(numbers, (int32_t)count)
           : kind == MAP_HALVES ? halves_may_have_faults(numbers, (int32_t)count)
                                : false;
}
