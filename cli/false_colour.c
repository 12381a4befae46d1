/* SPDX-License-Identifier: MIT */
#include "false_colour.h"

#include "srgb.h"

#include <math.h>
#include <stdbool.h>

/* In Oklab (B. Ottosson 2020), whose lightness is even to the eye. */
static const double DARKEST = 0.22, LIGHTEST = 0.97;
static const double FIRST_HUE = 275, LAST_HUE = 460; /* degrees: violet, and yellow once around */
static const double MOST_CHROMA = 0.2;

/* To linear sRGB. False if it has no such colour. */
static bool from_oklab(double lightness, double a, double b, double rgb[3])
{
    double l = lightness + 0.3963377774 * a + 0.2158037573 * b;
    double m = lightness - 0.1055613458 * a - 0.0638541728 * b;
    double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
    l = l * l * l;
    m = m * m * m;
    s = s * s * s;
    rgb[0] = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
    rgb[1] = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
    rgb[2] = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
    bool exists = true;
    for (int c = 0; c < 3; c++)
        exists = exists && rgb[c] >= 0 && rgb[c] <= 1;
    return exists;
}

void false_colour(double position, double rgb[3])
{
    double t = fmin(fmax(position, 0), 1), lightness = DARKEST + t * (LIGHTEST - DARKEST);
    double hue = (FIRST_HUE + t * (LAST_HUE - FIRST_HUE)) * acos(-1) / 180, chroma = MOST_CHROMA;
    while (!from_oklab(lightness, chroma * cos(hue), chroma * sin(hue), rgb) && chroma > 0)
        chroma -= 0.002;
    for (int c = 0; c < 3; c++)
        rgb[c] = srgb_encode(rgb[c]);
}
