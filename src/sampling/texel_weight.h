/* SPDX-License-Identifier: MIT
 * texel_weight.h - what the tables hold of a texel: its light, and the integer that this becomes in its row. From the
 * same radiance comes the same integer on every instruction set, so that who has just read a texel need not read the
 * tables as well. */
#ifndef HELIOSTAT_SRC_TEXEL_WEIGHT_H
#define HELIOSTAT_SRC_TEXEL_WEIGHT_H

#include "sampling/fixed_point.h"
#include "sampling/tables.h"

/* Constants where they are expanded. */
typedef enum texel_weight_kind {
    WEIGHT_LUMINANCE,
    WEIGHT_FLUX,       /* luminance x solid angle */
    WEIGHT_FLUX_ABOVE, /* the same of what the luminance has above a level */
} texel_weight_kind;

/* A texel that is lit weighs at least this much, the smallest float that no machine flushes to zero. */
static const float LEAST_WEIGHT = 0x1p-126f;

/* Luminance x relative solid angle. Relative to 4 / K sr, the largest that a texel of a fine cube has, so that no
 * product overflows. */
static inline float texel_weight(texel_weight_kind kind, vec3 radiance, float relative_solid_angle, float level)
{
    float light = vec3_luminance(radiance);
    float brightest = radiance.x > radiance.y ? radiance.x : radiance.y;
    brightest = brightest > radiance.z ? brightest : radiance.z;
    if (kind == WEIGHT_FLUX_ABOVE)
        brightest = light = light - level;
    float weight = light * relative_solid_angle;
    float least = brightest > 0.0f ? LEAST_WEIGHT : 0.0f;
    return weight > least ? weight : least;
}

/* What the weights of a texel are made of besides its radiance. */
typedef struct texel_weighting {
    float relative_solid_angle; /* 1 where luminance alone counts */
    int32_t exponent;           /* of its row */
} texel_weighting;

/* The solid angle is that of the mirrored texel in one quarter of the face, which is small enough for a near cache. */
static inline texel_weighting texel_weighting_at(const helio_tables *tables, const face_place *at)
{
    const uint32_t size = tables->size, last = size - 1;
    const uint32_t row = at->row < last - at->row ? at->row : last - at->row;
    const uint32_t column = at->column < last - at->column ? at->column : last - at->column;
    const float quarter_texels = 0.25f * (float)size * (float)size;
    const float solid_angle = tables->environment->solid_angle[(size_t)row * size + column];
    return (texel_weighting){tables->weighting == HELIO_WEIGHTING_PAPER ? 1.0f : solid_angle * quarter_texels,
                             tables->row_sums[(size_t)at->face * size + at->row].exponent};
}

/* tables_texel_weight() of the texel that has this radiance. kind: LUMINANCE may be taken for FLUX. */
static inline uint32_t texel_weight_integer(texel_weight_kind kind, vec3 radiance, float level,
                                            float relative_solid_angle, int32_t exponent)
{
    const float factor = float_of_bits((exponent + 127) * (1 << 23));
    return fixed_point_integer(texel_weight(kind, radiance, relative_solid_angle, level), factor);
}

#endif
