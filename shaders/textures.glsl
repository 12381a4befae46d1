// SPDX-License-Identifier: MIT
// textures.glsl - colours of textures: as src/scene/texture.c. Needs common.glsl and a scene whose mesh has some.

// The place in 0..1 that shows what is seen at x.
float folded(float x, uint wrap)
{
    if (wrap == LAYOUT_WRAP_CLAMP)
        return clamp(x, 0.0, 1.0);
    if (wrap == LAYOUT_WRAP_REPEAT)
        return x - floor(x);
    const float in_pair = x - 2.0 * floor(0.5 * x);
    return in_pair > 1.0 ? 2.0 - in_pair : in_pair;
}

// The two texels of a row or column around a place, and how much the second one weighs.
struct texel_pair {
    uint first, second;
    float weight;
};

texel_pair find_texels(float x, uint count, uint wrap)
{
    const float place = folded(x, wrap) * float(count) - 0.5, below = floor(place); // -0.5 ... count - 0.5
    const bool repeats = wrap == LAYOUT_WRAP_REPEAT;
    const int last = int(count) - 1, first = min(int(below), last);
    const int before = first >= 0 ? first : repeats ? last : 0, behind = first < last ? first + 1 : repeats ? 0 : last;
    return texel_pair(uint(before), uint(max(behind, 0)), place - below);
}

vec3 texture_texel(uint index, uint curve)
{
    const uint bits = TEXTURES.texels.at[index];
    return vec3(TEXTURES.curves.at[curve + (bits & 255u)], TEXTURES.curves.at[curve + (bits >> 8 & 255u)],
                TEXTURES.curves.at[curve + (bits >> 16 & 255u)]);
}

// number: from 1, as materials have it; curve: LAYOUT_CURVE_...
vec3 texture_lookup(uint number, uint curve, vec2 at)
{
    const layout_texture shape = TEXTURES.shapes.at[max(number, 1u) - 1u];
    const texel_pair x = find_texels(at.x, shape.width, shape.wraps & 3u);
    const texel_pair y = find_texels(at.y, shape.height, shape.wraps >> 2);
    const uint upper = shape.first + y.first * shape.width, lower = shape.first + y.second * shape.width;
    const vec3 top = (1.0 - x.weight) * texture_texel(upper + x.first, curve) +
                     x.weight * texture_texel(upper + x.second, curve);
    const vec3 bottom = (1.0 - x.weight) * texture_texel(lower + x.first, curve) +
                        x.weight * texture_texel(lower + x.second, curve);
    return (1.0 - y.weight) * top + y.weight * bottom;
}

vec2 texture_coordinates(uint triangle, vec3 weights)
{
    vec2 at = vec2(0.0);
    for (uint i = 0u; i < 3u; i++)
        at += weights[i] * vec2(TEXTURES.coordinates.at[6u * triangle + 2u * i],
                                TEXTURES.coordinates.at[6u * triangle + 2u * i + 1u]);
    return at;
}
