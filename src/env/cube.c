/* SPDX-License-Identifier: MIT */
#include "env/cube.h"

const cube_face cube_faces[CUBE_FACES] = {
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
};

double cube_corner_solid_angle(double u, double v)
{
    return atan2(u * v, sqrt(1.0 + u * u + v * v));
}

double cube_solid_angle(double u0, double u1, double v0, double v1)
{
    return (cube_corner_solid_angle(u1, v1) - cube_corner_solid_angle(u0, v1)) -
           (cube_corner_solid_angle(u1, v0) - cube_corner_solid_angle(u0, v0));
}
