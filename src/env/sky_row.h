/* SPDX-License-Identifier: MIT
 * sky_row.h - a piece of a row of directions, at which a kernel evaluates the sky on one face or on four. */
#ifndef HELIOSTAT_SRC_SKY_ROW_H
#define HELIOSTAT_SRC_SKY_ROW_H

#include "env/cube.h"
#include "env/sky_model.h"

enum { SKY_ROW_PIECE = 256, SKY_TOP_FACE = 2, SKY_GROUND_FACE = 3, SKY_SIDE_FACES = 4 };

/* The faces that see the sky in their upper halves. A row at the same height is the same on all of them, but for the
 * sun. */
extern const uint32_t sky_side_faces[SKY_SIDE_FACES];

/* The centres of texels first ... first + count - 1 of a row of `size` texels at the face coordinate v. */
typedef struct sky_row {
    uint32_t size, first, count; /* count at most SKY_ROW_PIECE */
    float v;                     /* not below the horizon: at most 0 on the side faces */
    bool is_top;                 /* of the top face; otherwise of all side faces */
} sky_row;

#endif
