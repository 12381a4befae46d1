/* SPDX-License-Identifier: MIT */
#include "eval/lab.h"

#include <heliostat/comparison.h>

#include <lcms2.h>

bool helio_comparison_has_lab(void)
{
    return true;
}

void lab_space_make(lab_space *space)
{
    const double white[3] = {1, 1, 1};
    space->to_xyz = colour_rec709_to_xyz();
    colour_transform(&space->to_xyz, white, space->white);
}

static cmsCIEXYZ xyz_of(const double xyz[3])
{
    return (cmsCIEXYZ){xyz[0], xyz[1], xyz[2]};
}

static cmsCIELab lcms_colour(const lab_colour *colour)
{
    return (cmsCIELab){colour->lightness, colour->a, colour->b};
}

lab_colour lab_from_rec709(const lab_space *space, const float rgb[3])
{
    const double linear[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    double tristimulus[3];
    colour_transform(&space->to_xyz, linear, tristimulus);
    const cmsCIEXYZ white = xyz_of(space->white), xyz = xyz_of(tristimulus);
    cmsCIELab lab;
    cmsXYZ2Lab(&white, &lab, &xyz);
    return (lab_colour){lab.L, lab.a, lab.b};
}

double lab_difference(const lab_colour *a, const lab_colour *b)
{
    const cmsCIELab first = lcms_colour(a), second = lcms_colour(b);
    return cmsDeltaE(&first, &second);
}

double lab_difference_2000(const lab_colour *a, const lab_colour *b)
{
    const cmsCIELab first = lcms_colour(a), second = lcms_colour(b);
    return cmsCIE2000DeltaE(&first, &second, 1, 1, 1);
}
