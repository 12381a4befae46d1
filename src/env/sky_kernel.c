/* SPDX-License-Identifier: MIT
 *
 * Radiance of the sky for rows of texels. No sum of many terms and no fused operation, so every instruction set gives
 * the same bits. */
#include "env/sky_row.h"
#include "sampling/elementary.h"
#include "sampling/kernels.h"

/* What a row's directions have in common on all faces. */
typedef struct row_terms {
    float u[SKY_ROW_PIECE], along_axis[SKY_ROW_PIECE]; /* along_axis: 1 / length of axis + u right + v down */
    float root_up[SKY_ROW_PIECE];                      /* square root of the cosine to the zenith */
    float horizon[3][SKY_ROW_PIECE];                   /* the model's first factor */
} row_terms;

/* is_top is a constant where this is expanded. */
static inline __attribute__((always_inline)) void find_terms(const sky_light *light, const sky_row *row, bool is_top,
                                                             row_terms *restrict terms)
{
    const float step = 1.0f / (float)row->size, v = row->v;
    const float h0 = light->horizon[0], h1 = light->horizon[1], h2 = light->horizon[2];
    const float e0 = light->horizon_exponent[0], e1 = light->horizon_exponent[1], e2 = light->horizon_exponent[2];
#pragma omp simd
    for (uint32_t i = 0; i < row->count; i++) {
        float u = (float)(int32_t)(2 * (row->first + i) + 1) * step - 1.0f;
        float along_axis = 1.0f / sqrtf(1.0f + u * u + v * v);
        float up = is_top ? along_axis : -v * along_axis;
        float inverse = 1.0f / (up + 0.01f);
        terms->u[i] = u;
        terms->along_axis[i] = along_axis;
        terms->root_up[i] = sqrtf(up);
        terms->horizon[0][i] = 1.0f + h0 * exp2_fast(e0 * inverse);
        terms->horizon[1][i] = 1.0f + h1 * exp2_fast(e1 * inverse);
        terms->horizon[2][i] = 1.0f + h2 * exp2_fast(e2 * inverse);
    }
}

/* One channel. versine: 1 - cos gamma. */
static inline float radiance(const sky_light *light, int channel, float horizon, float root_up, float gamma,
                             float versine)
{
    float cosine = 1.0f - versine, square = cosine * cosine;
    float q = light->mie_near[channel] + light->mie_far[channel] * versine;
    float mie = (1.0f + square) / (q * sqrtf(q));
    float value = light->constant[channel] + light->glow[channel] * exp2_fast(light->glow_exponent[channel] * gamma) +
                  light->rayleigh[channel] * square + light->mie[channel] * mie + light->zenith[channel] * root_up;
    value *= horizon;
    return (value > 0.0f ? value : 0.0f) + light->even[channel];
}

static void fill_face(const sky_light *light, const sky_row *row, const row_terms *restrict terms, uint32_t face,
                      float *restrict rgb)
{
    /* The sun in the face's own axes. */
    const cube_face *f = &cube_faces[face];
    const float axis = dot(light->sun, f->axis), right = dot(light->sun, f->right), down = dot(light->sun, f->down);
    const sky_light local = *light;
    const float v = row->v;
    float values[3][SKY_ROW_PIECE];
#pragma omp simd
    for (uint32_t i = 0; i < row->count; i++) {
        float a = terms->along_axis[i], x = a - axis, y = terms->u[i] * a - right, z = v * a - down;
        float versine = 0.5f * (x * x + y * y + z * z), gamma = angle_of_versine(versine);
        values[0][i] = radiance(&local, 0, terms->horizon[0][i], terms->root_up[i], gamma, versine);
        values[1][i] = radiance(&local, 1, terms->horizon[1][i], terms->root_up[i], gamma, versine);
        values[2][i] = radiance(&local, 2, terms->horizon[2][i], terms->root_up[i], gamma, versine);
    }
    for (uint32_t i = 0; i < row->count; i++) {
        rgb[3 * i] = values[0][i];
        rgb[3 * i + 1] = values[1][i];
        rgb[3 * i + 2] = values[2][i];
    }
}

void KERNEL(fill_sky)(const sky_light *light, const sky_row *row, float *const *rgb)
{
    row_terms terms;
    if (row->is_top) {
        find_terms(light, row, true, &terms);
        fill_face(light, row, &terms, SKY_TOP_FACE, rgb[0]);
        return;
    }
    find_terms(light, row, false, &terms);
    for (uint32_t i = 0; i < SKY_SIDE_FACES; i++)
        fill_face(light, row, &terms, sky_side_faces[i], rgb[i]);
}
