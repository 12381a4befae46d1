/* SPDX-License-Identifier: MIT */
#include "study_measure.h"

#include "bench_series.h"
#include "machine.h"
#include "study_seed.h"

#include <math.h>

enum { PARTS = 6 };

/* ---- what is rendered ---------------------------------------------------------------------- */

helio_renderer_desc study_renderer_desc(const study_job *job)
{
    const cli_options *options = job->plan->options;
    return (helio_renderer_desc){
        .environment = job->environment,
        .scene = job->scene,
        .width = options->size[0],
        .height = options->size[1],
        .aa = options->aa,
        .no_visibility = options->study.visibility[0] == 'n',
    };
}

study_turn study_turn_of(const study_plan *plan)
{
    const cli_options *options = plan->options;
    return (study_turn){options->rotate, options->study.turn, options->flip, (float)options->intensity};
}

uint32_t study_seed_of(const study_job *job, uint32_t frame, uint32_t repetition)
{
    const cli_options *options = job->plan->options;
    uint32_t index = options->seed_mode[1] == 'r' ? BENCH_REPEATS + frame : 0;
    return study_seed(options->seed, index + repetition);
}

static uint32_t sequence_length(const study_job *job, const study_point *point)
{
    return job->plan->is_shown[point->spp] && job->light.count > 1 ? job->light.count : 0;
}

double study_measure_work(const study_plan *plan, const study_point *point)
{
    const study_options *study = &plan->options->study;
    uint32_t frames = study->repeat + (plan->is_shown[point->spp] && plan->sequence > 1 ? plan->sequence : 0);
    return frames * study_progress_frame(plan->strategies[point->strategy].strategy, plan->spp[point->spp]);
}

/* ---- one frame ----------------------------------------------------------------------------- */

typedef struct measured_frame {
    double parts[PARTS]; /* ms: all, cube, tables, pools, camera rays, shading */
    helio_frame_info info;
} measured_frame;

static void begin_frame(study_job *job, const study_point *point)
{
    const study_plan *plan = job->plan;
    study_progress_begin(&job->progress,
                         study_progress_frame(plan->strategies[point->strategy].strategy, plan->spp[point->spp]));
}

/* All that a frame takes once its map is in memory. */
static helio_status render_frame(study_job *job, helio_renderer *renderer, uint32_t index, uint32_t seed,
                                 measured_frame *frame)
{
    const study_turn turn = study_turn_of(job->plan);
    const helio_frame_desc desc = {.camera = job->camera,
                                   .seed = seed,
                                   .progress = study_progress_update,
                                   .user = &job->progress,
                                   .retrace = true};
    frame->info = (helio_frame_info){0};
    double start = machine_milliseconds();
    helio_status status = study_light_apply(&job->light, index, &turn, job->environment, NULL);
    double lit = machine_milliseconds();
    if (status == HELIO_OK)
        status = helio_renderer_render(renderer, &desc, &frame->info);
    double parts[PARTS] = {machine_milliseconds() - start, lit - start,
                           frame->info.tables_ms,          frame->info.pools_ms,
                           frame->info.primary_ms,         frame->info.shade_ms};
    for (int i = 0; i < PARTS; i++)
        frame->parts[i] = parts[i];
    return status;
}

static helio_comparison_pair pair_of(const study_job *job, const helio_renderer *renderer, uint32_t frame)
{
    return (helio_comparison_pair){.picture = helio_renderer_picture(renderer).rgba,
                                   .picture_channels = 4,
                                   .reference = job->truths[frame].rgb,
                                   .mask = job->truths[frame].object,
                                   .exposure = job->exposure,
                                   .tonemap = job->plan->tonemap};
}

/* ---- repetitions --------------------------------------------------------------------------- */

typedef struct repetitions {
    bench_series parts[PARTS]; /* as those of measured_frame */
    helio_frame_info info;     /* of the last */
} repetitions;

static void note_times(const repetitions *all, study_cell *cell)
{
    bench_spread total = bench_series_spread(&all->parts[0]);
    cell->total_ms = total.median;
    cell->low_ms = total.low;
    cell->high_ms = total.high;
    cell->cube_ms = bench_series_spread(&all->parts[1]).median;
    cell->tables_ms = bench_series_spread(&all->parts[2]).median;
    cell->pools_ms = bench_series_spread(&all->parts[3]).median;
    cell->primary_ms = bench_series_spread(&all->parts[4]).median;
    cell->shade_ms = bench_series_spread(&all->parts[5]).median;
    const helio_frame_info *info = &all->info;
    cell->samples = (double)info->samples;
    cell->useful_share = info->samples > 0 ? (double)info->samples_useful / (double)info->samples : (double)NAN;
    cell->rays = (double)info->rays;
    cell->passes = info->passes;
}

static helio_status write_pictures(study_job *job, const study_point *point, const helio_renderer *renderer)
{
    double range;
    char path[STUDY_PATH];
    const float *errors = helio_comparison_map(job->full, study_job_error_map(&range));
    uint32_t width = job->plan->options->size[0];
    if (!job->plan->is_shown[point->spp] || !study_job_has_pictures() ||
        !study_plan_shows(job->plan, point->environment, point->material))
        return HELIO_OK;
    study_job_picture_path(job->plan, point, "picture", path);
    helio_status status = study_picture_write(job->context, path, &job->window, helio_renderer_picture(renderer).rgba,
                                              width, 4, job->exposure, job->plan->tonemap);
    study_job_picture_path(job->plan, point, "error", path);
    return status == HELIO_OK ? study_picture_write_errors(job->context, path, &job->window, errors, width, range)
                              : status;
}

/* What takes long to compare by, and what is shown, is of the first repetition. */
static helio_status note_view(study_job *job, const study_point *point, const helio_renderer *renderer,
                              study_cell *cell)
{
    helio_comparison_info info;
    const helio_comparison_pair pair = pair_of(job, renderer, study_plan_still(job->light.count));
    helio_status status = helio_comparison_measure(job->full, &pair, &info);
    if (status != HELIO_OK)
        return status;
    cell->lab_mean = info.lab_mean;
    cell->de2000_mean = info.de2000_mean;
    cell->psnr = info.psnr;
    cell->flip = info.flip;
    return write_pictures(job, point, renderer);
}

static helio_status repeat(study_job *job, const study_point *point, helio_renderer *renderer, study_cell *cell,
                           bool *is_whole)
{
    repetitions all = {0};
    double relmse = 0, squares = 0;
    uint32_t still = study_plan_still(job->light.count), count = job->plan->options->study.repeat;
    for (uint32_t i = 0; i < count; i++) {
        measured_frame frame;
        helio_comparison_info info;
        begin_frame(job, point);
        helio_status status = render_frame(job, renderer, still, study_seed_of(job, still, i), &frame);
        *is_whole = !frame.info.stopped;
        if (status != HELIO_OK || frame.info.stopped)
            return status;
        const helio_comparison_pair pair = pair_of(job, renderer, still);
        helio_comparison_restart(job->plain);
        status = helio_comparison_measure(job->plain, &pair, &info);
        if (status == HELIO_OK && i == 0)
            status = note_view(job, point, renderer, cell);
        if (status != HELIO_OK)
            return status;
        for (int part = 0; part < PARTS; part++)
            bench_series_add(&all.parts[part], frame.parts[part]);
        all.info = frame.info;
        relmse += info.relmse;
        squares += info.rmse * info.rmse;
        study_progress_end(&job->progress);
    }
    cell->relmse = relmse / count;
    cell->rmse = sqrt(squares / count);
    note_times(&all, cell);
    return HELIO_OK;
}

/* ---- flicker ------------------------------------------------------------------------------- */

static helio_status measure_flicker(study_job *job, const study_point *point, helio_renderer *renderer,
                                    study_cell *cell, bool *is_whole)
{
    measured_frame frame;
    helio_comparison_info info;
    uint32_t count = sequence_length(job, point);
    double flicker = 0, squares = 0, relmse = 0;
    helio_comparison_restart(job->plain);
    for (uint32_t i = 0; i < count; i++) {
        begin_frame(job, point);
        helio_status status = render_frame(job, renderer, i, study_seed_of(job, i, 0), &frame);
        *is_whole = !frame.info.stopped;
        if (status != HELIO_OK || frame.info.stopped)
            return status;
        const helio_comparison_pair pair = pair_of(job, renderer, i);
        status = helio_comparison_measure(job->plain, &pair, &info);
        if (status != HELIO_OK)
            return status;
        relmse += info.relmse;
        flicker += i > 0 ? info.flicker : 0;
        squares += i > 0 ? info.flicker_rmse * info.flicker_rmse : 0;
        study_progress_end(&job->progress);
    }
    cell->flicker = count > 1 ? flicker / (count - 1) : (double)NAN;
    cell->flicker_rmse = count > 1 ? sqrt(squares / (count - 1)) : (double)NAN;
    cell->sequence_relmse = count > 1 ? relmse / count : (double)NAN;
    cell->flicker_ratio = cell->flicker / cell->sequence_relmse;
    return HELIO_OK;
}

helio_status study_measure(study_job *job, const study_point *point, study_cell *cell, bool *is_whole)
{
    const study_strategy *strategy = &job->plan->strategies[point->strategy];
    helio_renderer *renderer;
    helio_renderer_desc desc = study_renderer_desc(job);
    desc.spp = job->plan->spp[point->spp];
    desc.strategy = strategy->strategy;
    desc.weighting = strategy->weighting;
    desc.brdf_share = strategy->brdf_share;
    desc.no_beta = strategy->no_beta;
    desc.no_control = strategy->no_control;
    desc.no_decorrelation = strategy->no_decorrelation;
    *cell = (study_cell){.reference_rmse = job->truths[study_plan_still(job->light.count)].rmse,
                         .exposure = (double)job->exposure};
    helio_status status = helio_renderer_create(job->context, &desc, &renderer);
    if (status == HELIO_OK)
        status = repeat(job, point, renderer, cell, is_whole);
    if (status == HELIO_OK && *is_whole)
        status = measure_flicker(job, point, renderer, cell, is_whole);
    helio_renderer_destroy(renderer);
    return status;
}
