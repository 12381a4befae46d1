/* SPDX-License-Identifier: MIT
 * face.h - the geometry of the cube's faces, as include/heliostat/environment.h defines them. */
#ifndef HELIOSTAT_CLI_FACE_H
#define HELIOSTAT_CLI_FACE_H

#include <stddef.h>
#include <stdint.h>

enum { FACE_COUNT = 6 };

/* A direction on a face is axis + u right + v down, u and v in -1..1: columns grow with u, rows with v. */
typedef struct face_frame {
    int axis[3], right[3], down[3];
} face_frame;

extern const face_frame face_frames[FACE_COUNT];
extern const char *const face_names[FACE_COUNT]; /* "+X" and so on */

/* Not of unit length. */
void face_direction(int face, double u, double v, double direction[3]);

/* The face that a direction of any length meets, and where. */
int face_project(const double direction[3], double *u, double *v);

/* The texel of a cube [6][size][size] that a direction of any length meets. */
size_t face_texel(uint32_t size, const double direction[3]);

/* Of a texel in any face, sr. */
double face_solid_angle(uint32_t size, uint32_t row, uint32_t column);

#endif
