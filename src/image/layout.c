/* SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "core/name_list.h"

#include <heliostat/image.h>

#include <math.h>

static const char *const NAMES[] = {"auto",          "latlong",    "cross-v",    "cross-h", "faces",     "strip",
                                    "strip-openexr", "octahedral", "equal-area", "angular", "mirrorball"};
static const name_list LAYOUTS = NAME_LIST("layout", NAMES);

const char *helio_layout_name(helio_layout layout)
{
    return name_list_get(&LAYOUTS, (int)layout);
}

helio_status helio_layout_parse(const char *name, helio_layout *layout)
{
    int value;
    HELIO_TRY(name_list_find(&LAYOUTS, layout ? name : NULL, &value));
    *layout = (helio_layout)value;
    return HELIO_OK;
}

/* ---- shapes ---- */

/* Width to height; {0, 0}: any. */
typedef struct layout_ratio {
    uint32_t width, height;
} layout_ratio;

enum { MAX_RATIOS = 2 };

typedef struct layout_shape {
    layout_ratio ratios[MAX_RATIOS]; /* the second one, where there is none: as the first */
    const char *words;
} layout_shape;

static const layout_shape SHAPES[] = {
    [HELIO_LAYOUT_LATLONG] = {{{0, 0}, {0, 0}}, "2:1"},       [HELIO_LAYOUT_CROSS_V] = {{{3, 4}, {3, 4}}, "3:4"},
    [HELIO_LAYOUT_CROSS_H] = {{{4, 3}, {4, 3}}, "4:3"},       [HELIO_LAYOUT_FACES] = {{{1, 6}, {6, 1}}, "6:1 or 1:6"},
    [HELIO_LAYOUT_STRIP] = {{{1, 6}, {6, 1}}, "6:1 or 1:6"},  [HELIO_LAYOUT_STRIP_OPENEXR] = {{{1, 6}, {1, 6}}, "1:6"},
    [HELIO_LAYOUT_OCTAHEDRAL] = {{{1, 1}, {1, 1}}, "square"}, [HELIO_LAYOUT_EQUAL_AREA] = {{{1, 1}, {1, 1}}, "square"},
    [HELIO_LAYOUT_ANGULAR] = {{{1, 1}, {1, 1}}, "square"},    [HELIO_LAYOUT_MIRRORBALL] = {{{1, 1}, {1, 1}}, "square"},
};

/* Whole faces, too: 8 x 6 pixels are a cross, 2 x 1.5 would not be. */
static bool has_ratio(uint32_t width, uint32_t height, layout_ratio ratio)
{
    return ratio.width == 0 ||
           (width % ratio.width == 0 && height % ratio.height == 0 && width / ratio.width == height / ratio.height);
}

static bool has_shape(uint32_t width, uint32_t height, helio_layout layout)
{
    const layout_shape *shape = &SHAPES[layout];
    return has_ratio(width, height, shape->ratios[0]) || has_ratio(width, height, shape->ratios[1]);
}

helio_status helio_layout_shape(helio_layout layout, uint32_t size, uint32_t *width, uint32_t *height)
{
    enum { MAX_SIZE = 4096 };
    if (size == 0 || size > MAX_SIZE || width == NULL || height == NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_layout_shape needs a cube's size of 1 to %d (got %u) and places for width and height",
                    MAX_SIZE, size);
    HELIO_TRY(name_list_check(&LAYOUTS, (int)layout));
    if (layout == HELIO_LAYOUT_AUTO)
        return fail(HELIO_ERR_ARGUMENT, "layout auto has no shape; name one that a map can have");
    layout_ratio ratio = SHAPES[layout].ratios[0];
    uint32_t edge = size;
    if (ratio.width == 0) {
        ratio = (layout_ratio){4, 2};
    } else if (ratio.width == ratio.height) {
        edge = (uint32_t)ceil(sqrt(8.0 * size * size));
        edge += edge % 2;
    }
    *width = ratio.width * edge;
    *height = ratio.height * edge;
    return HELIO_OK;
}

/* ---- guesses ---- */

static bool is_latlong_shape(uint64_t width, uint64_t height)
{
    uint64_t wanted = 2 * height, difference = width > wanted ? width - wanted : wanted - width;
    return 100 * difference <= wanted;
}

static helio_status guess_from_shape(uint32_t width, uint32_t height, helio_layout *layout)
{
    static const helio_layout certain[] = {HELIO_LAYOUT_STRIP, HELIO_LAYOUT_CROSS_V, HELIO_LAYOUT_CROSS_H};
    for (size_t i = 0; i < sizeof certain / sizeof *certain; i++)
        if (has_shape(width, height, certain[i])) {
            *layout = certain[i];
            return HELIO_OK;
        }
    if (is_latlong_shape(width, height)) {
        *layout = HELIO_LAYOUT_LATLONG;
        return HELIO_OK;
    }
    if (width == height)
        return fail(HELIO_ERR_DATA,
                    "%u x %u pixels do not tell the layout: a square may be angular, mirrorball, octahedral or "
                    "equal-area; name the layout (--layout)",
                    width, height);
    return fail(HELIO_ERR_DATA,
                "%u x %u pixels do not tell the layout: latlong is 2:1, cross-v 3:4, cross-h 4:3, strip 6:1 or 1:6, "
                "strip-openexr 1:6, and angular, mirrorball, octahedral and equal-area are square; name the layout "
                "(--layout) or change the shape",
                width, height);
}

helio_status helio_layout_guess(uint32_t width, uint32_t height, helio_layout hint, helio_layout *layout)
{
    if (width == 0 || height == 0 || layout == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_layout_guess needs a size of at least 1 x 1 (got %u x %u) and a place",
                    width, height);
    HELIO_TRY(name_list_check(&LAYOUTS, (int)hint));
    if (width == 1 && height == 1) {
        *layout = HELIO_LAYOUT_LATLONG; /* constant: any layout does */
        return HELIO_OK;
    }
    if (hint == HELIO_LAYOUT_AUTO)
        return guess_from_shape(width, height, layout);
    /* A lat-long map may have any shape if somebody says that it is one; faces, squares and discs may not. */
    if (!has_shape(width, height, hint))
        return fail(HELIO_ERR_DATA,
                    "%u x %u pixels cannot be a map of layout %s, which is %s; choose another layout (latlong may have "
                    "any shape) or change the shape",
                    width, height, helio_layout_name(hint), SHAPES[hint].words);
    *layout = hint;
    return HELIO_OK;
}
