/* SPDX-License-Identifier: MIT */
#include "image/tonemap.h"

#include "core/error.h"
#include "core/name_list.h"
#include "core/vector.h"
#include "image/colour.h"

static const char *const NAMES[] = {"clip", "reinhard"};
static const name_list TONEMAPS = NAME_LIST("tone map", NAMES);

const char *helio_tonemap_name(helio_tonemap tonemap)
{
    return name_list_get(&TONEMAPS, (int)tonemap);
}

helio_status helio_tonemap_parse(const char *name, helio_tonemap *tonemap)
{
    int value;
    HELIO_TRY(name_list_find(&TONEMAPS, tonemap ? name : NULL, &value));
    *tonemap = (helio_tonemap)value;
    return HELIO_OK;
}

helio_status tonemap_check(const helio_picture_write_desc *desc, const char *name)
{
    if (!isfinite(desc->exposure))
        return fail(HELIO_ERR_ARGUMENT, "the exposure for %s is no finite number", name);
    if ((unsigned)desc->tonemap > HELIO_TONEMAP_REINHARD)
        return fail(HELIO_ERR_ARGUMENT, "tone map %d for %s is unknown; use HELIO_TONEMAP_CLIP or _REINHARD",
                    (int)desc->tonemap, name);
    return HELIO_OK;
}

/* 0 for NaN. */
static float clamp(float value, float greatest)
{
    return value > 0 ? (value < greatest ? value : greatest) : 0;
}

static unsigned char to_byte(float value)
{
    return (unsigned char)(clamp(value, 1) * 255 + 0.5f);
}

void helio_tonemap_apply(helio_tonemap tonemap, float exposure, const float rgb[3], float shown[3])
{
    const float much = 1e30f; /* a stand-in for infinity that can be divided */
    float factor = exp2f(exposure);
    for (int c = 0; c < 3; c++)
        shown[c] = clamp(rgb[c] * factor, much);
    float divisor = tonemap == HELIO_TONEMAP_REINHARD ? 1 + luminance(shown) : 1;
    for (int c = 0; c < 3; c++)
        shown[c] = clamp(shown[c] / divisor, 1);
}

void tonemap_linear(const float rgba[4], const helio_picture_write_desc *desc, float rgb[3])
{
    float alpha = clamp(rgba[3], 1);
    for (int c = 0; c < 3; c++)
        rgb[c] = !desc->alpha ? rgba[c] : alpha > 0 ? rgba[c] / alpha : 0;
    helio_tonemap_apply(desc->tonemap, desc->exposure, rgb, rgb);
}

void tonemap_pixel(const float rgba[4], const helio_picture_write_desc *desc, unsigned char *pixel)
{
    float rgb[3];
    tonemap_linear(rgba, desc, rgb);
    for (int c = 0; c < 3; c++)
        pixel[c] = to_byte(srgb_encode(rgb[c]));
    if (desc->alpha)
        pixel[3] = to_byte(clamp(rgba[3], 1));
}
