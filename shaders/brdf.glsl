// SPDX-License-Identifier: MIT
// brdf.glsl - BRDFs: the functions of src/sampling/brdf.h and brdf.c. A pipeline knows which kinds the scene has; the
// others vanish from it. Needs common.glsl and elementary.glsl.

const float INVERSE_PI = 0.318309886, LEAST_VIEW_COSINE = 1e-3, LEAST_ALPHA = 1e-3, DIELECTRIC_REFLECTANCE = 0.04;

struct scene_material {
    uint kind;
    vec3 diffuse, specular;
    float exponent, metallic, roughness;
};

scene_material read_material(uint index)
{
    const vec4 a = vector_at(STEP.materials, 3u * index), b = vector_at(STEP.materials, 3u * index + 1u);
    const vec4 c = vector_at(STEP.materials, 3u * index + 2u);
    return scene_material(floatBitsToUint(a.w), a.rgb, b.rgb, b.w, c.x, c.y);
}

// The lobes' colours times their shapes: see brdf_lobes().
struct brdf {
    uint kind;
    vec3 normal, view; // view: PHONG: its mirror direction, which is all that is needed of it
    float view_cosine;
    vec3 colours[3];
    float specular_share;
    float shape; // PHONG: exponent. GGX: alpha^2
};

bool is_phong(uint kind)
{
    return (KINDS & 1u << LAYOUT_PHONG) != 0u && kind == LAYOUT_PHONG;
}

bool is_ggx(uint kind)
{
    return (KINDS & 1u << LAYOUT_GGX) != 0u && kind == LAYOUT_GGX;
}

float luminance(vec3 rgb)
{
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

// The rule for grazing views.
vec3 lift_view(vec3 normal, vec3 view)
{
    precise float cosine = dot(normal, view);
    if (cosine >= LEAST_VIEW_COSINE)
        return view;
    precise vec3 along = view - normal * cosine;
    precise float norm = length(along);
    if (norm < 1e-6)
        return normal;
    along /= norm;
    along = normalize(along - normal * dot(normal, along));
    precise vec3 lifted = along * sqrt(1.0 - LEAST_VIEW_COSINE * LEAST_VIEW_COSINE) + normal * LEAST_VIEW_COSINE;
    return lifted;
}

float part_of(float part, float other)
{
    return part + other > 0.0 ? part / (part + other) : 0.0;
}

float schlick_weight(float x)
{
    const float m = max(1.0 - x, 0.0), m2 = m * m;
    return m2 * m2 * m;
}

float ggx_visibility(float alpha2, float cosine)
{
    return 1.0 / (cosine + sqrt(alpha2 + (1.0 - alpha2) * cosine * cosine));
}

brdf prepare_ggx(brdf b, scene_material m)
{
    const float alpha = max(m.roughness * m.roughness, LEAST_ALPHA), weight = schlick_weight(b.view_cosine);
    const vec3 diffuse = m.diffuse * (1.0 - m.metallic);
    const vec3 specular = DIELECTRIC_REFLECTANCE + (m.diffuse - DIELECTRIC_REFLECTANCE) * m.metallic;
    const vec3 reflected = specular + (1.0 - specular) * weight;
    b.shape = alpha * alpha;
    const float visibility = ggx_visibility(b.shape, b.view_cosine);
    b.colours[0] = (1.0 - specular) * diffuse * INVERSE_PI;
    b.colours[1] = specular * visibility;
    b.colours[2] = (1.0 - specular) * visibility;
    b.specular_share = part_of(luminance(reflected), luminance(diffuse * (1.0 - reflected)));
    return b;
}

brdf prepare_brdf(scene_material m, vec3 normal, vec3 view)
{
    brdf b = brdf(m.kind, normal, view, dot(normal, view), vec3[3](m.diffuse * INVERSE_PI, vec3(0.0), vec3(0.0)), 0.0,
                  0.0);
    if (is_phong(m.kind)) {
        b.shape = m.exponent;
        b.colours[1] = m.specular * ((m.exponent + 2.0) * 0.5 * INVERSE_PI);
        b.view = normal * (2.0 * b.view_cosine) - view;
        b.specular_share = part_of(luminance(m.specular), luminance(m.diffuse));
    } else if (is_ggx(m.kind)) {
        return prepare_ggx(b, m);
    }
    return b;
}

// ---- values and densities ----

float phong_lobe(brdf b, vec3 light)
{
    const vec3 difference = light - b.view;
    const float less = 0.5 * dot(difference, difference); // 1 - cosine, of which a cosine near 1 has lost too much
    return less < 1.0 ? exp2_fast(b.shape * log2_one_minus(min(less, 0.99999994))) : 0.0;
}

vec3 ggx_half(brdf b, vec3 light)
{
    const vec3 sum = b.view + light;
    const float norm2 = dot(sum, sum);
    return norm2 > 0.0 ? sum * (1.0 / sqrt(norm2)) : b.normal;
}

float ggx_distribution(brdf b, vec3 facet)
{
    const float cosine = dot(b.normal, facet);
    const vec3 sine = cross(b.normal, facet);
    const float d = dot(sine, sine) + b.shape * cosine * cosine;
    return cosine > 0.0 ? b.shape * INVERSE_PI / (d * d) : 0.0;
}

// 1/sr, for lights above the normal's horizon.
vec3 brdf_value(brdf b, vec3 light, float light_cosine)
{
    if (is_phong(b.kind))
        return b.colours[0] + b.colours[1] * phong_lobe(b, light);
    if (is_ggx(b.kind)) {
        const vec3 facet = ggx_half(b, light);
        const float weight = schlick_weight(dot(b.view, facet));
        const float lobe = ggx_distribution(b, facet) * ggx_visibility(b.shape, light_cosine);
        return b.colours[0] * (1.0 - weight) + b.colours[1] * lobe + b.colours[2] * (lobe * weight);
    }
    return b.colours[0];
}

float brdf_density(brdf b, vec3 light)
{
    const float diffuse = max(dot(b.normal, light), 0.0) * INVERSE_PI;
    float specular = 0.0;
    if (is_phong(b.kind))
        specular = (b.shape + 1.0) * 0.5 * INVERSE_PI * phong_lobe(b, light);
    else if (is_ggx(b.kind))
        specular = 0.5 * ggx_visibility(b.shape, b.view_cosine) * ggx_distribution(b, ggx_half(b, light));
    return (1.0 - b.specular_share) * diffuse + b.specular_share * specular;
}

// ---- drawing ----

// Axes about a unit vector, of which the first two are its tangents.
mat3 frame_about(vec3 n)
{
    const float way = floatBitsToInt(n.z) < 0 ? -1.0 : 1.0, a = -1.0 / (way + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + way * n.x * n.x * a, way * b, -way * n.x), vec3(b, way + n.y * n.y * a, -n.y), n);
}

vec3 cosine_sample(vec3 normal, float u, float v)
{
    const float radius = sqrt(v);
    return frame_about(normal) * vec3(radius * cosine_of_turn(u), radius * sine_of_turn(u), sqrt(1.0 - v));
}

vec3 phong_sample(brdf b, float u, float v)
{
    const float exponent = 2.0 / (b.shape + 1.0) * log2_one_minus(v);
    const float cosine = exp2_fast(0.5 * exponent), sine = sqrt(one_minus_exp2(exponent));
    return frame_about(b.view) * vec3(sine * cosine_of_turn(u), sine * sine_of_turn(u), cosine);
}

vec3 ggx_sample(brdf b, float u, float v)
{
    const float alpha = sqrt(b.shape);
    const mat3 axes = frame_about(b.normal);
    const vec3 view = vec3(dot(b.view, axes[0]), dot(b.view, axes[1]), b.view_cosine);
    const vec3 stretched = normalize(vec3(alpha * view.xy, view.z));
    const float z = (1.0 - v) * (1.0 + stretched.z) - stretched.z, sine = sqrt(max(1.0 - z * z, 0.0));
    vec3 facet = vec3(sine * cosine_of_turn(u), sine * sine_of_turn(u), z) + stretched;
    facet = normalize(vec3(alpha * facet.xy, max(facet.z, 1e-12)));
    return axes * (facet * (2.0 * dot(view, facet)) - view);
}

vec3 brdf_sample(brdf b, float lobe, float u, float v)
{
    if (lobe < b.specular_share) {
        if (is_phong(b.kind))
            return phong_sample(b, u, v);
        if (is_ggx(b.kind))
            return ggx_sample(b, u, v);
    }
    return cosine_sample(b.normal, u, v);
}
