/* SPDX-License-Identifier: MIT
 *
 * Six faces in a strip: a texel and a pixel overlap in a rectangle of their face, whose solid angle is known exactly.
 */
#include "core/context.h"
#include "env/cube.h"
#include "env/overlap.h"

/* OpenEXR puts the centres of the outer pixels on the edges of the face, so that these pixels are half as wide. */
helio_status overlap_strip_geometry(helio_context *context, uint32_t size, uint32_t map_size, bool openexr,
                                    overlap_geometry *geometry)
{
    double *borders = context_allocate(context, (size_t)map_size + 1, sizeof *borders);
    *geometry = (overlap_geometry){.size = size, .map_width = map_size, .map_height = map_size, .borders = borders};
    if (borders == NULL)
        return HELIO_ERR_MEMORY;
    for (uint32_t k = 1; k < map_size; k++)
        borders[k] = openexr ? (2.0 * k - 1.0) / (map_size - 1.0) - 1.0 : texel_border(k, map_size);
    borders[0] = -1.0;
    borders[map_size] = 1.0;
    return HELIO_OK;
}

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

/* A stretch of a line of texels and the pixels under it: first ... last. */
typedef struct stretch {
    double from, to;
    uint32_t first, last;
} stretch;

static stretch find_stretch(const overlap_geometry *geometry, uint32_t texel)
{
    stretch s = {.from = texel_border(texel, geometry->size), .to = texel_border(texel + 1, geometry->size)};
    s.first = find_pixel(geometry, s.from);
    s.last = find_pixel(geometry, s.to);
    if (s.last > s.first && geometry->borders[s.last] >= s.to)
        s.last--; /* only its border is touched */
    return s;
}

/* Border k between the pixels of a stretch, but no farther than the texel reaches. */
static double cut_border(const overlap_geometry *geometry, const stretch *s, uint32_t k)
{
    return fmin(fmax(geometry->borders[k], s->from), s->to);
}

/* The pixels from column first on, count of them, in all rows of the texel. */
static void write_columns(const overlap_geometry *geometry, const stretch *down, const stretch *across, uint32_t first,
                          uint32_t count, overlap_writer *writer)
{
    double upper[OVERLAP_RUN_LIMIT + 1], areas[OVERLAP_RUN_LIMIT]; /* upper: at the corners above a row of pixels */
    for (uint32_t i = 0; i <= count; i++)
        upper[i] = cube_corner_solid_angle(cut_border(geometry, across, first + i), down->from);
    for (uint32_t row = down->first; row <= down->last; row++) {
        double v = cut_border(geometry, down, row + 1), left = 0;
        for (uint32_t i = 0; i <= count; i++) {
            double lower = cube_corner_solid_angle(cut_border(geometry, across, first + i), v);
            double between = lower - upper[i]; /* of the face's axis, this border and the row */
            upper[i] = lower;
            if (i > 0)
                areas[i - 1] = between - left;
            left = between;
        }
        overlap_write(writer, (overlap_run){.column = first, .row = (uint16_t)row}, areas, count);
    }
}

void overlap_strip(const void *data, uint32_t row, uint32_t first_column, uint32_t end_column, overlap_writer *writer)
{
    const overlap_geometry *geometry = data;
    stretch down = find_stretch(geometry, row);
    for (uint32_t column = first_column; column < end_column; column++) {
        stretch across = find_stretch(geometry, column);
        for (uint32_t first = across.first; first <= across.last; first += OVERLAP_RUN_LIMIT) {
            uint32_t left = across.last - first + 1, count = left < OVERLAP_RUN_LIMIT ? left : OVERLAP_RUN_LIMIT;
            write_columns(geometry, &down, &across, first, count, writer);
        }
        overlap_end_texel(writer);
    }
}
