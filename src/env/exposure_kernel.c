/* SPDX-License-Identifier: MIT
 *
 * Adds texels to what an exposure is measured by. Columns are summed apart, so that every instruction set gives the
 * same bits. */
#include "core/vector.h"
#include "env/exposure.h"
#include "sampling/kernels.h"

void KERNEL(add_light)(const float *restrict rgb, const float *restrict solid_angles, float v, uint32_t count,
                       exposure_columns *restrict sums)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        float value = luminance(rgb + 3 * (size_t)i), u = sums->u[i], flux = value * solid_angles[i];
        float along_axis = flux / sqrtf(1.0f + u * u + v * v);
        sums->flux[i] += flux;
        sums->along_axis[i] += along_axis;
        sums->along_down[i] += along_axis * v;
        sums->brightest[i] = value > sums->brightest[i] ? value : sums->brightest[i];
    }
}
