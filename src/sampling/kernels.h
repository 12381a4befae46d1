/* SPDX-License-Identifier: MIT
 * kernels.h - the inner loops that are built once for each instruction set, and how to get those of one.
 *
 * The files named ..._kernel.c are compiled with HELIO_ISA, the suffix of their functions' names, and HELIO_LANES, how
 * many floats a register holds (1 for the scalar build, which also takes its elementary functions from libm). They hold
 * no state and no policy: what to compute is decided elsewhere. */
#ifndef HELIOSTAT_SRC_KERNELS_H
#define HELIOSTAT_SRC_KERNELS_H

#include "core/isa.h"
#include "sampling/tables.h"

#define KERNEL_JOIN(name, set) name##_##set
#define KERNEL_NAME(name, set) KERNEL_JOIN(name, set)
#define KERNEL(name) KERNEL_NAME(name, HELIO_ISA)

/* Prefix sums of the weights of one row of texels. rgb: [size][3]. solid_angles: [size], or NULL for luminance alone.
 * sums: [size + 1], or NULL if only the total is wanted. The same bits with every instruction set. */
typedef row_sum (*sum_row_kernel)(const float *rgb, const float *solid_angles, uint32_t size, uint32_t *sums);

typedef struct kernel_set {
    sum_row_kernel sum_row;
} kernel_set;

const kernel_set *kernels_of(isa set);

#endif
