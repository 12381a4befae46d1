/* SPDX-License-Identifier: MIT
 *
 * What a reference has come to: colours, errors, the picture. */
#include "core/context.h"
#include "core/error.h"
#include "eval/reference.h"

void reference_colour(const helio_reference *reference, size_t index, double rgb[3], double error[3])
{
    const reference_pixel *pixel = &reference->pixels[index];
    double passes = (double)reference_passes(reference, (uint32_t)(index / reference->desc.renderer.width));
    film_colour(&pixel->light, reference_shows_background(reference), reference_weight(reference) * passes, rgb);
    bool is_known = passes > (reference->quadrature != NULL ? 0.0 : 1.0);
    for (int c = 0; c < 3; c++) {
        double spread = passes > 1.0 ? sqrt(fmax(0.0, pixel->squares[c]) / (passes * (passes - 1.0))) : 0.0;
        error[c] = is_known ? spread + pixel->bound[c] / passes : (double)INFINITY;
    }
}

/* Does the pixel show the object, as far as is known? */
static bool shows_object(const helio_reference *reference, size_t index)
{
    double passes = (double)reference_passes(reference, (uint32_t)(index / reference->desc.renderer.width));
    return passes > 0.0 && reference->pixels[index].light.object >= 0.5 * reference_weight(reference) * passes;
}

static void measure_row(void *data, size_t row)
{
    helio_reference *reference = data;
    uint32_t width = reference->desc.renderer.width;
    reference_row sums = {0};
    for (size_t i = row * width; i < (row + 1) * width; i++) {
        double rgb[3], error[3];
        if (!shows_object(reference, i))
            continue;
        reference_colour(reference, i, rgb, error);
        sums.squares += (rgb[0] * rgb[0] + rgb[1] * rgb[1] + rgb[2] * rgb[2]) / 3.0;
        sums.is_unknown |= isinf(error[0]);
        sums.pixels++;
    }
    reference->rows[row] = sums;
}

typedef struct error_sum {
    helio_reference *reference;
    double floor_squared;
} error_sum;

static void add_errors(void *data, size_t row)
{
    const error_sum *sum = data;
    uint32_t width = sum->reference->desc.renderer.width;
    double errors = 0.0;
    for (size_t i = row * width; i < (row + 1) * width; i++) {
        double rgb[3], error[3];
        if (!shows_object(sum->reference, i))
            continue;
        reference_colour(sum->reference, i, rgb, error);
        for (int c = 0; c < 3; c++)
            errors += error[c] > 0.0 ? error[c] / sqrt(rgb[c] * rgb[c] + sum->floor_squared) : 0.0;
    }
    sum->reference->rows[row].errors = errors;
}

/* Rows on their own, and their sums in order: the same bits on any number of threads. */
double helio_reference_error(helio_reference *reference)
{
    uint32_t height = reference->desc.renderer.height;
    reference_row all = {0};
    context_parallel_for(reference->context, height, measure_row, reference);
    for (uint32_t row = 0; row < height; row++) {
        all.pixels += reference->rows[row].pixels;
        all.squares += reference->rows[row].squares;
        all.is_unknown |= reference->rows[row].is_unknown;
    }
    if (all.pixels == 0 || all.is_unknown)
        return (double)NAN;
    error_sum sum = {reference, 0.01 * all.squares / (double)all.pixels};
    context_parallel_for(reference->context, height, add_errors, &sum);
    for (uint32_t row = 0; row < height; row++)
        all.errors += reference->rows[row].errors;
    return all.errors / (3.0 * (double)all.pixels);
}

static void develop_row(void *data, size_t row)
{
    helio_reference *reference = data;
    uint32_t width = reference->desc.renderer.width;
    double weight = reference_weight(reference) * (double)reference_passes(reference, (uint32_t)row);
    for (size_t i = row * width; i < (row + 1) * width; i++) {
        double rgb[3], error[3];
        film_develop_light(&reference->pixels[i].light, reference_shows_background(reference), weight,
                           reference->rgba + 4 * i, reference->object + i);
        reference_colour(reference, i, rgb, error);
        for (size_t c = 0; c < 3; c++)
            reference->standard_error[3 * i + c] = (float)error[c];
    }
}

helio_picture helio_reference_picture(helio_reference *reference)
{
    const helio_renderer_desc *desc = &reference->desc.renderer;
    context_parallel_for(reference->context, desc->height, develop_row, reference);
    bool has_error = reference->quadrature != NULL || reference->pieces > 1;
    return (helio_picture){
        .width = desc->width,
        .height = desc->height,
        .rgba = reference->rgba,
        .object = reference->object,
        .standard_error = has_error ? reference->standard_error : NULL,
    };
}
