/* SPDX-License-Identifier: MIT */
#include "env/overlap_square.h"

#include "core/context.h"
#include "core/error.h"
#include "env/cutting.h"

/* ---- quarters of faces ---- */

static int along(vec3 axis, const int signs[3])
{
    return (int)axis.x * signs[0] + (int)axis.y * signs[1] + (int)axis.z * signs[2];
}

square_quarter square_quarter_in(const int signs[3], int axis)
{
    uint32_t face = 2 * (uint32_t)axis + (signs[axis] < 0);
    return (square_quarter){.face = face,
                            .from_right = along(cube_faces[face].right, signs) > 0,
                            .from_below = along(cube_faces[face].down, signs) > 0};
}

/* The texels of a face that see the upper left quarter of the map, those cut by its borders included. */
static texel_window find_window(const projection *map, uint32_t face, uint32_t size)
{
    const uint32_t half = (size + 1) / 2;
    const int axis = (int)face / 2, sign = face % 2 ? -1 : 1;
    texel_window window = {0, size, 0, size};
    if ((axis == 0 && sign > 0) || (axis == map->up_axis && sign < 0))
        return (texel_window){0};
    int signs[3] = {-1, 0, 0};
    signs[map->up_axis] = 1;
    int right = along(cube_faces[face].right, signs), down = along(cube_faces[face].down, signs);
    if (right != 0)
        *(right > 0 ? &window.first_column : &window.end_column) = right > 0 ? size - half : half;
    if (down != 0)
        *(down > 0 ? &window.first_row : &window.end_row) = down > 0 ? size - half : half;
    return window;
}

/* ---- by pixel ---- */

/* Pixels of small maps are taken in parts each way, so that parts are small and none lies across a fold or an axis. */
typedef struct pixel_walk {
    const projection *map;
    uint32_t map_size, parts;
    uint32_t count; /* of rows and of columns that are walked over */
    cutting start;  /* with no parts yet */
    size_t *ends;   /* [count], of each row's entries; while counting, their number */
    uint32_t *pixels;
    texel_part *areas;
} pixel_walk;

static uint32_t find_parts(uint32_t map_size)
{
    uint32_t parts = (OUTLINE_LEAST_PIECES + map_size - 1) / map_size;
    return parts + (map_size * parts) % 2;
}

static void cut_pixel(const pixel_walk *walk, uint32_t row, uint32_t column, outline *polygon, cutting *result)
{
    uint32_t parts = walk->parts, first_row = row * parts, first_column = column * parts;
    int64_t whole = (int64_t)walk->map_size * parts;
    for (uint32_t i = 0; i < parts * parts; i++) {
        int64_t down = 2 * (int64_t)(first_row + i / parts) - whole;
        int64_t right = 2 * (int64_t)(first_column + i % parts) - whole;
        outline_trace(walk->map, (double[2]){(double)right / (double)whole, (double)(right + 2) / (double)whole},
                      (double[2]){(double)down / (double)whole, (double)(down + 2) / (double)whole}, polygon);
        if (polygon->count > 0)
            cut_outline(polygon, result);
    }
}

static void walk_row(void *data, size_t row)
{
    const pixel_walk *walk = data;
    outline polygon;
    cutting result = walk->start;
    size_t first = row > 0 && walk->areas != NULL ? walk->ends[row - 1] : 0;
    if (walk->areas != NULL)
        result.parts = walk->areas + first;
    for (uint32_t column = 0; column < walk->count; column++) {
        size_t before = result.count;
        cut_pixel(walk, (uint32_t)row, column, &polygon, &result);
        if (walk->areas != NULL)
            for (size_t i = before; i < result.count; i++)
                walk->pixels[first + i] = (uint32_t)row * walk->map_size + column;
    }
    if (walk->areas == NULL)
        walk->ends[row] = result.count;
}

/* ---- by texel ---- */

/* Sorts the entries by texel; those of one texel stay in their order. */
static void sort(const pixel_walk *walk, size_t count, square_overlaps *overlaps)
{
    size_t texels = (size_t)CUBE_FACES * overlaps->size * overlaps->size;
    uint32_t *starts = overlaps->starts;
    for (size_t i = 0; i < count; i++)
        starts[walk->areas[i].texel + 1]++;
    for (size_t texel = 0; texel < texels; texel++)
        starts[texel + 1] += starts[texel];
    for (size_t i = 0; i < count; i++) {
        uint32_t place = starts[walk->areas[i].texel]++;
        overlaps->pixels[place] = walk->pixels[i];
        overlaps->areas[place] = walk->areas[i].area;
    }
    for (size_t texel = texels; texel > 0; texel--)
        starts[texel] = starts[texel - 1];
    starts[0] = 0;
}

static helio_status fill(helio_context *context, pixel_walk *walk, square_overlaps *overlaps)
{
    size_t count = 0;
    context_parallel_for(context, walk->count, walk_row, walk);
    for (uint32_t row = 0; row < walk->count; row++)
        walk->ends[row] = count += walk->ends[row];
    if (count > UINT32_MAX)
        return fail(HELIO_ERR_MEMORY, "a map of %u x %u pixels over a cube of 6 x %u^2 texels takes too much memory",
                    walk->map_size, walk->map_size, overlaps->size);
    walk->pixels = context_allocate(context, count, sizeof *walk->pixels);
    walk->areas = context_allocate(context, count, sizeof *walk->areas);
    overlaps->starts =
        context_allocate(context, (size_t)CUBE_FACES * overlaps->size * overlaps->size + 1, sizeof *overlaps->starts);
    overlaps->pixels = context_allocate(context, count, sizeof *overlaps->pixels);
    overlaps->areas = context_allocate(context, count, sizeof *overlaps->areas);
    if (!walk->pixels || !walk->areas || !overlaps->starts || !overlaps->pixels || !overlaps->areas)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, walk->count, walk_row, walk);
    sort(walk, count, overlaps);
    return HELIO_OK;
}

helio_status square_overlaps_create(helio_context *context, helio_layout layout, uint32_t map_size, uint32_t size,
                                    square_overlaps *overlaps)
{
    *overlaps = (square_overlaps){.size = size, .map_size = map_size};
    pixel_walk walk = {.map = projection_of(layout), .map_size = map_size, .parts = find_parts(map_size)};
    /* Texels that lie across the middle need pixels of both halves. */
    walk.count = size % 2 == 0 ? (map_size + 1) / 2 : map_size;
    walk.start = (cutting){.size = size};
    walk.start.least = 1e-15 / ((double)map_size * walk.parts);
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        walk.start.windows[face] = find_window(walk.map, face, size);
    walk.ends = context_allocate(context, walk.count, sizeof *walk.ends);
    helio_status status = walk.ends != NULL ? fill(context, &walk, overlaps) : HELIO_ERR_MEMORY;
    context_release(context, walk.areas);
    context_release(context, walk.pixels);
    context_release(context, walk.ends);
    return status;
}

void square_overlaps_release(helio_context *context, square_overlaps *overlaps)
{
    context_release(context, overlaps->areas);
    context_release(context, overlaps->pixels);
    context_release(context, overlaps->starts);
}

/* ---- lists ---- */

/* Writes neighbours in a row of the map. Returns where they end. */
static uint32_t write_neighbours(const square_overlaps *overlaps, uint32_t at, uint32_t end, overlap_writer *writer)
{
    const uint32_t *pixels = overlaps->pixels, first = pixels[at], row = first / overlaps->map_size;
    double areas[OVERLAP_RUN_LIMIT] = {0};
    uint32_t count = 0;
    for (; at < end && pixels[at] / overlaps->map_size == row; at++) {
        uint32_t place = pixels[at] - first;
        if (place > count || place == OVERLAP_RUN_LIMIT)
            break;
        areas[place] += (double)overlaps->areas[at];
        count = place + 1;
    }
    overlap_write(writer, (overlap_run){.column = first % overlaps->map_size, .row = (uint16_t)row}, areas, count);
    return at;
}

void overlap_square(const void *data, uint32_t row, uint32_t first_column, uint32_t end_column, overlap_writer *writer)
{
    const square_quarter *quarter = data;
    const square_overlaps *overlaps = quarter->overlaps;
    uint32_t size = overlaps->size, face_row = quarter->from_below ? size - 1 - row : row;
    for (uint32_t column = first_column; column < end_column; column++) {
        uint32_t face_column = quarter->from_right ? size - 1 - column : column;
        uint32_t texel = (quarter->face * size + face_row) * size + face_column;
        uint32_t at = overlaps->starts[texel], end = overlaps->starts[texel + 1];
        while (at < end)
            at = write_neighbours(overlaps, at, end, writer);
        overlap_end_texel(writer);
    }
}
