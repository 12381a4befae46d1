/* SPDX-License-Identifier: MIT */
#include "env/sky_model.h"

#include <heliostat/sky.h>

/* The dataset's luminances times 683 lm/W are cd/m^2. */
static const double UNIT = 683.0 / HELIO_SKY_CANDELAS;
static const double LOG2_E = 1.44269504088896340736;

/* What control points weigh at an elevation. */
static void find_point_weights(double elevation, double weights[SKY_CONTROL_POINTS])
{
    static const double binomials[SKY_CONTROL_POINTS] = {1, 5, 10, 10, 5, 1};
    double x = cbrt(elevation / 90.0);
    for (int i = 0; i < SKY_CONTROL_POINTS; i++)
        weights[i] = binomials[i] * pow(1.0 - x, SKY_CONTROL_POINTS - 1 - i) * pow(x, i);
}

/* Adds the coefficients of one row of the tables. */
static void add_row(int row, double weight, const double point_weights[SKY_CONTROL_POINTS],
                    double coefficients[SKY_COEFFICIENTS], double *radiance)
{
    for (int i = 0; i < SKY_CONTROL_POINTS; i++) {
        int point = row * SKY_CONTROL_POINTS + i;
        double w = weight * point_weights[i];
        *radiance += w * sky_radiances[point];
        for (int k = 0; k < SKY_COEFFICIENTS; k++)
            coefficients[k] += w * sky_coefficients[point * SKY_COEFFICIENTS + k];
    }
}

/* Between two turbidities and between black and white ground. */
static void interpolate(int channel, double turbidity, double albedo, const double point_weights[SKY_CONTROL_POINTS],
                        double coefficients[SKY_COEFFICIENTS], double *radiance)
{
    int lower = (int)turbidity < SKY_TURBIDITIES - 1 ? (int)turbidity : SKY_TURBIDITIES - 1;
    double part = turbidity - lower;
    for (int white = 0; white < 2; white++) {
        int row = (channel * 2 + white) * SKY_TURBIDITIES + lower - 1;
        double weight = white ? albedo : 1.0 - albedo;
        add_row(row, weight * (1.0 - part), point_weights, coefficients, radiance);
        add_row(row + 1, weight * part, point_weights, coefficients, radiance);
    }
}

void sky_model_prepare(double elevation, double turbidity, double albedo, vec3 sun, sky_light *light)
{
    double point_weights[SKY_CONTROL_POINTS];
    find_point_weights(elevation, point_weights);
    *light = (sky_light){.sun = sun};
    for (int i = 0; i < 3; i++) {
        double c[SKY_COEFFICIENTS] = {0}, radiance = 0;
        interpolate(i, turbidity, albedo, point_weights, c, &radiance);
        radiance *= UNIT;
        light->horizon[i] = (float)c[0];
        light->horizon_exponent[i] = (float)(c[1] * LOG2_E);
        light->constant[i] = (float)(c[2] * radiance);
        light->glow[i] = (float)(c[3] * radiance);
        light->glow_exponent[i] = (float)(c[4] * LOG2_E);
        light->rayleigh[i] = (float)(c[5] * radiance);
        light->mie[i] = (float)(c[6] * radiance);
        light->zenith[i] = (float)(c[7] * radiance);
        /* 1 + g^2 - 2 g cos gamma = (1 - g)^2 + 2 g (1 - cos gamma), which stays exact near the sun. */
        light->mie_near[i] = (float)((1.0 - c[8]) * (1.0 - c[8]));
        light->mie_far[i] = (float)(2.0 * c[8]);
    }
}

void sky_light_scale(sky_light *light, double factor)
{
    float *const terms[] = {light->constant, light->glow, light->rayleigh, light->mie, light->zenith, light->even};
    for (size_t t = 0; t < sizeof terms / sizeof *terms; t++)
        for (int i = 0; i < 3; i++)
            terms[t][i] *= (float)factor;
}
