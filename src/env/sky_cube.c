/* SPDX-License-Identifier: MIT
 *
 * Radiance at the centres of texels, or averaged over several places in each where texels are large. */
#include "env/sky_cube.h"

#include "core/context.h"
#include "env/sky_row.h"
#include "sampling/kernels.h"

#include <string.h>

const uint32_t sky_side_faces[SKY_SIDE_FACES] = {0, 1, 4, 5};

/* Texels of smaller cubes, which hide much of the sky, are averages over places at least this dense. */
enum { LEAST_SAMPLES = 128 };

typedef struct sky_frame {
    const kernel_set *kernels;
    helio_environment *environment;
    uint32_t samples; /* along an edge of a texel */
    sky_light light;
    float ground[3]; /* radiance */
} sky_frame;

/* The horizon must run between samples, so odd sizes need an even number of them. */
uint32_t sky_cube_samples(uint32_t size)
{
    return size >= LEAST_SAMPLES && size % 2 == 0 ? 1 : 2 * ((LEAST_SAMPLES / 2 + size - 1) / size);
}

/* One texel, then two like it, then four: copies of whole blocks are fastest. */
static void fill_ground(const sky_frame *frame, uint32_t face, uint32_t row)
{
    size_t size = frame->environment->size;
    float *rgb = frame->environment->cube + (face * size + row) * size * 3;
    memcpy(rgb, frame->ground, sizeof frame->ground);
    for (size_t done = 1; done < size; done *= 2)
        memcpy(rgb + 3 * done, rgb, (done < size - done ? done : size - done) * sizeof frame->ground);
}

/* Where the texels of a row begin, on the top face or on all side faces. */
static void find_row(const sky_frame *frame, bool is_top, uint32_t row, uint32_t column, float *rgb[SKY_SIDE_FACES])
{
    size_t size = frame->environment->size;
    for (int i = 0; i < SKY_SIDE_FACES; i++) {
        size_t face = is_top ? SKY_TOP_FACE : sky_side_faces[i];
        rgb[i] = frame->environment->cube + ((face * size + row) * size + column) * 3;
    }
}

/* One sample in the middle of each texel. */
static void fill_row(const sky_frame *frame, bool is_top, uint32_t row)
{
    uint32_t size = frame->environment->size;
    float v = (float)(2 * row + 1) / (float)size - 1.0f, *rgb[SKY_SIDE_FACES];
    for (uint32_t first = 0; first < size; first += SKY_ROW_PIECE) {
        uint32_t count = size - first < SKY_ROW_PIECE ? size - first : SKY_ROW_PIECE;
        find_row(frame, is_top, row, first, rgb);
        frame->kernels->fill_sky(&frame->light, &(sky_row){size, first, count, v, is_top}, rgb);
    }
}

/* Sums over the samples of some texels in a row. */
typedef struct sample_sums {
    uint32_t first, columns, samples; /* samples: along an edge of each */
    double weights[SKY_ROW_PIECE], values[SKY_SIDE_FACES][SKY_ROW_PIECE][3];
} sample_sums;

/* Adds a row of samples, each with its solid angle. stride: 0 where all are the same. */
static void add_samples(sample_sums *sums, uint32_t face_count, float *const *rgb, size_t stride, const sky_row *row)
{
    for (uint32_t i = 0; i < row->count; i++) {
        double u = (2.0 * (row->first + i) + 1.0) / row->size - 1.0, v = (double)row->v, square = 1.0 + u * u + v * v;
        double weight = 1.0 / (square * sqrt(square));
        uint32_t column = i / sums->samples;
        sums->weights[column] += weight;
        for (uint32_t face = 0; face < face_count; face++)
            for (int c = 0; c < 3; c++)
                sums->values[face][column][c] += weight * (double)rgb[face][stride * i + (size_t)c];
    }
}

/* Averages over samples x samples places in each texel; those below the horizon see the ground. */
static void average_row(const sky_frame *frame, bool is_top, uint32_t row)
{
    uint32_t size = frame->environment->size, samples = frame->samples, step = SKY_ROW_PIECE / samples;
    uint32_t face_count = is_top ? 1 : SKY_SIDE_FACES;
    float sky[SKY_SIDE_FACES][SKY_ROW_PIECE * 3], ground[3];
    memcpy(ground, frame->ground, sizeof ground);
    float *const above[SKY_SIDE_FACES] = {sky[0], sky[1], sky[2], sky[3]};
    float *const below[SKY_SIDE_FACES] = {ground, ground, ground, ground};
    for (uint32_t first = 0; first < size; first += step) {
        sample_sums sums = {.samples = samples, .columns = size - first < step ? size - first : step};
        sky_row piece = {size * samples, first * samples, sums.columns * samples, 0.0f, is_top};
        for (uint32_t i = 0; i < samples; i++) {
            piece.v = (float)(2 * (row * samples + i) + 1) / (float)piece.size - 1.0f;
            bool is_below = !is_top && piece.v > 0.0f;
            if (!is_below)
                frame->kernels->fill_sky(&frame->light, &piece, above);
            add_samples(&sums, face_count, is_below ? below : above, is_below ? 0 : 3, &piece);
        }
        float *rgb[SKY_SIDE_FACES];
        find_row(frame, is_top, row, first, rgb);
        for (uint32_t face = 0; face < face_count; face++)
            for (uint32_t i = 0; i < sums.columns; i++)
                for (int c = 0; c < 3; c++)
                    rgb[face][3 * i + (uint32_t)c] = (float)(sums.values[face][i][c] / sums.weights[i]);
    }
}

/* Rows of the top face first, each with one of the bottom face; then those of the side faces from above, each with its
 * mirror image below the horizon. */
static void fill_rows(void *data, size_t index)
{
    const sky_frame *frame = data;
    uint32_t size = frame->environment->size;
    bool is_top = index < size;
    uint32_t row = (uint32_t)(is_top ? index : index - size), mirrored = size - 1 - row;
    if (frame->samples == 1)
        fill_row(frame, is_top, row);
    else
        average_row(frame, is_top, row);
    if (is_top)
        fill_ground(frame, SKY_GROUND_FACE, row);
    else if (mirrored != row)
        for (int i = 0; i < SKY_SIDE_FACES; i++)
            fill_ground(frame, sky_side_faces[i], mirrored);
}

static void add_sun(const sky_parts *parts, helio_environment *environment)
{
    for (size_t i = 0; i < parts->sun_count; i++)
        for (size_t c = 0; c < 3; c++)
            environment->cube[(size_t)parts->sun[i].texel * 3 + c] += parts->sun[i].rgb[c];
}

void sky_cube_fill(const sky_parts *parts, helio_environment *environment)
{
    uint32_t size = environment->size;
    sky_frame frame = {.kernels = kernels_of(context_isa(environment->context)),
                       .environment = environment,
                       .samples = sky_cube_samples(size),
                       .light = parts->light};
    memcpy(frame.ground, parts->ground, sizeof frame.ground);
    context_parallel_for(environment->context, size + (size + 1) / 2, fill_rows, &frame);
    add_sun(parts, environment);
}
