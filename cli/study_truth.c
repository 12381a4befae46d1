/* SPDX-License-Identifier: MIT */
#include "study_truth.h"

#include "study_seed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES = 16 }; /* independent pictures, whose spread tells the standard error of their mean */

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

/* Of each channel: the mean so far, and the sum of squared differences from it (Welford). */
typedef struct moments {
    double *mean, *squares;
} moments;

static void add_pass(moments *sums, const float *rgba, size_t pixels, uint32_t pass)
{
    for (size_t i = 0; i < 3 * pixels; i++) {
        double value = (double)rgba[4 * (i / 3) + i % 3], change = value - sums->mean[i];
        sums->mean[i] += change / (pass + 1);
        sums->squares[i] += change * (value - sums->mean[i]);
    }
}

static void finish(study_truth *truth, const moments *sums, const float *object)
{
    for (size_t i = 0; i < 3 * pixels_of(truth); i++) {
        truth->rgb[i] = (float)sums->mean[i];
        truth->error[i] = (float)sqrt(sums->squares[i] / (PASSES * (PASSES - 1)));
    }
    memcpy(truth->object, object, pixels_of(truth) * sizeof *object);
    find_rmse(truth);
}

static uint32_t pass_spp(const study_truth_desc *desc)
{
    return (desc->spp + PASSES - 1) / PASSES;
}

double study_truth_work(uint32_t spp)
{
    const study_truth_desc desc = {.spp = spp};
    return PASSES * study_progress_frame(HELIO_STRATEGY_AUTO, pass_spp(&desc));
}

static helio_status render_passes(helio_renderer *renderer, const study_truth_desc *desc, study_truth *truth,
                                  moments *sums, bool *is_whole)
{
    helio_frame_desc frame = {.camera = desc->camera, .progress = study_progress_update, .user = desc->progress};
    helio_frame_info info = {0};
    helio_status status = HELIO_OK;
    for (uint32_t pass = 0; pass < PASSES && status == HELIO_OK && !info.stopped; pass++) {
        study_progress_begin(desc->progress, study_progress_frame(HELIO_STRATEGY_AUTO, pass_spp(desc)));
        frame.seed = study_seed(desc->seed, STUDY_SEED_TRUTH + pass);
        status = helio_renderer_render(renderer, &frame, &info);
        if (status == HELIO_OK && !info.stopped)
            add_pass(sums, helio_renderer_picture(renderer).rgba, pixels_of(truth), pass);
        study_progress_end(desc->progress);
    }
    *is_whole = status == HELIO_OK && !info.stopped;
    if (*is_whole)
        finish(truth, sums, helio_renderer_picture(renderer).object);
    return status;
}

helio_status study_truth_make(helio_context *context, const study_truth_desc *desc, study_truth *truth, bool *is_whole)
{
    helio_renderer_desc renderer_desc = desc->renderer;
    helio_renderer *renderer = NULL;
    const uint32_t size[2] = {renderer_desc.width, renderer_desc.height};
    *is_whole = false;
    if (!take_memory(truth, size))
        return HELIO_ERR_MEMORY;
    moments sums = {calloc(3 * pixels_of(truth), sizeof(double)), calloc(3 * pixels_of(truth), sizeof(double))};
    helio_status status = sums.mean != NULL && sums.squares != NULL ? HELIO_OK : HELIO_ERR_MEMORY;
    renderer_desc.spp = pass_spp(desc);
    renderer_desc.strategy = HELIO_STRATEGY_AUTO;
    if (status == HELIO_OK)
        status = helio_renderer_create(context, &renderer_desc, &renderer);
    if (status == HELIO_OK)
        status = render_passes(renderer, desc, truth, &sums, is_whole);
    helio_renderer_destroy(renderer);
    free(sums.mean);
    free(sums.squares);
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
