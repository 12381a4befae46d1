/* SPDX-License-Identifier: MIT */
#include "sampling/brdf.h"

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

static float share(float part, float other)
{
    return part + other > 0.0f ? part / (part + other) : 0.0f;
}

static void prepare_diffuse(brdf *b, const helio_material *material)
{
    for (int c = 0; c < 3; c++)
        b->diffuse[c] = material->diffuse[c];
    b->colours[0] = scale(vec3_from(b->diffuse), INVERSE_PI);
}

static void prepare_phong(brdf *b, const helio_material *material)
{
    prepare_diffuse(b, material);
    for (int c = 0; c < 3; c++)
        b->specular[c] = material->specular[c];
    b->exponent = material->exponent;
    b->colours[1] = scale(vec3_from(b->specular), (b->exponent + 2.0f) * 0.5f * INVERSE_PI);
    b->mirror = add_scaled(scale(b->normal, 2.0f * b->view_cosine), b->view, -1.0f);
}

static void prepare_ggx(brdf *b, const helio_material *material)
{
    float alpha = fmaxf(material->roughness * material->roughness, LEAST_ALPHA);
    b->alpha2 = alpha * alpha;
    for (int c = 0; c < 3; c++) {
        b->diffuse[c] = material->diffuse[c] * (1.0f - material->metallic);
        b->specular[c] = DIELECTRIC_REFLECTANCE + (material->diffuse[c] - DIELECTRIC_REFLECTANCE) * material->metallic;
    }
    vec3 reflected = vec3_from(b->specular), rest = subtract((vec3){1.0f, 1.0f, 1.0f}, reflected);
    float view_visibility = ggx_visibility(b, b->view_cosine);
    b->colours[0] = scale((vec3){rest.x * b->diffuse[0], rest.y * b->diffuse[1], rest.z * b->diffuse[2]}, INVERSE_PI);
    b->colours[1] = scale(reflected, view_visibility);
    b->colours[2] = scale(rest, view_visibility);
}

void brdf_prepare_value(brdf *b, const helio_material *material, vec3 normal, vec3 view)
{
    b->kind = material->kind;
    b->normal = normal;
    b->view = view;
    b->view_cosine = dot(normal, view);
    b->specular_share = 0.0f;
    if (material->kind == HELIO_MATERIAL_PHONG)
        prepare_phong(b, material);
    else if (material->kind == HELIO_MATERIAL_GGX)
        prepare_ggx(b, material);
    else
        prepare_diffuse(b, material);
}

static float ggx_share(const brdf *b)
{
    float weight = schlick_weight(b->view_cosine), reflected[3], scattered[3];
    for (int c = 0; c < 3; c++) {
        reflected[c] = b->specular[c] + (1.0f - b->specular[c]) * weight;
        scattered[c] = b->diffuse[c] * (1.0f - reflected[c]);
    }
    return share(luminance(reflected), luminance(scattered));
}

void brdf_prepare_share(brdf *b)
{
    if (b->kind == HELIO_MATERIAL_PHONG)
        b->specular_share = share(luminance(b->specular), luminance(b->diffuse));
    else if (b->kind == HELIO_MATERIAL_GGX)
        b->specular_share = ggx_share(b);
}

brdf brdf_prepare(const helio_material *material, vec3 normal, vec3 view)
{
    brdf b = {0};
    brdf_prepare_value(&b, material, normal, view);
    brdf_prepare_share(&b);
    return b;
}

brdf_axes brdf_find_axes(const brdf *b)
{
    brdf_axes axes;
    tangent_frame(b->normal, &axes.tangent, &axes.bitangent);
    if (b->kind == HELIO_MATERIAL_PHONG)
        tangent_frame(b->mirror, &axes.lobe_tangent, &axes.lobe_bitangent);
    else
        axes.lobe_tangent = axes.lobe_bitangent = (vec3){0, 0, 0};
    return axes;
}

void brdf_value(const brdf *b, vec3 light, float value[3])
{
    float light_cosine = dot(b->normal, light);
    value[0] = value[1] = value[2] = 0.0f;
    if (light_cosine > 0.0f && b->view_cosine > 0.0f)
        vec3_to(brdf_value_above(b->kind, b, light, light_cosine), value);
}

float brdf_density(const brdf *b, vec3 light)
{
    return brdf_density_of(b->kind, b, light);
}

vec3 brdf_sample(const brdf *b, float lobe, float u, float v)
{
    brdf_axes axes = brdf_find_axes(b);
    return brdf_sample_of(b->kind, b, &axes, lobe, u, v);
}

/* ---- the public functions ---- */

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
