/* SPDX-License-Identifier: MIT */
#include "eval/horizon.h"

void horizons_add(horizons *h, vec3 normal)
{
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        h->lines[face][h->count] =
            (horizon_line){(double)dot(normal, cube_faces[face].axis), (double)dot(normal, cube_faces[face].right),
                           (double)dot(normal, cube_faces[face].down)};
    h->count++;
}

static void add_corner(face_polygon *polygon, double u, double v)
{
    if (polygon->count == POLYGON_LIMIT)
        return;
    polygon->u[polygon->count] = u;
    polygon->v[polygon->count++] = v;
}

/* Sutherland and Hodgman's clipping. It adds one corner to a convex polygon; what rounding has made of one may get
 * two, of edges that have no length to speak of. */
static void clip(const horizon_line *line, face_polygon *polygon)
{
    face_polygon from = *polygon;
    polygon->count = 0;
    for (uint32_t i = 0; i < from.count; i++) {
        uint32_t next = i + 1 < from.count ? i + 1 : 0;
        double here = line->constant + from.u[i] * line->along_u + from.v[i] * line->along_v;
        double there = line->constant + from.u[next] * line->along_u + from.v[next] * line->along_v;
        if (here > 0.0)
            add_corner(polygon, from.u[i], from.v[i]);
        if ((here > 0.0) != (there > 0.0)) {
            double part = here / (here - there);
            add_corner(polygon, from.u[i] + part * (from.u[next] - from.u[i]),
                       from.v[i] + part * (from.v[next] - from.v[i]));
        }
    }
}

/* At the lowest corner. */
static double horizon_least(const horizon_line *line, const face_rectangle *r)
{
    return line->constant + line->along_u * (line->along_u > 0.0 ? r->u0 : r->u1) +
           line->along_v * (line->along_v > 0.0 ? r->v0 : r->v1);
}

face_polygon horizons_clip(const horizons *h, uint32_t face, const face_rectangle *r)
{
    face_polygon polygon = {4, {r->u0, r->u1, r->u1, r->u0}, {r->v0, r->v0, r->v1, r->v1}};
    for (uint32_t i = 0; i < h->count && polygon.count >= 3; i++)
        if (horizon_least(&h->lines[face][i], r) < 0.0)
            clip(&h->lines[face][i], &polygon);
    return polygon;
}
