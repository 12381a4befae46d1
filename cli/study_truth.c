/* SPDX-License-Identifier: MIT */
#include "study_truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* PIECES: independent pictures, whose spread tells the standard error of their mean. */
enum { PIECES = 16, MOST_AA = 4096 };

static const double QUADRATURE_WORK = 60000; /* in samples of study_progress, of each pixel; very roughly */

static size_t pixels_of(const study_truth *truth)
{
    return (size_t)truth->width * truth->height;
}

static bool take_memory(study_truth *truth, const uint32_t size[2])
{
    *truth = (study_truth){.width = size[0], .height = size[1]};
    truth->rgb = calloc(3 * pixels_of(truth), sizeof *truth->rgb);
    truth->object = calloc(pixels_of(truth), sizeof *truth->object);
    truth->error = calloc(3 * pixels_of(truth), sizeof *truth->error);
    return truth->rgb != NULL && truth->object != NULL && truth->error != NULL;
}

void study_truth_release(study_truth *truth)
{
    free(truth->rgb);
    free(truth->object);
    free(truth->error);
    *truth = (study_truth){0};
}

static void find_rmse(study_truth *truth)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < 3 * pixels_of(truth); i++)
        if (truth->object[i / 3] >= 0.5f && isfinite(truth->error[i])) {
            sum += (double)truth->error[i] * (double)truth->error[i];
            count++;
        }
    truth->rmse = count > 0 ? sqrt(sum / count) : 0;
}

/* ---- rendering ----------------------------------------------------------------------------- */

static uint32_t piece_spp(uint32_t spp)
{
    return (spp + PIECES - 1) / PIECES;
}

/* One camera sample has no noise; several, which are at random, have less than those of what is compared. */
static uint32_t quadrature_aa(uint32_t aa)
{
    return aa == 1 ? 1 : aa < MOST_AA / PIECES ? PIECES * aa : MOST_AA;
}

/* As study_progress counts it, each of a pixel's aa camera samples is one frame's. */
double study_truth_work(const study_truth_desc *desc)
{
    uint32_t aa = desc->renderer.aa;
    return desc->is_quadrature ? QUADRATURE_WORK * quadrature_aa(aa) / aa
                               : PIECES * study_progress_frame(HELIO_STRATEGY_PRODUCT_BRDF, piece_spp(desc->spp));
}

static helio_status create(helio_context *context, const study_truth_desc *desc, helio_reference **reference)
{
    helio_reference_desc made = {.renderer = desc->renderer,
                                 .camera = desc->camera,
                                 .method = desc->is_quadrature ? HELIO_REFERENCE_QUADRATURE : HELIO_REFERENCE_SAMPLING,
                                 .seed = desc->seed};
    made.renderer.strategy = HELIO_STRATEGY_PRODUCT_BRDF;
    made.renderer.spp = piece_spp(desc->spp) * made.renderer.aa; /* references count samples of a pixel */
    if (desc->is_quadrature)
        made.renderer.aa = quadrature_aa(made.renderer.aa);
    return helio_reference_create(context, &made, reference);
}

/* Pieces of quadrature are bands of the picture. */
static helio_status advance(helio_reference *reference, const study_truth_desc *desc, bool *is_whole)
{
    helio_reference_info info = helio_reference_get_info(reference);
    uint64_t count = desc->is_quadrature ? info.piece_count : PIECES;
    helio_status status = HELIO_OK;
    while (status == HELIO_OK && !info.stopped && info.pieces < count) {
        study_progress_begin(desc->progress, study_truth_work(desc) / (double)count);
        status = helio_reference_advance(reference, study_progress_update, desc->progress, &info);
        study_progress_end(desc->progress);
    }
    *is_whole = status == HELIO_OK && !info.stopped;
    return status;
}

static void take_picture(study_truth *truth, const helio_picture *picture)
{
    size_t pixels = pixels_of(truth);
    for (size_t i = 0; i < 3 * pixels; i++)
        truth->rgb[i] = picture->rgba[4 * (i / 3) + i % 3];
    memcpy(truth->object, picture->object, pixels * sizeof *truth->object);
    if (picture->standard_error != NULL)
        memcpy(truth->error, picture->standard_error, 3 * pixels * sizeof *truth->error);
    find_rmse(truth);
}

helio_status study_truth_make(helio_context *context, const study_truth_desc *desc, study_truth *truth, bool *is_whole)
{
    const uint32_t size[2] = {desc->renderer.width, desc->renderer.height};
    helio_reference *reference = NULL;
    *is_whole = false;
    if (!take_memory(truth, size))
        return HELIO_ERR_MEMORY;
    helio_status status = create(context, desc, &reference);
    if (status == HELIO_OK)
        status = advance(reference, desc, is_whole);
    if (*is_whole) {
        const helio_picture picture = helio_reference_picture(reference);
        take_picture(truth, &picture);
    }
    helio_reference_destroy(reference);
    return status;
}

/* ---- files --------------------------------------------------------------------------------- */

static bool read_layer(helio_context *context, const char *path, const char *layer, const study_truth *truth,
                       float *values, uint32_t channels)
{
    const helio_image_read_desc desc = {
        .layer = layer, .without_alpha = true, .max_pixels = (uint64_t)truth->width * truth->height};
    helio_image *image;
    if (helio_image_read(context, path, &desc, &image) != HELIO_OK)
        return false;
    bool fits = image->width == truth->width && image->height == truth->height;
    for (size_t i = 0; fits && i < channels * pixels_of(truth); i++)
        values[i] = channels == 3 ? image->rgb[i] : image->rgb[3 * i];
    helio_image_destroy(context, image);
    return fits;
}

bool study_truth_read(helio_context *context, const char *path, const uint32_t size[2], study_truth *truth)
{
    bool good = take_memory(truth, size) && read_layer(context, path, NULL, truth, truth->rgb, 3) &&
                read_layer(context, path, "object", truth, truth->object, 1) &&
                read_layer(context, path, "stderr", truth, truth->error, 3);
    if (good)
        find_rmse(truth);
    else
        study_truth_release(truth);
    return good;
}

helio_status study_truth_write(helio_context *context, const char *path, const study_truth *truth)
{
    float *rgba = malloc(4 * pixels_of(truth) * sizeof *rgba);
    if (rgba == NULL)
        return HELIO_ERR_MEMORY;
    for (size_t i = 0; i < 4 * pixels_of(truth); i++)
        rgba[i] = i % 4 == 3 ? 1 : truth->rgb[3 * (i / 4) + i % 4];
    const helio_picture picture = {.width = truth->width,
                                   .height = truth->height,
                                   .rgba = rgba,
                                   .object = truth->object,
                                   .standard_error = truth->error};
    helio_status status = helio_picture_write(context, path, &picture, NULL);
    free(rgba);
    return status;
}
