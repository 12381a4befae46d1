/* SPDX-License-Identifier: MIT */
#include "inspect_drawing.h"

#include "false_colour.h"

#include <math.h>

/* ---- scale -------------------------------------------------------------------------------- */

static double lit_area(const inspect_histogram *histogram)
{
    double area = 0;
    for (int i = 0; i < HISTOGRAM_BINS; i++)
        area += histogram->area[i];
    return area;
}

/* The stop below which that part of the lit area lies. */
static double find_stop(const inspect_histogram *histogram, double part)
{
    double wanted = part * lit_area(histogram), below = 0;
    int bin = 0;
    while (bin < HISTOGRAM_BINS - 1 && below + histogram->area[bin] <= wanted)
        below += histogram->area[bin++];
    return (double)bin / STOP_BINS + LOWEST_STOP;
}

static double find_greatest(const inspect_histogram *histogram)
{
    int bin = HISTOGRAM_BINS - 1;
    while (bin > 0 && histogram->area[bin] <= 0)
        bin--;
    return (double)bin / STOP_BINS + LOWEST_STOP;
}

/* In whole stops. */
colour_scale colour_scale_choose(const inspect_histogram *histogram)
{
    if (!(lit_area(histogram) > 0))
        return (colour_scale){-LEAST_STOPS / 2.0, LEAST_STOPS / 2.0, LEAST_STOPS / 2.0};
    colour_scale scale = {.low = floor(find_stop(histogram, 0.005)), .high = floor(find_greatest(histogram)) + 1};
    double lacking = LEAST_STOPS - (scale.high - scale.low);
    if (lacking > 0) {
        scale.low -= floor(lacking / 2);
        scale.high += ceil(lacking / 2);
    }
    scale.low = fmax(scale.low, scale.high - MOST_STOPS);
    scale.knee = fmin(fmax(floor(find_stop(histogram, 0.995)) + 1, scale.low + 1), scale.high);
    return scale;
}

void colour_scale_colour(const colour_scale *scale, double stop, double rgb[3])
{
    const double share = 0.7; /* of the colours, at least, for what lies below the knee */
    double even = (scale->knee - scale->low) / (scale->high - scale->low), below = fmax(even, share);
    if (stop < scale->knee || scale->knee >= scale->high)
        false_colour(below * (stop - scale->low) / (scale->knee - scale->low), rgb);
    else
        false_colour(below + (1 - below) * (stop - scale->knee) / (scale->high - scale->knee), rgb);
}
