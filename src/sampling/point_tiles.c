/* SPDX-License-Identifier: MIT */
#include "sampling/point_tiles.h"

#include "sampling/rules.h"

/* Angle from the mirror direction at which the lobe has fallen to a quarter. */
static float lobe_width(const brdf *b)
{
    return b->kind == HELIO_MATERIAL_GGX ? 2.0f * sqrtf(b->alpha2) : RULE_PHONG_WIDTH / sqrtf(fmaxf(b->exponent, 1.0f));
}

/* 0 for a lobe as wide as the sky, 1 for a mirror. */
static float narrowness(const tiles *t, const brdf *b)
{
    return t->radius / (t->radius + lobe_width(b) / RULE_EVEN_WIDTH);
}

float tile_lobe_need(const tiles *t, const brdf *b)
{
    return b->specular_share * narrowness(t, b);
}

/* Convolved with a tile, the lobe's variance grows by that of the tile. */
static void prepare_phong(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    lobe->axis = b->mirror;
    lobe->width = 1.0f / fmaxf(b->exponent, 1e-3f) + RULE_PHONG_TILE * t->edge * t->edge;
    lobe->specular /= b->exponent + 2.0f;
}

static void prepare_ggx(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    lobe->axis = b->view;
    lobe->alpha = sqrtf(b->alpha2);
    lobe->width = b->alpha2 + t->edge * t->edge;
    lobe->specular += vec3_luminance(b->colours[2]) * schlick_weight(b->view_cosine);
    lobe->specular *= INVERSE_PI;
}

void tile_lobe_prepare(tile_lobe *lobe, const tiles *t, const brdf *b)
{
    *lobe = (tile_lobe){.kind = b->kind,
                        .normal = b->normal,
                        .edge = t->edge,
                        .view_cosine = b->view_cosine,
                        .geometric_normal = b->normal};
    lobe->slope = 0.25f / t->edge;
    lobe->to_surface = RULE_EVEN_WIDTH / lobe_width(b);
    lobe->least_part = (1.0f + (POINT_REFINED_TIMES - 1) * tile_lobe_need(t, b)) / POINT_REFINED_PARTS;
    lobe->diffuse = vec3_luminance(b->colours[0]);
    lobe->specular = vec3_luminance(b->colours[1]);
    if (b->kind == HELIO_MATERIAL_PHONG)
        prepare_phong(lobe, t, b);
    else
        prepare_ggx(lobe, t, b);
}
