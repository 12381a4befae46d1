/* SPDX-License-Identifier: MIT */
#include "eval/comparison.h"

#include "core/error.h"
#include "core/vector.h"

#include <math.h>
#include <string.h>

static const double SHOWN = 0.8, SHARE = 0.95; /* of the lit pixels, which are shown no brighter than that */

enum { DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS };

/* The bits of the pixel's luminance, which have the order of the numbers. 0: none that is positive and finite. */
static uint32_t luminance_bits(const helio_comparison_pair *pair, size_t pixel)
{
    uint32_t channels = pair->reference_channels != 0 ? pair->reference_channels : 3, bits;
    float light = luminance(pair->reference + pixel * channels);
    if ((pair->mask != NULL && !(pair->mask[pixel] >= 0.5f)) || !(light > 0 && light <= 1e30f))
        return 0;
    memcpy(&bits, &light, sizeof bits);
    return bits;
}

/* How many of the numbers that begin with the bits of prefix, those above shift + DIGIT_BITS, have which digit next. */
static void count_digits(const helio_comparison_pair *pair, size_t pixels, uint32_t prefix, unsigned shift,
                         uint64_t counts[DIGITS])
{
    memset(counts, 0, DIGITS * sizeof counts[0]);
    for (size_t i = 0; i < pixels; i++) {
        uint64_t bits = luminance_bits(pair, i);
        if (bits != 0 && bits >> (shift + DIGIT_BITS) == (uint64_t)prefix >> (shift + DIGIT_BITS))
            counts[bits >> shift & (DIGITS - 1)]++;
    }
}

/* The number of that rank, from 1, among those that are not 0: digit by digit, which takes no memory. */
static uint32_t find_ranked(const helio_comparison_pair *pair, size_t pixels, uint64_t rank)
{
    uint64_t counts[DIGITS];
    uint32_t prefix = 0;
    for (int shift = 32 - DIGIT_BITS; shift >= 0; shift -= DIGIT_BITS) {
        uint32_t digit = 0;
        count_digits(pair, pixels, prefix, (unsigned)shift, counts);
        while (counts[digit] < rank)
            rank -= counts[digit++];
        prefix |= digit << shift;
    }
    return prefix;
}

helio_status helio_comparison_auto_exposure(const helio_comparison *comparison, const helio_comparison_pair *pair,
                                            float *exposure)
{
    if (comparison == NULL || pair == NULL || exposure == NULL || pair->reference == NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_comparison_auto_exposure needs a comparison, a reference and a place for the exposure");
    size_t pixels = (size_t)comparison->width * comparison->height;
    uint64_t lit = 0;
    for (size_t i = 0; i < pixels; i++)
        lit += luminance_bits(pair, i) != 0;
    *exposure = 0;
    if (lit == 0)
        return HELIO_OK;
    uint32_t bits = find_ranked(pair, pixels, (uint64_t)ceil(SHARE * (double)lit));
    float light;
    memcpy(&light, &bits, sizeof light);
    *exposure = (float)fmin(fmax(log2(SHOWN / (double)light), -100), 100);
    return HELIO_OK;
}
