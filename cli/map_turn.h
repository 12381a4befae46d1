/* SPDX-License-Identifier: MIT
 * map_turn.h - environment maps turned and mirrored for good, as helio_orientation does when they are looked up. */
#ifndef HELIOSTAT_CLI_MAP_TURN_H
#define HELIOSTAT_CLI_MAP_TURN_H

#include <stdbool.h>
#include <stdint.h>

typedef struct map_turn {
    double degrees; /* about +Y, from +Z towards +X; 0 <= degrees < 360 */
    bool flip;      /* left to right, before */
} map_turn;

/* Any angle. */
map_turn map_turn_make(double degrees, bool flip);

bool map_turn_is_none(const map_turn *turn);

/* By a multiple of 90 degrees, which takes faces of a cube to faces? */
bool map_turn_is_square(const map_turn *turn);

/* Turns a lat-long map: whole columns move; where the angle is no whole number of columns, a new one is the average of
 * what it covers. Keeps the flux of each row. from and to: [height][width][3], different. */
void map_turn_latlong(const map_turn *turn, uint32_t width, uint32_t height, const float *from, float *to);

/* Turns a cube by a multiple of 90 degrees; each texel moves as it is. from and to: [6][size][size][3], different. */
void map_turn_cube(const map_turn *turn, uint32_t size, const float *from, float *to);

#endif
