/* SPDX-License-Identifier: MIT
 * brdf.h - BRDFs with what depends on the point alone worked out once; their formulas, for loops over samples.
 *
 * The formulas are inline and choose by selection, not by branches: kernels build them into vector loops, with the
 * material as a constant. Value and density have one function each, used for drawing and for MIS. */
#ifndef HELIOSTAT_SRC_BRDF_H
#define HELIOSTAT_SRC_BRDF_H

#include "core/vector.h"
#include "sampling/elementary.h"

#include <heliostat/sampling.h>

/* Least cosine between normal and view, see helio_shading_point. */
#define BRDF_LEAST_VIEW_COSINE 1e-3f

#define INVERSE_PI ((float)(1.0 / PI))

enum { BRDF_LOBES = 3 };

/* A BRDF is a sum over lobes: a colour, which depends on the point alone, times a number that depends on the light. */
typedef struct brdf {
    helio_material_kind kind;
    vec3 normal, view;
    float view_cosine;        /* normal . view */
    vec3 mirror;              /* PHONG: of the view direction */
    float diffuse[3];         /* albedo of the diffuse lobe */
    float specular[3];        /* PHONG: ks. GGX: reflectance at normal incidence */
    vec3 colours[BRDF_LOBES]; /* of the lobes: red, green, blue; 1/sr times what brdf_lobes() leaves out */
    float specular_share;     /* probability of the specular lobe when sampling */
    float exponent;           /* PHONG */
    float alpha2;             /* GGX: alpha^2 */
} brdf;

/* Axes to draw directions about: the normal's, and the mirror direction's for PHONG. */
typedef struct brdf_axes {
    vec3 tangent, bitangent, lobe_tangent, lobe_bitangent;
} brdf_axes;

/* view must satisfy the rule for grazing views already. */
brdf brdf_prepare(const helio_material *material, vec3 normal, vec3 view);

/* The two halves of brdf_prepare(): what brdf_value() needs, and the rest, without which there is no density. */
void brdf_prepare_value(brdf *b, const helio_material *material, vec3 normal, vec3 view);
void brdf_prepare_share(brdf *b);

brdf_axes brdf_find_axes(const brdf *b);

/* The rule for grazing views. */
vec3 brdf_lift_view(vec3 normal, vec3 view);

/* For one direction; kernels use the inline functions below, of which these are made. */
void brdf_value(const brdf *b, vec3 light, float value[3]); /* [3], 1/sr; 0 below the normal's horizon */
float brdf_density(const brdf *b, vec3 light);
vec3 brdf_sample(const brdf *b, float lobe, float u, float v); /* three numbers in [0, 1) */

/* ---- PHONG ---- */

/* cos^n about the mirror direction, from the distance between the tips of the unit vectors: a cosine near 1 has lost
 * what a sharp lobe needs. */
static inline float phong_lobe(const brdf *b, vec3 light)
{
    float x = light.x - b->mirror.x, y = light.y - b->mirror.y, z = light.z - b->mirror.z;
    float less = 0.5f * (x * x + y * y + z * z); /* 1 - cos */
    float lobe = exp2_fast(b->exponent * log2_one_minus(less < 0.99999994f ? less : 0.99999994f));
    return less < 1.0f ? lobe : 0.0f;
}

/* log2 of the same from the cosine itself, with fewer operations: for lobes that are wide, so that its rounding does
 * not show (relative error of the lobe below 1e-4), and that shine beside a diffuse lobe, as what is behind the mirror
 * direction gets next to nothing in place of 0. See phong_is_wide(). */
static inline float phong_lobe_wide_log2(const brdf *b, vec3 light)
{
    float cosine = dot(b->mirror, light);
    return b->exponent * log2_fast(cosine > 0x1p-100f ? cosine : 0x1p-100f);
}

static inline bool phong_is_wide(const brdf *b)
{
    bool is_beside_diffuse = b->colours[0].x + b->colours[0].y + b->colours[0].z > 0.0f;
    return is_beside_diffuse && b->exponent >= 1.0f && b->exponent <= 512.0f;
}

static inline vec3 phong_sample(const brdf *b, const brdf_axes *axes, float u, float v)
{
    /* cos^2 = (1 - v)^(2 / (n + 1)); the sine by 1 - 2^x, so that sharp lobes keep their width. */
    float exponent = 2.0f / (b->exponent + 1.0f) * log2_one_minus(v);
    float cosine = exp2_fast(0.5f * exponent), sine = sqrtf(one_minus_exp2(exponent));
    float x = sine * cosine_of_turn(u), y = sine * sine_of_turn(u);
    return add_scaled(add_scaled(scale(axes->lobe_tangent, x), axes->lobe_bitangent, y), b->mirror, cosine);
}

/* ---- GGX ---- */

/* (1 - x)^5 for x in 0..1 */
static inline float schlick_weight(float x)
{
    float m = x < 1.0f ? 1.0f - x : 0.0f;
    return m * m * m * m * m;
}

static inline vec3 ggx_half(const brdf *b, vec3 light)
{
    vec3 sum = add(b->view, light);
    float norm2 = dot(sum, sum);
    bool opposite = !(norm2 > 0.0f);
    float factor = 1.0f / sqrtf(opposite ? 1.0f : norm2);
    return (vec3){opposite ? b->normal.x : sum.x * factor, opposite ? b->normal.y : sum.y * factor,
                  opposite ? b->normal.z : sum.z * factor};
}

/* Distribution of microfacet normals, 1/sr. The sine comes from a cross product: 1 - cos^2 would lose the peak of a
 * smooth surface to rounding. */
static inline float ggx_distribution(const brdf *b, vec3 half)
{
    float cosine = dot(b->normal, half);
    vec3 sine = cross(b->normal, half);
    float d = dot(sine, sine) + b->alpha2 * cosine * cosine;
    float value = b->alpha2 * INVERSE_PI / (d * d);
    return cosine > 0.0f ? value : 0.0f;
}

/* Smith's masking of one direction, divided by twice its cosine to the normal. */
static inline float ggx_visibility(const brdf *b, float cosine)
{
    return 1.0f / (cosine + sqrtf(b->alpha2 + (1.0f - b->alpha2) * cosine * cosine));
}

/* Density of a reflection about a visible microfacet normal: D_v(h) / (4 v.h) = G1(v) D(h) / (4 n.v). */
static inline float ggx_density(const brdf *b, vec3 light)
{
    return 0.5f * ggx_visibility(b, b->view_cosine) * ggx_distribution(b, ggx_half(b, light));
}

/* Reflects the view about a visible normal, drawn as a point of a spherical cap (Dupuy and Benyoub, "Sampling Visible
 * GGX Normals with Spherical Caps", HPG 2023). */
static inline vec3 ggx_sample(const brdf *b, const brdf_axes *axes, float u, float v)
{
    float alpha = sqrtf(b->alpha2);
    vec3 view = {dot(b->view, axes->tangent), dot(b->view, axes->bitangent), b->view_cosine};
    vec3 stretched = normalize((vec3){alpha * view.x, alpha * view.y, view.z});
    float z = (1.0f - v) * (1.0f + stretched.z) - stretched.z;
    float sine2 = 1.0f - z * z, sine = sqrtf(sine2 > 0.0f ? sine2 : 0.0f);
    vec3 facet = add((vec3){sine * cosine_of_turn(u), sine * sine_of_turn(u), z}, stretched);
    facet = normalize((vec3){alpha * facet.x, alpha * facet.y, facet.z > 1e-12f ? facet.z : 1e-12f});
    vec3 light = add_scaled(scale(facet, 2.0f * dot(view, facet)), view, -1.0f);
    return add_scaled(add_scaled(scale(axes->tangent, light.x), axes->bitangent, light.y), b->normal, light.z);
}

/* ---- all materials: kind is b->kind, given apart so that kernels can make it a constant ---- */

static inline vec3 cosine_sample(const brdf *b, const brdf_axes *axes, float u, float v)
{
    float radius = sqrtf(v), height = sqrtf(1.0f - v);
    float x = radius * cosine_of_turn(u), y = radius * sine_of_turn(u);
    return add_scaled(add_scaled(scale(axes->tangent, x), axes->bitangent, y), b->normal, height);
}

/* The lobes for a light at `light_cosine` >= 0 to the normal, which the view must be above too:
 *   DIFFUSE  1                                colour kd / pi
 *   PHONG    1, cos^n                         colours kd / pi, ks (n + 2) / (2 pi)
 *   GGX      1 - w, D V, D V w                colours (1 - F0) base / pi, F0 V', (1 - F0) V'
 * with w Schlick's weight, so that F = F0 + (1 - F0) w, and V and V' the visibilities of light and view. Not an array,
 * which compilers would keep in memory. */
static inline vec3 brdf_lobes(helio_material_kind kind, const brdf *b, vec3 light, float light_cosine)
{
    if (kind == HELIO_MATERIAL_GGX) {
        vec3 half = ggx_half(b, light);
        float weight = schlick_weight(dot(b->view, half));
        float lobe = ggx_distribution(b, half) * ggx_visibility(b, light_cosine);
        return (vec3){1.0f - weight, lobe, lobe * weight};
    }
    return (vec3){1.0f, kind == HELIO_MATERIAL_PHONG ? phong_lobe(b, light) : 0.0f, 0.0f};
}

/* Red, green and blue, 1/sr, for the same lights as brdf_lobes(). */
static inline vec3 brdf_value_above(helio_material_kind kind, const brdf *b, vec3 light, float light_cosine)
{
    vec3 lobes = brdf_lobes(kind, b, light, light_cosine);
    vec3 value = scale(b->colours[0], lobes.x);
    if (kind != HELIO_MATERIAL_DIFFUSE)
        value = add_scaled(value, b->colours[1], lobes.y);
    if (kind == HELIO_MATERIAL_GGX)
        value = add_scaled(value, b->colours[2], lobes.z);
    return value;
}

static inline float brdf_density_of(helio_material_kind kind, const brdf *b, vec3 light)
{
    float cosine = dot(b->normal, light), specular = 0.0f;
    float diffuse = cosine > 0.0f ? cosine * INVERSE_PI : 0.0f;
    if (kind == HELIO_MATERIAL_PHONG)
        specular = (b->exponent + 1.0f) * 0.5f * INVERSE_PI * phong_lobe(b, light);
    else if (kind == HELIO_MATERIAL_GGX)
        specular = ggx_density(b, light);
    return (1.0f - b->specular_share) * diffuse + b->specular_share * specular;
}

/* lobe, u, v: three numbers in [0, 1). */
static inline vec3 brdf_sample_of(helio_material_kind kind, const brdf *b, const brdf_axes *axes, float lobe, float u,
                                  float v)
{
    vec3 diffuse = cosine_sample(b, axes, u, v);
    if (kind == HELIO_MATERIAL_DIFFUSE)
        return diffuse;
    vec3 specular = kind == HELIO_MATERIAL_PHONG ? phong_sample(b, axes, u, v) : ggx_sample(b, axes, u, v);
    bool is_specular = lobe < b->specular_share;
    return (vec3){is_specular ? specular.x : diffuse.x, is_specular ? specular.y : diffuse.y,
                  is_specular ? specular.z : diffuse.z};
}

#endif
