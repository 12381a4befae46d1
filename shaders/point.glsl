// SPDX-License-Identifier: MIT
// point.glsl - what a point needs before its first sample: its BRDF in the map's space, expected and realised counts,
// windows of the pools. As points_kernel.c and estimate.c, rounded as these are, so that both take the same samples. Needs
// division.glsl, brdf.glsl, tiles.glsl, lobe_variance.glsl and the constants LIGHT, SURFACE and VISIBILITY.

struct shading_point {
    uint pixel, hit, material_index;
    vec3 normal, geometric_normal, view; // in world space
};

struct prepared_point {
    brdf surface;
    vec3 geometric_normal;
    uint end[LAYOUT_FACES];       // of the samples of each light technique, counted through all of them ...
    uint from[LAYOUT_FACES];      // ... and what is added to such a number to get that of the sample in the pools
    float expected[LAYOUT_FACES]; // number of samples
    float surface_expected;
    uint surface_count, surface_seed, bin, seed;
    bool is_calm;  // shines, but need not weigh tiles
    bool has_both; // samples of light and of the surface, however few
};

// A point that shines reads no pool of a bin, but weighs the tiles itself: in another pass, shade_tiles.comp; unless the
// light in its lobe is calm. Where all light is even the surface has all samples.
bool weighs_tiles(prepared_point p)
{
    return LIGHT == LAYOUT_LIGHT_BINS && !p.is_calm && p.has_both;
}

const uint TECHNIQUES = LIGHT == LAYOUT_LIGHT_FACES ? LAYOUT_FACES : LIGHT == LAYOUT_LIGHT_NONE ? 0u : 1u;

shading_point read_point(uint index)
{
    const vec4 a = vector_at(STEP.points, 3u * index), b = vector_at(STEP.points, 3u * index + 1u);
    const vec4 c = vector_at(STEP.points, 3u * index + 2u);
    return shading_point(floatBitsToUint(a.w), floatBitsToUint(c.w), floatBitsToUint(b.w), a.xyz, b.xyz, c.xyz);
}

vec3 turned(vec3 v)
{
    precise vec3 result = vec3(STEP.map_axes[0], STEP.map_axes[1], STEP.map_axes[2]) * v.x +
                          vec3(STEP.map_axes[3], STEP.map_axes[4], STEP.map_axes[5]) * v.y +
                          vec3(STEP.map_axes[6], STEP.map_axes[7], STEP.map_axes[8]) * v.z;
    return result;
}

// ---- shares and expected counts ----

// What this is times the spread of a tile: see tile_lobe in point_tiles.h.
float to_surface(brdf b)
{
    return RULE_EVEN_WIDTH / (is_ggx(b.kind) ? 2.0 * sqrt(b.shape) : RULE_PHONG_WIDTH / sqrt(max(b.shape, 1.0)));
}

// See tile_lobe_need().
float need_of_lobe(brdf b)
{
    const float x = STATE.tile_radius * to_surface(b);
    return b.specular_share * (x / (1.0 + x));
}

// The share given is what `need` is at an even split.
float share_of_need(float need)
{
    precise float for_surface = need * STEP.brdf_share, for_light = (1.0 - need) * (1.0 - STEP.brdf_share);
    precise float both = for_surface + for_light;
    return for_surface > 0.0 ? divide(for_surface, both) : 0.0;
}

// Bins know light and cosine, and tiles light and BRDF, so that BRDF samples have only the lobe to look after, the more
// the narrower it is. How many they are where tiles are weighed, shade_tiles.comp finds; here it matters whether there are any.
float share_of_lobe(shading_point p, scene_material m)
{
    const brdf b = prepare_brdf(m, p.normal, lift_view(p.normal, p.view));
    return m.kind != LAYOUT_DIFFUSE ? share_of_need(need_of_lobe(b)) : 0.0;
}

// Is the light so even that it does not pay to aim at it?
bool is_even()
{
    return LIGHT == LAYOUT_LIGHT_BINS && STATE.is_automatic != 0u && STATE.sums.all.uneven_faces == 0u;
}

// Part of the samples that the surface technique takes.
float surface_share(shading_point p, scene_material m)
{
    if (LIGHT == LAYOUT_LIGHT_NONE || is_even())
        return 1.0;
    if (SURFACE == LAYOUT_SURFACE_NONE)
        return 0.0;
    return LIGHT == LAYOUT_LIGHT_BINS ? share_of_lobe(p, m) : STEP.brdf_share;
}

// See class_of_lobe() in estimate.c.
uint class_of_lobe(scene_material m)
{
    precise float alpha = m.roughness * m.roughness, alpha2 = alpha * alpha;
    if (m.kind == LAYOUT_GGX && m.metallic == 1.0)
        return lobe_class(alpha2);
    if (m.kind == LAYOUT_PHONG && !(luminance(m.diffuse) > 0.0) && luminance(m.specular) > 0.0)
        return lobe_class(1.0 / max(m.exponent, 1e-3));
    return LAYOUT_LOBE_CLASSES;
}

// See is_calm() in points_kernel.c. Directions in the map's space. shade.comp and shade_tiles.comp both ask, and must be told
// the same, so that all is precise that this depends on.
bool is_calm(scene_material m, vec3 normal, vec3 view, uint seed)
{
    if (LIGHT != LAYOUT_LIGHT_BINS || SURFACE != LAYOUT_SURFACE_BRDF || is_even())
        return false;
    const uint class_of = class_of_lobe(m), random = hash_combine(seed, LAYOUT_STREAM_LOBE);
    precise float twice = 2.0 * (normal.x * view.x + normal.y * view.y + normal.z * view.z);
    precise vec3 mirror = normal * twice - view;
    const uint cell = bin_of_normal(mirror, random);
    precise float limit = lobe_class_most(class_of, VISIBILITY == 0u) * (0.5 + unit_float(hash(random)));
    return class_of < LAYOUT_LOBE_CLASSES &&
           STATE.lobe_variances.at[LAYOUT_LOBE_CLASSES * cell + class_of] < limit;
}

// How much, at most, a face can light a surface with this normal: strategy_beta().
float beta_of(uint face, vec3 normal)
{
    const uint axis = face / 2u;
    const float along = (face & 1u) == 0u ? normal[axis] : -normal[axis];
    precise float beta = along + abs(normal[axis == 0u ? 1 : 0]) + abs(normal[axis == 2u ? 1 : 2]);
    return max(beta, 0.0);
}

const float FACE_EXTRA = LIGHT == LAYOUT_LIGHT_FACES ? RULE_FACE_EXTRA : 0.0;

float worth_of_face(uint face, vec3 normal)
{
    const float beta = beta_of(face, normal);
    precise float worth = (STEP.no_beta != 0u && beta > 0.0 ? 1.0 : beta) * STATE.sums.all.worth[face];
    return worth;
}

// Writes worths of the light techniques and returns their sum.
float find_worths(vec3 normal, uint bin, out float worths[LAYOUT_FACES])
{
    precise float total = 0.0;
    for (uint k = 0u; k < TECHNIQUES; k++) {
        if (LIGHT == LAYOUT_LIGHT_FACES)
            worths[k] = worth_of_face(k, normal);
        else if (LIGHT == LAYOUT_LIGHT_BINS)
            worths[k] = STATE.bin_shares.at[bin] > 0.0 ? 1.0 : 0.0;
        else
            worths[k] = STATE.sums.all.faces[LAYOUT_FACES] != 0u ? 1.0 : 0.0;
        total += worths[k];
    }
    return LIGHT == LAYOUT_LIGHT_NONE ? 1.0 : total;
}

// See expect_counts() in points_kernel.c.
void expect_counts(vec3 normal, float share, inout prepared_point p)
{
    float worths[LAYOUT_FACES];
    const float total = find_worths(normal, p.bin, worths);
    const bool lit = total >= RULE_FACE_LEAST;
    // Where compensated tables only say that there is nothing to compensate, the surface gets all.
    const float of_dark = STATE.weighting == LAYOUT_COMPENSATED ? 1.0 : 0.0, samples = float(STEP.samples);
    precise float by_surface = samples * (lit ? share : of_dark), by_light = samples - by_surface;
    precise float to_divide = by_light * (1.0 - float(LAYOUT_FACES) * FACE_EXTRA), least = by_light * FACE_EXTRA;
    const float light = lit ? divide(to_divide, total) : 0.0;
    for (uint k = 0u; k < TECHNIQUES; k++) {
        precise float expected = worths[k] * light + (worths[k] >= RULE_FACE_LEAST ? least : 0.0);
        p.expected[k] = expected;
    }
    p.surface_expected = by_surface;
    p.has_both = lit && by_surface > 0.0 && by_light > 0.0;
}

// ---- realised counts and windows ----

uint window_of(uint realised, uint pool, uint seed)
{
    const uint bits = realised > 1u ? uint(findMSB(realised - 1u)) + 1u : 0u;
    const uint choice = hash_combine(hash_combine(seed, LAYOUT_STREAM_WINDOW), pool);
    return pool * STATE.pool_length + (multiply_high(choice, STATE.pool_length >> bits) << bits);
}

// Systematic rounding on its way through the techniques: see round_counts() in points_kernel.c. Sums begin with 1.
struct rounding {
    float least;        // part of a whole number from which on a sum is rounded up
    float total, end;   // sum of all expected counts, and what becomes of it
    float sum, reached; // of those so far
    uint given;
};

rounding begin_rounding(uint seed, prepared_point p)
{
    precise float total = 1.0, least = 1.0 - unit_float(hash_combine(seed, LAYOUT_STREAM_ROUNDING));
    for (uint k = 0u; k < TECHNIQUES; k++)
        total += p.expected[k];
    total += p.surface_expected;
    return rounding(least, total, total > 1.0 ? 1.0 + float(STEP.samples) : 1.0, 1.0, 1.0, 1u);
}

// The realised count. The expected one becomes what it stands for.
uint round_count(inout float expected, inout rounding r)
{
    precise float sum = r.sum + expected;
    const float to = sum < r.total && sum < r.end ? sum : r.end;
    const uint whole = uint(to);
    precise float part = to - float(whole), between = to - r.reached;
    const uint up_to = whole + (part >= r.least ? 1u : 0u), realised = up_to - r.given;
    expected = between;
    r.sum = sum;
    r.reached = to;
    r.given = up_to;
    return realised;
}

void round_counts(uint seed, inout prepared_point p)
{
    rounding r = begin_rounding(seed, p);
    uint given = 0u;
    for (uint k = 0u; k < TECHNIQUES; k++) {
        const uint realised = round_count(p.expected[k], r);
        p.from[k] = window_of(realised, LIGHT == LAYOUT_LIGHT_BINS ? p.bin : k, seed) - given;
        p.end[k] = given += realised;
    }
    p.surface_count = round_count(p.surface_expected, r);
}

prepared_point prepare_with(shading_point given, scene_material m, uint seed)
{
    const vec3 normal = turned(given.normal), view = lift_view(normal, turned(given.view));
    prepared_point p;
    p.seed = seed;
    for (uint k = 0u; k < LAYOUT_FACES; k++) {
        p.end[k] = p.from[k] = 0u;
        p.expected[k] = 0.0;
    }
    p.geometric_normal = turned(given.geometric_normal);
    p.surface = prepare_brdf(m, normal, view);
    p.bin = LIGHT == LAYOUT_LIGHT_BINS ? bin_of_normal(normal, hash_combine(seed, LAYOUT_STREAM_BIN)) : 0u;
    p.is_calm = is_calm(m, normal, view, seed);
    expect_counts(normal, p.is_calm ? share_of_need(1.0 - LOBE_POOL_PART) : surface_share(given, m), p);
    round_counts(seed, p);
    p.surface_seed = hash_combine(seed, LAYOUT_STREAM_SURFACE);
    return p;
}

prepared_point prepare(shading_point given)
{
    const uint seed = STEP.same_seed != 0u ? STEP.point_seed : hash_combine(STEP.point_seed, given.pixel);
    return prepare_with(given, read_material(given.material_index), seed);
}
