/* SPDX-License-Identifier: MIT
 *
 * The kernels of one instruction set. */
#include "sampling/kernels.h"

const kernel_set KERNEL(kernels) = {
    .sum_row = KERNEL(sum_row),
    .weigh_tiles = KERNEL(weigh_tiles),
    .find_lobe_variances = KERNEL(find_lobe_variances),
    .find_moments = KERNEL(find_moments),
    .add_texels = KERNEL(add_texels),
    .sum_columns = KERNEL(sum_columns),
    .know_bin = KERNEL(know_bin),
    .weigh_point = KERNEL(weigh_point),
    .know_tiles = KERNEL(know_tiles),
    .draw_pool = KERNEL(draw_pool),
    .draw_tiles = KERNEL(draw_tiles),
    .draw_bin = KERNEL(draw_bin),
    .prepare_points = KERNEL(prepare_points),
    .round_counts = KERNEL(round_counts),
    .sum_light = KERNEL(sum_light),
    .choose_tiles = KERNEL(choose_tiles),
    .aim_surface = KERNEL(aim_surface),
    .take_tiles = KERNEL(take_tiles),
    .take_pools = KERNEL(take_pools),
    .take_surface = KERNEL(take_surface),
    .weigh = KERNEL(weigh),
    .sum_block = KERNEL(sum_block),
    .fill_background = KERNEL(fill_background),
    .fill_sky = KERNEL(fill_sky),
    .resample = KERNEL(resample),
    .may_have_faults = KERNEL(may_have_faults),
    .add_light = KERNEL(add_light),
    .aim = KERNEL(aim),
};
