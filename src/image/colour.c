/* SPDX-License-Identifier: MIT */
#include "image/colour.h"

#include <math.h>

static const chromaticities REC709 = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/* Lam's Bradford matrix: XYZ to sharpened cone responses. */
static const colour_matrix BRADFORD = {
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

bool colour_is_rec709(const chromaticities *space)
{
    const double tolerance = 1e-4;
    const double *pairs[4][2] = {{space->red, REC709.red},
                                 {space->green, REC709.green},
                                 {space->blue, REC709.blue},
                                 {space->white, REC709.white}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 2; c++)
            if (!(fabs(pairs[i][0][c] - pairs[i][1][c]) <= tolerance))
                return false;
    return true;
}

void colour_transform(const colour_matrix *a, const double v[3], double out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = a->m[row][0] * v[0] + a->m[row][1] * v[1] + a->m[row][2] * v[2];
}

colour_matrix colour_multiply(const colour_matrix *a, const colour_matrix *b)
{
    colour_matrix product;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            product.m[row][column] =
                a->m[row][0] * b->m[0][column] + a->m[row][1] * b->m[1][column] + a->m[row][2] * b->m[2][column];
    return product;
}

static double cofactor(const colour_matrix *a, int row, int column)
{
    int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return a->m[r1][c1] * a->m[r2][c2] - a->m[r1][c2] * a->m[r2][c1];
}

bool colour_invert(const colour_matrix *a, colour_matrix *inverse)
{
    double determinant = 0;
    for (int column = 0; column < 3; column++)
        determinant += a->m[0][column] * cofactor(a, 0, column);
    if (!(fabs(determinant) > 1e-9) || !isfinite(determinant))
        return false;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            inverse->m[column][row] = cofactor(a, row, column) / determinant;
    return true;
}

/* XYZ of a chromaticity with Y = 1. */
static bool xyz_from_xy(const double xy[2], double xyz[3])
{
    if (!(fabs(xy[1]) > 1e-6) || !(fabs(xy[0]) < 1e6) || !(fabs(xy[1]) < 1e6))
        return false;
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1;
    xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
    return true;
}

/* RGB to XYZ, where RGB (1, 1, 1) has the XYZ of white with Y = 1. */
static bool matrix_to_xyz(const chromaticities *space, colour_matrix *matrix)
{
    const double *primaries[3] = {space->red, space->green, space->blue};
    colour_matrix columns, inverse;
    for (int column = 0; column < 3; column++) {
        columns.m[0][column] = primaries[column][0];
        columns.m[1][column] = primaries[column][1];
        columns.m[2][column] = 1 - primaries[column][0] - primaries[column][1];
    }
    double white[3], amounts[3];
    if (!xyz_from_xy(space->white, white) || !colour_invert(&columns, &inverse))
        return false;
    colour_transform(&inverse, white, amounts);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            matrix->m[row][column] = columns.m[row][column] * amounts[column];
    return true;
}

/* XYZ under one white to the XYZ of the corresponding colour under the other. */
static bool adaptation(const double from[2], const double to[2], colour_matrix *matrix)
{
    double from_xyz[3], to_xyz[3], from_cone[3], to_cone[3];
    if (!xyz_from_xy(from, from_xyz) || !xyz_from_xy(to, to_xyz))
        return false;
    colour_transform(&BRADFORD, from_xyz, from_cone);
    colour_transform(&BRADFORD, to_xyz, to_cone);
    colour_matrix scaled = BRADFORD, inverse;
    for (int row = 0; row < 3; row++) {
        if (!(from_cone[row] > 1e-6))
            return false;
        for (int column = 0; column < 3; column++)
            scaled.m[row][column] *= to_cone[row] / from_cone[row];
    }
    colour_invert(&BRADFORD, &inverse);
    *matrix = colour_multiply(&inverse, &scaled);
    return true;
}

bool colour_to_rec709(const chromaticities *space, colour_matrix *matrix)
{
    colour_matrix to_xyz, adapt;
    if (!matrix_to_xyz(space, &to_xyz) || !adaptation(space->white, REC709.white, &adapt))
        return false;
    colour_matrix adapted = colour_multiply(&adapt, &to_xyz), from_xyz = colour_xyz_to_rec709();
    *matrix = colour_multiply(&from_xyz, &adapted);
    for (int i = 0; i < 9; i++)
        if (!(fabs(matrix->m[i / 3][i % 3]) < 1e3))
            return false;
    return true;
}

colour_matrix colour_rec709_to_xyz(void)
{
    colour_matrix to_xyz;
    matrix_to_xyz(&REC709, &to_xyz);
    return to_xyz;
}

colour_matrix colour_xyz_to_rec709(void)
{
    colour_matrix to_xyz = colour_rec709_to_xyz(), from_xyz;
    colour_invert(&to_xyz, &from_xyz);
    return from_xyz;
}

void colour_apply(const colour_matrix *matrix, float *rgb, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        double old[3] = {(double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]}, converted[3];
        colour_transform(matrix, old, converted);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] = (float)converted[c];
    }
}

double srgb_to_linear(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

float srgb_decode(float encoded)
{
    return (float)srgb_to_linear((double)encoded);
}

float srgb_encode(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}
