/* SPDX-License-Identifier: MIT
 * BRDFs: densities that integrate to 1 and describe what is drawn, values that keep energy and follow their formulas.
 *
 * Quadrature: a regular grid in the coordinates of the sharpest lobe (worked out here, in double) and one that is
 * uniform over the sphere are combined by the balance heuristic, so that peaks and tails are both resolved. */
#include "support.h"

#include "core/vector.h"
#include "sampling/brdf.h"

#include <stdio.h>
#include <string.h>

enum { NODES = 30000 };                                /* of each of the two lattices */
enum { POLAR_RINGS = 24, HEIGHTS = 16, SECTORS = 16 }; /* bins of the two histograms */
enum { POLAR_BINS = POLAR_RINGS * SECTORS, SPHERE_BINS = HEIGHTS * SECTORS, DRAWS = 20000 };

static const double LEAST_P = 1e-9, GOLDEN = 0.61803398874989485;

/* ---- materials and views --------------------------------------------------------------- */

static helio_material diffuse(float r, float g, float b)
{
    return (helio_material){.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {r, g, b}};
}

static helio_material phong(float kd, float ks, float exponent)
{
    return (helio_material){.kind = HELIO_MATERIAL_PHONG,
                            .diffuse = {kd, 0.5f * kd, 0.9f * kd},
                            .specular = {ks, ks, 0.25f * ks},
                            .exponent = exponent};
}

static helio_material ggx(float base, float metallic, float roughness)
{
    return (helio_material){.kind = HELIO_MATERIAL_GGX,
                            .diffuse = {base, 0.8f * base, 0.3f * base},
                            .metallic = metallic,
                            .roughness = roughness};
}

static const float exponents[] = {0, 1, 20, 120, 1e4f, 1e5f};
static const float kd_ks[][2] = {{0, 1}, {0.5f, 0.5f}, {0.9f, 0.05f}};
static const float roughnesses[] = {0, 0.05f, 0.1f, 0.3f, 0.6f, 1};
static const float metallics[] = {0, 0.5f, 1};
static const float view_angles[] = {0, 45, 80, 89.9f};

enum { MATERIALS = 2 + 6 * 3 + 6 * 3, VIEWS = 4 };

static helio_material material_at(int index)
{
    if (index < 2)
        return index == 0 ? diffuse(0.8f, 0.8f, 0.8f) : diffuse(0.8f, 0.2f, 0.0f);
    index -= 2;
    if (index < 6 * 3)
        return phong(kd_ks[index % 3][0], kd_ks[index % 3][1], exponents[index / 3]);
    index -= 6 * 3;
    return ggx(1, metallics[index % 3], roughnesses[index / 3]);
}

static void describe(const helio_material *material, double angle, char text[160])
{
    snprintf(text, 160, "kind %d, kd %g, ks %g, n %g, metallic %g, roughness %g, view at %g degrees",
             (int)material->kind, (double)material->diffuse[0], (double)material->specular[0],
             (double)material->exponent, (double)material->metallic, (double)material->roughness, angle);
}

/* ---- vectors of doubles ------------------------------------------------------------------ */

typedef struct dvec {
    double x, y, z;
} dvec;

static dvec dadd(dvec a, dvec b, double s)
{
    return (dvec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double ddot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static dvec dcross(dvec a, dvec b)
{
    return (dvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static dvec dunit(dvec a)
{
    return dadd((dvec){0, 0, 0}, a, 1 / sqrt(ddot(a, a)));
}

static dvec from_vec3(vec3 a)
{
    return (dvec){(double)a.x, (double)a.y, (double)a.z};
}

static vec3 to_vec3(dvec a)
{
    return (vec3){(float)a.x, (float)a.y, (float)a.z};
}

typedef struct frame {
    dvec x, y, z;
} frame;

static frame frame_about(dvec z)
{
    dvec helper = fabs(z.x) < 0.5 ? (dvec){1, 0, 0} : (dvec){0, 1, 0};
    frame f = {.z = z, .x = dunit(dcross(helper, z))};
    f.y = dcross(f.z, f.x);
    return f;
}

static dvec in_frame(const frame *f, double sine, double cosine, double azimuth)
{
    dvec d = dadd((dvec){0, 0, 0}, f->z, cosine);
    return dadd(dadd(d, f->x, sine * cos(azimuth)), f->y, sine * sin(azimuth));
}

static dvec random_direction(uint64_t *state)
{
    double z = 2 * random_unit(state) - 1, azimuth = 2 * PI * random_unit(state);
    return (dvec){sqrt(1 - z * z) * cos(azimuth), sqrt(1 - z * z) * sin(azimuth), z};
}

/* ---- a surface under test ---------------------------------------------------------------- */

typedef struct surface {
    helio_material material;
    dvec view;
    frame about_normal, about_mirror;
    double alpha;
    brdf b;
    char name[160];
} surface;

static surface make_surface(const helio_material *material, double angle, dvec normal, double azimuth)
{
    surface s = {.material = *material};
    frame f = frame_about(normal);
    vec3 n = to_vec3(normal), v = to_vec3(in_frame(&f, sin(angle * PI / 180), cos(angle * PI / 180), azimuth));
    s.b = brdf_prepare(material, n, v);
    s.about_normal = frame_about(dunit(from_vec3(n)));
    s.view = dunit(from_vec3(v));
    dvec mirror = dadd(dadd((dvec){0, 0, 0}, s.about_normal.z, 2 * ddot(s.about_normal.z, s.view)), s.view, -1);
    s.about_mirror = frame_about(dunit(mirror));
    s.alpha = fmax((double)material->roughness * (double)material->roughness, 1e-3);
    describe(material, angle, s.name);
    return s;
}

/* ---- the lobe's own coordinates, p and q in [0, 1) ---------------------------------------- */

static dvec lobe_direction(const surface *s, double p, double q)
{
    double azimuth = 2 * PI * q;
    if (s->material.kind == HELIO_MATERIAL_DIFFUSE)
        return in_frame(&s->about_normal, sqrt(p), sqrt(1 - p), azimuth);
    if (s->material.kind == HELIO_MATERIAL_PHONG) {
        double cosine = pow(1 - p, 1 / ((double)s->material.exponent + 1));
        return in_frame(&s->about_mirror, sqrt(1 - cosine * cosine), cosine, azimuth);
    }
    double tangent = s->alpha * sqrt(p / (1 - p)), cosine = 1 / sqrt(1 + tangent * tangent);
    dvec half = in_frame(&s->about_normal, tangent * cosine, cosine, azimuth);
    return dadd(dadd((dvec){0, 0, 0}, half, 2 * ddot(s->view, half)), s->view, -1);
}

static double ggx_d(double alpha, dvec normal, dvec half)
{
    dvec sine = dcross(normal, half);
    double cosine = ddot(normal, half), d = ddot(sine, sine) + alpha * alpha * cosine * cosine;
    return cosine > 0 ? alpha * alpha / (PI * d * d) : 0;
}

/* Density over the sphere that uniform p and q have. */
static double lobe_density(const surface *s, dvec light)
{
    double cosine = ddot(s->about_normal.z, light);
    if (s->material.kind == HELIO_MATERIAL_DIFFUSE)
        return cosine > 0 ? cosine / PI : 0;
    if (s->material.kind == HELIO_MATERIAL_PHONG) {
        double n = (double)s->material.exponent, along = ddot(s->about_mirror.z, light);
        return along > 0 ? (n + 1) / (2 * PI) * pow(along, n) : 0;
    }
    dvec half = dunit(dadd(s->view, light, 1));
    double normal_cosine = ddot(s->about_normal.z, half);
    return normal_cosine > 0 ? ggx_d(s->alpha, s->about_normal.z, half) * normal_cosine / (4 * ddot(s->view, half)) : 0;
}

/* ---- bins ----------------------------------------------------------------------------------- */

static double azimuth_about(const frame *f, dvec d)
{
    double azimuth = atan2(ddot(d, f->y), ddot(d, f->x)) / (2 * PI);
    return azimuth < 0 ? azimuth + 1 : azimuth;
}

static size_t sector(const frame *f, dvec d)
{
    size_t k = (size_t)(azimuth_about(f, d) * SECTORS);
    return k < SECTORS ? k : SECTORS - 1;
}

/* Rings about the mirror direction whose width doubles with every second one, down to 1e-3. */
static size_t polar_bin(const surface *s, dvec d)
{
    dvec apart = dcross(s->about_mirror.z, d);
    double angle = atan2(sqrt(ddot(apart, apart)), ddot(s->about_mirror.z, d));
    double ring = POLAR_RINGS + 2 * log2(fmax(angle, 1e-30) / (PI * (1 + 1e-9)));
    return (ring > 0 ? (size_t)ring : 0) * SECTORS + sector(&s->about_mirror, d);
}

static size_t sphere_bin(const surface *s, dvec d)
{
    double height = (ddot(s->about_normal.z, d) + 1) / 2 * HEIGHTS;
    size_t k = height > 0 ? (size_t)height : 0;
    return (k < HEIGHTS ? k : HEIGHTS - 1) * SECTORS + sector(&s->about_normal, d);
}

/* ---- quadrature ------------------------------------------------------------------------------ */

typedef struct integrals {
    double density, albedo[3], polar[POLAR_BINS], sphere[SPHERE_BINS];
} integrals;

static void add_node(const surface *s, dvec light, integrals *sum)
{
    double weight = 1.0 / (NODES * (lobe_density(s, light) + 1 / (4 * PI)));
    vec3 direction = to_vec3(light);
    float value[3];
    double density = (double)brdf_density(&s->b, direction) * weight, cosine = ddot(s->about_normal.z, light);
    sum->density += density;
    sum->polar[polar_bin(s, light)] += density;
    sum->sphere[sphere_bin(s, light)] += density;
    brdf_value(&s->b, direction, value);
    for (int c = 0; c < 3; c++)
        sum->albedo[c] += (double)value[c] * fmax(cosine, 0) * weight;
}

static void integrate(const surface *s, integrals *sum)
{
    memset(sum, 0, sizeof *sum);
    for (int i = 0; i < NODES; i++) {
        double p = (i + 0.5) / NODES, q = fmod(i * GOLDEN, 1), z = 1 - 2 * p;
        dvec light = lobe_direction(s, p, q);
        /* Facets that face away from the view fold over: their reflections belong to other facets. */
        if (s->material.kind != HELIO_MATERIAL_GGX || ddot(dadd(s->view, light, 1), s->about_normal.z) > 0)
            add_node(s, light, sum);
        add_node(s, in_frame(&s->about_normal, sqrt(1 - z * z), z, 2 * PI * q), sum);
    }
}

/* ---- drawn against density --------------------------------------------------------------------- */

typedef struct tally {
    double polar[POLAR_BINS], sphere[SPHERE_BINS], mean[3], square[3];
} tally;

static void draw(const surface *s, uint64_t *state, tally *sum)
{
    memset(sum, 0, sizeof *sum);
    for (int i = 0; i < DRAWS; i++) {
        float lobe = (float)(random_bits(state) >> 8) * 0x1p-24f, u = (float)(random_bits(state) >> 8) * 0x1p-24f;
        vec3 light = brdf_sample(&s->b, lobe, u, (float)(random_bits(state) >> 8) * 0x1p-24f);
        float value[3], density = brdf_density(&s->b, light);
        if (!(density > 0.0f) || !isfinite(density))
            fail_msg("%s: a drawn direction has density %g", s->name, (double)density);
        dvec d = dunit(from_vec3(light));
        sum->polar[polar_bin(s, d)]++;
        sum->sphere[sphere_bin(s, d)]++;
        brdf_value(&s->b, light, value);
        for (int c = 0; c < 3; c++) {
            double x = (double)value[c] * fmax((double)dot(s->b.normal, light), 0) / (double)density;
            if (!(x >= 0) || !isfinite(x))
                fail_msg("%s: a weight of %g", s->name, x);
            sum->mean[c] += x / DRAWS;
            sum->square[c] += x * x / DRAWS;
        }
    }
}

static void check_histogram(const surface *s, const char *kind, const double *drawn, double *share, size_t bins)
{
    for (size_t i = 0; i < bins; i++)
        share[i] = share[i] * DRAWS + 1e-3; /* a bin smaller than a cell of the quadrature may hold none of its nodes */
    double p = chi_square_tail(drawn, share, bins, 1);
    if (!(p > LEAST_P))
        fail_msg("%s: drawn directions do not follow the density over %s, p = %g", s->name, kind, p);
}

static void check_albedo(const surface *s, const integrals *exact, const tally *drawn)
{
    for (int c = 0; c < 3; c++) {
        double deviation = sqrt(fmax(drawn->square[c] - drawn->mean[c] * drawn->mean[c], 0) / DRAWS);
        if (fabs(drawn->mean[c] - exact->albedo[c]) > 6.5 * deviation + 2e-3 * exact->albedo[c])
            fail_msg("%s: albedo %g by sampling, %g by quadrature", s->name, drawn->mean[c], exact->albedo[c]);
    }
}

/* No surface reflects more than it receives, except that glTF's diffuse lobe, dimmed by the Fresnel term of the half
 * vector and not of the view, does not leave room for all that a dielectric's specular lobe reflects at grazing views:
 * up to 1.83 for white at roughness 0. Each of the two lobes stays below 1. */
static void check_energy(const surface *s, const integrals *exact)
{
    const helio_material *m = &s->material;
    bool dielectric = m->kind == HELIO_MATERIAL_GGX && m->metallic < 1.0f, grazing = s->b.view_cosine < 0.7f;
    for (int c = 0; c < 3; c++) {
        double limit = dielectric && grazing ? 2 : 1;
        if (m->kind != HELIO_MATERIAL_GGX)
            limit = (double)m->diffuse[c] + (double)m->specular[c];
        if (exact->albedo[c] > limit + 2e-3)
            fail_msg("%s: albedo %g is more than %g", s->name, exact->albedo[c], limit);
        if (m->kind == HELIO_MATERIAL_DIFFUSE && exact->albedo[c] < limit - 2e-3)
            fail_msg("%s: albedo %g is less than %g", s->name, exact->albedo[c], limit);
    }
}

static void densities_integrate_to_one_and_describe_draws(void **context)
{
    (void)context;
    static integrals exact;
    static tally drawn;
    uint64_t state = 1;
    for (int i = 0; i < MATERIALS * VIEWS; i++) {
        helio_material material = material_at(i / VIEWS);
        dvec normal = random_direction(&state);
        surface s = make_surface(&material, (double)view_angles[i % VIEWS], normal, 2 * PI * random_unit(&state));
        integrate(&s, &exact);
        if (fabs(exact.density - 1) > 1e-3)
            fail_msg("%s: the density integrates to %.6f", s.name, exact.density);
        draw(&s, &state, &drawn);
        check_histogram(&s, "rings about the mirror direction", drawn.polar, exact.polar, POLAR_BINS);
        check_histogram(&s, "the sphere", drawn.sphere, exact.sphere, SPHERE_BINS);
        check_albedo(&s, &exact, &drawn);
        check_energy(&s, &exact);
    }
}

/* ---- values against their formulas ---------------------------------------------------------------- */

/* glTF 2.0, appendix B.3.5, in the words of its text. */
static void gltf_value(const surface *s, dvec light, double value[3])
{
    const helio_material *m = &s->material;
    dvec n = s->about_normal.z, v = s->view, h = dunit(dadd(v, light, 1));
    double alpha2 = s->alpha * s->alpha, nl = ddot(n, light), nv = ddot(n, v), hl = ddot(h, light), hv = ddot(h, v);
    double g =
        2 * nl / (nl + sqrt(alpha2 + (1 - alpha2) * nl * nl)) * 2 * nv / (nv + sqrt(alpha2 + (1 - alpha2) * nv * nv));
    for (int c = 0; c < 3; c++) {
        double base = (double)m->diffuse[c], metallic = (double)m->metallic;
        double c_diff = base + (0 - base) * metallic, f0 = 0.04 + (base - 0.04) * metallic;
        double f = f0 + (1 - f0) * pow(1 - fabs(hv), 5);
        value[c] =
            nl > 0 && nv > 0 && hl > 0 ? (1 - f) / PI * c_diff + f * ggx_d(s->alpha, n, h) * g / (4 * nv * nl) : 0;
    }
}

static void phong_value(const surface *s, dvec light, double value[3])
{
    const helio_material *m = &s->material;
    double n = (double)m->exponent, along = ddot(s->about_mirror.z, light);
    dvec apart = dcross(s->about_mirror.z, light);
    double lobe = along > 0 ? exp(0.5 * n * log1p(-fmin(ddot(apart, apart), 1))) * (n + 2) / (2 * PI) : 0;
    for (int c = 0; c < 3; c++)
        value[c] = ddot(s->about_normal.z, light) > 0 ? (double)m->diffuse[c] / PI + (double)m->specular[c] * lobe : 0;
}

/* A direction that matters: from the lobe, near the normal or anywhere. */
static dvec interesting_direction(const surface *s, uint64_t *state)
{
    switch (random_bits(state) % 3) {
    case 0: return lobe_direction(s, random_unit(state), random_unit(state));
    case 1: return dunit(dadd(s->about_normal.z, random_direction(state), 0.999));
    default: return random_direction(state);
    }
}

static surface random_surface(int index, uint64_t *state)
{
    helio_material material = material_at(index % MATERIALS);
    double angle = random_bits(state) % 4 == 0 ? 89.9 : acos(random_unit(state) * 0.998 + 0.002) * 180 / PI;
    return make_surface(&material, angle, random_direction(state), 2 * PI * random_unit(state));
}

static void values_follow_their_formulas(void **context)
{
    (void)context;
    uint64_t state = 2;
    for (int i = 0; i < MATERIALS * 3000; i++) {
        surface s = random_surface(i, &state);
        dvec light = dunit(from_vec3(to_vec3(interesting_direction(&s, &state))));
        /* Closer to the horizon, the rounding of a direction's own coordinates shows in its cosine. */
        if (fabs(ddot(light, s.about_normal.z)) < 1e-3)
            continue;
        /* Light and view are unit vectors but for their rounding, which tilts a half vector the more the shorter their
         * sum is, and a smooth surface tells the tilt. */
        dvec sum = dadd(s.view, light, 1);
        double tolerance = 1e-3 + 4e-7 / (sqrt(ddot(sum, sum)) * s.alpha), expected[3];
        float value[3];
        if (s.material.kind == HELIO_MATERIAL_GGX)
            gltf_value(&s, light, expected);
        else
            phong_value(&s, light, expected);
        brdf_value(&s.b, to_vec3(light), value);
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)value[c] - expected[c]) <= tolerance * expected[c] + 1e-9))
                fail_msg("%s: value %g in place of %g", s.name, (double)value[c], expected[c]);
    }
}

static void values_are_reciprocal(void **context)
{
    (void)context;
    uint64_t state = 3;
    for (int i = 0; i < MATERIALS * 1000; i++) {
        surface s = random_surface(i, &state);
        vec3 light = to_vec3(interesting_direction(&s, &state));
        if (dot(s.b.normal, light) < 1e-3f)
            continue;
        brdf swapped = brdf_prepare(&s.material, s.b.normal, light);
        float value[3], back[3];
        brdf_value(&s.b, light, value);
        brdf_value(&swapped, s.b.view, back);
        for (int c = 0; c < 3; c++)
            if (!(fabsf(value[c] - back[c]) <= 3e-3f * value[c] + 1e-9f))
                fail_msg("%s: value %g there and %g back", s.name, (double)value[c], (double)back[c]);
    }
}

/* What is reflected can be drawn, and nothing is reflected from below or to below. */
static void values_are_finite_and_only_above_the_horizon(void **context)
{
    (void)context;
    uint64_t state = 4;
    for (int i = 0; i < MATERIALS * 2000; i++) {
        surface s = random_surface(i, &state);
        vec3 light = to_vec3(interesting_direction(&s, &state)), below = scale(s.b.view, -1.0f);
        float value[3], density = brdf_density(&s.b, light);
        brdf_value(&s.b, light, value);
        bool above = dot(s.b.normal, light) > 0.0f;
        for (int c = 0; c < 3; c++)
            if (!(value[c] >= 0.0f) || !isfinite(value[c]) || (value[c] > 0.0f && !(above && density > 0.0f)))
                fail_msg("%s: value %g, density %g, cosine %g", s.name, (double)value[c], (double)density,
                         (double)dot(s.b.normal, light));
        if (!(density >= 0.0f) || !isfinite(density))
            fail_msg("%s: density %g", s.name, (double)density);
        brdf hidden = brdf_prepare(&s.material, s.b.normal, below);
        brdf_value(&hidden, light, value);
        if (value[0] != 0.0f || value[1] != 0.0f || value[2] != 0.0f)
            fail_msg("%s: a surface is seen from behind", s.name);
    }
}

/* ---- the public functions ---------------------------------------------------------------------- */

static void drawing_returns_the_density_of_what_it_drew(void **context)
{
    (void)context;
    static const float ends[] = {0.0f, 0.5f, 0x1.fffffep-1f};
    uint64_t state = 5;
    for (int i = 0; i < MATERIALS * 27 * 8; i++) {
        surface s = random_surface(i, &state);
        int k = i / MATERIALS;
        float u[3] = {ends[k % 3], ends[k / 3 % 3], ends[k / 9 % 3]};
        if (k >= 27)
            for (int j = 0; j < 3; j++)
                u[j] = (float)(random_bits(&state) >> 8) * 0x1p-24f;
        float normal[3], view[3], light[3], value[3], same[3];
        vec3_to(s.b.normal, normal);
        vec3_to(s.b.view, view);
        float density = helio_brdf_sample(&s.material, normal, view, u, light);
        double length2 = ddot(from_vec3(vec3_from(light)), from_vec3(vec3_from(light)));
        helio_brdf_value(&s.material, normal, view, light, value);
        bool lit = value[0] > 0.0f || value[1] > 0.0f || value[2] > 0.0f; /* not so below the edge of a lobe */
        if (!(fabs(length2 - 1) < 2e-6) || !(density > 0.0f || !lit) || !isfinite(density))
            fail_msg("%s: drew a vector of length^2 %.8f with density %g", s.name, length2, (double)density);
        assert_true(density == helio_brdf_density(&s.material, normal, view, light));
        assert_true(density == brdf_density(&s.b, vec3_from(light)));
        brdf_value(&s.b, vec3_from(light), same);
        assert_memory_equal(value, same, sizeof value);
    }
}

static void lambert_reflects_exactly_its_colour(void **context)
{
    (void)context;
    uint64_t state = 6;
    for (int i = 0; i < 2000; i++) {
        helio_material material = diffuse((float)random_unit(&state), (float)random_unit(&state), 1);
        surface s = make_surface(&material, 80 * random_unit(&state), random_direction(&state), 1);
        vec3 light = brdf_sample(&s.b, 0.5f, (float)(i % 40) / 40, (float)(i / 40) / 50);
        float value[3], density = brdf_density(&s.b, light);
        brdf_value(&s.b, light, value);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(value[c] * dot(s.b.normal, light) / density - material.diffuse[c]) < 1e-6f);
    }
}

/* ---- grazing views ------------------------------------------------------------------------------- */

static void grazing_views_are_lifted_along_the_normal(void **context)
{
    (void)context;
    uint64_t state = 7;
    for (int i = 0; i < 20000; i++) {
        dvec n = random_direction(&state), v = random_direction(&state);
        if (i % 2 == 0) /* near the horizon */
            v = dunit(dadd(v, n, -ddot(n, v) + 4e-3 * (random_unit(&state) - 0.5)));
        vec3 normal = to_vec3(n), view = to_vec3(v), lifted = brdf_lift_view(normal, view);
        assert_true(fabsf(length(lifted) - 1.0f) < 1e-5f);
        assert_true(dot(normal, lifted) >= BRDF_LEAST_VIEW_COSINE - 3e-7f);
        if (dot(normal, view) >= BRDF_LEAST_VIEW_COSINE) {
            assert_memory_equal(&lifted, &view, sizeof view);
            continue;
        }
        assert_true(fabsf(dot(normal, lifted) - BRDF_LEAST_VIEW_COSINE) < 3e-7f);
        /* In the plane of normal and view, on the view's side. */
        dvec side = dcross(n, v), moved = from_vec3(lifted);
        assert_true(fabs(ddot(side, moved)) < 1e-6 + 1e-6 * sqrt(ddot(side, side)));
        assert_true(ddot(dadd(v, n, -ddot(n, v)), moved) > 0);
    }
}

static void views_from_straight_behind_become_unit_vectors(void **context)
{
    (void)context;
    uint64_t state = 8;
    for (int i = 0; i < 1000; i++) {
        vec3 normal = to_vec3(random_direction(&state)), lifted = brdf_lift_view(normal, scale(normal, -1.0f));
        assert_true(fabsf(length(lifted) - 1.0f) < 1e-5f);
        assert_true(dot(normal, lifted) >= BRDF_LEAST_VIEW_COSINE - 3e-7f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities_integrate_to_one_and_describe_draws),
        cmocka_unit_test(values_follow_their_formulas),
        cmocka_unit_test(values_are_reciprocal),
        cmocka_unit_test(values_are_finite_and_only_above_the_horizon),
        cmocka_unit_test(drawing_returns_the_density_of_what_it_drew),
        cmocka_unit_test(lambert_reflects_exactly_its_colour),
        cmocka_unit_test(grazing_views_are_lifted_along_the_normal),
        cmocka_unit_test(views_from_straight_behind_become_unit_vectors),
    };
    return cmocka_run_group_tests_name("brdf", tests, NULL, NULL);
}
