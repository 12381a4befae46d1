/* SPDX-License-Identifier: MIT
 * bench_flops.h - floating-point operations of a sample, to compare the estimate with the arithmetic peak. */
#ifndef HELIOSTAT_CLI_BENCH_FLOPS_H
#define HELIOSTAT_CLI_BENCH_FLOPS_H

#include <heliostat/sampling.h>

/* Mean over the samples of a point, with half of them for the BRDF in ..._BRDF. */
double bench_flops_per_sample(helio_strategy strategy, helio_material_kind kind);

#endif
