/* SPDX-License-Identifier: MIT */
#include "sampling/kernels.h"

extern const kernel_set kernels_scalar;
#ifdef HELIO_KERNELS_X86
extern const kernel_set kernels_sse2, kernels_avx2, kernels_avx512;
#else
extern const kernel_set kernels_simd;
#endif

const kernel_set *kernels_of(isa set)
{
    static const kernel_set *const sets[ISA_COUNT] = {
        [ISA_SCALAR] = &kernels_scalar,
#ifdef HELIO_KERNELS_X86
        [ISA_SSE2] = &kernels_sse2,
        [ISA_AVX2] = &kernels_avx2,
        [ISA_AVX512] = &kernels_avx512,
#else
        [ISA_SIMD] = &kernels_simd,
#endif
    };
    return sets[set];
}
