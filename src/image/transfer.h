/* SPDX-License-Identifier: MIT
 * transfer.h - what the code values of video stand for: curves, matrices and ranges. docs/video.md has the formulas. */
#ifndef HELIOSTAT_SRC_IMAGE_TRANSFER_H
#define HELIOSTAT_SRC_IMAGE_TRANSFER_H

#include <heliostat/video.h>

#include <string.h>

/* Linear light of a signal, 1 = white as helio_transfer says. A signal below 0 is 0, except where it is linear. */
double transfer_decode(helio_transfer transfer, double signal);

/* The signal of linear light: the inverse of the above, for light that the signal can carry. */
double transfer_encode(helio_transfer transfer, double light);

/* transfer_decode() for many pixels: linear between so many entries for each 1 of the signal, within 1e-5 of the light
 * or 1e-7. No integer code is beyond the last: the largest blue of BT.2020's narrow range is 2.16. */
enum { TRANSFER_STEPS = 1 << 16, TRANSFER_ENTRIES = 9 * TRANSFER_STEPS / 4 };

typedef struct transfer_table {
    helio_transfer transfer;
    float light[TRANSFER_ENTRIES + 1];
} transfer_table;

void transfer_table_fill(transfer_table *table, helio_transfer transfer);

static inline float transfer_look_up(const transfer_table *table, float signal)
{
    if (table->transfer == HELIO_TRANSFER_LINEAR)
        return signal;
    float position = signal * TRANSFER_STEPS;
    if (!(position < TRANSFER_ENTRIES))
        return (float)transfer_decode(table->transfer, (double)signal);
    if (position <= 0)
        return 0;
    int i = (int)position;
    return table->light[i] + (position - (float)i) * (table->light[i + 1] - table->light[i]);
}

/* transfer_encode() for many pixels, for SRGB and PQ. Linear between entries that have equal ratios, as bits of floats
 * have; the error is under a hundredth of a step of 12 bits. */
enum { TRANSFER_OCTAVES = 32, TRANSFER_STEP_BITS = 15, TRANSFER_OCTAVE_STEPS = 1 << (23 - TRANSFER_STEP_BITS) };

typedef struct transfer_encoder {
    float share; /* 1 / the light of the signal 1 */
    float signal[TRANSFER_OCTAVES * TRANSFER_OCTAVE_STEPS + 1];
} transfer_encoder;

void transfer_encoder_fill(transfer_encoder *encoder, helio_transfer transfer);

/* light: any number; what is not positive gives 0, what is beyond the peak 1. */
static inline float transfer_encoder_look_up(const transfer_encoder *encoder, float light)
{
    const uint32_t least_bits = (127 - TRANSFER_OCTAVES) << 23; /* of 2^-TRANSFER_OCTAVES */
    float share = light * encoder->share;
    if (!(share >= 0x1p-32f))
        return share > 0 ? encoder->signal[0] * (share * 0x1p32f) : 0;
    if (share >= 1)
        return 1;
    uint32_t bits;
    memcpy(&bits, &share, sizeof bits);
    bits -= least_bits;
    const float *entry = encoder->signal + (bits >> TRANSFER_STEP_BITS);
    float part = (float)(int)(bits & ((1u << TRANSFER_STEP_BITS) - 1)) * (1.0f / (1 << TRANSFER_STEP_BITS));
    return entry[0] + part * (entry[1] - entry[0]);
}

#endif
