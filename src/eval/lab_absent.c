/* SPDX-License-Identifier: MIT
 * What builds without lcms2 have in place of lab.c. Nobody gets here: a comparison with Lab cannot be created. */
#include "eval/lab.h"

#include <heliostat/comparison.h>

#include <math.h>

bool helio_comparison_has_lab(void)
{
    return false;
}

void lab_space_make(lab_space *space)
{
    *space = (lab_space){0};
}

lab_colour lab_from_rec709(const lab_space *space, const float rgb[3])
{
    (void)space, (void)rgb;
    return (lab_colour){(double)NAN, (double)NAN, (double)NAN};
}

double lab_difference(const lab_colour *a, const lab_colour *b)
{
    (void)a, (void)b;
    return (double)NAN;
}

double lab_difference_2000(const lab_colour *a, const lab_colour *b)
{
    return lab_difference(a, b);
}
