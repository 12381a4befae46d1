/* SPDX-License-Identifier: MIT
 *
 * The kernels of one instruction set. */
#include "sampling/kernels.h"

row_sum KERNEL(sum_row)(const float *rgb, const float *solid_angles, uint32_t size, uint32_t *sums);

extern const kernel_set KERNEL(kernels);
const kernel_set KERNEL(kernels) = {
    .sum_row = KERNEL(sum_row),
};
