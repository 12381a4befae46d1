/* SPDX-License-Identifier: MIT
 * See flip_filter.c for the paper. */
#include "eval/flip.h"

#include "image/colour.h"

#include <math.h>
#include <string.h>

static const float COLOUR_EXPONENT = 0.7f, FEATURE_EXPONENT = 0.5f;

/* Differences of colours up to this part of the greatest are spread over 0..0.95: large ones count as equally bad. */
static const float KNEE = 0.4f, KNEE_ERROR = 0.95f;

/* ---- colours ------------------------------------------------------------------------------ */

static void multiply(const float matrix[3][3], const float in[3], float out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = matrix[row][0] * in[0] + matrix[row][1] * in[1] + matrix[row][2] * in[2];
}

void flip_opponents(const flip_viewer *viewer, const float rgb[3], float opponents[3])
{
    float xyz[3];
    multiply(viewer->to_xyz, rgb, xyz);
    opponents[0] = 116 * xyz[1] - 16;
    opponents[1] = 500 * (xyz[0] - xyz[1]);
    opponents[2] = 200 * (xyz[1] - xyz[2]);
}

/* Clamped to what a screen shows. */
static void from_opponents(const flip_viewer *viewer, const float opponents[3], float rgb[3])
{
    float y = (opponents[0] + 16) * (1 / 116.0f);
    const float xyz[3] = {y + opponents[1] * (1 / 500.0f), y, y - opponents[2] * (1 / 200.0f)};
    multiply(viewer->from_xyz, xyz, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = fminf(fmaxf(rgb[c], 0), 1);
}

/* Of a number from 1e-3 to 10. A third of its exponent, then Halley's iteration, twice: exact but for rounding, and in
 * a third of cbrtf()'s time. */
static float cube_root(float x)
{
    uint32_t bits;
    float root;
    memcpy(&bits, &x, sizeof bits);
    bits = bits / 3 + 0x2a5137a0;
    memcpy(&root, &bits, sizeof root);
    for (int i = 0; i < 2; i++) {
        float cube = root * root * root;
        root *= (cube + 2 * x) / (2 * cube + x);
    }
    return root;
}

static float lightness_curve(float t)
{
    const float edge = 6 / 29.0f;
    return t > edge * edge * edge ? cube_root(t) : t / (3 * edge * edge) + 4 / 29.0f;
}

void flip_lab(const flip_viewer *viewer, const float rgb[3], float lab[3])
{
    float xyz[3];
    multiply(viewer->to_xyz, rgb, xyz);
    float x = lightness_curve(xyz[0]), y = lightness_curve(xyz[1]), z = lightness_curve(xyz[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

/* After Hunt: what is dark has less colour. */
static void hunt_lab(const flip_viewer *viewer, const float rgb[3], float lab[3])
{
    flip_lab(viewer, rgb, lab);
    lab[1] *= 0.01f * lab[0];
    lab[2] *= 0.01f * lab[0];
}

/* The HyAB distance, which holds for large differences too, to a power. */
static float colour_distance(const flip_viewer *viewer, const float first[3], const float second[3])
{
    float a[3], b[3];
    hunt_lab(viewer, first, a);
    hunt_lab(viewer, second, b);
    float across = a[1] - b[1], along = a[2] - b[2];
    float distance = fabsf(a[0] - b[0]) + sqrtf(across * across + along * along);
    return powf(distance, COLOUR_EXPONENT);
}

void flip_viewer_make(flip_viewer *viewer, double pixels_per_degree)
{
    const double white[3] = {1, 1, 1};
    const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double white_xyz[3];
    colour_matrix to_xyz = colour_rec709_to_xyz(), from_xyz = colour_xyz_to_rec709();
    colour_transform(&to_xyz, white, white_xyz);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            viewer->to_xyz[row][column] = (float)(to_xyz.m[row][column] / white_xyz[row]);
            viewer->from_xyz[row][column] = (float)(from_xyz.m[row][column] * white_xyz[column]);
        }
    flip_filter_make(&viewer->filter, pixels_per_degree);
    viewer->greatest = colour_distance(viewer, green, blue);
}

/* ---- errors ------------------------------------------------------------------------------- */

static float colour_error(const flip_viewer *viewer, const flip_view *picture, const flip_view *reference, uint32_t i)
{
    float rgb[2][3];
    const flip_view *views[2] = {picture, reference};
    for (int side = 0; side < 2; side++) {
        const float opponents[3] = {views[side]->colours[0][i], views[side]->colours[1][i], views[side]->colours[2][i]};
        from_opponents(viewer, opponents, rgb[side]);
    }
    float distance = colour_distance(viewer, rgb[0], rgb[1]), knee = KNEE * viewer->greatest;
    if (distance < knee)
        return KNEE_ERROR * distance / knee;
    return fminf(KNEE_ERROR + (1 - KNEE_ERROR) * (distance - knee) / (viewer->greatest - knee), 1);
}

static float feature_error(const flip_view *picture, const flip_view *reference, uint32_t i)
{
    float edges = fabsf(picture->edges[i] - reference->edges[i]);
    float points = fabsf(picture->points[i] - reference->points[i]);
    return powf(fminf(fmaxf(edges, points) * sqrtf(0.5f), 1), FEATURE_EXPONENT);
}

static void compare_chunk(const flip_viewer *viewer, const flip_picture *picture, const flip_picture *reference,
                          uint32_t row, uint32_t column, uint32_t count, float *errors)
{
    flip_view seen, wanted;
    flip_filter_see(&viewer->filter, picture, row, column, count, &seen);
    flip_filter_see(&viewer->filter, reference, row, column, count, &wanted);
    for (uint32_t i = 0; i < count; i++)
        if (!isnan(errors[column + i]))
            errors[column + i] = powf(colour_error(viewer, &seen, &wanted, i), 1 - feature_error(&seen, &wanted, i));
}

/* From one pixel that is wanted to another, not too far on. */
void flip_compare_row(const flip_viewer *viewer, const flip_picture *picture, const flip_picture *reference,
                      uint32_t row, float *errors)
{
    for (uint32_t column = 0, count = 1; column < picture->width; column += count, count = 1) {
        if (isnan(errors[column]))
            continue;
        count = picture->width - column < FLIP_CHUNK ? picture->width - column : FLIP_CHUNK;
        while (isnan(errors[column + count - 1]))
            count--;
        compare_chunk(viewer, picture, reference, row, column, count, errors);
    }
}
