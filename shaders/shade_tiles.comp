#version 460
// SPDX-License-Identifier: MIT
//
// The light that leaves points that shine, where pools are of bins: a work group weighs the tiles of the map by light x
// BRDF x cosine for one point, and takes samples from the lists of these tiles, and of the specular lobe. As
// src/sampling/point_tiles_kernel.c. Points that do not shine are left to shade.comp.
#include "common.glsl"

layout(constant_id = 1) const uint KINDS = 7u; // of materials, as bits
layout(constant_id = 2) const uint VISIBILITY = 1u;
const uint LIGHT = LAYOUT_LIGHT_BINS, SURFACE = LAYOUT_SURFACE_BRDF;

#include "random.glsl"
#include "cube.glsl"
#include "elementary.glsl"
#include "fixed_point.glsl"
#include "scan.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "brdf.glsl"
#include "point.glsl"
#include "film.glsl"
#include "rays.glsl"
#include "samples.glsl"

shared uint sums[LAYOUT_TILES_MOST + 1]; // before each tile; at first the bits of the weights
shared vec4 parts[SCAN_MOST];

// See tile_lobe in point_tiles.h.
struct tile_lobe {
    float diffuse, specular, sharpness, narrowness, alpha;
};

tile_lobe prepare_lobe(brdf b)
{
    const float rest = 1.0 - narrowness(b), edge2 = STATE.tile_edge * STATE.tile_edge;
    tile_lobe lobe = tile_lobe(luminance(b.colours[0]), luminance(b.colours[1]), 0.0, 0.0, 0.0);
    if (is_ggx(b.kind)) {
        const float widened = b.shape + edge2;
        lobe.alpha = sqrt(b.shape);
        lobe.narrowness = 1.0 - min(widened, 0.999);
        lobe.specular += luminance(b.colours[2]) * schlick_weight(b.view_cosine);
        lobe.specular *= widened * INVERSE_PI;
    } else {
        const float widened = 1.0 / (1.0 / max(b.shape, 1e-3) + 0.3 * edge2);
        lobe.sharpness = 1.44269504 * widened;
        lobe.specular *= (widened + 2.0) / (b.shape + 2.0);
    }
    lobe.specular *= rest;
    return lobe;
}

// BRDF x cosine for the centre of a tile.
float lobe_value(brdf b, tile_lobe lobe, vec3 direction)
{
    const float cosine = dot(b.normal, direction), edge = STATE.tile_edge, risen = max(cosine + edge, 0.0);
    const float soft = cosine < edge ? risen * risen / (4.0 * edge) : cosine, along = dot(b.view, direction);
    if (!is_ggx(b.kind))
        return soft * (lobe.diffuse + lobe.specular * exp2_fast(lobe.sharpness * (along - 1.0)));
    const float height = b.view_cosine + cosine, twice = 2.0 + 2.0 * along;
    const float safe = max(twice - lobe.narrowness * (height * height), 1e-6);
    const float masking = soft * (2.0 - lobe.alpha) + lobe.alpha;
    return soft * (lobe.diffuse + lobe.specular * (twice * twice) / (safe * safe * masking));
}

float weigh(brdf b, tile_lobe lobe, uint position)
{
    const vec4 tile = STATE.tiles.at[position];
    if (tile.w == 0.0 || dot(b.normal, tile.xyz) <= -STATE.tile_edge)
        return 0.0;
    return tile.w * lobe_value(b, lobe, tile.xyz);
}

// Fills in the sums and returns that of all tiles.
uint weigh_tiles(brdf b)
{
    const tile_lobe lobe = prepare_lobe(b);
    const uint count = STATE.tile_count, each = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(each * gl_LocalInvocationID.x, count), end = min(begin + each, count);
    uint largest = 0u, own = 0u, total;
    for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x) {
        const uint bits = floatBitsToUint(weigh(b, lobe, i));
        sums[i] = bits;
        largest = max(largest, bits);
    }
    const float factor = power_of_two(fixed_point_exponent(greatest_in_group(largest), summand_bits(count)));
    for (uint i = begin; i < end; i++)
        own += fixed_point_integer(uintBitsToFloat(sums[i]), factor);
    uint before = sum_before_in_group(own, total);
    for (uint i = begin; i < end; i++) {
        const uint weight = fixed_point_integer(uintBitsToFloat(sums[i]), factor);
        sums[i] = before;
        before += weight;
    }
    if (gl_LocalInvocationID.x == 0u)
        sums[count] = total;
    barrier();
    return total;
}

// ---- samples ----

uint64_t part_of(uint64_t x, uint fraction)
{
    return (x >> 32) * fraction + (((x & 0xffffffffUL) * fraction) >> 32);
}

uint find_tile(uint whole)
{
    uint low = 0u, high = STATE.tile_count;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (sums[middle] <= whole)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Sample i of all that the tiles give to the point: places at equal steps through the sums, from a random start. What is
// left of a place in its tile counts through the tile's list.
void add_tile_sample(prepared_point p, uint i, uint total, inout vec4 sum)
{
    const uint64_t stride = (uint64_t(total) << 20) / p.end[0];
    const uint64_t place = i * stride + part_of(stride, hash_combine(p.seed, LAYOUT_STREAM_WINDOW));
    const uint position = find_tile(uint(place >> 20)), weight = sums[position + 1u] - sums[position];
    const uint start = STATE.list_starts.at[position], length = STATE.list_starts.at[position + 1u] - start;
    const double rest = double(place - (uint64_t(sums[position]) << 20));
    const uint element = uint(rest * double(length) / (double(weight) * 1048576.0LF));
    const uint index = 2u * (start + min(element, length - 1u));
    const vec4 direction = STATE.listed.at[index];
    const float probability = float(weight) / float(total);
    const vec3 light = STATE.listed.at[index + 1u].rgb / probability;
    add_light_sample(p, direction.xyz, light, probability * direction.w, p.expected[0], true, sum);
}

float density_of_tiles(prepared_point p, face_place at, uint total)
{
    const uint position = tile_position(at), weight = sums[position + 1u] - sums[position];
    return weight != 0u ? p.expected[0] * (float(weight) / float(total) * tile_density(at)) : 0.0;
}

vec4 light_point(prepared_point p, uint total)
{
    vec4 sum = vec4(0.0);
    origin_of_rays = read_origin(group_index());
    for (uint i = gl_LocalInvocationID.x; i < p.end[0]; i += gl_WorkGroupSize.x)
        add_tile_sample(p, i, total, sum);
    for (uint i = gl_LocalInvocationID.x; i < p.surface_count; i += gl_WorkGroupSize.x) {
        const surface_sample drawn = draw_surface_sample(p, i);
        if (drawn.counts)
            add_surface_sample(p, drawn, density_of_tiles(p, drawn.at, total), sum);
    }
    return sum;
}

void main()
{
    begin_with_step();
    if (group_index() >= STEP.point_count)
        return;
    const shading_point given = read_point(group_index());
    prepared_point p = prepare(given);
    if (!weighs_tiles(p))
        return;
    const uint total = weigh_tiles(p.surface), thread = gl_LocalInvocationID.x;
    p.surface.specular_share = 1.0; // of what the tiles leave over
    parts[thread] = total != 0u ? light_point(p, total) : vec4(0.0);
    barrier();
    if (thread != 0u)
        return;
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < gl_WorkGroupSize.x; i++)
        sum += parts[i];
    film_add(given.pixel, sum.rgb * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    if (total != 0u)
        count_up(p.end[0] + p.surface_count, uint(sum.w + 0.5));
}
