/* SPDX-License-Identifier: MIT
 *
 * Pools of bins: samples of the lists of tiles, as a bin weighs these, and what they stand for in the control variate.
 */
#include "sampling/kernels.h"
#include "sampling/tile_levels.h"

#include <float.h>
#include <string.h>

_Static_assert((int)POOL_RUN_MOST <= (int)TILE_SAMPLES_MOST, "a run is shared out at once");

/* Samples of the pool of a bin that are drawn together, in the order in which they are stored. */
typedef struct bin_samples {
    alignas(64) uint32_t positions[POOL_RUN_MOST], elements[POOL_RUN_MOST];
    alignas(64) float probabilities[POOL_RUN_MOST], scales[POOL_RUN_MOST]; /* of the tile given the bin; 1 / that */
    alignas(64) float slopes[POOL_RUN_MOST], offsets[POOL_RUN_MOST];       /* see control_line */
    alignas(64) float arrays[POOL_ARRAYS][POOL_RUN_MOST];                  /* what the pool holds in the end */
} bin_samples;

/* Samples of a run lie in the order of their numbers with the bits reversed, and some of them flipped at random: so
 * each aligned window of a power of two has one of each of that many parts of the run, and any place holds each of the
 * samples with the same probability. */
static void order_run(const tile_samples *drawn, uint32_t *restrict positions, uint32_t *restrict elements)
{
    alignas(64) uint32_t numbers[POOL_RUN_MOST];
    const uint32_t flipped = tile_tree_random(drawn->seed, TILE_TREE_ORDER), run = drawn->count;
    const int unused = __builtin_clz(run) + 1; /* bits: runs are powers of two */
#pragma omp simd
    for (uint32_t i = 0; i < run; i++)
        numbers[i] = (reverse_bits(i) ^ flipped) >> unused;
    for (uint32_t i = 0; i < run; i++) {
        positions[i] = drawn->nodes[numbers[i]];
        elements[i] = drawn->places[numbers[i]];
    }
}

static void weigh_samples(const normal_bins *bins, uint32_t bin, const uint32_t *restrict sums, uint32_t count,
                          bin_samples *restrict samples)
{
    const tiles *restrict t = bins->tiles;
    const normal_bin b = bins->bins[bin];
    const float share = bins->shares[bin];
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t tile = samples->positions[i];
        const float cosine = b.centre.x * t->x[tile] + b.centre.y * t->y[tile] + b.centre.z * t->z[tile];
        const control_line line = control_line_of(&b, cosine);
        samples->slopes[i] = line.slope;
        samples->offsets[i] = line.offset;
        samples->probabilities[i] = normal_bins_probability_by(sums, tile, share);
        samples->scales[i] = 1.0f / samples->probabilities[i];
    }
}

/* What a sample is worth given the bin: weighted is finite here too. */
static inline void scale_light(const listed_sample *restrict sample, float scale, float *restrict light)
{
#pragma omp simd
    for (int c = 0; c < 4; c++) {
        const float product = sample->weighted[c] * scale;
        light[c] = product < FLT_MAX ? product : FLT_MAX;
    }
}

/* Adds what a sample stands for, see control.h. */
static inline void add_known(const listed_sample *sample, float slope, float offset, const float *restrict light,
                             control_matrix *restrict sum)
{
    const float line[4] = {slope, slope, slope, offset};
    float factors[4];
#pragma omp simd
    for (int row = 0; row < 4; row++)
        factors[row] = line[row] * sample->direction[row];
    for (int row = 0; row < 4; row++)
#pragma omp simd
        for (int c = 0; c < 4; c++)
            sum->rows[row][c] += factors[row] * light[c];
}

/* Takes the samples of a chunk from their lists, and finds the sums up to its end. */
static inline void take_chunk(const listed_sample *listed, uint32_t first, bin_samples *samples,
                              const control_matrix *before, control_matrix *after)
{
    control_matrix sum = {{{0}}};
    for (uint32_t i = first; i < first + CONTROL_CHUNK; i++) {
        const listed_sample *sample = &listed[samples->elements[i]];
        float light[4];
        scale_light(sample, samples->scales[i], light);
        for (int c = 0; c < 3; c++) {
            samples->arrays[SAMPLE_X + c][i] = sample->direction[c];
            samples->arrays[SAMPLE_RED + c][i] = sample->radiance[c];
            samples->arrays[SAMPLE_WEIGHTED_RED + c][i] = light[c];
        }
        samples->arrays[SAMPLE_DENSITY][i] = samples->probabilities[i] * sample->density;
        add_known(sample, samples->slopes[i], samples->offsets[i], light, &sum);
    }
    for (int row = 0; row < 4; row++)
        for (int c = 0; c < 4; c++)
            after->rows[row][c] = sum.rows[row][c] + before->rows[row][c];
}

/* Whole runs, as many as fit. */
static void draw_runs(helio_pools *pools, uint32_t bin, const tile_levels *levels, uint32_t first, uint32_t count,
                      uint32_t seed, tile_samples *drawn)
{
    const normal_bins *bins = pools->bins;
    const uint32_t run = pools_run_of_bin(pools);
    control_matrix *control = control_sums(pools->control, bin) + first / CONTROL_CHUNK;
    bin_samples samples;
    for (uint32_t done = 0; done < count; done += run) {
        tile_levels_draw(levels, bins->list_starts, run, hash_combine(seed, (first + done) / run), drawn);
        for (uint32_t i = 0; i < run; i++)
            __builtin_prefetch(&bins->listed[drawn->places[i]]);
        order_run(drawn, samples.positions + done, samples.elements + done);
    }
    weigh_samples(bins, bin, levels->tiles, count, &samples);
    for (uint32_t i = 0; i < count; i += CONTROL_CHUNK, control++)
        take_chunk(bins->listed, i, &samples, control, control + 1);
    for (int array = 0; array < POOL_ARRAYS; array++)
        memcpy(pools_array(pools, bin, (enum sample_array)array) + first, samples.arrays[array], count * sizeof(float));
}

void KERNEL(draw_bin)(helio_pools *pools, uint32_t bin, uint32_t seed)
{
    const uint32_t length = pools->pool_length, most = length < POOL_RUN_MOST ? length : POOL_RUN_MOST;
    tile_levels levels;
    tile_samples drawn = {0};
    tile_levels_make(normal_bins_sums(pools->bins, bin), pools->bins->tiles->count, &levels);
    for (uint32_t first = 0; first < length; first += most)
        draw_runs(pools, bin, &levels, first, most, seed, &drawn);
}
