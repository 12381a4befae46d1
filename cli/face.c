/* SPDX-License-Identifier: MIT */
#include "face.h"

#include <math.h>

const face_frame face_frames[FACE_COUNT] = {
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
};

const char *const face_names[FACE_COUNT] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

void face_direction(int face, double u, double v, double direction[3])
{
    const face_frame *frame = &face_frames[face];
    for (int i = 0; i < 3; i++)
        direction[i] = frame->axis[i] + u * frame->right[i] + v * frame->down[i];
}

static double dot(const int axis[3], const double direction[3])
{
    return axis[0] * direction[0] + axis[1] * direction[1] + axis[2] * direction[2];
}

static uint32_t texel_of(double coordinate, uint32_t size)
{
    double position = floor((coordinate + 1) / 2 * size);
    return (uint32_t)fmin(fmax(position, 0), size - 1.0);
}

int face_project(const double direction[3], double *u, double *v)
{
    int face = 0;
    for (int i = 1; i < FACE_COUNT; i++)
        if (dot(face_frames[i].axis, direction) > dot(face_frames[face].axis, direction))
            face = i;
    const face_frame *frame = &face_frames[face];
    double distance = dot(frame->axis, direction);
    *u = dot(frame->right, direction) / distance;
    *v = dot(frame->down, direction) / distance;
    return face;
}

size_t face_texel(uint32_t size, const double direction[3])
{
    double u, v;
    size_t face = (size_t)face_project(direction, &u, &v);
    return (face * size + texel_of(v, size)) * size + texel_of(u, size);
}

/* Of the rectangle between a face's centre and (u, v), with the sign of u v. */
static double corner(double u, double v)
{
    return atan2(u * v, sqrt(1 + u * u + v * v));
}

double face_solid_angle(uint32_t size, uint32_t row, uint32_t column)
{
    double u0 = 2.0 * column / size - 1, u1 = 2.0 * (column + 1.0) / size - 1;
    double v0 = 2.0 * row / size - 1, v1 = 2.0 * (row + 1.0) / size - 1;
    return corner(u1, v1) - corner(u0, v1) - corner(u1, v0) + corner(u0, v0);
}
