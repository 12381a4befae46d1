/* SPDX-License-Identifier: MIT */
#include "env/projection.h"

#include "core/vector.h"

/* ---- folded squares ---- */

/* Point of the octahedron |x| + |y| + |z| = 1, folded open: the lower faces are the corners of the square. */
static direction unfold_octahedron(double right, double down)
{
    double x = right, z = -down, y = 1.0 - fabs(right) - fabs(down);
    if (y < 0.0) {
        x = copysign(1.0 - fabs(down), right);
        z = -copysign(1.0 - fabs(right), down);
    }
    return (direction){x, y, z};
}

static direction find_octahedral(double right, double down)
{
    direction p = unfold_octahedron(right, down);
    double scale_by = 1.0 / sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    return (direction){p.x * scale_by, p.y * scale_by, p.z * scale_by};
}

static double octahedral_density(double right, double down)
{
    direction p = unfold_octahedron(right, down);
    return pow(p.x * p.x + p.y * p.y + p.z * p.z, -1.5);
}

/* Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", Journal of Graphics Tools 13(3), 2008: squares
 * around the centre become circles of latitude, with their corners on the diagonals. */
static direction find_equal_area(double right, double down)
{
    double u = fabs(right), v = fabs(down), from_fold = 1.0 - u - v;
    double r = 1.0 - fabs(from_fold), angle = r > 0.0 ? ((v - u) / r + 1.0) * (PI / 4) : PI / 4;
    double radius = r * sqrt(2.0 - r * r);
    return (direction){copysign(radius * cos(angle), right), copysign(1.0 - r * r, from_fold),
                       -copysign(radius * sin(angle), down)};
}

static double equal_area_density(double right, double down)
{
    (void)right;
    (void)down;
    return PI;
}

/* ---- discs ---- */

static direction find_angular(double right, double down)
{
    double radius = sqrt(right * right + down * down), angle = PI * radius;
    double scale_by = radius > 0.0 ? sin(angle) / radius : 0.0;
    return (direction){right * scale_by, -down * scale_by, -cos(angle)};
}

static double angular_density(double right, double down)
{
    double radius = sqrt(right * right + down * down);
    return radius > 0.0 ? PI * sin(PI * radius) / radius : PI * PI;
}

/* radius = sin(angle / 2): sin(angle) = 2 radius sqrt(1 - radius^2), cos(angle) = 1 - 2 radius^2. */
static direction find_mirrorball(double right, double down)
{
    double square = right * right + down * down, scale_by = 2.0 * sqrt(square < 1.0 ? 1.0 - square : 0.0);
    return (direction){right * scale_by, -down * scale_by, 2.0 * square - 1.0};
}

static double mirrorball_density(double right, double down)
{
    (void)right;
    (void)down;
    return 4.0;
}

const projection *projection_of(helio_layout layout)
{
    static const projection octahedral = {find_octahedral, octahedral_density, false, 2};
    static const projection equal_area = {find_equal_area, equal_area_density, false, 2};
    static const projection angular = {find_angular, angular_density, true, 1};
    static const projection mirrorball = {find_mirrorball, mirrorball_density, true, 1};
    switch (layout) {
    case HELIO_LAYOUT_OCTAHEDRAL: return &octahedral;
    case HELIO_LAYOUT_EQUAL_AREA: return &equal_area;
    case HELIO_LAYOUT_ANGULAR: return &angular;
    case HELIO_LAYOUT_MIRRORBALL: return &mirrorball;
    default: return NULL;
    }
}
