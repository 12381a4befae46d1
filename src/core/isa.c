/* SPDX-License-Identifier: MIT */
#include "core/isa.h"

#include "core/error.h"
#include "core/name_list.h"

#include <stdlib.h>

#ifdef HELIO_KERNELS_X86
static const char *const NAMES[] = {"scalar", "sse2", "avx2", "avx512"};
#else
static const char *const NAMES[] = {"scalar", "simd"};
#endif
static const name_list SETS = NAME_LIST("instruction set", NAMES);

const char *isa_name(isa set)
{
    return name_list_get(&SETS, (int)set);
}

bool isa_is_supported(isa set)
{
#ifdef HELIO_KERNELS_X86
    if (set == ISA_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (set == ISA_AVX2)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
    return set >= ISA_SCALAR && set < ISA_COUNT;
}

static isa best(void)
{
    isa set = (isa)(ISA_COUNT - 1);
    while (!isa_is_supported(set))
        set = (isa)(set - 1);
    return set;
}

helio_status isa_choose(const char *name, isa *set)
{
    if (name == NULL || name[0] == '\0')
        name = getenv("HELIOSTAT_ISA");
    if (name == NULL || name[0] == '\0') {
        *set = best();
        return HELIO_OK;
    }
    int value;
    HELIO_TRY(name_list_find(&SETS, name, &value));
    if (!isa_is_supported((isa)value))
        return fail(HELIO_ERR_UNSUPPORTED, "this machine has no %s; use %s or leave HELIOSTAT_ISA unset", name,
                    isa_name(best()));
    *set = (isa)value;
    return HELIO_OK;
}

const char *helio_isa_name(uint32_t index)
{
    for (int set = ISA_SCALAR; set < ISA_COUNT; set++)
        if (isa_is_supported((isa)set) && index-- == 0)
            return isa_name((isa)set);
    return NULL;
}
