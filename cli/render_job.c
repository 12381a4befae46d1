/* SPDX-License-Identifier: MIT */
#include "render_job.h"

#include "input_source.h"
#include "interrupt.h"
#include "machine.h"
#include "message.h"

#include <inttypes.h>
#include <stdio.h>

/* ---- opening ---------------------------------------------------------------------------- */

static helio_status open_context(render_job *job)
{
    return input_source_context(job->plan.options, &job->warnings, &job->context);
}

static helio_status open_source(render_job *job)
{
    helio_status status =
        helio_source_open(job->context, job->plan.light.specification, &job->plan.source, &job->source);
    if (status == HELIO_OK)
        job->source_info = helio_source_get_info(job->source);
    return status;
}

static helio_status load_scene(render_job *job)
{
    const cli_options *options = job->plan.options;
    const helio_mesh_load_desc limits = {.max_memory = (uint64_t)options->max_mesh_memory << 20,
                                         .max_seconds = options->max_mesh_seconds,
                                         .max_pixels = options->max_pixels};
    double start = machine_milliseconds();
    helio_status status = helio_mesh_load(job->context, job->plan.mesh, &limits, &job->mesh);
    double loaded = machine_milliseconds();
    const helio_scene_desc desc = {
        .mesh = job->mesh,
        .material = job->plan.has_material ? &job->plan.material : NULL,
        .ground = job->plan.ground,
    };
    if (status == HELIO_OK)
        status = helio_scene_create(job->context, &desc, &job->scene);
    if (status == HELIO_OK && options->verbose)
        message_note("%s: %" PRIu32 " triangles, normals %s, loaded in %.0f ms, made ready for rays in %.0f ms",
                     job->plan.mesh, job->mesh->triangle_count,
                     job->mesh->has_file_normals ? "of the file" : "computed", loaded - start,
                     machine_milliseconds() - loaded);
    return status;
}

static helio_status make_environment(render_job *job)
{
    const cli_options *options = job->plan.options;
    const helio_environment_desc desc = {.cube_size = options->env_size};
    const helio_orientation orientation = {
        .rotate = (float)options->rotate, .flip = options->flip, .intensity = (float)options->intensity};
    helio_status status = helio_environment_create(job->context, &desc, &job->environment);
    return status == HELIO_OK ? helio_environment_orient(job->environment, &orientation) : status;
}

static helio_status place_camera(render_job *job)
{
    return helio_camera_parse(job->plan.options->camera, job->mesh, render_plan_aspect(&job->plan), &job->camera);
}

helio_renderer_desc render_job_describe(const render_job *job)
{
    const cli_options *options = job->plan.options;
    return (helio_renderer_desc){
        .environment = job->environment,
        .scene = job->scene,
        .width = options->size[0],
        .height = options->size[1],
        .spp = options->spp,
        .aa = options->aa,
        .strategy = job->plan.strategy,
        .weighting = job->plan.weighting,
        .pool_length = options->pool_length,
        .bins = options->bins,
        .brdf_share = (float)options->brdf_share,
        .no_beta = options->no_beta,
        .no_control = options->no_control,
        .no_decorrelation = options->decorrelate[0] == 'n',
        .no_visibility = options->visibility[0] == 'n',
        .background = job->plan.background,
        .device = job->device,
        .aovs = options->aovs,
    };
}

/* Only where a device is asked for. */
static helio_status open_device(render_job *job)
{
    const cli_options *options = job->plan.options;
    const helio_device_desc desc = {.name = options->device};
    if (options->backend[0] != 'v')
        return HELIO_OK;
    helio_status status = helio_device_create(job->context, &desc, &job->device);
    if (status == HELIO_OK && options->verbose)
        message_note("computing on %s", helio_device_get_info(job->device).name);
    return status;
}

static helio_status make_renderer(render_job *job)
{
    const cli_options *options = job->plan.options;
    const helio_renderer_desc desc = render_job_describe(job);
    helio_status status = helio_renderer_create(job->context, &desc, &job->renderer);
    if (status != HELIO_OK || !options->verbose)
        return status;
    uint32_t passes = helio_renderer_passes(job->renderer), threads = helio_context_threads(job->context);
    message_note("rendering %" PRIu32 "x%" PRIu32 " in %" PRIu32 " pass%s on %" PRIu32 " thread%s", options->size[0],
                 options->size[1], passes, passes == 1 ? "" : "es", threads, threads == 1 ? "" : "s");
    return status;
}

/* A signal may also be why a step failed, and is then what is told. */
static int run_steps(render_job *job, helio_status (*const *steps)(render_job *), size_t count)
{
    helio_status status = HELIO_OK;
    for (size_t i = 0; i < count && status == HELIO_OK && interrupt_signal() == 0; i++)
        status = steps[i](job);
    if (interrupt_signal() != 0) {
        message_failure("stopped; nothing was written to %s", job->plan.out[0] != 0 ? job->plan.out : "any file");
        return EXIT_CODE_SIGNAL + interrupt_signal();
    }
    if (status == HELIO_OK)
        return EXIT_CODE_OK;
    return status == HELIO_ERR_ARGUMENT ? message_usage("%s", helio_last_error())
                                        : message_failure("%s", helio_last_error());
}

int render_job_open_source(render_job *job)
{
    static helio_status (*const steps[])(render_job *) = {open_context, open_source};
    return run_steps(job, steps, sizeof steps / sizeof steps[0]);
}

int render_job_open_parts(render_job *job)
{
    static helio_status (*const steps[])(render_job *) = {load_scene, make_environment, place_camera};
    return run_steps(job, steps, sizeof steps / sizeof steps[0]);
}

int render_job_open_scene(render_job *job)
{
    static helio_status (*const steps[])(render_job *) = {open_device, make_renderer};
    int code = render_job_open_parts(job);
    return code == EXIT_CODE_OK ? run_steps(job, steps, sizeof steps / sizeof steps[0]) : code;
}

int render_job_open(render_job *job, const cli_options *options)
{
    *job = (render_job){0};
    int code = render_plan_make(&job->plan, options);
    if (code == EXIT_CODE_OK)
        code = render_job_open_source(job);
    if (code == EXIT_CODE_OK)
        code = render_plan_settle(&job->plan, job->source);
    if (code == EXIT_CODE_OK)
        code = frame_error_open(&job->error, job->context, options->reference, options->size);
    return code == EXIT_CODE_OK ? render_job_open_scene(job) : code;
}

void render_job_close(render_job *job)
{
    frame_error_close(&job->error);
    helio_renderer_destroy(job->renderer);
    helio_device_destroy(job->device);
    helio_scene_destroy(job->scene);
    if (job->mesh != NULL)
        helio_mesh_destroy(job->context, job->mesh);
    helio_environment_destroy(job->environment);
    helio_source_close(job->source);
    helio_context_destroy(job->context);
    render_plan_release(&job->plan);
}

/* ---- one frame -------------------------------------------------------------------------- */

helio_status render_job_next(render_job *job, helio_source_frame *frame, stats_frame *stats)
{
    double start = machine_milliseconds();
    helio_status status = helio_source_next(job->source, frame);
    *stats = (stats_frame){.source_ms = machine_milliseconds() - start};
    if (status == HELIO_OK) {
        stats->index = frame->index;
        stats->read_ms = frame->read_ms;
    }
    return status;
}

/* Frames of a sequence have names of their own; those of a video have numbers. */
static void make_label(const render_job *job, const helio_source_frame *frame, char label[SINK_PATH_SIZE])
{
    bool is_numbered = job->source_info.kind == HELIO_SOURCE_VIDEO || job->source_info.kind == HELIO_SOURCE_DEVICE;
    if (is_numbered)
        snprintf(label, SINK_PATH_SIZE, "%s: frame %" PRIu64, frame->name, frame->index);
    else
        snprintf(label, SINK_PATH_SIZE, "%s", frame->name);
}

static void note_light(render_job *job, const helio_source_frame *frame, const helio_bad_pixels *bad,
                       const double flux[6], stats_frame *stats)
{
    char label[SINK_PATH_SIZE];
    make_label(job, frame, label);
    stats_note_bad_pixels(stats, &frame->bad, bad);
    for (int face = 0; face < 6; face++)
        stats->flux += flux[face];
    if (frame->rgb != NULL)
        frame_warnings_size(&job->warnings, label, frame);
    frame_warnings_bad_pixels(&job->warnings, label, stats);
}

helio_status render_job_light(render_job *job, const helio_source_frame *frame, helio_environment_info *light,
                              stats_frame *stats)
{
    char label[SINK_PATH_SIZE];
    make_label(job, frame, label);
    double start = machine_milliseconds();
    helio_status status = helio_source_apply(job->source, frame, job->environment, light);
    stats->cube_ms = machine_milliseconds() - start;
    if (status != HELIO_OK)
        return status;
    job->light_is_late = light == NULL;
    if (light != NULL)
        note_light(job, frame, &light->bad, light->flux, stats);
    if (job->plan.options->verbose && frame->rgb != NULL)
        message_note("%s: %" PRIu32 "x%" PRIu32 " pixels, layout %s, read in %.0f ms; cube filled in %.0f ms", label,
                     frame->width, frame->height, helio_layout_name(frame->layout), frame->read_ms, stats->cube_ms);
    return status;
}

/* Two rounds of a mixing function (the finaliser of MurmurHash3), so that neighbouring frames share nothing. */
static uint32_t frame_seed(uint32_t seed, uint64_t index)
{
    const uint32_t words[2] = {(uint32_t)index, (uint32_t)(index >> 32)};
    uint32_t hash = seed;
    for (int i = 0; i < 2; i++) {
        hash = (hash ^ words[i]) * 0x9e3779b1u;
        hash = (hash ^ hash >> 16) * 0x85ebca6bu;
        hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
        hash ^= hash >> 16;
    }
    return hash;
}

helio_frame_desc render_job_frame(render_job *job, uint64_t index)
{
    const cli_options *options = job->plan.options;
    return (helio_frame_desc){
        .camera = job->camera,
        .seed = options->seed_mode[1] == 'r' ? frame_seed(options->seed, index) : options->seed,
        .progress = progress_update,
        .user = &job->progress,
        .shown = job->shown,
        .no_radiance = job->no_radiance,
    };
}

helio_status render_job_render(render_job *job, const helio_source_frame *frame, stats_frame *stats, bool *is_whole)
{
    const uint64_t index = frame->index;
    const helio_frame_desc desc = render_job_frame(job, index);
    helio_frame_info info = {0};
    helio_status status = helio_renderer_render(job->renderer, &desc, &info);
    *is_whole = status == HELIO_OK && !info.stopped;
    job->passes = info.passes;
    if (job->light_is_late && status == HELIO_OK)
        note_light(job, frame, &info.bad, info.flux, stats);
    stats->cube_ms += info.cube_ms;
    stats->tables_ms = info.tables_ms;
    stats->pools_ms = info.pools_ms;
    stats->primary_ms = info.primary_ms;
    stats->shade_ms = info.shade_ms;
    stats->has_device = job->device != NULL;
    stats->upload_ms = info.upload_ms;
    stats->read_back_ms = info.read_back_ms;
    stats->samples = info.samples;
    stats->samples_useful = info.samples_useful;
    if (*is_whole && job->plan.options->verbose)
        message_note("frame %" PRIu64 ": tables %.1f ms, pools %.1f ms, camera rays %.1f ms, shading %.1f ms; %" PRIu64
                     " samples, %.1f %% of them useful, %" PRIu64 " shadow rays",
                     index, info.tables_ms, info.pools_ms, info.primary_ms, info.shade_ms, info.samples,
                     info.samples ? 100 * (double)info.samples_useful / (double)info.samples : 0.0, info.rays);
    return status;
}
