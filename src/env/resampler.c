/* SPDX-License-Identifier: MIT
 *
 * A face of the cube is a list of overlaps (overlap.h) and a view: where the face's pixels are in the map. Faces that differ
 * by their view alone share the list: the six faces of a strip; in a lat-long map the sides, a quarter of the width apart,
 * and the poles, upside down. */
#include "env/resampler.h"

#include "core/context.h"
#include "core/error.h"
#include "core/vector.h"
#include "env/cube.h"
#include "env/overlap.h"

enum { MAX_LISTS = 5 };

/* Overlaps of all texels of a face: texel t has count[t] of them, from overlaps[first[t]] on. */
typedef struct overlap_list {
    overlap_geometry geometry;
    overlap_generator generate;
    overlap_bound bound;
    size_t *first;   /* [R x R + 1] */
    uint32_t *count; /* [R x R] */
    overlap *overlaps;
} overlap_list;

/* A face of the cube: texel rows may be taken from below, pixels mirrored and moved. Columns wrap around the map. */
typedef struct face_view {
    const overlap_list *list;
    bool texel_rows_reversed, rows_reversed, columns_reversed;
    uint32_t row_offset, column_offset;
} face_view;

struct resampler {
    uint32_t width, size; /* of the map; R */
    double *borders;      /* see overlap_geometry */
    overlap_list lists[MAX_LISTS];
    int list_count;
    face_view faces[CUBE_FACES];
};

/* ---- lists ---- */

static void bound_row(void *data, size_t row)
{
    overlap_list *list = data;
    size_t size = list->geometry.size;
    for (uint32_t column = 0; column < size; column++)
        list->first[row * size + column + 1] = list->bound(&list->geometry, (uint32_t)row, column);
}

static void generate_row(void *data, size_t row)
{
    overlap_list *list = data;
    size_t size = list->geometry.size;
    for (uint32_t column = 0; column < size; column++) {
        size_t texel = row * size + column;
        list->count[texel] =
            list->generate(&list->geometry, (uint32_t)row, column, list->overlaps + list->first[texel]);
    }
}

static helio_status fill_list(helio_context *context, overlap_list *list)
{
    size_t size = list->geometry.size, texels = size * size;
    list->first = context_allocate(context, texels + 1, sizeof *list->first);
    list->count = context_allocate(context, texels, sizeof *list->count);
    if (list->first == NULL || list->count == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, size, bound_row, list);
    for (size_t texel = 0; texel < texels; texel++)
        list->first[texel + 1] += list->first[texel];
    list->overlaps = context_allocate(context, list->first[texels], sizeof *list->overlaps);
    if (list->overlaps == NULL)
        return HELIO_ERR_MEMORY;
    context_parallel_for(context, size, generate_row, list);
    return HELIO_OK;
}

static overlap_list *add_list(resampler *plan, overlap_generator generate, overlap_bound bound,
                              const overlap_geometry *geometry)
{
    overlap_list *list = &plan->lists[plan->list_count++];
    list->geometry = *geometry;
    list->geometry.borders = plan->borders;
    list->generate = generate;
    list->bound = bound;
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

static void plan_latlong(resampler *plan, uint32_t width, uint32_t height)
{
    /* Sides in the order of their longitudes: +Z, +X, -Z, -X. */
    static const int sides[4] = {4, 0, 5, 1};
    overlap_geometry geometry = {.size = plan->size, .map_width = width, .map_height = height};
    latlong_borders(plan->borders, height);
    const overlap_list *pole = add_list(plan, overlap_pole, overlap_pole_bound, &geometry), *side = NULL;
    plan->faces[2] = (face_view){.list = pole};
    plan->faces[3] = (face_view){.list = pole, .texel_rows_reversed = true, .rows_reversed = true};
    for (uint32_t quarter = 0; quarter < 4; quarter++) {
        bool shared = width % 4 == 0; /* else the sides begin in different places of a column */
        geometry.longitude = shared ? 0.0 : 0.5 * PI * quarter;
        if (side == NULL || !shared)
            side = add_list(plan, overlap_side, overlap_side_bound, &geometry);
        uint32_t shift = shared ? (4 - quarter) % 4 * (width / 4) : 0; /* columns run against the longitude */
        plan->faces[sides[quarter]] = (face_view){.list = side, .column_offset = shift};
    }
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

static void plan_strip(resampler *plan, uint32_t face_size, bool stacked, bool openexr)
{
    const overlap_geometry geometry = {.size = plan->size, .map_width = face_size, .map_height = face_size};
    strip_borders(plan->borders, face_size, openexr);
    const overlap_list *list = add_list(plan, overlap_strip, overlap_strip_bound, &geometry);
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        /* OpenEXR draws its faces as seen from outside: the sides mirrored left to right, top and bottom upside down. */
        bool is_pole = face == 2 || face == 3;
        plan->faces[face] = (face_view){
            .list = list,
            .rows_reversed = openexr && is_pole,
            .columns_reversed = openexr && !is_pole,
            .row_offset = stacked ? face * face_size : 0,
            .column_offset = stacked ? 0 : face * face_size,
        };
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
    plan->width = width;
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

static const float *find_pixel(const resampling *work, const face_view *view, const overlap *o)
{
    const overlap_geometry *geometry = &view->list->geometry;
    uint32_t row = view->rows_reversed ? geometry->map_height - 1 - o->row : o->row;
    uint32_t column = view->columns_reversed ? geometry->map_width - 1 - o->column : o->column;
    column += view->column_offset;
    column -= column >= work->plan->width ? work->plan->width : 0;
    return work->map + ((size_t)(row + view->row_offset) * work->plan->width + column) * 3;
}

static void resample_row(void *data, size_t index)
{
    const resampling *work = data;
    size_t size = work->plan->size, row = index % size;
    const face_view *view = &work->plan->faces[index / size];
    size_t texel = (view->texel_rows_reversed ? size - 1 - row : row) * size;
    float *rgb = work->cube + index * size * 3;
    for (size_t column = 0; column < size; column++, texel++, rgb += 3) {
        const overlap *o = view->list->overlaps + view->list->first[texel], *end = o + view->list->count[texel];
        double sum[3] = {0, 0, 0};
        for (; o < end; o++) {
            const float *pixel = find_pixel(work, view, o);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)o->weight * (double)pixel[c];
        }
        for (int c = 0; c < 3; c++)
            rgb[c] = (float)sum[c];
    }
}

void resampler_run(helio_context *context, const resampler *plan, const float *map, float *cube)
{
    resampling work = {.plan = plan, .map = map, .cube = cube};
    context_parallel_for(context, CUBE_FACES * (size_t)plan->size, resample_row, &work);
}
