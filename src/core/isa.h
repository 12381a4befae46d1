/* SPDX-License-Identifier: MIT
 * isa.h - the instruction sets that kernels are built for, and which of them this machine runs.
 *
 * Kernel files are compiled once for each: cmake/HeliostatKernels.cmake defines HELIO_ISA (the suffix of their names)
 * and HELIO_LANES (how many floats a register holds). "scalar" is the definition that the others are compared with. */
#ifndef HELIOSTAT_SRC_ISA_H
#define HELIOSTAT_SRC_ISA_H

#include <heliostat/core.h>

typedef enum isa {
    ISA_SCALAR = 0,
#ifdef HELIO_KERNELS_X86
    ISA_SSE2,
    ISA_AVX2, /* with FMA */
    ISA_AVX512,
#else
    ISA_SIMD, /* what the compiler's target has */
#endif
    ISA_COUNT
} isa;

const char *isa_name(isa set);

/* Does this machine run it? */
bool isa_is_supported(isa set);

/* The set of that name; where name is NULL or empty that of the environment variable HELIOSTAT_ISA; where that is unset
 * or empty the best that the machine has. HELIO_ERR_ARGUMENT for a name that is none, HELIO_ERR_UNSUPPORTED where the
 * machine lacks it. */
helio_status isa_choose(const char *name, isa *set);

#endif
