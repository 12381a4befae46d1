/* SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "core/name_list.h"

#include <heliostat/image.h>

static const char *const NAMES[] = {"auto", "latlong", "strip", "strip-openexr"};
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

static bool is_latlong_shape(uint64_t width, uint64_t height)
{
    uint64_t wanted = 2 * height, difference = width > wanted ? width - wanted : wanted - width;
    return 100 * difference <= wanted;
}

static helio_status guess_from_shape(uint32_t width, uint32_t height, helio_layout *layout)
{
    bool strip = width == UINT64_C(6) * height || height == UINT64_C(6) * width;
    if (!strip && !is_latlong_shape(width, height))
        return fail(HELIO_ERR_DATA,
                    "%u x %u pixels do not tell the layout: latlong is 2:1, strip and strip-openexr are 6:1 or 1:6; "
                    "name the layout or change the shape",
                    width, height);
    *layout = strip ? HELIO_LAYOUT_STRIP : HELIO_LAYOUT_LATLONG;
    return HELIO_OK;
}

/* A lat-long map may have any shape if somebody says that it is one; faces must be square. */
static helio_status check_hint(uint32_t width, uint32_t height, helio_layout hint)
{
    bool wide = width == UINT64_C(6) * height, high = height == UINT64_C(6) * width;
    if (hint == HELIO_LAYOUT_STRIP && !wide && !high)
        return fail(HELIO_ERR_DATA,
                    "%u x %u pixels cannot be a strip of six square faces, which is 6:1 or 1:6; "
                    "choose latlong or change the shape",
                    width, height);
    if (hint == HELIO_LAYOUT_STRIP_OPENEXR && !high)
        return fail(HELIO_ERR_DATA,
                    "%u x %u pixels cannot be OpenEXR's stack of six square faces (strip-openexr), which is 1:6; "
                    "choose latlong or strip, or change the shape",
                    width, height);
    return HELIO_OK;
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
    HELIO_TRY(check_hint(width, height, hint));
    *layout = hint;
    return HELIO_OK;
}
