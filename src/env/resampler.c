/* SPDX-License-Identifier: MIT
 *
 * All layouts are symmetric: of the overlaps (overlap.h) of a face only one quarter is kept, the texels with u <= 0 and
 * v <= 0, and faces that differ by where they are in the map share it. A strip has one such quarter, a lat-long map
 * two: of a side and of a pole. Each quarter of each face sees the map through a transformation of rows and columns. */
#include "env/resampler.h"

#include "core/context.h"
#include "core/error.h"
#include "core/vector.h"
#include "env/cube.h"
#include "env/overlap.h"

enum { MAX_LISTS = 2 };

/* Overlaps of a quarter of a face: texel t of half x half has count[t] of them, from overlaps[first[t]] on. */
typedef struct overlap_list {
    overlap_geometry geometry;
    overlap_generator generate;
    overlap_bound bound;
    size_t half;     /* (R + 1) / 2 */
    size_t *first;   /* [half x half + 1] */
    uint32_t *count; /* [half x half] */
    overlap *overlaps;
} overlap_list;

/* Row and column of the map from those of an overlap: offset + sign x index. Columns may have to wrap around once. */
typedef struct pixel_transform {
    int64_t row_offset, row_sign, column_offset, column_sign;
} pixel_transform;

typedef struct face_view {
    const overlap_list *list;
    bool upside_down;               /* texel rows are counted from below */
    pixel_transform quarters[2][2]; /* [u > 0][v > 0], the latter after upside_down */
} face_view;

struct resampler {
    uint32_t size;         /* R */
    uint32_t width;        /* of the map, in parts of columns */
    uint32_t column_parts; /* that a column is cut into, see plan_latlong() */
    double *borders;       /* see overlap_geometry */
    overlap_list lists[MAX_LISTS];
    int list_count;
    face_view faces[CUBE_FACES];
};

/* ---- lists ---- */

static void bound_row(void *data, size_t row)
{
    overlap_list *list = data;
    for (size_t column = 0; column < list->half; column++)
        list->first[row * list->half + column + 1] = list->bound(&list->geometry, (uint32_t)row, (uint32_t)column);
}

static void generate_row(void *data, size_t row)
{
    overlap_list *list = data;
    for (size_t column = 0; column < list->half; column++) {
        size_t texel = row * list->half + column;
        list->count[texel] =
            list->generate(&list->geometry, (uint32_t)row, (uint32_t)column, list->overlaps + list->first[texel]);
    }
}

static helio_status fill_list(helio_context *context, overlap_list *list)
{
    size_t texels = list->half * list->half;
    list->first = context_allocate(context, texels + 1, sizeof *list->first);
    list->count = context_allocate(context, texels, sizeof *list->count);
    if (list->first == NULL || list->count == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, list->half, bound_row, list);
    for (size_t texel = 0; texel < texels; texel++)
        list->first[texel + 1] += list->first[texel];
    list->overlaps = context_allocate(context, list->first[texels], sizeof *list->overlaps);
    if (list->overlaps == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, list->half, generate_row, list);
    return HELIO_OK;
}

static const overlap_list *add_list(resampler *plan, overlap_generator generate, overlap_bound bound, uint32_t width,
                                    uint32_t height)
{
    overlap_list *list = &plan->lists[plan->list_count++];
    list->geometry =
        (overlap_geometry){.size = plan->size, .map_width = width, .map_height = height, .borders = plan->borders};
    list->generate = generate;
    list->bound = bound;
    list->half = (plan->size + 1) / 2;
    return list;
}

/* ---- lat-long maps ---- */

/* Equal steps of latitude; the ends are exact, so that no light is lost at the poles. */
static void latlong_borders(double *borders, uint32_t height)
{
    for (uint32_t k = 1; k < height; k++)
        borders[k] = cos(PI * k / height);
    borders[0] = 1.0;
    borders[height] = -1.0;
}

static int64_t wrap(int64_t column, int64_t width)
{
    return (column % width + width) % width;
}

/* A side, a number of quarter turns from +Z: columns run against the longitude. */
static face_view view_side(const overlap_list *list, int64_t quarter_turns)
{
    int64_t width = list->geometry.map_width, last_row = list->geometry.map_height - 1;
    int64_t shift = -quarter_turns * (width / 4);
    face_view view = {.list = list};
    for (int right = 0; right < 2; right++)
        for (int below = 0; below < 2; below++)
            view.quarters[right][below] = (pixel_transform){
                .row_offset = below ? last_row : 0,
                .row_sign = below ? -1 : 1,
                .column_offset = wrap(right ? width - 1 + shift : shift, width),
                .column_sign = right ? -1 : 1,
            };
    return view;
}

/* A pole: mirroring x or z mirrors longitude, both turn it by half. -Y is +Y upside down, in rows of texels and of
 * pixels. */
static face_view view_pole(const overlap_list *list, bool south)
{
    int64_t width = list->geometry.map_width, last_row = list->geometry.map_height - 1;
    face_view view = {.list = list, .upside_down = south};
    const int64_t offsets[2][2] = {{0, width / 2 - 1}, {width - 1, width / 2}};
    for (int mirror_x = 0; mirror_x < 2; mirror_x++)
        for (int mirror_z = 0; mirror_z < 2; mirror_z++)
            view.quarters[mirror_x][mirror_z] = (pixel_transform){
                .row_offset = south ? last_row : 0,
                .row_sign = south ? -1 : 1,
                .column_offset = offsets[mirror_x][mirror_z],
                .column_sign = mirror_x != mirror_z ? -1 : 1,
            };
    return view;
}

static void plan_latlong(resampler *plan, uint32_t width, uint32_t height)
{
    /* Symmetric about each axis are only widths that four divides; other maps are taken with their columns in parts. */
    plan->column_parts = width % 4 == 0 ? 1 : width % 2 == 0 ? 2 : 4;
    plan->width = width * plan->column_parts;
    latlong_borders(plan->borders, height);
    const overlap_list *side = add_list(plan, overlap_side, overlap_side_bound, plan->width, height);
    const overlap_list *pole = add_list(plan, overlap_pole, overlap_pole_bound, plan->width, height);
    plan->faces[4] = view_side(side, 0); /* +Z */
    plan->faces[0] = view_side(side, 1); /* +X */
    plan->faces[5] = view_side(side, 2); /* -Z */
    plan->faces[1] = view_side(side, 3); /* -X */
    plan->faces[2] = view_pole(pole, false);
    plan->faces[3] = view_pole(pole, true);
}

/* ---- strips ---- */

/* OpenEXR puts the centres of the outer pixels on the edges of the face, so that these pixels are half as wide. */
static void strip_borders(double *borders, uint32_t size, bool openexr)
{
    for (uint32_t k = 1; k < size; k++)
        borders[k] = openexr ? (2.0 * k - 1.0) / (size - 1.0) - 1.0 : texel_border(k, size);
    borders[0] = -1.0;
    borders[size] = 1.0;
}

/* Rows and columns of the face in the map, perhaps mirrored. */
static face_view view_strip(const overlap_list *list, int64_t row, int64_t column, bool mirror_rows,
                            bool mirror_columns)
{
    int64_t last = list->geometry.map_width - 1;
    face_view view = {.list = list};
    for (int right = 0; right < 2; right++)
        for (int below = 0; below < 2; below++) {
            bool rows = mirror_rows != (below == 1), columns = mirror_columns != (right == 1);
            view.quarters[right][below] = (pixel_transform){
                .row_offset = rows ? row + last : row,
                .row_sign = rows ? -1 : 1,
                .column_offset = columns ? column + last : column,
                .column_sign = columns ? -1 : 1,
            };
        }
    return view;
}

static void plan_strip(resampler *plan, uint32_t face_size, bool stacked, bool openexr)
{
    plan->column_parts = 1;
    plan->width = stacked ? face_size : CUBE_FACES * face_size;
    strip_borders(plan->borders, face_size, openexr);
    const overlap_list *list = add_list(plan, overlap_strip, overlap_strip_bound, face_size, face_size);
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        /* OpenEXR draws its faces as seen from outside: the sides mirrored left to right, top and bottom upside down.
         */
        bool is_pole = face == 2 || face == 3;
        plan->faces[face] = view_strip(list, stacked ? face * face_size : 0, stacked ? 0 : face * face_size,
                                       openexr && is_pole, openexr && !is_pole);
    }
}

/* ---- life ---- */

static helio_status fill_plan(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                              resampler *plan)
{
    bool latlong = layout == HELIO_LAYOUT_LATLONG;
    uint32_t face_size = width < height ? width : height;
    plan->borders = context_allocate(context, (size_t)(latlong ? height : face_size) + 1, sizeof *plan->borders);
    if (plan->borders == NULL)
        return HELIO_ERR_MEMORY;
    if (latlong)
        plan_latlong(plan, width, height);
    else
        plan_strip(plan, face_size, height > width, layout == HELIO_LAYOUT_STRIP_OPENEXR);
    for (int i = 0; i < plan->list_count; i++)
        HELIO_TRY(fill_list(context, &plan->lists[i]));
    return HELIO_OK;
}

helio_status resampler_create(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                              uint32_t cube_size, resampler **out)
{
    resampler *plan = context_allocate(context, 1, sizeof *plan);
    if (plan == NULL)
        return HELIO_ERR_MEMORY;
    plan->size = cube_size;
    helio_status status = fill_plan(context, layout, width, height, plan);
    if (status != HELIO_OK) {
        resampler_destroy(context, plan);
        return status;
    }
    *out = plan;
    return HELIO_OK;
}

void resampler_destroy(helio_context *context, resampler *plan)
{
    if (plan == NULL)
        return;
    for (int i = 0; i < plan->list_count; i++) {
        context_release(context, plan->lists[i].overlaps);
        context_release(context, plan->lists[i].count);
        context_release(context, plan->lists[i].first);
    }
    context_release(context, plan->borders);
    context_release(context, plan);
}

/* ---- a frame ---- */

typedef struct resampling {
    const resampler *plan;
    const float *map;
    float *cube;
} resampling;

static const float *find_pixel(const resampling *work, const pixel_transform *t, const overlap *o)
{
    const resampler *plan = work->plan;
    int64_t column = t->column_offset + t->column_sign * o->column, width = plan->width;
    column += column < 0 ? width : column >= width ? -width : 0;
    int64_t row = t->row_offset + t->row_sign * o->row;
    return work->map + (row * (width / plan->column_parts) + column / plan->column_parts) * 3;
}

static void resample_texel(const resampling *work, const overlap_list *list, size_t texel, const pixel_transform *t,
                           float rgb[3])
{
    const overlap *o = list->overlaps + list->first[texel], *end = o + list->count[texel];
    double sum[3] = {0, 0, 0};
    for (; o < end; o++) {
        const float *pixel = find_pixel(work, t, o);
        for (int c = 0; c < 3; c++)
            sum[c] += (double)o->weight * (double)pixel[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)sum[c];
}

static void resample_row(void *data, size_t index)
{
    const resampling *work = data;
    size_t size = work->plan->size, row = index % size;
    const face_view *view = &work->plan->faces[index / size];
    const overlap_list *list = view->list;
    float *rgb = work->cube + index * size * 3;
    row = view->upside_down ? size - 1 - row : row;
    bool below = row >= list->half;
    row = below ? size - 1 - row : row;
    for (size_t column = 0; column < size; column++) {
        bool right = column >= list->half;
        size_t texel = row * list->half + (right ? size - 1 - column : column);
        resample_texel(work, list, texel, &view->quarters[right][below], rgb + column * 3);
    }
}

void resampler_run(helio_context *context, const resampler *plan, const float *map, float *cube)
{
    resampling work = {.plan = plan, .map = map, .cube = cube};
    context_parallel_for(context, CUBE_FACES * (size_t)plan->size, resample_row, &work);
}
