/* SPDX-License-Identifier: MIT */
#include "eval/lobe.h"

/* What is left of a lobe beyond its reach: 2^-40 of its peak. */
static const double REACH_BITS = 40.0;

/* cos^n has as many derivatives at 90 degrees, where it is cut off. */
static const float SMOOTH_EXPONENT = 12.0f;

lobe lobe_measure(const brdf *surface)
{
    lobe l = {.surface = surface, .width = (double)INFINITY, .reach = 2.0};
    if (surface->kind == HELIO_MATERIAL_PHONG) {
        double exponent = (double)surface->exponent;
        l.width = 1.0 / sqrt(exponent + 1.0); /* of the bell curve that it is like */
        l.reach = exponent > 0.0 ? sqrt(2.0 * (1.0 - exp2(-REACH_BITS / exponent))) : 2.0;
    } else if (surface->kind == HELIO_MATERIAL_GGX) {
        l.width = 2.0 * (double)surface->view_cosine * sqrt((double)surface->alpha2);
    }
    return l;
}

double lobe_distance(const lobe *l, vec3 light)
{
    return l->surface->kind == HELIO_MATERIAL_PHONG ? (double)length(subtract(light, l->surface->mirror)) : 0.0;
}

bool lobe_has_horizon(const lobe *l)
{
    return l->surface->kind == HELIO_MATERIAL_PHONG && l->surface->exponent < SMOOTH_EXPONENT;
}

/* The distribution changes over its width, or over the distance from its peak in the space of half vectors, which move
 * at half the pace of the light, or faster where the light comes at a right angle to the view. Masking changes over
 * some alpha at the horizon. Neither distance changes faster than the direction does. */
static double ggx_scale(const lobe *l, vec3 light, double radius)
{
    const brdf *b = l->surface;
    vec3 half = ggx_half(b, light), sine = cross(b->normal, half);
    double pace = 2.0 * fabs((double)dot(b->view, half)), alpha2 = (double)b->alpha2;
    double above = fmax(0.0, fabs((double)dot(b->normal, light)) - radius);
    double peak = pace * sqrt(alpha2 + (double)dot(sine, sine)) - radius, masking = 4.0 * sqrt(alpha2 + above * above);
    double least = fmin(1.0, 0.7 * pace) * sqrt(alpha2);
    return fmin(0.5, fmin(masking, fmax(least, peak)));
}

double lobe_scale(const lobe *l, vec3 light, double radius)
{
    switch (l->surface->kind) {
    case HELIO_MATERIAL_PHONG: return l->width;
    case HELIO_MATERIAL_GGX: return ggx_scale(l, light, radius);
    default: return (double)INFINITY;
    }
}
