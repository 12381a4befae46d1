/* SPDX-License-Identifier: MIT */
#include "map_shape.h"

/* Beyond this a cube twice as fine as the maps takes more memory than what it keeps is worth. */
enum { FINE_ENOUGH = 2048 };

static bool holds(const map_shape *shape, uint32_t size)
{
    uint32_t width, height;
    if (helio_layout_shape(shape->layout, size, &width, &height) != HELIO_OK)
        return true;
    /* A strip may lie or stand. */
    uint32_t wide = width > height ? width : height, narrow = width > height ? height : width;
    uint32_t shape_wide = shape->width > shape->height ? shape->width : shape->height;
    uint32_t shape_narrow = shape->width > shape->height ? shape->height : shape->width;
    return wide >= shape_wide && narrow >= shape_narrow;
}

uint32_t map_shape_fineness(const map_shape *shape)
{
    uint32_t too_small = 0, enough = MAP_FINEST;
    while (enough - too_small > 1) {
        uint32_t middle = (too_small + enough) / 2;
        if (holds(shape, middle))
            enough = middle;
        else
            too_small = middle;
    }
    return enough;
}

bool map_shape_is_cube(helio_layout layout)
{
    switch (layout) {
    case HELIO_LAYOUT_CROSS_V:
    case HELIO_LAYOUT_CROSS_H:
    case HELIO_LAYOUT_FACES:
    case HELIO_LAYOUT_STRIP: return true;
    default: return false;
    }
}

static helio_layout without_files(helio_layout layout)
{
    return layout == HELIO_LAYOUT_FACES ? HELIO_LAYOUT_STRIP : layout;
}

bool map_shape_is_same(const map_shape *a, const map_shape *b)
{
    return a->width == b->width && a->height == b->height && without_files(a->layout) == without_files(b->layout);
}

uint32_t map_shape_cube(const map_shape *from, const map_shape *to)
{
    /* The cube is the map that is wanted, or the one that is given: then there is one change of shape only. */
    if (map_shape_is_cube(to->layout))
        return map_shape_fineness(to);
    if (map_shape_is_cube(from->layout))
        return map_shape_fineness(from);
    uint32_t a = map_shape_fineness(from), b = map_shape_fineness(to), finer = a > b ? a : b;
    if (finer >= FINE_ENOUGH)
        return finer;
    return 2 * finer < FINE_ENOUGH ? 2 * finer : FINE_ENOUGH;
}
