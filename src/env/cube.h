/* SPDX-License-Identifier: MIT
 * cube.h - the geometry of the cube: directions, face coordinates, texels, solid angles. */
#ifndef HELIOSTAT_SRC_CUBE_H
#define HELIOSTAT_SRC_CUBE_H

#include "core/vector.h"

#include <stdbool.h>
#include <stdint.h>

enum { CUBE_FACES = 6, CUBE_MAX_SIZE = 4096 };

/* A direction on a face is axis + u * right + v * down, u and v in [-1, 1]. */
typedef struct cube_face {
    vec3 axis, right, down;
} cube_face;

/* In the order +X -X +Y -Y +Z -Z, oriented as in the cube map tables of Vulkan and OpenGL. */
extern const cube_face cube_faces[CUBE_FACES];

typedef struct cube_position {
    uint32_t face;
    float u, v;
} cube_position;

/* The face that a direction (not 0, any length) meets; u and v are right / distance and down / distance. */
typedef struct cube_meeting {
    uint32_t face;
    float right, down, distance;
} cube_meeting;

/* On edges X wins over Y over Z. By selection, as directions come in no order that a processor could guess branches
 * from; conditions made of conditions would keep loops from becoming vectors. */
static inline cube_meeting cube_meet(vec3 d)
{
    float x = fabsf(d.x), y = fabsf(d.y), z = fabsf(d.z);
    bool on_x = (x >= y) & (x >= z), y_over_z = y >= z;
    float major = on_x ? d.x : y_over_z ? d.y : d.z, sign = copysignf(1.0f, major);
    float right_off_x = y_over_z ? d.x : sign * d.x, down_off_x = y_over_z ? sign * d.z : -d.y;
    int32_t axis = on_x ? 0 : y_over_z ? 2 : 4;
    return (cube_meeting){(uint32_t)(axis + (major < 0.0f ? 1 : 0)), on_x ? -sign * d.z : right_off_x,
                          on_x ? -d.y : down_off_x, fabsf(major)};
}

/* Where a direction meets the cube. */
static inline cube_position cube_project(vec3 d)
{
    cube_meeting at = cube_meet(d);
    return (cube_position){at.face, at.right / at.distance, at.down / at.distance};
}

/* Unit vector towards a point of a face. */
static inline vec3 cube_direction_on(const cube_face *face, float u, float v)
{
    return scale(add_scaled(add_scaled(face->axis, face->right, u), face->down, v), 1.0f / sqrtf(1.0f + u * u + v * v));
}

static inline vec3 cube_direction(uint32_t face, float u, float v)
{
    return cube_direction_on(&cube_faces[face], u, v);
}

/* Row or column of a face coordinate. Both ends belong to the face, so u = 1 is in the last texel. */
static inline uint32_t cube_texel(float coordinate, uint32_t size)
{
    float position = (coordinate + 1.0f) * 0.5f * (float)size, last = (float)(size - 1);
    position = position > 0.0f ? position : 0.0f; /* also NaN */
    return (uint32_t)(int32_t)(position < last ? position : last);
}

/* Solid angle, sr, of the part of a face between its centre and the corner (u, v), with the sign of u v. */
double cube_corner_solid_angle(double u, double v);

/* Exact solid angle, sr, of a rectangle of a face. */
double cube_solid_angle(double u0, double u1, double v0, double v1);

#endif
