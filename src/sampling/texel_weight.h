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

/* solid_angles: whether they count; level: luminance that does not, or 0. */
static inline texel_weight_kind texel_weight_kind_of(bool solid_angles, float level)
{
    return !solid_angles ? WEIGHT_LUMINANCE : level > 0.0f ? WEIGHT_FLUX_ABOVE : WEIGHT_FLUX;
}

/* A quarter of the texels of a face: solid angles are taken relative to 4 / K sr, the largest that a texel of a fine
 * cube has, so that no product overflows. */
static inline float texel_quarter(uint32_t size)
{
    return 0.25f * (float)size * (float)size;
}

static inline float texel_weight(texel_weight_kind kind, vec3 radiance, float solid_angle, float quarter, float level)
{
    float light = vec3_luminance(radiance);
    float brightest = radiance.x > radiance.y ? radiance.x : radiance.y;
    brightest = brightest > radiance.z ? brightest : radiance.z;
    if (kind == WEIGHT_FLUX_ABOVE)
        brightest = light = light - level;
    float weight = light * (kind == WEIGHT_LUMINANCE ? 1.0f : solid_angle * quarter);
    float least = brightest > 0.0f ? LEAST_WEIGHT : 0.0f;
    return weight > least ? weight : least;
}

/* tables_texel_weight() from the radiance. exponent: of the row. */
static inline uint32_t texel_weight_integer(texel_weight_kind kind, vec3 radiance, float solid_angle, float quarter,
                                            float level, int32_t exponent)
{
    return fixed_point_integer(texel_weight(kind, radiance, solid_angle, quarter, level), fixed_point_power(exponent));
}

/* Index, in solid angles [R][R], of the texel in one quarter of the face that mirrors this one: the quarter is small
 * enough for a near cache. */
static inline uint32_t texel_mirrored(uint32_t size, uint32_t row, uint32_t column)
{
    const uint32_t last = size - 1;
    row = row < last - row ? row : last - row;
    column = column < last - column ? column : last - column;
    return row * size + column;
}

#endif
