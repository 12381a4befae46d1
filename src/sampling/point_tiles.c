/* SPDX-License-Identifier: MIT */
#include "sampling/point_tiles.h"

/* The lobe's width at which light and BRDF get equally many samples is this part of a tile's radius. */
static const float EVEN_WIDTH = 1.25f;

/* Angle from the mirror direction at which the lobe has fallen to a quarter. */
static float lobe_width(const brdf *b)
{
    return b->kind == HELIO_MATERIAL_GGX ? 2.0f * sqrtf(b->alpha2) : 1.665f / sqrtf(fmaxf(b->exponent, 1.0f));
}

/* 0 for a lobe as wide as the sky, 1 for a mirror. */
static float narrowness(const tiles *t, const brdf *b)
{
    return t->radius / (t->radius + lobe_width(b) / EVEN_WIDTH);
}

float tile_lobe_need(const tiles *t, const brdf *b)
{
    return b->specular_share * narrowness(t, b);
}

static float luminance_of(vec3 colour)
{
    const float rgb[3] = {colour.x, colour.y, colour.z};
    return luminance(rgb);
}

/* Convolved with a tile, the lobe's variance grows by that of the tile. */
static void prepare_phong(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    const float per_nat = 1.44269504f, widened = 1.0f / (1.0f / fmaxf(b->exponent, 1e-3f) + 0.3f * t->edge * t->edge);
    lobe->axis = b->mirror;
    lobe->sharpness = per_nat * widened;
    lobe->specular *= (widened + 2.0f) / (b->exponent + 2.0f);
}

static void prepare_ggx(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    const float widened = b->alpha2 + t->edge * t->edge, fresnel = schlick_weight(b->view_cosine);
    lobe->axis = b->view;
    lobe->alpha = sqrtf(b->alpha2);
    lobe->narrowness = 1.0f - fminf(widened, 0.999f);
    lobe->specular += luminance_of(b->colours[2]) * fresnel;
    lobe->specular *= widened * INVERSE_PI;
}

void tile_lobe_prepare(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    *lobe = (tile_lobe){.kind = b->kind, .normal = b->normal, .edge = t->edge, .view_cosine = b->view_cosine};
    lobe->slope = 0.25f / t->edge;
    lobe->to_surface = EVEN_WIDTH / lobe_width(b);
    lobe->diffuse = luminance_of(b->colours[0]);
    lobe->specular = luminance_of(b->colours[1]);
    if (b->kind == HELIO_MATERIAL_PHONG)
        prepare_phong(lobe, t, b);
    else
        prepare_ggx(lobe, t, b);
}
