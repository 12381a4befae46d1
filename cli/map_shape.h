/* SPDX-License-Identifier: MIT
 * map_shape.h - how fine an environment map is, and what shape another one needs to hold as much. */
#ifndef HELIOSTAT_CLI_MAP_SHAPE_H
#define HELIOSTAT_CLI_MAP_SHAPE_H

#include <heliostat/image.h>

enum { MAP_FINEST = 4096 }; /* the largest cube */

typedef struct map_shape {
    helio_layout layout;
    uint32_t width, height;
} map_shape;

/* The size of the smallest cube that holds as much, at most MAP_FINEST. */
uint32_t map_shape_fineness(const map_shape *shape);

/* Is the map made of the six faces of a cube as this library's, so that going through a cube changes nothing? */
bool map_shape_is_cube(helio_layout layout);

/* Do pixels mean the same direction in both? Six files are a strip. */
bool map_shape_is_same(const map_shape *a, const map_shape *b);

/* The cube through which one map is made from the other, so that as little as can be is lost on the way. */
uint32_t map_shape_cube(const map_shape *from, const map_shape *to);

#endif
