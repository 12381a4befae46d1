/* SPDX-License-Identifier: MIT
 *
 * The sum of all texels' light at a point: against closed forms, and against plain sums over fine grids, in double and
 * with BRDFs that are written anew here. */
#include "support.h"

#include "eval/gauss.h"
#include "eval/horizon.h"
#include "eval/quadrature.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct vector {
    double x, y, z;
} vector;

static vector vector_of(const float a[3])
{
    return (vector){(double)a[0], (double)a[1], (double)a[2]};
}

static vector combine(vector a, double s, vector b, double t)
{
    return (vector){a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t};
}

static double inner(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector outer(vector a, vector b)
{
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vector unit(vector a)
{
    return combine(a, 1.0 / sqrt(inner(a, a)), a, 0.0);
}

static vector random_normal(uint64_t *state)
{
    double z = 2.0 * random_unit(state) - 1.0, angle = 2.0 * PI * random_unit(state), sine = sqrt(1.0 - z * z);
    return (vector){sine * cos(angle), sine * sin(angle), z};
}

/* A unit vector at right angles. */
static vector beside(vector n)
{
    return unit(outer(n, fabs(n.x) < 0.5 ? (vector){1, 0, 0} : (vector){0, 1, 0}));
}

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.12g in place of %.12g, within %g", found, expected, tolerance);
}

/* ---- what is lit ---------------------------------------------------------------------------- */

static helio_environment *make_cube(helio_context *context, uint32_t size, const float *pixels)
{
    return make_environment(context, HELIO_LAYOUT_STRIP, size, 6 * size, size, pixels, NULL);
}

static helio_environment *make_even_cube(helio_context *context, uint32_t size, const float rgb[3])
{
    size_t count = (size_t)18 * size * size;
    float *pixels = malloc(count * sizeof *pixels);
    assert_non_null(pixels);
    for (size_t i = 0; i < count; i++)
        pixels[i] = rgb[i % 3];
    helio_environment *environment = make_cube(context, size, pixels);
    free(pixels);
    return environment;
}

static helio_shading_point make_point(const helio_material *material, vector normal, vector flat, vector view)
{
    return (helio_shading_point){.normal = {(float)normal.x, (float)normal.y, (float)normal.z},
                                 .geometric_normal = {(float)flat.x, (float)flat.y, (float)flat.z},
                                 .view = {(float)view.x, (float)view.y, (float)view.z},
                                 .material = *material};
}

static quadrature_result integrate(const helio_environment *environment, const helio_shading_point *point)
{
    quadrature *q;
    quadrature_result result;
    assert_ok(quadrature_create(environment, 1e-5, &q));
    quadrature_point(q, point, &result);
    quadrature_destroy(q);
    return result;
}

static const helio_material white = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};

/* ---- BRDFs in double ------------------------------------------------------------------------ */

static double phong(const helio_material *m, vector n, vector v, vector light)
{
    vector mirror = unit(combine(n, 2.0 * inner(n, v), v, -1.0)), apart = combine(light, 1.0, mirror, -1.0);
    double exponent = (double)m->exponent, less = 0.5 * inner(apart, apart);
    double lobe = less < 1.0 ? exp(exponent * log1p(-less)) : 0.0;
    return (double)m->diffuse[0] / PI + (double)m->specular[0] * (exponent + 2.0) / (2.0 * PI) * lobe;
}

static double ggx(const helio_material *m, vector n, vector v, vector light)
{
    double alpha = fmax((double)m->roughness * (double)m->roughness, 1e-3), alpha2 = alpha * alpha;
    vector half = unit(combine(v, 1.0, light, 1.0)), sine = outer(n, half);
    double nv = inner(n, v), nl = inner(n, light), nh = inner(n, half);
    double d = inner(sine, sine) + alpha2 * nh * nh, base = (double)m->diffuse[0], metallic = (double)m->metallic;
    double lobe = alpha2 / (PI * d * d) / (nl + sqrt(alpha2 + (1.0 - alpha2) * nl * nl)) /
                  (nv + sqrt(alpha2 + (1.0 - alpha2) * nv * nv));
    double normal_reflectance = 0.04 + (base - 0.04) * metallic;
    double fresnel = normal_reflectance + (1.0 - normal_reflectance) * pow(1.0 - inner(v, half), 5.0);
    return (1.0 - fresnel) * base * (1.0 - metallic) / PI + fresnel * lobe;
}

/* BRDF x cosine, red. */
static double reflected(const helio_material *m, vector n, vector v, vector light)
{
    double cosine = inner(n, light);
    if (!(cosine > 0.0))
        return 0.0;
    double value = m->kind == HELIO_MATERIAL_PHONG ? phong(m, n, v, light)
                   : m->kind == HELIO_MATERIAL_GGX ? ggx(m, n, v, light)
                                                   : (double)m->diffuse[0] / PI;
    return value * cosine;
}

/* ---- closed forms --------------------------------------------------------------------------- */

static const uint32_t sizes[] = {1, 2, 3, 7, 16, 40, 130};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* All texels count, each with its exact solid angle, and those that the horizon cuts with the part above it. */
static void a_matte_furnace_returns_its_albedo(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    const helio_material matte = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.5f, 0.1f}};
    const float light[3] = {1.0f, 2.0f, 0.25f};
    uint64_t random = 1;
    for (int i = 0; i < SIZES; i++) {
        helio_environment *environment = make_even_cube(context, sizes[i], light);
        for (int k = 0; k < 12; k++) {
            vector n = k == 0 ? (vector){0, 1, 0} : k == 1 ? unit((vector){1, 1, 1}) : random_normal(&random);
            helio_shading_point point = make_point(&matte, n, n, n);
            quadrature_result result = integrate(environment, &point);
            for (int c = 0; c < 3; c++) {
                double expected = (double)matte.diffuse[c] * (double)light[c];
                assert_near(result.rgb[c] / expected, 1.0, 1e-6);
                assert_true(fabs(result.rgb[c] - expected) <= result.bound[c]);
                assert_true(result.bound[c] < 1.3e-5 * expected); /* tolerance and rounding */
            }
        }
        helio_environment_destroy(environment);
    }
    helio_context_destroy(context);
}

/* A polygon of directions, cut off where the plane through the origin has its other side. */
static int clip(vector corners[12], int count, vector normal)
{
    vector from[12];
    int kept = 0;
    memcpy(from, corners, sizeof from);
    for (int i = 0; i < count; i++) {
        double here = inner(from[i], normal), there = inner(from[(i + 1) % count], normal);
        if (here > 0.0)
            corners[kept++] = from[i];
        if ((here > 0.0) != (there > 0.0))
            corners[kept++] =
                unit(combine(from[i], there / (there - here), from[(i + 1) % count], here / (here - there)));
    }
    return kept;
}

/* Lambert's formula: half the sum over edges of the edge's angle times the cosine between normal and edge's plane. */
static double lambert_irradiance(const vector *corners, int count, vector normal)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        vector plane = outer(corners[i], corners[(i + 1) % count]);
        double size = sqrt(inner(plane, plane));
        if (size > 0.0)
            sum += atan2(size, inner(corners[i], corners[(i + 1) % count])) * inner(normal, plane) / size;
    }
    return fabs(0.5 * sum);
}

static vector on_face(uint32_t face, double u, double v)
{
    const cube_face *f = &cube_faces[face];
    return unit((vector){(double)f->axis.x + u * (double)f->right.x + v * (double)f->down.x,
                         (double)f->axis.y + u * (double)f->right.y + v * (double)f->down.y,
                         (double)f->axis.z + u * (double)f->right.z + v * (double)f->down.z});
}

/* Irradiance from a texel of radiance 1, as far as it is above both horizons. */
static double texel_irradiance(uint32_t size, uint32_t texel, vector normal, vector flat)
{
    uint32_t face = texel / (size * size), row = texel / size % size, column = texel % size;
    double u = 2.0 * column / size - 1.0, v = 2.0 * row / size - 1.0, edge = 2.0 / size;
    vector corners[12] = {on_face(face, u, v), on_face(face, u + edge, v), on_face(face, u + edge, v + edge),
                          on_face(face, u, v + edge)};
    int count = clip(corners, 4, normal);
    count = count > 0 ? clip(corners, count, flat) : 0;
    return count > 2 ? lambert_irradiance(corners, count, normal) : 0.0;
}

/* Also texels that one or two horizons cut, or leave only a corner of. Parts of texels that are cut have an error of
 * their own, which is small beside a texel: tolerances are relative to a whole one that faces the point. */
static void one_lit_texel_gives_its_closed_form(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    uint64_t random = 2;
    int cut = 0, whole = 0, dark = 0;
    for (int i = 0; i < 600; i++) {
        uint32_t size = sizes[i % 6], texels = 6 * size * size, texel = random_bits(&random) % texels;
        float *pixels = calloc((size_t)texels * 3, sizeof *pixels);
        pixels[3 * texel] = 100.0f;
        helio_environment *environment = make_cube(context, size, pixels);
        vector n = random_normal(&random), flat = n;
        if (i % 3 == 0)
            flat = unit(combine(n, 1.0, random_normal(&random), 0.4));
        helio_shading_point point = make_point(&white, n, flat, n);
        n = unit(vector_of(point.normal));
        quadrature_result result = integrate(environment, &point);
        double expected = 100.0 / PI * texel_irradiance(size, texel, n, unit(vector_of(point.geometric_normal)));
        double facing = 100.0 / PI * cube_solid_angle(0, 2.0 / size, 0, 2.0 / size);
        double all = 100.0 / PI * texel_irradiance(size, texel, n, n);
        dark += expected == 0.0;
        cut += expected > 0.0 && expected < 0.999 * all;
        whole += expected > 0.999 * all;
        double off = fabs(result.rgb[0] - expected);
        if (off > result.bound[0] + 1e-7 * facing || off > 5e-6 * expected + 1e-7 * facing)
            fail_msg("size %u, texel %u: %.9g in place of %.9g, bound %.2g", size, texel, result.rgb[0], expected,
                     result.bound[0]);
        assert_true(result.rgb[1] == 0.0 && result.rgb[2] == 0.0);
        helio_environment_destroy(environment);
        free(pixels);
    }
    assert_true(cut > 20 && whole > 100 && dark > 100);
    helio_context_destroy(context);
}

/* With the eye above the surface a Phong lobe is symmetric, and its integral over the cosine is ks. */
static void phong_in_a_furnace_returns_all_of_it_however_sharp(void **state)
{
    (void)state;
    static const float exponents[] = {0, 0.5f, 1, 1.5f, 2, 7, 11.5f, 30, 120, 1000, 20000, 100000};
    helio_context *context = make_context(1, NULL);
    uint64_t random = 3;
    for (int size = 0; size < 3; size++) {
        helio_environment *environment = make_even_cube(context, sizes[size * 2], (const float[3]){1, 1, 1});
        for (size_t i = 0; i < sizeof exponents / sizeof exponents[0]; i++) {
            helio_material material = {.kind = HELIO_MATERIAL_PHONG,
                                       .diffuse = {0.25f, 0, 1},
                                       .specular = {0.75f, 0.5f, 0},
                                       .exponent = exponents[i]};
            vector n = random_normal(&random);
            helio_shading_point point = make_point(&material, n, n, n);
            quadrature_result result = integrate(environment, &point);
            const double expected[3] = {1.0, 0.5, 1.0};
            for (int c = 0; c < 3; c++)
                if (fabs(result.rgb[c] - expected[c]) > fmin(result.bound[c], 2e-5))
                    fail_msg("size %u, n = %g: %.9g in place of %g, bound %.2g", sizes[size * 2], (double)exponents[i],
                             result.rgb[c], expected[c], result.bound[c]);
        }
        helio_environment_destroy(environment);
    }
    helio_context_destroy(context);
}

/* Likewise for GGX, by a fine sum over the angle alone, in steps that grow with it. */
static double ggx_from_above(const helio_material *m)
{
    enum { STEPS = 4000 };
    const gauss_rule rule = gauss_make(4);
    double alpha = fmax((double)m->roughness * (double)m->roughness, 1e-3), sum = 0.0;
    double top = asinh(0.5 * PI / alpha), step = top / STEPS; /* angle = alpha sinh(t) */
    for (int i = 0; i < STEPS; i++)
        for (uint32_t k = 0; k < rule.count; k++) {
            double t = step * (i + 0.5 + 0.5 * rule.points[k]), angle = alpha * sinh(t);
            vector light = {sin(angle), 0.0, cos(angle)}, up = {0, 0, 1};
            sum += 0.5 * step * rule.weights[k] * alpha * cosh(t) * 2.0 * PI * sin(angle) * reflected(m, up, up, light);
        }
    return sum;
}

static void ggx_in_a_furnace_returns_its_albedo_however_smooth(void **state)
{
    (void)state;
    static const float roughnesses[] = {0, 0.04f, 0.1f, 0.2f, 0.3f, 0.6f, 1};
    helio_context *context = make_context(1, NULL);
    uint64_t random = 4;
    for (int size = 0; size < 2; size++) {
        helio_environment *environment = make_even_cube(context, size ? 16 : 3, (const float[3]){1, 1, 1});
        for (size_t i = 0; i < sizeof roughnesses / sizeof roughnesses[0]; i++) {
            helio_material material = {.kind = HELIO_MATERIAL_GGX,
                                       .diffuse = {0.8f, 0.8f, 0.8f},
                                       .metallic = i % 2 ? 1.0f : 0.25f,
                                       .roughness = roughnesses[i]};
            vector n = random_normal(&random);
            helio_shading_point point = make_point(&material, n, n, n);
            quadrature_result result = integrate(environment, &point);
            double expected = ggx_from_above(&material);
            if (fabs(result.rgb[0] - expected) > fmin(result.bound[0], 5e-5 * expected))
                fail_msg("roughness %g: %.9g in place of %.9g, bound %.2g", (double)roughnesses[i], result.rgb[0],
                         expected, result.bound[0]);
        }
        helio_environment_destroy(environment);
    }
    helio_context_destroy(context);
}

/* ---- plain sums over fine grids ------------------------------------------------------------------- */

enum { SIZE = 4, TEXELS = 6 * SIZE * SIZE };

/* An uneven sky with a sun of 1e5 in one texel. */
static void fill_sunny(float pixels[3 * TEXELS], uint32_t sun)
{
    uint64_t random = 5;
    for (int i = 0; i < 3 * TEXELS; i++)
        pixels[i] = 0.2f + (float)random_unit(&random);
    for (int c = 0; c < 3; c++)
        pixels[3 * sun + (uint32_t)c] = 1e5f;
}

typedef struct plain_sum {
    const helio_environment *environment;
    const helio_material *material;
    vector normal, flat, view;
    gauss_rule rule;
    double edge; /* of the cells */
} plain_sum;

static vector to_world(const helio_environment *environment, vector d)
{
    const vec3 *axes = environment->map_axes;
    float turned[3][3];
    for (int i = 0; i < 3; i++)
        vec3_to(axes[i], turned[i]);
    return (vector){inner(vector_of(turned[0]), d), inner(vector_of(turned[1]), d), inner(vector_of(turned[2]), d)};
}

static bool is_cut(const plain_sum *p, uint32_t face, double u, double v, double edge)
{
    bool above[2] = {false, false}, below[2] = {false, false};
    vector mirror = combine(p->normal, 2.0 * inner(p->normal, p->view), p->view, -1.0);
    bool has_mirror = p->material->kind == HELIO_MATERIAL_PHONG && p->material->exponent < 10.0f;
    bool lobe_above = false, lobe_below = false;
    for (int i = 0; i < 4; i++) {
        vector d = to_world(p->environment, on_face(face, u + (i & 1 ? edge : 0), v + (i & 2 ? edge : 0)));
        above[0] |= inner(d, p->normal) > 0;
        below[0] |= inner(d, p->normal) < 0;
        above[1] |= inner(d, p->flat) > 0;
        below[1] |= inner(d, p->flat) < 0;
        lobe_above |= inner(d, mirror) > 0;
        lobe_below |= inner(d, mirror) < 0;
    }
    return (above[0] && below[0]) || (above[1] && below[1]) || (has_mirror && lobe_above && lobe_below);
}

/* Cells that a horizon cuts are halved until they do not matter; a third of their error is left to chance. */
static double sum_cell(const plain_sum *p, uint32_t face, double u, double v, double edge)
{
    if (edge > p->edge / 16.0 && is_cut(p, face, u, v, edge)) {
        double half = 0.5 * edge;
        return sum_cell(p, face, u, v, half) + sum_cell(p, face, u + half, v, half) +
               sum_cell(p, face, u, v + half, half) + sum_cell(p, face, u + half, v + half, half);
    }
    double sum = 0.0;
    for (uint32_t k = 0; k < p->rule.count * p->rule.count; k++) {
        uint32_t i = k % p->rule.count, j = k / p->rule.count;
        double x = u + 0.5 * edge * (1.0 + p->rule.points[i]), y = v + 0.5 * edge * (1.0 + p->rule.points[j]);
        vector d = to_world(p->environment, on_face(face, x, y));
        double squared = 1.0 + x * x + y * y;
        if (inner(d, p->flat) > 0.0)
            sum += p->rule.weights[i] * p->rule.weights[j] * reflected(p->material, p->normal, p->view, d) /
                   (squared * sqrt(squared));
    }
    return sum * 0.25 * edge * edge;
}

/* parts: cells along the edge of a texel. */
static double sum_plainly(const helio_environment *environment, const helio_shading_point *point, int parts)
{
    double edge = 2.0 / (SIZE * parts), sum = 0.0;
    plain_sum p = {environment,
                   &point->material,
                   unit(vector_of(point->normal)),
                   unit(vector_of(point->geometric_normal)),
                   unit(vector_of(point->view)),
                   gauss_make(4),
                   edge};
    for (uint32_t face = 0; face < 6; face++)
        for (int row = 0; row < SIZE * parts; row++)
            for (int column = 0; column < SIZE * parts; column++) {
                const float *rgb =
                    environment_texel(environment, face, (uint32_t)(row / parts), (uint32_t)(column / parts));
                sum += (double)rgb[0] * sum_cell(&p, face, -1.0 + column * edge, -1.0 + row * edge, edge);
            }
    return sum * (double)environment->intensity;
}

/* Lobes wider and narrower than a texel, which is half a radian wide here: the narrowest is 1/20 of one. */
static void surfaces_agree_with_plain_sums_over_fine_grids(void **state)
{
    (void)state;
    static const struct {
        helio_material material;
        int parts;
    } cases[] = {
        {{.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.7f, 0, 0}}, 8},
        {{.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0, 0}, .specular = {0.5f, 0, 0}, .exponent = 3.5f}, 12},
        {{.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0, 0}, .specular = {0.5f, 0, 0}, .exponent = 120}, 12},
        {{.kind = HELIO_MATERIAL_PHONG, .specular = {1, 0, 0}, .exponent = 1000}, 28},
        {{.kind = HELIO_MATERIAL_GGX, .diffuse = {0.9f, 0, 0}, .metallic = 1, .roughness = 0.6f}, 8},
        {{.kind = HELIO_MATERIAL_GGX, .diffuse = {0.9f, 0, 0}, .metallic = 0.5f, .roughness = 0.3f}, 14},
        {{.kind = HELIO_MATERIAL_GGX, .diffuse = {0.9f, 0, 0}, .metallic = 0, .roughness = 0.15f}, 44},
    };
    static const double tilts[] = {0.0, 0.8, 2.0, 0.4};
    helio_context *context = make_context(1, NULL);
    float pixels[3 * TEXELS];
    uint64_t random = 6;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int k = 0; k < 4; k++) {
            fill_sunny(pixels, random_bits(&random) % TEXELS);
            helio_environment *environment = make_cube(context, SIZE, pixels);
            const helio_orientation turned = {.rotate = 50, .flip = true, .intensity = 0.5f};
            if (k == 3)
                assert_ok(helio_environment_orient(environment, &turned));
            vector n = random_normal(&random), tangent = beside(n);
            vector view = unit(combine(n, 1.0, tangent, tilts[k]));
            vector flat = k == 1 ? unit(combine(n, 1.0, outer(n, tangent), 0.3)) : n;
            helio_shading_point point = make_point(&cases[i].material, n, flat, view);
            quadrature_result result = integrate(environment, &point);
            double expected = sum_plainly(environment, &point, cases[i].parts);
            /* What is left of the plain sum's own error, at horizons, is up to some millionths. */
            double off = fabs(result.rgb[0] - expected), allowed = result.bound[0] + 3e-6 * expected;
            if (off > allowed || result.bound[0] > 1e-4 * expected)
                fail_msg("case %zu, view %d: %.9g in place of %.9g, off by %.1e, bound %.1e", i, k, result.rgb[0],
                         expected, off / expected, result.bound[0] / expected);
            helio_environment_destroy(environment);
        }
    helio_context_destroy(context);
}

/* ---- how fine ----------------------------------------------------------------------------------- */

static void a_smaller_tolerance_costs_more_and_is_nearer(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float pixels[3 * TEXELS];
    fill_sunny(pixels, 20);
    helio_environment *environment = make_cube(context, SIZE, pixels);
    const helio_material material = {
        .kind = HELIO_MATERIAL_GGX, .diffuse = {1, 1, 1}, .metallic = 1, .roughness = 0.3f};
    vector n = unit((vector){0.3, 1.0, 0.2});
    helio_shading_point point = make_point(&material, n, n, unit((vector){1.0, 1.0, 0.1}));
    static const double tolerances[3] = {1e-2, 1e-5, 1e-9};
    quadrature_result results[3];
    for (int i = 0; i < 3; i++) {
        quadrature *q;
        assert_ok(quadrature_create(environment, tolerances[i], &q));
        quadrature_point(q, &point, &results[i]);
        quadrature_destroy(q);
    }
    assert_true(results[0].evaluations <= results[1].evaluations && results[1].evaluations < results[2].evaluations);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(results[0].rgb[c] - results[2].rgb[c]) <= results[0].bound[c]);
        assert_true(fabs(results[1].rgb[c] - results[2].rgb[c]) <= results[1].bound[c]);
        assert_true(results[1].bound[c] < 2e-5 * results[1].rgb[c]);
    }
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

/* Fused multiply-adds and the order of sums are all that differs. */
static void instruction_sets_agree(void **state)
{
    (void)state;
    float pixels[3 * TEXELS];
    fill_sunny(pixels, 20);
    const helio_material material = {
        .kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.5f, 0.5f}, .specular = {0.5f, 0.5f, 0.5f}, .exponent = 120};
    vector n = unit((vector){0.3, 1.0, 0.2});
    helio_shading_point point = make_point(&material, n, n, unit((vector){1.0, 1.0, 0.1}));
    quadrature_result first = {{0}, {0}, 0};
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++) {
        helio_context *context;
        assert_ok(helio_context_create(&(helio_context_desc){.threads = 1, .isa = helio_isa_name(i)}, &context));
        helio_environment *environment = make_cube(context, SIZE, pixels);
        quadrature_result result = integrate(environment, &point);
        if (i == 0)
            first = result;
        assert_int_equal(result.evaluations, first.evaluations);
        for (int c = 0; c < 3; c++)
            assert_near(result.rgb[c], first.rgb[c], 1e-6 * first.rgb[c]);
        helio_environment_destroy(environment);
        helio_context_destroy(context);
    }
}

static void black_maps_and_light_from_below_give_nothing(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float pixels[3 * TEXELS] = {0};
    vector up = {0, 1, 0};
    helio_shading_point point = make_point(&white, up, up, up);
    for (int lit = 0; lit < 2; lit++) {
        for (int i = 0; lit && i < SIZE * SIZE * 3; i++)
            pixels[3 * SIZE * SIZE * 3 + i] = 7.0f; /* the face -Y */
        helio_environment *environment = make_cube(context, SIZE, pixels);
        quadrature_result result = integrate(environment, &point);
        for (int c = 0; c < 3; c++)
            assert_true(result.rgb[c] == 0.0 && result.bound[c] == 0.0);
        helio_environment_destroy(environment);
    }
    helio_context_destroy(context);
}

/* ---- parts ------------------------------------------------------------------------------------------- */

static void gauss_rules_are_exact_for_their_polynomials(void **state)
{
    (void)state;
    for (uint32_t count = 1; count <= GAUSS_LIMIT; count++) {
        gauss_rule rule = gauss_make(count);
        for (uint32_t power = 0; power < 2 * count; power++) {
            double sum = 0.0;
            for (uint32_t i = 0; i < count; i++)
                sum += rule.weights[i] * pow(rule.points[i], power);
            assert_near(sum, power % 2 ? 0.0 : 2.0 / (power + 1.0), 1e-13);
        }
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = 0; k < count; k++)
                assert_near(gauss_basis(&rule, i, rule.points[k]), i == k, 1e-12);
    }
}

/* Every node sums a cosine exactly, whatever its size: as all texels of it do. */
static void nodes_of_all_sizes_hold_the_light_of_their_texels(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    uint64_t random = 7;
    for (int i = 0; i < SIZES; i++) {
        uint32_t size = sizes[i];
        size_t count = (size_t)18 * size * size;
        float *pixels = malloc(count * sizeof *pixels);
        for (size_t k = 0; k < count; k++)
            pixels[k] = (float)random_unit(&random);
        helio_environment *environment = make_cube(context, size, pixels);
        light_tree tree;
        assert_ok(light_tree_create(environment, &tree));
        for (uint32_t depth = 0; depth <= tree.depth; depth++) {
            light_node node = {random_bits(&random) % 6, depth, random_bits(&random) % (1u << depth),
                               random_bits(&random) % (1u << depth)};
            face_rectangle r = light_tree_rectangle(&tree, &node);
            const float *weights = tree.weights + light_tree_index(&node) * 3 * TREE_POINTS;
            vector n = on_face(node.face, 0.3, -0.2); /* sees all of the face */
            double sum = 0.0, expected = 0.0;
            for (uint32_t k = 0; k < TREE_POINTS; k++)
                sum += (double)weights[TREE_POINTS + k] *
                       inner(n, on_face(node.face, 0.5 * (r.u0 + r.u1 + tree.rule.points[k % 8] * (r.u1 - r.u0)),
                                        0.5 * (r.v0 + r.v1 + tree.rule.points[k / 8] * (r.v1 - r.v0))));
            for (uint32_t row = light_tree_texel(&tree, depth, node.row);
                 row < light_tree_texel(&tree, depth, node.row + 1); row++)
                for (uint32_t column = light_tree_texel(&tree, depth, node.column);
                     column < light_tree_texel(&tree, depth, node.column + 1); column++) {
                    uint32_t texel = (node.face * size + row) * size + column;
                    double all = texel_irradiance(size, texel, n, n);
                    expected += (double)environment_texel(environment, node.face, row, column)[1] * all;
                }
            assert_near(sum / expected, 1.0, 1e-6);
        }
        light_tree_destroy(&tree);
        helio_environment_destroy(environment);
        free(pixels);
    }
    helio_context_destroy(context);
}

static void memory_that_runs_out_is_told(void **state)
{
    (void)state;
    memory_count memory = {0};
    helio_context *context = make_context(1, &memory);
    helio_environment *environment = make_even_cube(context, 16, (const float[3]){1, 1, 1});
    size_t live = memory.live, before = memory.taken, failures = 0;
    quadrature *q = NULL;
    for (helio_status status = HELIO_ERR_MEMORY; status != HELIO_OK; failures++) {
        memory.refuse_after = memory.taken + failures;
        if (failures == 0) /* 0 stands for no limit */
            memory.refuse_after = before;
        status = quadrature_create(environment, 1e-5, &q);
        assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
        assert_true((status == HELIO_OK) == (q != NULL));
        if (status != HELIO_OK)
            assert_int_equal(memory.live, live);
    }
    assert_int_equal(failures, 4);
    quadrature_destroy(q);
    assert_int_equal(memory.live, live);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gauss_rules_are_exact_for_their_polynomials),
        cmocka_unit_test(nodes_of_all_sizes_hold_the_light_of_their_texels),
        cmocka_unit_test(a_matte_furnace_returns_its_albedo),
        cmocka_unit_test(one_lit_texel_gives_its_closed_form),
        cmocka_unit_test(phong_in_a_furnace_returns_all_of_it_however_sharp),
        cmocka_unit_test(ggx_in_a_furnace_returns_its_albedo_however_smooth),
        cmocka_unit_test(surfaces_agree_with_plain_sums_over_fine_grids),
        cmocka_unit_test(a_smaller_tolerance_costs_more_and_is_nearer),
        cmocka_unit_test(instruction_sets_agree),
        cmocka_unit_test(black_maps_and_light_from_below_give_nothing),
        cmocka_unit_test(memory_that_runs_out_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
