// SPDX-License-Identifier: MIT
// fixed_point.glsl - weights as integers, as src/sampling/fixed_point.h and tables.c have them: the same bits on every
// device. Powers of two are made from bits, and `precise` keeps multiplications and additions apart.

// A row holds integers below 2^bits; their sum, rounding included, stays below 2^32.
int summand_bits(uint count)
{
    return count > 1u ? 30 - findMSB(count - 1u) : 31;
}

// 2^exponent, -126 to 127.
float power_of_two(int exponent)
{
    return uintBitsToFloat(uint(exponent + 127) << 23);
}

// x 2^exponent. In two steps, of which only the last may leave the range of normal floats.
float scaled(float x, int exponent)
{
    const int first = exponent >> 1;
    precise float result = x * power_of_two(first) * power_of_two(exponent - first);
    return result;
}

// The exponent e for which the largest weight x 2^e is below 2^bits, and nearly reaches it; weights are 0 or normal.
int fixed_point_exponent(uint largest_bits, int bits)
{
    int exponent = largest_bits != 0u ? int(largest_bits >> 23) - 126 : 0; // frexp's: the largest is below 2^this
    return min(bits - exponent, 126);
}

// Rounded, and at least 1 for a weight above 0.
uint fixed_point_integer(float weight, float factor)
{
    precise float scaled = weight * factor + 0.5;
    uint integer = uint(scaled), least = weight > 0.0 ? 1u : 0u;
    return max(integer, least);
}

// Position of the highest bit of sum x 2^-exponent; INT_MIN where it is 0.
int top_bit(layout_row_sum row)
{
    return row.sum != 0u ? findMSB(row.sum) - row.exponent : int(0x80000000u);
}

// The exponent for which sums of which the greatest has this highest bit are below 2^bits.
int common_exponent(int highest, int bits)
{
    return highest == int(0x80000000u) ? 0 : bits - 1 - highest;
}

// sum x 2^-exponent x 2^to, rounded to the nearest integer, at least 1 unless the sum is 0.
uint rescale(layout_row_sum row, int to)
{
    int shift = row.exponent - to; // to the right
    if (row.sum == 0u)
        return 0u;
    if (shift <= 0)
        return row.sum << -shift;
    if (shift > 32)
        return 1u;
    uint64_t rounded = (uint64_t(row.sum) + (uint64_t(1) << (shift - 1))) >> shift;
    return max(uint(rounded), 1u);
}

// sum x 2^-exponent x factor x 2^to. Of the sum 24 bits, so that it need not be rounded.
float scale_sum(layout_row_sum row, float factor, int to)
{
    const int cut = max(findMSB(row.sum) - 23, 0);
    precise float result = float(row.sum >> cut) * factor;
    return scaled(result, cut - row.exponent + to);
}
