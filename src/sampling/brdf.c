/* SPDX-License-Identifier: MIT */
#include "sampling/brdf.h"

static const float INVERSE_PI = (float)(1.0 / PI);
static const float LEAST_ALPHA = 1e-3f;            /* DESIGN: alpha = max(roughness^2, 1e-3) */
static const float DIELECTRIC_REFLECTANCE = 0.04f; /* glTF 2.0: index of refraction 1.5 */

vec3 brdf_lift_view(vec3 normal, vec3 view)
{
    float cosine = dot(normal, view);
    if (cosine >= BRDF_LEAST_VIEW_COSINE)
        return view;
    vec3 along = add_scaled(view, normal, -cosine);
    float norm = length(along);
    if (norm < 1e-6f) /* seen from straight behind */
        return normal;
    /* Again, because where little is left of the view, what is left is not quite at right angles to the normal. */
    along = scale(along, 1.0f / norm);
    along = normalize(add_scaled(along, normal, -dot(normal, along)));
    float sine = sqrtf(1.0f - BRDF_LEAST_VIEW_COSINE * BRDF_LEAST_VIEW_COSINE);
    return add_scaled(scale(along, sine), normal, BRDF_LEAST_VIEW_COSINE);
}

/* (1 - x)^5 for x in 0..1 */
static float schlick_weight(float x)
{
    float m = 1.0f - x;
    m = m < 0.0f ? 0.0f : m;
    return m * m * m * m * m;
}

static float share(float part, float other)
{
    return part + other > 0.0f ? part / (part + other) : 0.0f;
}

static void prepare_phong(brdf *b, const helio_material *material)
{
    for (int c = 0; c < 3; c++)
        b->specular[c] = material->specular[c];
    b->exponent = material->exponent;
    b->mirror = add_scaled(scale(b->normal, 2.0f * b->view_cosine), b->view, -1.0f);
    b->specular_share = share(luminance(b->specular), luminance(b->diffuse));
}

static void prepare_ggx(brdf *b, const helio_material *material)
{
    float alpha = fmaxf(material->roughness * material->roughness, LEAST_ALPHA);
    float weight = schlick_weight(b->view_cosine), reflected[3], scattered[3];
    b->alpha2 = alpha * alpha;
    for (int c = 0; c < 3; c++) {
        b->diffuse[c] = material->diffuse[c] * (1.0f - material->metallic);
        b->specular[c] = DIELECTRIC_REFLECTANCE + (material->diffuse[c] - DIELECTRIC_REFLECTANCE) * material->metallic;
        reflected[c] = b->specular[c] + (1.0f - b->specular[c]) * weight;
        scattered[c] = b->diffuse[c] * (1.0f - reflected[c]);
    }
    b->specular_share = share(luminance(reflected), luminance(scattered));
}

brdf brdf_prepare(const helio_material *material, vec3 normal, vec3 view)
{
    brdf b = {.kind = material->kind, .normal = normal, .view = view, .view_cosine = dot(normal, view)};
    tangent_frame(normal, &b.tangent, &b.bitangent);
    for (int c = 0; c < 3; c++)
        b.diffuse[c] = material->diffuse[c];
    if (material->kind == HELIO_MATERIAL_PHONG)
        prepare_phong(&b, material);
    else if (material->kind == HELIO_MATERIAL_GGX)
        prepare_ggx(&b, material);
    return b;
}

/* ---- GGX ---- */

/* Distribution of microfacet normals, 1/sr. The sine comes from a cross product: 1 - cos^2 would lose the peak of a
 * smooth surface to rounding. */
static float ggx_distribution(const brdf *b, vec3 half)
{
    float cosine = dot(b->normal, half);
    vec3 sine = cross(b->normal, half);
    float d = dot(sine, sine) + b->alpha2 * cosine * cosine;
    return cosine > 0.0f ? b->alpha2 * INVERSE_PI / (d * d) : 0.0f;
}

/* Smith's masking of one direction, divided by twice its cosine to the normal. */
static float ggx_visibility(const brdf *b, float cosine)
{
    return 1.0f / (cosine + sqrtf(b->alpha2 + (1.0f - b->alpha2) * cosine * cosine));
}

static vec3 half_vector(const brdf *b, vec3 light)
{
    vec3 sum = add(b->view, light);
    float norm2 = dot(sum, sum);
    return norm2 > 0.0f ? scale(sum, 1.0f / sqrtf(norm2)) : b->normal;
}

static void add_ggx(const brdf *b, vec3 light, float light_cosine, float value[3])
{
    vec3 half = half_vector(b, light);
    float weight = schlick_weight(dot(b->view, half));
    float specular = ggx_distribution(b, half) * ggx_visibility(b, light_cosine) * ggx_visibility(b, b->view_cosine);
    for (int c = 0; c < 3; c++) {
        float fresnel = b->specular[c] + (1.0f - b->specular[c]) * weight;
        value[c] = (1.0f - fresnel) * b->diffuse[c] * INVERSE_PI + fresnel * specular;
    }
}

/* Density of a reflection about a visible microfacet normal: D_v(h) / (4 v.h) = G1(v) D(h) / (4 n.v). */
static float ggx_density(const brdf *b, vec3 light)
{
    return 0.5f * ggx_visibility(b, b->view_cosine) * ggx_distribution(b, half_vector(b, light));
}

/* Reflects the view about a visible normal, drawn as a point of a spherical cap (Dupuy and Benyoub, "Sampling Visible
 * GGX Normals with Spherical Caps", HPG 2023). */
static vec3 sample_ggx(const brdf *b, float u, float v)
{
    float alpha = sqrtf(b->alpha2);
    vec3 view = {dot(b->view, b->tangent), dot(b->view, b->bitangent), b->view_cosine};
    vec3 stretched = normalize((vec3){alpha * view.x, alpha * view.y, view.z});
    float angle = (float)(2 * PI) * u;
    float z = (1.0f - v) * (1.0f + stretched.z) - stretched.z;
    float sine = sqrtf(fmaxf(0.0f, 1.0f - z * z));
    vec3 facet = add((vec3){sine * cosf(angle), sine * sinf(angle), z}, stretched);
    facet = normalize((vec3){alpha * facet.x, alpha * facet.y, fmaxf(facet.z, 1e-12f)});
    vec3 light = add_scaled(scale(facet, 2.0f * dot(view, facet)), view, -1.0f);
    return add_scaled(add_scaled(scale(b->tangent, light.x), b->bitangent, light.y), b->normal, light.z);
}

/* ---- Phong ---- */

/* cos^n, from the distance between the tips of the unit vectors: a cosine near 1 has lost what a sharp lobe needs. */
static float phong_lobe(const brdf *b, vec3 light)
{
    vec3 apart = subtract(light, b->mirror);
    float less = 0.5f * dot(apart, apart); /* 1 - cos */
    return less < 1.0f ? expf(b->exponent * log1pf(-less)) : 0.0f;
}

static vec3 sample_phong(const brdf *b, float u, float v)
{
    /* 1 - v is in (0, 1], and cos^2 = (1 - v)^(2 / (n + 1)); the sine by expm1, so that sharp lobes keep their width.
     */
    float exponent = 2.0f / (b->exponent + 1.0f) * logf(1.0f - v);
    float cosine = expf(0.5f * exponent), sine = sqrtf(-expm1f(exponent));
    float angle = (float)(2 * PI) * u;
    vec3 x, y;
    tangent_frame(b->mirror, &x, &y);
    return add_scaled(add_scaled(scale(x, sine * cosf(angle)), y, sine * sinf(angle)), b->mirror, cosine);
}

/* ---- all materials ---- */

static vec3 sample_cosine(const brdf *b, float u, float v)
{
    float angle = (float)(2 * PI) * u, radius = sqrtf(v), height = sqrtf(1.0f - v);
    return add_scaled(add_scaled(scale(b->tangent, radius * cosf(angle)), b->bitangent, radius * sinf(angle)),
                      b->normal, height);
}

void brdf_value(const brdf *b, vec3 light, float value[3])
{
    float light_cosine = dot(b->normal, light);
    value[0] = value[1] = value[2] = 0.0f;
    if (!(light_cosine > 0.0f) || !(b->view_cosine > 0.0f))
        return;
    if (b->kind == HELIO_MATERIAL_GGX) {
        add_ggx(b, light, light_cosine, value);
        return;
    }
    float lobe = 0.0f;
    if (b->kind == HELIO_MATERIAL_PHONG)
        lobe = (b->exponent + 2.0f) * 0.5f * INVERSE_PI * phong_lobe(b, light);
    for (int c = 0; c < 3; c++)
        value[c] = b->diffuse[c] * INVERSE_PI + b->specular[c] * lobe;
}

float brdf_density(const brdf *b, vec3 light)
{
    float cosine = dot(b->normal, light), specular = 0.0f;
    float diffuse = cosine > 0.0f ? cosine * INVERSE_PI : 0.0f;
    if (b->kind == HELIO_MATERIAL_PHONG)
        specular = (b->exponent + 1.0f) * 0.5f * INVERSE_PI * phong_lobe(b, light);
    else if (b->kind == HELIO_MATERIAL_GGX)
        specular = ggx_density(b, light);
    return (1.0f - b->specular_share) * diffuse + b->specular_share * specular;
}

vec3 brdf_sample(const brdf *b, float lobe, float u, float v)
{
    if (!(lobe < b->specular_share))
        return sample_cosine(b, u, v);
    return b->kind == HELIO_MATERIAL_PHONG ? sample_phong(b, u, v) : sample_ggx(b, u, v);
}

void helio_brdf_value(const helio_material *material, const float normal[3], const float view[3], const float light[3],
                      float value[3])
{
    brdf b = brdf_prepare(material, vec3_from(normal), vec3_from(view));
    brdf_value(&b, vec3_from(light), value);
}

float helio_brdf_density(const helio_material *material, const float normal[3], const float view[3],
                         const float light[3])
{
    brdf b = brdf_prepare(material, vec3_from(normal), vec3_from(view));
    return brdf_density(&b, vec3_from(light));
}

float helio_brdf_sample(const helio_material *material, const float normal[3], const float view[3], const float u[3],
                        float light[3])
{
    brdf b = brdf_prepare(material, vec3_from(normal), vec3_from(view));
    vec3 direction = brdf_sample(&b, u[0], u[1], u[2]);
    vec3_to(direction, light);
    return brdf_density(&b, direction);
}
