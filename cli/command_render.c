/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "interrupt.h"
#include "machine.h"
#include "message.h"
#include "progress.h"
#include "render_plan.h"
#include "stats.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* Everything that one picture needs, in the order in which it comes to be. */
typedef struct render_job {
    render_plan plan;
    bool verbose;
    helio_context *context;
    helio_environment *environment;
    helio_environment_info light;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_renderer *renderer;
    float exposure; /* stops */
    uint32_t passes;
    stats_frame frame;
    bool failure_told; /* the sentence about what failed is printed already */
} render_job;

static void print_log(void *user, helio_log_level level, const char *message)
{
    (void)user;
    if (level <= HELIO_LOG_WARNING)
        message_warning("%s", message);
    else
        message_note("%s", message);
}

static bool open_context(render_job *job)
{
    helio_context_desc desc = {
        .threads = job->plan.options->threads,
        .log_level = job->verbose ? HELIO_LOG_INFO : HELIO_LOG_WARNING,
        .log = print_log,
    };
    return helio_context_create(&desc, &job->context) == HELIO_OK;
}

static void warn_of_bad_texels(const char *label, const stats_frame *frame)
{
    uint64_t bad = frame->nan + frame->infinite + frame->negative + frame->out_of_gamut;
    if (bad > 0)
        message_warning("%s has %" PRIu64 " bad pixel%s: %" PRIu64 " NaN and %" PRIu64 " infinite (taken as black), "
                        "%" PRIu64 " negative and %" PRIu64 " out of gamut (negative channels taken as 0)",
                        label, bad, bad == 1 ? "" : "s", frame->nan, frame->infinite, frame->negative,
                        frame->out_of_gamut);
}

/* What was negative in the file, and what colour conversion made so. */
static void note_light(stats_frame *frame, const helio_environment_info *light, const helio_bad_pixels *in_file)
{
    frame->nan = light->bad.nan;
    frame->infinite = light->bad.infinite;
    frame->negative = in_file->negative;
    frame->out_of_gamut = light->bad.negative > in_file->negative ? light->bad.negative - in_file->negative : 0;
    for (int face = 0; face < 6; face++)
        frame->flux += light->flux[face];
}

/* What the option says, else the file, else the shape. */
static helio_status choose_layout(render_job *job, const environment_pixels *pixels, helio_layout *layout)
{
    helio_layout wanted = pixels->image != NULL ? job->plan.layout : HELIO_LAYOUT_AUTO;
    if (wanted == HELIO_LAYOUT_AUTO)
        wanted = pixels->layout;
    helio_status status = helio_layout_guess(pixels->width, pixels->height, wanted, layout);
    if (status != HELIO_OK) {
        message_failure("%s: %s (--layout)", job->plan.source.label, helio_last_error());
        job->failure_told = true;
    }
    return status;
}

static helio_status make_environment(render_job *job, const environment_pixels *pixels)
{
    const cli_options *options = job->plan.options;
    helio_environment_desc desc = {.cube_size = options->env_size, .width = pixels->width, .height = pixels->height};
    helio_status status = choose_layout(job, pixels, &desc.layout);
    double start = machine_milliseconds();
    if (status == HELIO_OK)
        status = helio_environment_create(job->context, &desc, &job->environment);
    double created = machine_milliseconds();
    if (status == HELIO_OK)
        status = helio_environment_update(job->environment, pixels->rgb, &job->light);
    job->frame.cube_ms = machine_milliseconds() - created;
    helio_orientation orientation = {
        .rotate = (float)options->rotate, .flip = options->flip, .intensity = (float)options->intensity};
    if (status == HELIO_OK)
        status = helio_environment_orient(job->environment, &orientation);
    if (status == HELIO_OK && job->verbose)
        message_note("%s: %" PRIu32 "x%" PRIu32 " pixels, layout %s, read in %.0f ms; a cube of %" PRIu32
                     " texels prepared in %.0f ms, filled in %.0f ms",
                     job->plan.source.label, pixels->width, pixels->height, helio_layout_name(desc.layout),
                     job->frame.source_ms, options->env_size, created - start, job->frame.cube_ms);
    return status;
}

static bool load_environment(render_job *job)
{
    environment_pixels pixels;
    double start = machine_milliseconds();
    helio_status status =
        environment_source_read(&job->plan.source, job->context, job->plan.options->max_pixels, &pixels);
    job->frame.source_ms = machine_milliseconds() - start;
    if (status == HELIO_OK)
        status = make_environment(job, &pixels);
    if (status == HELIO_OK) {
        note_light(&job->frame, &job->light, &pixels.bad);
        warn_of_bad_texels(job->plan.source.label, &job->frame);
    }
    environment_pixels_release(&pixels, job->context);
    double exposure = job->plan.options->exposure;
    job->exposure = isnan(exposure) ? job->light.auto_exposure : (float)exposure;
    return status == HELIO_OK;
}

static bool load_scene(render_job *job)
{
    const cli_options *options = job->plan.options;
    const helio_mesh_load_desc limits = {.max_memory = (uint64_t)options->max_mesh_memory << 20,
                                         .max_seconds = options->max_mesh_seconds,
                                         .max_pixels = options->max_pixels};
    double start = machine_milliseconds();
    if (helio_mesh_load(job->context, job->plan.mesh, &limits, &job->mesh) != HELIO_OK)
        return false;
    double loaded = machine_milliseconds();
    helio_scene_desc desc = {
        .mesh = job->mesh,
        .material = job->plan.has_material ? &job->plan.material : NULL,
        .ground = job->plan.ground,
    };
    if (helio_scene_create(job->context, &desc, &job->scene) != HELIO_OK)
        return false;
    if (job->verbose)
        message_note("%s: %" PRIu32 " triangles, normals %s, loaded in %.0f ms, made ready for rays in %.0f ms",
                     job->plan.mesh, job->mesh->triangle_count,
                     job->mesh->has_file_normals ? "of the file" : "computed", loaded - start,
                     machine_milliseconds() - loaded);
    return true;
}

static bool make_renderer(render_job *job)
{
    const cli_options *options = job->plan.options;
    helio_renderer_desc desc = {
        .environment = job->environment,
        .scene = job->scene,
        .width = options->size[0],
        .height = options->size[1],
        .spp = options->spp,
        .aa = options->aa,
        .strategy = job->plan.strategy,
        .weighting = job->plan.weighting,
        .brdf_share = (float)options->brdf_share,
        .no_beta = options->no_beta,
        .no_decorrelation = options->decorrelate[0] == 'n',
        .no_visibility = options->visibility[0] == 'n',
        .background = job->plan.background,
        .aovs = options->aovs,
    };
    return helio_renderer_create(job->context, &desc, &job->renderer) == HELIO_OK;
}

/* Adds the time of the whole call to the frame's total. */
static bool render_frame(render_job *job)
{
    const cli_options *options = job->plan.options;
    progress_bar progress;
    helio_frame_desc desc = {.seed = options->seed, .progress = progress_update, .user = &progress};
    if (helio_camera_parse(options->camera, job->mesh, render_plan_aspect(&job->plan), &desc.camera) != HELIO_OK)
        return false;
    uint32_t passes = helio_renderer_passes(job->renderer), threads = helio_context_threads(job->context);
    if (job->verbose)
        message_note("rendering %" PRIu32 "x%" PRIu32 " in %" PRIu32 " pass%s on %" PRIu32 " thread%s",
                     options->size[0], options->size[1], passes, passes == 1 ? "" : "es", threads,
                     threads == 1 ? "" : "s");
    helio_frame_info info = {0};
    progress_start(&progress, (double)options->size[0] * options->size[1], options->quiet);
    double start = machine_milliseconds();
    helio_status status = helio_renderer_render(job->renderer, &desc, &info);
    job->frame.total_ms = machine_milliseconds() - start;
    progress_end(&progress);
    job->passes = info.passes;
    job->frame.tables_ms = info.tables_ms;
    job->frame.pools_ms = info.pools_ms;
    job->frame.primary_ms = info.primary_ms;
    job->frame.shade_ms = info.shade_ms;
    job->frame.samples = info.samples;
    job->frame.samples_useful = info.samples_useful;
    if (status == HELIO_OK && job->verbose)
        message_note("tables %.1f ms, pools %.1f ms, camera rays %.1f ms, shading %.1f ms; %" PRIu64
                     " samples, %.1f %% "
                     "of them useful, %" PRIu64 " shadow rays",
                     info.tables_ms, info.pools_ms, info.primary_ms, info.shade_ms, info.samples,
                     info.samples ? 100 * (double)info.samples_useful / (double)info.samples : 0.0, info.rays);
    return status == HELIO_OK;
}

static bool write_picture(render_job *job)
{
    helio_picture picture = helio_renderer_picture(job->renderer);
    helio_picture_write_desc desc = {.exposure = job->exposure, .tonemap = job->plan.tonemap, .alpha = job->plan.alpha};
    double start = machine_milliseconds();
    helio_status status = helio_picture_write(job->context, job->plan.options->out, &picture, &desc);
    job->frame.write_ms = machine_milliseconds() - start;
    job->frame.total_ms += job->frame.source_ms + job->frame.cube_ms + job->frame.write_ms;
    return status == HELIO_OK;
}

static int write_stats(const render_job *job)
{
    const cli_options *options = job->plan.options;
    if (options->stats == NULL)
        return EXIT_CODE_OK;
    stats_summary summary = {
        .strategy = helio_strategy_name(helio_strategy_resolve(job->plan.strategy)),
        .spp = options->spp,
        .width = options->size[0],
        .height = options->size[1],
        .threads = helio_context_threads(job->context),
        .isa = helio_context_isa(job->context),
        .passes = job->passes,
        .ev = (double)job->exposure,
    };
    return stats_write(options->stats, &job->frame, 1, &summary);
}

static int run_job(render_job *job)
{
    static bool (*const steps[])(render_job *) = {open_context,  load_environment, load_scene,
                                                  make_renderer, render_frame,     write_picture};
    double start = machine_milliseconds();
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        /* A signal may also be why a step failed. Once the picture is written, it is too late to stop. */
        bool good = interrupt_signal() == 0 && steps[i](job);
        bool is_written = good && steps[i] == write_picture;
        if (interrupt_signal() != 0 && !is_written) {
            message_failure("stopped; nothing was written to %s", job->plan.options->out);
            return EXIT_CODE_SIGNAL + interrupt_signal();
        }
        if (!good)
            return job->failure_told ? EXIT_CODE_FAILED : message_failure("%s", helio_last_error());
    }
    int code = write_stats(job);
    if (code == EXIT_CODE_OK && !job->plan.options->quiet)
        printf("%s: %" PRIu32 "x%" PRIu32 ", %.2f s, strategy %s\n", job->plan.options->out, job->plan.options->size[0],
               job->plan.options->size[1], (machine_milliseconds() - start) / 1e3,
               helio_strategy_name(helio_strategy_resolve(job->plan.strategy)));
    return code;
}

static void release_job(render_job *job)
{
    helio_renderer_destroy(job->renderer);
    helio_scene_destroy(job->scene);
    if (job->mesh != NULL)
        helio_mesh_destroy(job->context, job->mesh);
    helio_environment_destroy(job->environment);
    helio_context_destroy(job->context);
}

int command_render(const cli_options *options)
{
    interrupt_install();
    render_job job = {.verbose = options->verbose};
    int code = render_plan_make(&job.plan, options);
    if (code != EXIT_CODE_OK)
        return code;
    code = run_job(&job);
    release_job(&job);
    return code;
}
