// SPDX-License-Identifier: MIT
// lobe_variance.glsl - how uneven the light in a specular lobe is: as lobe_variance.h.

const float LOBE_POOL_PART = 1.0 / float(RULE_LOBE_SAMPLES_PER_POOL);

// GGX's alpha^2 of the lobes of a class, widened by a tile, in relation to the square of tile_edge.
float lobe_class_width(uint class_of_lobe)
{
    return float(1u << class_of_lobe);
}

float lobe_class_most(uint class_of_lobe, bool is_free)
{
    precise float most = class_of_lobe == 0u ? RULE_LOBE_MOST_0 : class_of_lobe == 1u ? RULE_LOBE_MOST_1 : RULE_LOBE_MOST_2;
    precise float less = RULE_LOBE_WITH_RAYS * most;
    return is_free ? most : less;
}

// Of lobes that shine alone. alpha2: GGX's alpha^2, or 1 / exponent.
uint lobe_class(float alpha2)
{
    precise float width = alpha2 / (STATE.tile_edge * STATE.tile_edge) + 1.0;
    return (width >= RULE_LOBE_WIDTH_0 ? 1u : 0u) + (width >= RULE_LOBE_WIDTH_1 ? 1u : 0u) +
           (width >= RULE_LOBE_WIDTH_2 ? 1u : 0u);
}

// tiles.peak. light: of the tile.
float tile_peak(float light, uint position)
{
    const float part = STATE.tile_spreads.at[position] / STATE.tile_radius;
    return light > 0.0 ? light / (STATE.tile_angles.at[position] * (part * part)) : 0.0;
}
