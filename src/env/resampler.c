/* SPDX-License-Identifier: MIT */
#include "env/resampler.h"

#include "core/context.h"
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

/* Puts a view into a group where it fits. */
static void add_view(resampler *plan, const overlap_list *list, quarter_view view)
{
    int backwards = view.row_sign < 0;
    int64_t column_sign = view.row_sign * view.column_sign;
    view_group *group = plan->groups;
    while (group->list != NULL &&
           (group->list != list || group->column_sign != column_sign || group->counts[backwards] == GROUP_VIEWS / 2))
        group++;
    plan->group_count += group->list == NULL;
    group->list = list;
    group->column_sign = column_sign;
    group->views[backwards * (GROUP_VIEWS / 2) + group->counts[backwards]++] = view;
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
    plan->list_rows = plan->height;
    plan->list_count = 2;
    overlap_list *side = &plan->lists[0], *pole = &plan->lists[1];
    overlap_geometry geometry;
    helio_status status =
        overlap_latlong_geometry(context, plan->size, plan->width << plan->part_shift, plan->height, &geometry);
    if (status == HELIO_OK)
        status = overlap_list_create(context, &geometry, overlap_side, side);
    if (status == HELIO_OK)
        status = overlap_list_create(context, &geometry, overlap_pole, pole);
    overlap_geometry_release(context, &geometry);
    const uint32_t sides[4] = {4, 0, 5, 1}; /* +Z +X -Z -X */
    for (int turns = 0; turns < 4; turns++)
        add_side(plan, side, sides[turns], turns);
    add_pole(plan, pole, 2, false);
    add_pole(plan, pole, 3, true);
    return status;
}

/* ---- strips ---- */

/* A face whose pixels begin at a row and a column of the map, perhaps mirrored. */
static void add_strip_face(resampler *plan, uint32_t face, int64_t row, int64_t column, bool mirror_rows,
                           bool mirror_columns)
{
    int64_t last = (plan->width < plan->height ? plan->width : plan->height) - 1;
    for (int quarter = 0; quarter < 4; quarter++) {
        bool right = quarter & 1, below = quarter & 2;
        bool rows = mirror_rows != below, columns = mirror_columns != right;
        quarter_view view = view_of_quarter(plan, face, right, below);
        view.row_offset = rows ? row + last : row;
        view.row_sign = rows ? -1 : 1;
        view.column_offset = columns ? column + last : column;
        view.column_sign = columns ? -1 : 1;
        add_view(plan, &plan->lists[0], view);
    }
}

static helio_status plan_strip(helio_context *context, bool openexr, resampler *plan)
{
    bool stacked = plan->height > plan->width;
    uint32_t face_size = stacked ? plan->width : plan->height;
    plan->list_rows = face_size;
    plan->list_count = 1;
    overlap_geometry geometry;
    helio_status status = overlap_strip_geometry(context, plan->size, face_size, openexr, &geometry);
    if (status == HELIO_OK)
        status = overlap_list_create(context, &geometry, overlap_strip, &plan->lists[0]);
    overlap_geometry_release(context, &geometry);
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        /* OpenEXR draws its faces as seen from outside: the sides mirrored left to right, top and bottom upside down.
         */
        bool is_pole = face == 2 || face == 3;
        add_strip_face(plan, face, stacked ? face * face_size : 0, stacked ? 0 : face * face_size, openexr && is_pole,
                       openexr && !is_pole);
    }
    return status;
}

/* ---- life ---- */

static helio_status allocate_readings(helio_context *context, resampler *plan)
{
    plan->readings = context_allocate(context, (size_t)plan->group_count * plan->list_rows, sizeof *plan->readings);
    if (plan->readings == NULL)
        return HELIO_ERR_MEMORY;
    for (int i = 0; i < plan->group_count; i++)
        plan->groups[i].readings = plan->readings + (size_t)i * plan->list_rows;
    return HELIO_OK;
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
    helio_status status = layout == HELIO_LAYOUT_LATLONG
                              ? plan_latlong(context, plan)
                              : plan_strip(context, layout == HELIO_LAYOUT_STRIP_OPENEXR, plan);
    if (status == HELIO_OK)
        status = allocate_readings(context, plan);
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
    context_release(context, plan->readings);
    context_release(context, plan);
}
