/* SPDX-License-Identifier: MIT
 * horizon.h - great circles as straight lines on a face, and what lies above them. */
#ifndef HELIOSTAT_SRC_HORIZON_H
#define HELIOSTAT_SRC_HORIZON_H

#include "eval/light_tree.h"

enum { HORIZON_LIMIT = 3, POLYGON_LIMIT = 4 + 2 * HORIZON_LIMIT };

/* Above it is where constant + u along_u + v along_v > 0. */
typedef struct horizon_line {
    double constant, along_u, along_v;
} horizon_line;

/* The planes at right angles to some normals, as lines on each face. */
typedef struct horizons {
    uint32_t count;
    horizon_line lines[CUBE_FACES][HORIZON_LIMIT];
} horizons;

/* normal: in the map's space, of any length. At most HORIZON_LIMIT. */
void horizons_add(horizons *h, vec3 normal);

typedef enum horizon_side {
    HORIZON_BELOW, /* wholly below one of them */
    HORIZON_CUT,
    HORIZON_ABOVE, /* wholly above all of them */
} horizon_side;

static inline horizon_side horizons_side(const horizons *h, uint32_t face, const face_rectangle *r)
{
    horizon_side side = HORIZON_ABOVE;
    double u = 0.5 * (r->u0 + r->u1), v = 0.5 * (r->v0 + r->v1), half_u = 0.5 * (r->u1 - r->u0);
    double half_v = 0.5 * (r->v1 - r->v0);
    for (uint32_t i = 0; i < h->count; i++) {
        const horizon_line *line = &h->lines[face][i];
        double middle = line->constant + u * line->along_u + v * line->along_v;
        double extent = half_u * fabs(line->along_u) + half_v * fabs(line->along_v);
        if (middle + extent <= 0.0)
            return HORIZON_BELOW;
        if (middle - extent < 0.0)
            side = HORIZON_CUT;
    }
    return side;
}

/* The same for `count` squares side by side, of which r is the first: least[i] >= 0 if one is above all horizons, else
 * most[i] > 0 if it is cut. */
static inline void horizons_measure(const horizons *h, uint32_t face, const face_rectangle *r, uint32_t count,
                                    double *restrict least, double *restrict most)
{
    double u = 0.5 * (r->u0 + r->u1), v = 0.5 * (r->v0 + r->v1), edge = r->u1 - r->u0;
    for (uint32_t i = 0; i < count; i++)
        least[i] = most[i] = HUGE_VAL;
    for (uint32_t k = 0; k < h->count; k++) {
        const horizon_line line = h->lines[face][k];
        double middle = line.constant + u * line.along_u + v * line.along_v, step = edge * line.along_u;
        double extent = 0.5 * edge * (fabs(line.along_u) + fabs(line.along_v));
        for (uint32_t i = 0; i < count; i++) {
            double here = middle + i * step, low = here - extent, high = here + extent;
            least[i] = low < least[i] ? low : least[i];
            most[i] = high < most[i] ? high : most[i];
        }
    }
}

/* A convex polygon on a face. */
typedef struct face_polygon {
    uint32_t count; /* of corners; less than 3: there is nothing */
    double u[POLYGON_LIMIT], v[POLYGON_LIMIT];
} face_polygon;

/* The part of a rectangle that is above all horizons. */
face_polygon horizons_clip(const horizons *h, uint32_t face, const face_rectangle *r);

#endif
