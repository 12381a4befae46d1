/* SPDX-License-Identifier: MIT */
#include "env/sky_twilight.h"

#include <math.h>
#include <stddef.h>

/* xy = (0.25, 0.25), near the zenith's colour in civil twilight. */
const double twilight_colour[3] = {0.7052, 0.9899, 1.9666};

static const double MODEL_LOWEST = 0.5;

/* Rests at MODEL_LOWEST below 0 and goes into the elevation itself at TWILIGHT_BEGINS by a parabola. */
double twilight_model_elevation(double elevation)
{
    if (elevation >= TWILIGHT_BEGINS)
        return elevation;
    return elevation > 0.0 ? MODEL_LOWEST + (1.0 - MODEL_LOWEST) * elevation * elevation : MODEL_LOWEST;
}

/* Logarithms of brightness. The illuminances at -6, -12 and -18 degrees, 3.4, 0.0080 and 0.00065 lx, and how fast they
 * fall there are those of P. M. Janiczek and J. A. DeYoung, "Computer Programs for Sun and Moon Illuminance", U.S.
 * Naval Observatory Circular 171, 1987, relative to the 2,800 lx that the model gives at MODEL_LOWEST for turbidities
 * about
 * 3. Further down it stays as it is. */
static const struct knot {
    double elevation, logarithm, slope; /* slope: per degree */
} knots[] = {{1.0, 0.0, 0.0}, {-6.0, -6.71, 1.14}, {-12.0, -12.76, 0.66}, {-18.0, -15.28, 0.0}};

double twilight_brightness(double elevation)
{
    const size_t last = sizeof knots / sizeof *knots - 1;
    if (elevation >= knots[0].elevation)
        return 1.0;
    if (elevation <= knots[last].elevation)
        return exp(knots[last].logarithm);
    const struct knot *a = knots;
    while (elevation < a[1].elevation)
        a++;
    double width = a[1].elevation - a[0].elevation, t = (elevation - a[0].elevation) / width, s = 1.0 - t;
    return exp(s * s * ((1.0 + 2.0 * t) * a[0].logarithm + t * width * a[0].slope) +
               t * t * ((1.0 + 2.0 * s) * a[1].logarithm - s * width * a[1].slope));
}

double twilight_even_part(double elevation)
{
    const double complete = -12.0;
    double t = (TWILIGHT_BEGINS - elevation) / (TWILIGHT_BEGINS - complete);
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    return t * t * (3.0 - 2.0 * t);
}
