#version 460
// SPDX-License-Identifier: MIT
//
// The light that leaves points that shine, where pools are of bins: a work group weighs the tiles of the map by light x
// BRDF x cosine for one point, and takes samples from the lists of these tiles, and of the specular lobe. As
// src/sampling/point_tiles_kernel.c. Points that do not shine, or whose lobes are calm, are left to
// shade.comp.
#include "common.glsl"

layout(constant_id = 1) const uint KINDS = 7u; // of materials, as bits
layout(constant_id = 2) const uint VISIBILITY = LAYOUT_SHADOWS_CAST;
const uint LIGHT = LAYOUT_LIGHT_BINS, SURFACE = LAYOUT_SURFACE_BRDF;

#include "random.glsl"
#include "cube.glsl"
#include "elementary.glsl"
#include "fixed_point.glsl"
#include "division.glsl"
#include "scan.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "brdf.glsl"
#include "lobe_variance.glsl"
#include "point.glsl"
#include "film.glsl"
#include "rays.glsl"
#include "samples.glsl"

const uint RUNS_MOST = LAYOUT_TILES_MOST / (LAYOUT_TILE_GROUP * LAYOUT_TILE_RUN);
const uint GROUPS_MOST = LAYOUT_TILES_MOST / LAYOUT_TILE_GROUP, NOWHERE = GROUPS_MOST;

// Groups of tiles that reach above the point's horizon, in the order of the tiles; and where each group is among them, or
// NOWHERE.
shared uint groups[GROUPS_MOST], places[GROUPS_MOST];
shared uint runs[RUNS_MOST + 1u]; // how many of these are before each run of groups
// Of all groups: how their tiles are weighed; the BRDF that tiles share; light x BRDF x cosine; and what BRDF samples take
// of that.
const uint SHARED = 0u, LOW = 1u, APART = 2u; // all above the horizon with one value of the BRDF; some not; each its own
shared uint kinds[GROUPS_MOST];
shared bool knowns[GROUPS_MOST]; // whether the diffuse light is known, and so left out
shared float values[GROUPS_MOST], weights[GROUPS_MOST], takings[GROUPS_MOST];
// Before each tile of the chosen groups; at first the bits of the weights, and before that what the specular lobe has of
// each group. A number is left out after each group, so that threads with a group each reach for different banks of memory.
shared uint sums[LAYOUT_TILES_MOST + GROUPS_MOST + 1];
shared float parts[4u * gl_WorkGroupSize.x];

uint slot(uint i)
{
    return i + i / LAYOUT_TILE_GROUP;
}

uint tree_sum(uint i)
{
    return sums[slot(i)];
}

uint tree_run(uint run)
{
    return runs[run] * LAYOUT_TILE_GROUP;
}

const bool TREE_IS_EVEN = true;
#include "tile_tree.glsl"

// See tile_lobe in point_tiles.h.
struct tile_lobe {
    float diffuse, specular, width, alpha, to_surface, least_part;
    bool knows_diffuse;
    vec3 geometric_normal;
};

tile_lobe prepare_lobe(brdf b, vec3 geometric_normal)
{
    const float edge2 = STATE.tile_edge * STATE.tile_edge;
    const float diffuse = luminance(b.colours[0]);
    const float least_part = (1.0 + float(LAYOUT_REFINED_TIMES - 1) * need_of_lobe(b)) / float(LAYOUT_REFINED_PARTS);
    const bool knows_diffuse = VISIBILITY == 0u && STEP.control_part == 1.0 && diffuse > 0.0;
    tile_lobe lobe = tile_lobe(diffuse, luminance(b.colours[1]), 0.0, 0.0, to_surface(b), least_part, knows_diffuse,
                               geometric_normal);
    if (is_ggx(b.kind)) {
        lobe.alpha = sqrt(b.shape);
        lobe.width = b.shape + edge2;
        lobe.specular += luminance(b.colours[2]) * schlick_weight(b.view_cosine);
        lobe.specular *= INVERSE_PI;
    } else {
        lobe.width = 1.0 / max(b.shape, 1e-3) + RULE_PHONG_TILE * edge2;
        lobe.specular /= b.shape + 2.0;
    }
    return lobe;
}

float soft_cosine(float cosine, float edge)
{
    const float risen = max(cosine + edge, 0.0);
    return cosine < edge ? risen * risen / (4.0 * edge) : cosine;
}

// The specular lobe, of this width. cosine: between normal and direction; soft: the same, softened.
float specular_at(brdf b, tile_lobe lobe, vec3 direction, float width, float cosine, float soft)
{
    const float along = dot(b.view, direction);
    if (!is_ggx(b.kind)) {
        const float exponent = 1.0 / width;
        return lobe.specular * (exponent + 2.0) * exp2_fast(1.44269504 * exponent * (along - 1.0));
    }
    const float height = b.view_cosine + cosine, twice = max(2.0 + 2.0 * along, 1e-6);
    const float safe = max(twice - (1.0 - min(width, 0.999)) * (height * height), 1e-6);
    const float masking = soft * (2.0 - lobe.alpha) + lobe.alpha;
    return lobe.specular * width * (twice * twice) / (safe * safe * masking);
}

// Each of four threads adds up one of the four numbers of all.
vec4 sum_of_group(vec4 own)
{
    const uint thread = gl_LocalInvocationID.x, threads = gl_WorkGroupSize.x;
    for (uint c = 0u; c < 4u; c++)
        parts[c * threads + thread] = own[c];
    barrier();
    float sum = 0.0;
    for (uint i = 0u; thread < 4u && i < threads; i++)
        sum += parts[thread * threads + i];
    barrier();
    if (thread < 4u)
        parts[thread] = sum;
    barrier();
    return vec4(parts[0], parts[1], parts[2], parts[3]);
}

// Where runs begin among the chosen groups; to be read after the next barrier.
void find_runs(uint count)
{
    for (uint run = gl_LocalInvocationID.x; run <= RUNS_MOST; run += gl_WorkGroupSize.x) {
        uint low = 0u, high = count;
        while (low < high) {
            const uint middle = (low + high) / 2u;
            if (groups[middle] < run * LAYOUT_TILE_RUN)
                low = middle + 1u;
            else
                high = middle;
        }
        runs[run] = low;
    }
}

// Looks at a group by the mean direction of its light, and returns what it weighs, or 0 where no tile of it reaches above
// the horizon. As look_at_groups() in point_tiles_kernel.c.
float look_at_group(brdf b, tile_lobe lobe, uint i)
{
    const uint row = LAYOUT_GROUP_ROWS * i;
    const vec4 middle = vector_at(STATE.groups, row), light = vector_at(STATE.groups, row + 1u);
    const vec4 width = vector_at(STATE.groups, row + 2u); // variance, spread, moment, and what is above the horizon
    const float above = dot(b.normal, middle.xyz), cosine = dot(b.normal, light.xyz);
    knowns[i] = lobe.knows_diffuse && above >= middle.w && dot(lobe.geometric_normal, middle.xyz) >= middle.w;
    if (light.w == 0.0 || above <= -middle.w) {
        places[i] = NOWHERE;
        return 0.0;
    }
    const float soft = soft_cosine(cosine, middle.w);
    const float all = specular_at(b, lobe, light.xyz, lobe.width + width.x, cosine, soft);
    const float specular = all / (1.0 + lobe.to_surface * width.y);
    const float lit = above < width.w ? light.w * soft : width.z * cosine;
    places[i] = 0u;
    kinds[i] = above < width.w ? LOW : SHARED;
    values[i] = (knowns[i] ? 0.0 : lobe.diffuse) + specular;
    takings[i] = lit * (all - specular);
    weights[i] = lit * values[i];
    sums[i] = floatBitsToUint(lit * specular);
    return weights[i];
}

// Returns how many groups there are, each thread having looked at some that follow each other.
uint choose_groups(brdf b, tile_lobe lobe)
{
    const uint all = (STATE.tile_count + LAYOUT_TILE_GROUP - 1u) / LAYOUT_TILE_GROUP;
    const uint each = (all + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(each * gl_LocalInvocationID.x, all), end = min(begin + each, all);
    uint own = 0u, count;
    float weight = 0.0;
    for (uint i = begin; i < end; i++) {
        weight += look_at_group(b, lobe, i);
        if (places[i] != NOWHERE)
            places[i] = own++;
    }
    const float least = sum_of_group(vec4(weight, 0.0, 0.0, 0.0)).x * lobe.least_part;
    const uint before = sum_before_in_group(own, count);
    for (uint i = begin; i < end; i++)
        if (places[i] != NOWHERE) {
            places[i] += before;
            groups[places[i]] = i;
            if (uintBitsToFloat(sums[i]) > least)
                kinds[i] = APART;
        }
    barrier();
    find_runs(count);
    return count;
}

// Tile i of the chosen groups.
uint position_of(uint i)
{
    return groups[i / LAYOUT_TILE_GROUP] * LAYOUT_TILE_GROUP + i % LAYOUT_TILE_GROUP;
}

// Light x BRDF x cosine of a tile: of what BRDF samples leave; and what they take, where the lobe is the tile's own.
vec2 weigh(brdf b, tile_lobe lobe, uint position)
{
    if (position >= STATE.tile_count)
        return vec2(0.0);
    const vec4 tile = vector_at(STATE.tiles, position);
    const uint group = position / LAYOUT_TILE_GROUP;
    const float cosine = dot(b.normal, tile.xyz), light = max(tile.w, 0.0);
    if (kinds[group] == SHARED)
        return vec2(light * (cosine * values[group]), 0.0);
    const float soft = soft_cosine(cosine, STATE.tile_edge);
    if (kinds[group] == LOW)
        return vec2(light * (soft * values[group]), 0.0);
    const float all = specular_at(b, lobe, tile.xyz, lobe.width, cosine, soft);
    const float specular = all / (1.0 + lobe.to_surface * STATE.tile_spreads.at[position]);
    return light * soft * vec2((knowns[group] ? 0.0 : lobe.diffuse) + specular, all - specular);
}

float weight_at(uint i)
{
    return uintBitsToFloat(sums[slot(i)]);
}

const float BLACK_BELOW = 7.88860905e-31; // 2^-100

// The sum of a group's tiles, unless it is known; 0 below 2^-100, so that nothing that is divided is subnormal. As sum_of_tiles() and
// share_out() in point_tiles_kernel.c.
float sum_group(uint place)
{
    const uint first = place * LAYOUT_TILE_GROUP;
    float weight = weights[groups[place]];
    if (kinds[groups[place]] != SHARED) {
        float four[4];
        for (uint i = 0u; i < 4u; i++)
            four[i] = (weight_at(first + i) + weight_at(first + i + 8u)) +
                      (weight_at(first + i + 4u) + weight_at(first + i + 12u));
        weight = (four[0] + four[2]) + (four[1] + four[3]);
    }
    return weight >= BLACK_BELOW ? weight : 0.0;
}

// Of a group that is not black the weight is at least this, so that each tile, however dark, can have 1 or more.
const uint LEAST_WEIGHT = LAYOUT_TILE_GROUP * LAYOUT_TILE_GROUP;

uint group_integer(uint place, float factor)
{
    const float weight = weights[groups[place]];
    return weight > 0.0 ? max(fixed_point_integer(weight, factor), LEAST_WEIGHT) : 0u;
}

// The sums of a group's tiles: rounded down, and what is left over or too much a heavy tile takes. As know_tiles() in
// point_tiles_kernel.c. before: of the groups before it.
void divide_group(uint place, uint whole, uint before)
{
    const uint first = place * LAYOUT_TILE_GROUP;
    const float weight = weights[groups[place]], least = weight * (0.99 / float(LAYOUT_TILE_GROUP));
    const float per_weight = whole > 0u ? 1.0 / weight : 0.0;
    uint heavy = LAYOUT_TILE_GROUP, sum = 0u, integers[LAYOUT_TILE_GROUP];
    for (uint i = 0u; i < LAYOUT_TILE_GROUP; i++) {
        const float own = weight_at(first + i);
        integers[i] = whole > 0u && own > 0.0 ? max(uint(own * per_weight * float(whole)), 1u) : 0u;
        heavy = heavy == LAYOUT_TILE_GROUP && own >= least ? i : heavy;
        sum += integers[i];
    }
    for (uint i = 0u; i < LAYOUT_TILE_GROUP; i++) {
        sums[slot(first + i)] = before;
        before += integers[i] + (i == heavy ? whole - sum : 0u);
    }
}

// Fills in the sums of the tiles of `count` groups and returns that of all. left: part of the light that is left to BRDF
// samples. brightness: of the rest.
uint weigh_tiles(brdf b, tile_lobe lobe, uint count, out float left, out float brightness)
{
    const uint each = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(each * gl_LocalInvocationID.x, count), end = min(begin + each, count);
    uint largest = 0u, own = 0u, total;
    vec2 light = vec2(0.0); // and what BRDF samples take
    for (uint i = gl_LocalInvocationID.x; i < count * LAYOUT_TILE_GROUP; i += gl_WorkGroupSize.x) {
        const vec2 weight = weigh(b, lobe, position_of(i));
        sums[slot(i)] = floatBitsToUint(weight.x);
        light.y += weight.y;
    }
    barrier();
    for (uint place = begin; place < end; place++) {
        const float weight = sum_group(place);
        weights[groups[place]] = weight;
        light += vec2(weight, kinds[groups[place]] != APART ? takings[groups[place]] : 0.0);
        largest = max(largest, floatBitsToUint(weight));
    }
    light = sum_of_group(vec4(light, 0.0, 0.0)).xy;
    brightness = light.x;
    left = light.y > 0.0 ? light.y / (light.x + light.y) : 0.0;
    const int exponent = fixed_point_exponent(greatest_in_group(largest), summand_bits(GROUPS_MOST));
    const float factor = power_of_two(exponent);
    for (uint place = begin; place < end; place++)
        own += group_integer(place, factor);
    uint before = sum_before_in_group(own, total);
    for (uint place = begin; place < end; place++) {
        const uint whole = group_integer(place, factor);
        divide_group(place, whole, before);
        before += whole;
    }
    if (gl_LocalInvocationID.x == 0u)
        sums[slot(count * LAYOUT_TILE_GROUP)] = total;
    barrier();
    return total;
}

// ---- samples ----

// Sample `index` of those that the tiles get together.
void add_tile_sample(prepared_point p, uint index, uint total, inout vec4 sum, inout vec3 hues)
{
    const uint seed = hash_combine(p.seed, LAYOUT_STREAM_WINDOW);
    uint run;
    tree_sample s = begin_in_run(seed, index, p.end[0], run);
    s = descend(s, LAYOUT_TILE_GROUP, tree_random(seed, TREE_NODE_RUNS + run));
    s = descend(s, 1u, tree_random(seed, TREE_NODE_GROUPS + groups[s.begin / LAYOUT_TILE_GROUP]));
    const uint position = position_of(s.begin), weight = tree_sum(s.end) - tree_sum(s.begin);
    const uint start = STATE.list_starts.at[position], length = STATE.list_starts.at[position + 1u] - start;
    const uint element = 2u * (start + tree_element(s, seed, position, length));
    const vec4 direction = vector_at(STATE.listed, element);
    const float probability = float(weight) / float(total);
    const vec3 light = vector_at(STATE.listed, element + 1u).rgb;
    known_diffuse = knowns[position / LAYOUT_TILE_GROUP] ? 1.0 : 0.0;
    hues += light * (dot(vector_at(STATE.tiles, position).xyz, direction.xyz) / STATE.tile_hues.at[position].w);
    add_light_sample(p, direction.xyz, light / probability, probability * direction.w, p.expected[0], true, sum);
}

float density_of_tiles(prepared_point p, face_place at, uint total)
{
    const uint position = tile_position(at), place = places[position / LAYOUT_TILE_GROUP];
    const uint tile = place * LAYOUT_TILE_GROUP + position % LAYOUT_TILE_GROUP;
    const uint weight = place != NOWHERE ? tree_sum(tile + 1u) - tree_sum(tile) : 0u;
    return weight != 0u ? p.expected[0] * (float(weight) / float(total) * tile_density(at)) : 0.0;
}

// What is known of the hue of light samples, see control_hue() in estimate.c: a thread's part of it. hues: sums over its
// samples.
vec3 control_hue(prepared_point p, uint count, uint total, float brightness, vec3 hues)
{
    if (STEP.control_part == 0.0 || p.end[0] == 0u)
        return vec3(0.0);
    vec3 known = vec3(0.0);
    for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x) {
        const uint weight = tree_sum(i + 1u) - tree_sum(i);
        if (weight != 0u)
            known += float(weight) * vector_at(STATE.tile_hues, position_of(i)).rgb;
    }
    const float share = p.expected[0] / float(STEP.samples);
    const vec3 colour = p.surface.colours[0] + p.surface.colours[1];
    const float bright = brightness * STATE.tile_hues.at[STATE.tile_count].x / luminance(colour);
    const vec3 control = STEP.control_part * share * share * bright * colour *
                         (known / float(total) - hues / float(p.end[0]));
    return any(isnan(control)) || any(isinf(control)) ? vec3(0.0) : control;
}

vec4 light_point(prepared_point p, uint count, uint total, float brightness)
{
    vec4 sum = vec4(0.0);
    vec3 hues = vec3(0.0);
    origin_of_rays = read_origin(group_index());
    for (uint i = gl_LocalInvocationID.x; i < p.end[0]; i += gl_WorkGroupSize.x)
        add_tile_sample(p, i, total, sum, hues);
    for (uint i = gl_LocalInvocationID.x; i < p.surface_count; i += gl_WorkGroupSize.x) {
        const surface_sample drawn = draw_surface_sample(p, i);
        known_diffuse = knowns[tile_position(drawn.at) / LAYOUT_TILE_GROUP] ? 1.0 : 0.0;
        if (drawn.counts)
            add_surface_sample(p, drawn, density_of_tiles(p, drawn.at, total), sum);
    }
    sum.rgb += control_hue(p, count, total, brightness, hues);
    return sum;
}

// Diffuse light of the groups where it is known: a thread's part of it.
vec3 known_light(prepared_point p, tile_lobe lobe)
{
    const uint all = (STATE.tile_count + LAYOUT_TILE_GROUP - 1u) / LAYOUT_TILE_GROUP;
    vec3 irradiance = vec3(0.0);
    for (uint i = gl_LocalInvocationID.x; lobe.knows_diffuse && i < all; i += gl_WorkGroupSize.x)
        for (uint row = 0u; knowns[i] && row < 3u; row++)
            irradiance += vector_at(STATE.groups, LAYOUT_GROUP_ROWS * i + 3u + row).rgb * p.surface.normal[row];
    return irradiance * p.surface.colours[0];
}

// See begin_tiles() in estimate.c.
void divide_samples(float left, inout prepared_point p)
{
    const float samples = float(STEP.samples), need = sqrt(left * need_of_lobe(p.surface));
    p.surface_expected = samples * share_of_need(need);
    p.expected[0] = samples - p.surface_expected;
    p.end[0] = min(uint(p.expected[0] + unit_float(hash_combine(p.seed, LAYOUT_STREAM_ROUNDING))), STEP.samples);
    p.surface_count = STEP.samples - p.end[0];
}

void main()
{
    begin_with_step();
    if (group_index() >= STEP.counts_of_lists.at[0])
        return;
    const shading_point given = read_point(group_index());
    prepared_point p = prepare(given);
    if (!weighs_tiles(p))
        return;
    float left, brightness;
    const tile_lobe lobe = prepare_lobe(p.surface, p.geometric_normal);
    const uint group_count = choose_groups(p.surface, lobe), count = group_count * LAYOUT_TILE_GROUP;
    const uint total = weigh_tiles(p.surface, lobe, group_count, left, brightness);
    divide_samples(left, p);
    p.surface.specular_share = 1.0; // of what the tiles leave over
    const vec4 own = total != 0u ? light_point(p, count, total, brightness) : vec4(0.0);
    const vec4 sum = sum_of_group(own + vec4(known_light(p, lobe), 0.0));
    if (gl_LocalInvocationID.x != 0u)
        return;
    film_add(given.pixel, sum.rgb * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    if (total != 0u)
        count_up(p.end[0] + p.surface_count, uint(sum.w + 0.5));
}
