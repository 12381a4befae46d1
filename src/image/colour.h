/* SPDX-License-Identifier: MIT
 * colour.h - from other colour spaces to linear Rec. 709 and from there to sRGB. */
#ifndef HELIOSTAT_SRC_IMAGE_COLOUR_H
#define HELIOSTAT_SRC_IMAGE_COLOUR_H

#include <stdbool.h>
#include <stddef.h>

/* CIE 1931 xy of the primaries and of white, in the order in which OpenEXR and Radiance write them. */
typedef struct chromaticities {
    double red[2], green[2], blue[2], white[2];
} chromaticities;

typedef struct colour_matrix {
    double m[3][3]; /* new = m x old */
} colour_matrix;

/* Equal to Rec. 709 within what programs lose by rounding? */
bool colour_is_rec709(const chromaticities *space);

/* RGB of that space to Rec. 709, white to white by Bradford's adaptation. false if the numbers span no colour space. */
bool colour_to_rec709(const chromaticities *space, colour_matrix *matrix);

/* a x b */
colour_matrix colour_multiply(const colour_matrix *a, const colour_matrix *b);

/* false if there is no inverse. */
bool colour_invert(const colour_matrix *matrix, colour_matrix *inverse);

/* CIE XYZ to Rec. 709 as it stands, and back: the XYZ of D65 with Y = 1 is (1, 1, 1). */
colour_matrix colour_xyz_to_rec709(void);
colour_matrix colour_rec709_to_xyz(void);

/* out = matrix x v; out is not v. */
void colour_transform(const colour_matrix *matrix, const double v[3], double out[3]);

/* rgb: [pixels][3] */
void colour_apply(const colour_matrix *matrix, float *rgb, size_t pixels);

/* The sRGB curve (IEC 61966-2-1) on 0..1. */
double srgb_to_linear(double encoded);
float srgb_decode(float encoded);
float srgb_encode(float linear);

#endif
