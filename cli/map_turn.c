/* SPDX-License-Identifier: MIT */
#include "map_turn.h"

#include "face.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

map_turn map_turn_make(double degrees, bool flip)
{
    double rest = fmod(degrees, 360);
    if (rest < 0)
        rest += 360;
    return (map_turn){.degrees = rest < 360 ? rest : 0, .flip = flip};
}

bool map_turn_is_none(const map_turn *turn)
{
    return turn->degrees == 0 && !turn->flip;
}

bool map_turn_is_square(const map_turn *turn)
{
    return fmod(turn->degrees, 90) == 0;
}

/* ---- lat-long maps ---- */

/* +X, towards which the turn goes, is left of +Z: a column of the new map comes from further right in the old one. */
void map_turn_latlong(const map_turn *turn, uint32_t width, uint32_t height, const float *from, float *to)
{
    double shift = turn->degrees / 360 * width, whole = floor(shift + 1e-6), rest = shift - whole;
    float second = rest > 1e-6 ? (float)rest : 0, first = 1 - second;
    uint32_t columns = (uint32_t)whole % width;
    for (size_t row = 0; row < height; row++) {
        const float *old = from + 3 * row * width;
        float *new = to + 3 * row *width;
        for (uint32_t i = 0; i < width; i++, new += 3) {
            uint32_t a = (uint32_t)(((uint64_t)i + columns) % width), b = a + 1 < width ? a + 1 : 0;
            a = turn->flip ? width - 1 - a : a;
            b = turn->flip ? width - 1 - b : b;
            for (size_t c = 0; c < 3; c++)
                new[c] = second == 0 ? old[3 * (size_t)a + c]
                                     : first *old[3 * (size_t)a + c] + second *old[3 * (size_t)b + c];
        }
    }
}

/* ---- cubes ---- */

static int dot(const int a[3], const int b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Where a direction of the new map points to in the old one: turned back, then mirrored back. */
static void turn_back(const map_turn *turn, const int new[3], int old[3])
{
    static const int sines[] = {0, 1, 0, -1};
    int quarters = (int)(turn->degrees / 90) & 3, sine = sines[quarters], cosine = sines[(quarters + 1) & 3];
    int x = new[0] * cosine - new[2] * sine;
    old[0] = turn->flip ? -x : x;
    old[1] = new[1];
    old[2] = new[0] * sine + new[2] * cosine;
}

/* Steps through the old cube while a face of the new one is written row by row. */
typedef struct face_walk {
    ptrdiff_t start, column, row; /* texels */
} face_walk;

static face_walk find_walk(const map_turn *turn, const face_frame *face, uint32_t size)
{
    int axis[3], right[3], down[3], old = 0;
    turn_back(turn, face->axis, axis);
    turn_back(turn, face->right, right);
    turn_back(turn, face->down, down);
    while (dot(face_frames[old].axis, axis) != 1)
        old++;
    const face_frame *frame = &face_frames[old];
    ptrdiff_t edge = (ptrdiff_t)size, last = edge - 1;
    face_walk walk = {.column = dot(frame->right, right) + edge * dot(frame->down, right),
                      .row = dot(frame->right, down) + edge * dot(frame->down, down)};
    /* The corner where the new face begins: against both of its directions. */
    int u = -dot(frame->right, right) - dot(frame->right, down), v = -dot(frame->down, right) - dot(frame->down, down);
    walk.start = (ptrdiff_t)old * edge * edge + (v > 0 ? last * edge : 0) + (u > 0 ? last : 0);
    return walk;
}

void map_turn_cube(const map_turn *turn, uint32_t size, const float *from, float *to)
{
    for (int face = 0; face < FACE_COUNT; face++) {
        face_walk walk = find_walk(turn, &face_frames[face], size);
        for (uint32_t row = 0; row < size; row++) {
            ptrdiff_t old = walk.start + walk.row * (ptrdiff_t)row;
            for (uint32_t column = 0; column < size; column++, old += walk.column, to += 3)
                memcpy(to, from + 3 * old, 3 * sizeof *to);
        }
    }
}
