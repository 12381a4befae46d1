// SPDX-License-Identifier: MIT
// tables.glsl - drawing from prefix sums, and the densities of what is drawn: as tables.h and tables.c, in integers up to
// the place in a texel. Needs common.glsl and random.glsl.

// Where x, a fraction of 2^32 of a sum of `total`, lies inside of the cell that begins at `start` and has `weight`.
uint fraction_within(uint x, uint total, uint start, uint weight)
{
    const uint64_t target = uint64_t(x) * total; // in units of 2^-32
    return uint((target - (uint64_t(start) << 32)) / weight);
}

uint multiply_high(uint a, uint b)
{
    uint high, low;
    umulExtended(a, b, high, low);
    return high;
}

// The cell of prefix sums first ... first + count, which may be a piece of longer ones, that holds a fraction of 2^32.
// The fraction becomes that inside of the cell. The total must not be 0.
uint invert(uints sums, uint first, uint count, inout uint fraction)
{
    const uint base = sums.at[first], total = sums.at[first + count] - base;
    const uint whole = base + multiply_high(fraction, total);
    uint low = 0u, high = count;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (sums.at[first + middle] <= whole)
            low = middle;
        else
            high = middle;
    }
    const uint start = sums.at[first + low];
    fraction = fraction_within(fraction, total, start - base, sums.at[first + low + 1u] - start);
    return low;
}

// The same among the faces.
uint invert_faces(inout uint fraction)
{
    const uint total = STATE.sums.all.faces[LAYOUT_FACES], whole = multiply_high(fraction, total);
    uint face = 0u;
    for (uint i = 1u; i < LAYOUT_FACES; i++)
        face = STATE.sums.all.faces[i] <= whole ? i : face;
    const uint start = STATE.sums.all.faces[face];
    fraction = fraction_within(fraction, total, start, STATE.sums.all.faces[face + 1u] - start);
    return face;
}

// A place in a texel.
struct face_place {
    uint face, row, column;
    float u, v;
};

face_place place_in_texel(uint face, uint row, uint row_fraction, uint column, uint column_fraction)
{
    const float size = float(STATE.size);
    precise float u = (float(2u * column) + 2.0 * unit_float(column_fraction)) / size - 1.0;
    precise float v = (float(2u * row) + 2.0 * unit_float(row_fraction)) / size - 1.0;
    return face_place(face, row, column, u, v);
}

float projection(float u, float v)
{
    const float radius2 = 1.0 + u * u + v * v;
    return radius2 * sqrt(radius2);
}

uint texel_weight(face_place at)
{
    const uint first = (at.face * STATE.size + at.row) * (STATE.size + 1u) + at.column;
    return STATE.rows.at[first + 1u] - STATE.rows.at[first];
}

// Density, 1/sr, of a direction given its face.
float face_density(face_place at)
{
    return float(texel_weight(at)) * STATE.row_densities.at[at.face * STATE.size + at.row] * projection(at.u, at.v);
}

// Probability that the strategy of one pool for the whole map gives to a face.
float face_probability(uint face)
{
    const uint total = STATE.sums.all.faces[LAYOUT_FACES];
    const uint weight = STATE.sums.all.faces[face + 1u] - STATE.sums.all.faces[face];
    return total != 0u ? float(weight) / float(total) : 0.0;
}
