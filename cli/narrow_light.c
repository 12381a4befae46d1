/* SPDX-License-Identifier: MIT */
#include "narrow_light.h"

#include <math.h>
#include <stddef.h>

/* Texels by luminance, sixteen groups to a factor of two, from 2^-40 to 2^100. */
enum { GROUPS = 16 * 140 };

typedef struct light_groups {
    double flux[GROUPS], solid_angle[GROUPS], all;
} light_groups;

static void add_texel(light_groups *groups, const float *rgb, double solid_angle)
{
    double luminance = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
    if (!(luminance > 0))
        return;
    double place = fmin(fmax(16 * (log2(luminance) + 40), 0), GROUPS - 1);
    groups->flux[(size_t)place] += luminance * solid_angle;
    groups->solid_angle[(size_t)place] += solid_angle;
    groups->all += luminance * solid_angle;
}

double narrow_light_solid_angle(const helio_environment *environment, double share)
{
    static light_groups groups;
    const float *cube = helio_environment_cube(environment);
    size_t size = helio_environment_cube_size(environment);
    groups = (light_groups){.all = 0};
    for (size_t i = 0; i < 6 * size * size; i++) {
        double u = (2.0 * (double)(i % size) + 1) / (double)size - 1;
        double v = (2.0 * (double)(i / size % size) + 1) / (double)size - 1, squared = 1 + u * u + v * v;
        add_texel(&groups, cube + 3 * i, 4.0 / ((double)(size * size) * squared * sqrt(squared)));
    }
    double flux = 0, solid_angle = 0;
    for (size_t i = GROUPS; i-- > 0 && flux < share * groups.all;) {
        flux += groups.flux[i];
        solid_angle += groups.solid_angle[i];
    }
    return solid_angle;
}
