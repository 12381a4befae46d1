/* SPDX-License-Identifier: MIT */
#include "eval/comparison.h"

#include "core/context.h"
#include "core/error.h"
#include "core/name_list.h"

static const float USUAL_PIXELS_PER_DEGREE = 67;
static const uint32_t EDGE_LIMIT = 65536;
static const uint64_t PIXEL_LIMIT = UINT64_C(1) << 28;

static const char *const NAMES[ERROR_MAPS] = {"lab", "de2000", "relative", "flip"};
static const name_list MAPS = NAME_LIST("error map", NAMES);

const char *helio_error_map_name(helio_error_map map)
{
    return name_list_get(&MAPS, (int)map);
}

helio_status helio_error_map_parse(const char *name, helio_error_map *map)
{
    int value;
    HELIO_TRY(name_list_find(&MAPS, map ? name : NULL, &value));
    *map = (helio_error_map)value;
    return HELIO_OK;
}

/* The only place where the defaults of a comparison live. */
static helio_status resolve_desc(const helio_comparison_desc *given, helio_comparison_desc *desc)
{
    *desc = *given;
    if (desc->width < 1 || desc->height < 1 || desc->width > EDGE_LIMIT || desc->height > EDGE_LIMIT ||
        (uint64_t)desc->width * desc->height > PIXEL_LIMIT)
        return fail(HELIO_ERR_ARGUMENT,
                    "pictures of %u x %u pixels cannot be compared; each edge has 1 to %u, and all are at most 2^28",
                    desc->width, desc->height, EDGE_LIMIT);
    if (desc->pixels_per_degree == 0)
        desc->pixels_per_degree = USUAL_PIXELS_PER_DEGREE;
    if (!(desc->pixels_per_degree >= 1 && desc->pixels_per_degree <= FLIP_PIXELS_PER_DEGREE_LIMIT))
        return fail(HELIO_ERR_ARGUMENT, "%g pixels per degree were asked for; use 1 to %d, or 0 for %g",
                    (double)desc->pixels_per_degree, FLIP_PIXELS_PER_DEGREE_LIMIT, (double)USUAL_PIXELS_PER_DEGREE);
    if (!desc->without_lab && !helio_comparison_has_lab())
        return fail(HELIO_ERR_UNSUPPORTED,
                    "this build has no lcms2, which differences in Lab need; build with it, or set without_lab");
    return HELIO_OK;
}

static bool take(helio_comparison *comparison, size_t channels, float **floats)
{
    size_t pixels = (size_t)comparison->width * comparison->height;
    *floats = context_allocate(comparison->context, pixels * channels, sizeof **floats);
    return *floats != NULL;
}

static bool take_memory(helio_comparison *comparison, const helio_comparison_desc *desc)
{
    const bool wanted[ERROR_MAPS] = {!desc->without_lab, !desc->without_lab, true, !desc->without_flip};
    comparison->rows = context_allocate(comparison->context, desc->height, sizeof *comparison->rows);
    bool good = comparison->rows != NULL;
    for (int i = 0; i < ERROR_MAPS; i++)
        good = good && (!wanted[i] || take(comparison, 1, &comparison->maps[i]));
    for (int i = 0; i < 6 && !desc->without_flip; i++)
        good = good && take(comparison, 1, &comparison->pictures[i / 3].planes[i % 3]);
    if (desc->flicker)
        good =
            good && take(comparison, 3, &comparison->past.errors) && take(comparison, 3, &comparison->past.references);
    return good;
}

helio_status helio_comparison_create(helio_context *context, const helio_comparison_desc *given,
                                     helio_comparison **comparison)
{
    helio_comparison_desc desc;
    if (comparison == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_comparison_create needs a place for the comparison");
    *comparison = NULL;
    if (context == NULL || given == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_comparison_create needs a context and a desc");
    HELIO_TRY(resolve_desc(given, &desc));
    helio_comparison *made = context_allocate(context, 1, sizeof *made);
    if (made == NULL)
        return HELIO_ERR_MEMORY;
    made->context = context;
    made->width = desc.width;
    made->height = desc.height;
    if (!take_memory(made, &desc)) {
        helio_comparison_destroy(made);
        return HELIO_ERR_MEMORY;
    }
    lab_space_make(&made->lab);
    flip_viewer_make(&made->viewer, (double)desc.pixels_per_degree);
    for (int side = 0; side < 2; side++) {
        made->pictures[side].width = desc.width;
        made->pictures[side].height = desc.height;
    }
    *comparison = made;
    return HELIO_OK;
}

void helio_comparison_destroy(helio_comparison *comparison)
{
    if (comparison == NULL)
        return;
    helio_context *context = comparison->context;
    for (int i = 0; i < ERROR_MAPS; i++)
        context_release(context, comparison->maps[i]);
    for (int i = 0; i < 6; i++)
        context_release(context, comparison->pictures[i / 3].planes[i % 3]);
    context_release(context, comparison->past.errors);
    context_release(context, comparison->past.references);
    context_release(context, comparison->rows);
    context_release(context, comparison);
}

void helio_comparison_restart(helio_comparison *comparison)
{
    comparison->past.is_there = false;
}

const float *helio_comparison_map(const helio_comparison *comparison, helio_error_map map)
{
    bool is_known = map >= HELIO_ERROR_MAP_LAB && map <= HELIO_ERROR_MAP_FLIP;
    return comparison->has_pair && is_known ? comparison->maps[map] : NULL;
}
