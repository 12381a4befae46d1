/* SPDX-License-Identifier: MIT
 * vector.h - the little three-dimensional arithmetic that everything needs. */
#ifndef HELIOSTAT_SRC_VECTOR_H
#define HELIOSTAT_SRC_VECTOR_H

#include <math.h>

#define PI 3.14159265358979323846

typedef struct vec3 {
    float x, y, z;
} vec3;

static inline vec3 vec3_from(const float a[3])
{
    return (vec3){a[0], a[1], a[2]};
}

static inline void vec3_to(vec3 a, float out[3])
{
    out[0] = a.x;
    out[1] = a.y;
    out[2] = a.z;
}

static inline vec3 add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 subtract(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 scale(vec3 a, float s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

/* a + s b */
static inline vec3 add_scaled(vec3 a, vec3 b, float s)
{
    return (vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float length(vec3 a)
{
    return sqrtf(dot(a, a));
}

static inline vec3 normalize(vec3 a)
{
    return scale(a, 1.0f / length(a));
}

/* Two tangents that make a right-handed frame with the unit vector n, without a branch that depends on n's direction
 * except for a sign: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. */
static inline void tangent_frame(vec3 n, vec3 *tangent, vec3 *bitangent)
{
    float sign = copysignf(1.0f, n.z);
    float a = -1.0f / (sign + n.z);
    float b = n.x * n.y * a;
    *tangent = (vec3){1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    *bitangent = (vec3){b, sign + n.y * n.y * a, -n.y};
}

static inline float vec3_luminance(vec3 colour)
{
    return 0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z;
}

static inline float luminance(const float rgb[3])
{
    return vec3_luminance((vec3){rgb[0], rgb[1], rgb[2]});
}

#endif
