/* SPDX-License-Identifier: MIT */
#include "env/resampler.h"

#include "core/context.h"
#include "env/overlap_square.h"
#include "env/projection.h"
#include "env/resampler_plan.h"

/* ---- views ---- */

/* A quarter of a face: texels are counted from its left edge or from the right, from the top or from below. */
static quarter_view view_of_quarter(const resampler *plan, uint32_t face, bool from_right, bool from_below)
{
    int64_t size = plan->size, last = size - 1;
    return (quarter_view){
        .texel = (face * size + (from_below ? last : 0)) * size + (from_right ? last : 0),
        .texel_row_step = from_below ? -size : size,
        .texel_column_step = from_right ? -1 : 1,
    };
}

/* Puts a view into the first group of its list that lacks such a mirror image. */
static void add_view(resampler *plan, const overlap_list *list, quarter_view view)
{
    int place = 2 * (view.row_sign < 0) + (view.column_sign < 0);
    view_group *group = plan->groups;
    while (group->list != NULL && (group->list != list || group->filled >> place & 1))
        group++;
    plan->group_count += group->list == NULL;
    group->list = list;
    group->filled |= 1u << place;
    group->views[place] = view;
}

/* ---- lat-long maps ---- */

/* A side, a number of quarter turns from +Z: columns run against the longitude. */
static void add_side(resampler *plan, const overlap_list *list, uint32_t face, int64_t quarter_turns)
{
    int64_t width = (int64_t)plan->width << plan->part_shift, shift = -quarter_turns * (width / 4);
    for (int quarter = 0; quarter < 4; quarter++) {
        bool right = quarter & 1, below = quarter & 2;
        quarter_view view = view_of_quarter(plan, face, right, below);
        view.row_offset = below ? plan->height - 1 : 0;
        view.row_sign = below ? -1 : 1;
        view.column_offset = right ? shift - 1 : shift;
        view.column_sign = right ? -1 : 1;
        add_view(plan, list, view);
    }
}

/* A pole: mirroring x or z mirrors longitude, both turn it by half. -Y is +Y upside down, in rows of texels and of
 * pixels. */
static void add_pole(resampler *plan, const overlap_list *list, uint32_t face, bool south)
{
    int64_t width = (int64_t)plan->width << plan->part_shift;
    const int64_t offsets[4] = {0, -1, width / 2 - 1, width / 2};
    for (int quarter = 0; quarter < 4; quarter++) {
        bool mirror_x = quarter & 1, mirror_z = quarter & 2;
        quarter_view view = view_of_quarter(plan, face, mirror_x, mirror_z != south);
        view.row_offset = south ? plan->height - 1 : 0;
        view.row_sign = south ? -1 : 1;
        view.column_offset = offsets[quarter];
        view.column_sign = mirror_x != mirror_z ? -1 : 1;
        add_view(plan, list, view);
    }
}

static helio_status plan_latlong(helio_context *context, resampler *plan)
{
    /* Symmetric about each axis are only widths that four divides; other maps are taken with their columns in parts. */
    plan->part_shift = plan->width % 4 == 0 ? 0 : plan->width % 2 == 0 ? 1 : 2;
    plan->sees_all = true;
    plan->list_count = 2;
    overlap_list *side = &plan->lists[0], *pole = &plan->lists[1];
    overlap_geometry geometry;
    helio_status status =
        overlap_latlong_geometry(context, plan->size, plan->width << plan->part_shift, plan->height, &geometry);
    if (status == HELIO_OK)
        status = overlap_list_create(context, plan->size, overlap_side, &geometry, side);
    if (status == HELIO_OK)
        status = overlap_list_create(context, plan->size, overlap_pole, &geometry, pole);
    overlap_geometry_release(context, &geometry);
    const uint32_t sides[4] = {4, 0, 5, 1}; /* +Z +X -Z -X */
    for (int turns = 0; turns < 4; turns++)
        add_side(plan, side, sides[turns], turns);
    add_pole(plan, pole, 2, false);
    add_pole(plan, pole, 3, true);
    return status;
}

/* ---- strips and crosses ---- */

/* Where a face is in the map, counted in faces, and whether it is mirrored there. */
typedef struct face_place {
    uint8_t row, column;
    bool mirror_rows, mirror_columns;
} face_place;

/* A map of square faces; the places in the order of faces. */
typedef struct face_layout {
    uint32_t columns; /* of faces */
    face_place places[CUBE_FACES];
} face_layout;

static const face_layout STACKED = {1, {{.row = 0}, {.row = 1}, {.row = 2}, {.row = 3}, {.row = 4}, {.row = 5}}};
static const face_layout SIDE_BY_SIDE = {
    6, {{.column = 0}, {.column = 1}, {.column = 2}, {.column = 3}, {.column = 4}, {.column = 5}}};
/* OpenEXR draws its faces as seen from outside: the sides mirrored left to right, top and bottom upside down. */
static const face_layout OPENEXR = {1,
                                    {{0, 0, false, true},
                                     {1, 0, false, true},
                                     {2, 0, true, false},
                                     {3, 0, true, false},
                                     {4, 0, false, true},
                                     {5, 0, false, true}}};
static const face_layout CROSS_V = {3,
                                    {{1, 2, false, false},
                                     {1, 0, false, false},
                                     {0, 1, false, false},
                                     {2, 1, false, false},
                                     {1, 1, false, false},
                                     {3, 1, true, true}}};
static const face_layout CROSS_H = {4,
                                    {{1, 2, false, false},
                                     {1, 0, false, false},
                                     {0, 1, false, false},
                                     {2, 1, false, false},
                                     {1, 1, false, false},
                                     {1, 3, false, false}}};

static const face_layout *find_face_layout(const resampler *plan, helio_layout layout)
{
    switch (layout) {
    case HELIO_LAYOUT_CROSS_V: return &CROSS_V;
    case HELIO_LAYOUT_CROSS_H: return &CROSS_H;
    case HELIO_LAYOUT_STRIP_OPENEXR: return &OPENEXR;
    default: return plan->height > plan->width ? &STACKED : &SIDE_BY_SIDE;
    }
}

static void add_face(resampler *plan, uint32_t face, const face_place *place, int64_t size)
{
    int64_t row = place->row * size, column = place->column * size, last = size - 1;
    for (int quarter = 0; quarter < 4; quarter++) {
        bool right = quarter & 1, below = quarter & 2;
        bool rows = place->mirror_rows != below, columns = place->mirror_columns != right;
        quarter_view view = view_of_quarter(plan, face, right, below);
        view.row_offset = rows ? row + last : row;
        view.row_sign = rows ? -1 : 1;
        view.column_offset = columns ? column + last : column;
        view.column_sign = columns ? -1 : 1;
        add_view(plan, &plan->lists[0], view);
    }
}

static helio_status plan_faces(helio_context *context, helio_layout layout, resampler *plan)
{
    const face_layout *faces = find_face_layout(plan, layout);
    uint32_t face_size = plan->width / faces->columns;
    plan->sees_all = layout != HELIO_LAYOUT_CROSS_V && layout != HELIO_LAYOUT_CROSS_H;
    plan->list_count = 1;
    overlap_geometry geometry;
    helio_status status =
        overlap_strip_geometry(context, plan->size, face_size, layout == HELIO_LAYOUT_STRIP_OPENEXR, &geometry);
    if (status == HELIO_OK)
        status = overlap_list_create(context, plan->size, overlap_strip, &geometry, &plan->lists[0]);
    overlap_geometry_release(context, &geometry);
    for (uint32_t face = 0; face < CUBE_FACES; face++)
        add_face(plan, face, &faces->places[face], face_size);
    return status;
}

/* ---- squares and discs ---- */

/* A quarter of a face and its mirror images. */
static void add_quarters(resampler *plan, const overlap_list *list, const int signs[3], int up_axis, int axis)
{
    for (int mirror = 0; mirror < GROUP_VIEWS; mirror++) {
        bool columns = mirror & 1, rows = mirror & 2;
        int mirrored[3] = {signs[0], signs[1], signs[2]};
        mirrored[0] *= columns ? -1 : 1;
        mirrored[up_axis] *= rows ? -1 : 1;
        square_quarter quarter = square_quarter_in(mirrored, axis);
        quarter_view view = view_of_quarter(plan, quarter.face, quarter.from_right, quarter.from_below);
        view.row_offset = rows ? plan->height - 1 : 0;
        view.row_sign = rows ? -1 : 1;
        view.column_offset = columns ? plan->width - 1 : 0;
        view.column_sign = columns ? -1 : 1;
        add_view(plan, list, view);
    }
}

/* The upper left quarter of the map sees two octants of the sphere, each with quarters of three faces. */
static helio_status plan_square(helio_context *context, helio_layout layout, resampler *plan)
{
    int up_axis = projection_of(layout)->up_axis;
    square_overlaps overlaps;
    helio_status status = square_overlaps_create(context, layout, plan->width, plan->size, &overlaps);
    plan->sees_all = layout != HELIO_LAYOUT_ANGULAR && layout != HELIO_LAYOUT_MIRRORBALL;
    for (int i = 0; i < 6 && status == HELIO_OK; i++) {
        int signs[3] = {-1, 0, 0};
        signs[up_axis] = 1;
        signs[3 - up_axis] = i < 3 ? -1 : 1;
        square_quarter quarter = square_quarter_in(signs, i % 3);
        quarter.overlaps = &overlaps;
        overlap_list *list = &plan->lists[plan->list_count++];
        status = overlap_list_create(context, plan->size, overlap_square, &quarter, list);
        add_quarters(plan, list, signs, up_axis, i % 3);
    }
    square_overlaps_release(context, &overlaps);
    return status;
}

/* ---- life ---- */

static helio_status allocate_spaces(helio_context *context, resampler *plan)
{
    uint32_t threads = helio_context_threads(context);
    plan->space_count = threads < MAX_SPACES ? threads : MAX_SPACES;
    plan->spaces = context_allocate(context, plan->space_count, sizeof *plan->spaces);
    return plan->spaces != NULL ? HELIO_OK : HELIO_ERR_MEMORY;
}

helio_status resampler_create(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                              uint32_t cube_size, resampler **out)
{
    resampler *plan = context_allocate(context, 1, sizeof *plan);
    if (plan == NULL)
        return HELIO_ERR_MEMORY;
    plan->size = cube_size;
    plan->width = width;
    plan->height = height;
    helio_status status = layout == HELIO_LAYOUT_LATLONG  ? plan_latlong(context, plan)
                          : projection_of(layout) != NULL ? plan_square(context, layout, plan)
                                                          : plan_faces(context, layout, plan);
    if (status == HELIO_OK)
        status = allocate_spaces(context, plan);
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
    for (int i = 0; i < plan->list_count; i++)
        overlap_list_release(context, &plan->lists[i]);
    context_release(context, plan->spaces);
    context_release(context, plan);
}

bool resampler_sees_all(const resampler *plan)
{
    return plan->sees_all;
}
