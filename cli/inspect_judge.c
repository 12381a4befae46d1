/* SPDX-License-Identifier: MIT
 *
 * Does the map look clipped? Whoever cuts bright values off leaves many pixels with the very same greatest value; a sun
 * that is whole hardly has two. Of 22 captured maps one has 4 such pixels and none has more; 18 of them are changed by
 * clipping at 1000, and 16 of these then have 4 to 115 such pixels. A plateau is no clipping where the spot gives as
 * much light as a whole sun: above 5 degrees the sun in a clear sky gives a third or more of the light on a horizontal
 * surface. And a sun may have been too bright for all exposures of a capture, and lost its plateau when it was
 * resampled: a spot of its size in an even sky with less than a tenth of that light is no whole sun. */
#include "inspect.h"

#include <math.h>
#include <string.h>

enum { PLATEAU_LEAST = 4 };
static const double HALF_MOST = 65504;
static const double WHITE = 1, WHITE_WIDTH = 1e-3;

static const double SUN_MOST = 2e-3;    /* sr: a disc of 2.9 degrees, the sun with its glare in coarse maps */
static const double SUN_SHARE = 0.3;    /* of the light on a horizontal surface */
static const double WEAK_SHARE = 0.1;   /* too little for any sun */
static const double WEAK_ELEVATION = 5; /* degrees; below, the air takes most of it */
static const double SKY_EVENNESS = 0.3; /* median of the upper half, as a part of its mean without the spot */
static const double SMALL_SPOT = 0.02;  /* sr: a disc of 9 degrees */

const char *inspect_clipping_name(inspect_clipping clipping)
{
    static const char *const names[] = {"none", "white", "half", "plateau", "weak"};
    return names[clipping];
}

/* Of few bits, so that equal values mean nothing, but at the end of the range. */
static bool is_coarse(const inspect_findings *found)
{
    static const char *const kinds[] = {"PNG", "JPEG", "video", "device"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(found->file_kind, kinds[i]) == 0)
            return true;
    return false;
}

static bool is_within(const inspect_spot *spot, double solid_angle)
{
    return spot->edge <= SPOT_FIRST_EDGE && spot->solid_angle <= solid_angle;
}

static bool looks_like_sun(const inspect_spot *spot)
{
    return is_within(spot, SUN_MOST) && spot->elevation >= WEAK_ELEVATION;
}

/* Rooms and streets at night are dark between the lamps. */
static bool is_under_sky(const inspect_findings *found)
{
    return found->upper_median >= SKY_EVENNESS * found->upper_mean;
}

static inspect_clipping find_clipping(const inspect_findings *found)
{
    const inspect_spot *spot = &found->spot;
    bool has_plateau = found->plateau >= PLATEAU_LEAST;
    if (is_coarse(found) && has_plateau && fabs(found->greatest_channel - WHITE) < WHITE_WIDTH)
        return CLIPPING_WHITE;
    if (found->greatest_channel == HALF_MOST)
        return CLIPPING_HALF;
    if (!found->has_spot || strcmp(found->file_kind, "sky") == 0)
        return CLIPPING_NONE;
    bool is_whole_sun = looks_like_sun(spot) && spot->irradiance_share >= SUN_SHARE;
    if (has_plateau && !is_whole_sun && !is_coarse(found))
        return CLIPPING_PLATEAU;
    if (is_under_sky(found) && looks_like_sun(spot) && spot->irradiance_share < WEAK_SHARE)
        return CLIPPING_WEAK;
    return CLIPPING_NONE;
}

static const char *advise(const inspect_findings *found)
{
    const inspect_spot *spot = &found->spot;
    bool is_small = found->has_spot && is_within(spot, SMALL_SPOT);
    if (found->all_flux <= 0)
        return "the map gives no light";
    if (found->bad.nan + found->bad.infinite > 0)
        return "pixels that are no numbers are taken as black; heliostat convert writes the map without them";
    switch (found->clipping) {
    case CLIPPING_WHITE:
        return "the map has no more range than a screen: lights and sun are cut off, shadows will be soft";
    case CLIPPING_HALF: return "the brightest light is cut off at what half floats hold: write the map in floats";
    case CLIPPING_PLATEAU:
        if (!is_small)
            return "the brightest part is clipped, or was drawn with one brightness";
        return is_under_sky(found) && spot->elevation > 0
                   ? "the sun, or a lamp in its place, is clipped: it is too weak, and shadows will be soft"
                   : "the brightest light is clipped, or was drawn with one brightness: it may be too weak";
    case CLIPPING_WEAK: return "the sun is far too weak, as if clipped: shadows will be soft";
    case CLIPPING_NONE: break;
    }
    if (!found->has_spot)
        return "the light is even: few samples will do";
    if (is_small && spot->irradiance_share >= SUN_SHARE)
        return "a small bright spot gives much of the light: shadows will be sharp";
    return "nothing looks wrong";
}

void inspect_judge(inspect_findings *found)
{
    found->clipping = find_clipping(found);
    found->advice = advise(found);
}
