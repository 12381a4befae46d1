/* SPDX-License-Identifier: MIT
 *
 * Six faces in a strip: a texel and a pixel overlap in a rectangle of their face, whose solid angle is known exactly.
 */
#include "env/cube.h"
#include "env/overlap.h"

/* Index of the pixel that holds a coordinate. */
static uint32_t find_pixel(const overlap_geometry *geometry, double coordinate)
{
    uint32_t low = 0, high = geometry->map_width;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (geometry->borders[middle] <= coordinate)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Pixels under texel `index` of a line: first ... last. */
static void find_pixels(const overlap_geometry *geometry, uint32_t index, uint32_t *first, uint32_t *last)
{
    *first = find_pixel(geometry, texel_border(index, geometry->size));
    *last = find_pixel(geometry, texel_border(index + 1, geometry->size));
    if (*last > *first && geometry->borders[*last] >= texel_border(index + 1, geometry->size))
        --*last; /* only its border is touched */
}

size_t overlap_strip_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    uint32_t top, bottom, left, right;
    find_pixels(geometry, row, &top, &bottom);
    find_pixels(geometry, column, &left, &right);
    return (size_t)(bottom - top + 1) * (right - left + 1);
}

uint32_t overlap_strip(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps)
{
    const double *borders = geometry->borders;
    double u0 = texel_border(column, geometry->size), u1 = texel_border(column + 1, geometry->size);
    double v0 = texel_border(row, geometry->size), v1 = texel_border(row + 1, geometry->size);
    double whole = cube_solid_angle(u0, u1, v0, v1);
    uint32_t top, bottom, left, right, count = 0;
    find_pixels(geometry, row, &top, &bottom);
    find_pixels(geometry, column, &left, &right);
    for (uint32_t y = top; y <= bottom; y++)
        for (uint32_t x = left; x <= right; x++) {
            double part = cube_solid_angle(fmax(u0, borders[x]), fmin(u1, borders[x + 1]), fmax(v0, borders[y]),
                                           fmin(v1, borders[y + 1]));
            overlaps[count++] = (overlap){y, x, (float)fmax(0.0, part / whole)};
        }
    return count;
}
