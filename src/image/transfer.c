/* SPDX-License-Identifier: MIT */
#include "image/transfer.h"

#include "core/error.h"
#include "core/name_list.h"
#include "image/colour.h"

#include <math.h>

static const char *const NAMES[] = {"auto", "sdr", "srgb", "pq", "hlg", "linear"};
static const name_list TRANSFERS = NAME_LIST("transfer", NAMES);

const char *helio_transfer_name(helio_transfer transfer)
{
    return name_list_get(&TRANSFERS, (int)transfer);
}

helio_status helio_transfer_parse(const char *name, helio_transfer *transfer)
{
    int value;
    HELIO_TRY(name_list_find(&TRANSFERS, transfer ? name : NULL, &value));
    *transfer = (helio_transfer)value;
    return HELIO_OK;
}

/* BT.2100, table 4 (SMPTE ST 2084). Light is in units of 10000 cd/m^2. */
static const double PQ_M1 = 2610.0 / 16384, PQ_M2 = 2523.0 / 4096 * 128;
static const double PQ_C1 = 3424.0 / 4096, PQ_C2 = 2413.0 / 4096 * 32, PQ_C3 = 2392.0 / 4096 * 32;
static const double PQ_PEAK = 10000.0 / 203; /* BT.2408: 203 cd/m^2 is HDR reference white */

static double pq_decode(double signal)
{
    double power = pow(fmin(signal, 1), 1 / PQ_M2);
    return PQ_PEAK * pow(fmax(power - PQ_C1, 0) / (PQ_C2 - PQ_C3 * power), 1 / PQ_M1);
}

static double pq_encode(double light)
{
    double power = pow(fmin(light / PQ_PEAK, 1), PQ_M1);
    return pow((PQ_C1 + PQ_C2 * power) / (1 + PQ_C3 * power), PQ_M2);
}

/* BT.2100, table 5. */
static const double HLG_A = 0.17883277, HLG_B = 0.28466892, HLG_C = 0.55991073;
static const double HLG_GREATEST = 955.0 / 876; /* the largest code of a narrow-range signal, 109 % */

static double hlg_inverse_oetf(double signal)
{
    return signal <= 0.5 ? signal * signal / 3 : (exp((signal - HLG_C) / HLG_A) + HLG_B) / 12;
}

static double hlg_decode(double signal)
{
    return hlg_inverse_oetf(fmin(signal, HLG_GREATEST)) / hlg_inverse_oetf(0.75);
}

static double hlg_encode(double light)
{
    double scene = light * hlg_inverse_oetf(0.75);
    return fmin(scene <= 1.0 / 12 ? sqrt(3 * scene) : HLG_A * log(12 * scene - HLG_B) + HLG_C, HLG_GREATEST);
}

double transfer_decode(helio_transfer transfer, double signal)
{
    if (transfer == HELIO_TRANSFER_LINEAR || isnan(signal))
        return signal;
    if (signal <= 0)
        return 0;
    switch (transfer) {
    case HELIO_TRANSFER_SRGB: return srgb_to_linear(signal);
    case HELIO_TRANSFER_PQ: return pq_decode(signal);
    case HELIO_TRANSFER_HLG: return hlg_decode(signal);
    default: return pow(signal, 2.4); /* BT.1886 with a black of 0 */
    }
}

double transfer_encode(helio_transfer transfer, double light)
{
    if (transfer == HELIO_TRANSFER_LINEAR)
        return light;
    if (!(light > 0))
        return transfer == HELIO_TRANSFER_PQ ? pq_encode(0) : 0;
    switch (transfer) {
    case HELIO_TRANSFER_SRGB: return light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
    case HELIO_TRANSFER_PQ: return pq_encode(light);
    case HELIO_TRANSFER_HLG: return hlg_encode(light);
    default: return pow(light, 1 / 2.4);
    }
}

void transfer_table_fill(transfer_table *table, helio_transfer transfer)
{
    table->transfer = transfer;
    for (int i = 0; i <= TRANSFER_ENTRIES; i++)
        table->light[i] = (float)transfer_decode(transfer, (double)i / TRANSFER_STEPS);
}

void transfer_encoder_fill(transfer_encoder *encoder, helio_transfer transfer)
{
    double peak = transfer_decode(transfer, 1);
    encoder->share = (float)(1 / peak);
    for (int i = 0; i <= TRANSFER_OCTAVES * TRANSFER_OCTAVE_STEPS; i++) {
        double mantissa = 1 + (double)(i % TRANSFER_OCTAVE_STEPS) / TRANSFER_OCTAVE_STEPS;
        double light = ldexp(mantissa, i / TRANSFER_OCTAVE_STEPS - TRANSFER_OCTAVES);
        encoder->signal[i] = (float)transfer_encode(transfer, light * peak);
    }
}
