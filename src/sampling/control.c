/* SPDX-License-Identifier: MIT */
#include "sampling/control.h"

#include "core/context.h"
#include "sampling/kernels.h"

helio_status control_create(helio_context *context, const normal_bins *bins, light_control **out)
{
    light_control *c = context_allocate(context, 1, sizeof *c);
    if (c == NULL)
        return HELIO_ERR_MEMORY;
    c->context = context;
    c->bins = bins->count;
    c->chunks = bins->pool_length / CONTROL_CHUNK;
    c->known = context_allocate(context, c->bins, sizeof *c->known);
    c->sums = context_allocate(context, c->bins, (c->chunks + (size_t)1) * sizeof *c->sums);
    if (c->known == NULL || c->sums == NULL) {
        control_destroy(c);
        return HELIO_ERR_MEMORY;
    }
    *out = c;
    return HELIO_OK;
}

void control_destroy(light_control *c)
{
    if (c == NULL)
        return;
    context_release(c->context, c->sums);
    context_release(c->context, c->known);
    context_release(c->context, c);
}

/* ---- light of the bins ---- */

typedef struct control_work {
    light_control *control;
    const normal_bins *bins;
    const kernel_set *kernels;
} control_work;

static void know_bin(void *data, size_t bin)
{
    const control_work *work = data;
    light_control *c = work->control;
    work->kernels->know_bin(work->bins->tiles, &work->bins->bins[bin], &c->known[bin]);
}

void control_update(light_control *c, const normal_bins *bins)
{
    control_work work = {c, bins, kernels_of(context_isa(c->context))};
    context_parallel_for(c->context, bins->count, know_bin, &work);
}

/* ---- samples ---- */

float control_finite(float x)
{
    return isfinite(x) ? x : 0.0f;
}

vec3 control_difference(const light_control *c, uint32_t bin, uint32_t first, uint32_t count, vec3 normal)
{
    const uint32_t chunks = count / CONTROL_CHUNK;
    if (chunks == 0)
        return (vec3){0, 0, 0};
    const control_matrix *start = control_sums(c, bin) + first / CONTROL_CHUNK, *end = start + chunks;
    const control_matrix *known = &c->known[bin];
    const float factor = 1.0f / (float)(chunks * CONTROL_CHUNK), n[4] = {normal.x, normal.y, normal.z, 1.0f};
    float sum[4] = {0};
    for (int row = 0; row < 4; row++)
        for (int i = 0; i < 4; i++)
            sum[i] += n[row] * (known->rows[row][i] - factor * (end->rows[row][i] - start->rows[row][i]));
    return (vec3){control_finite(sum[0]), control_finite(sum[1]), control_finite(sum[2])};
}
