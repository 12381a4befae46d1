/* SPDX-License-Identifier: MIT
 *
 * The pipeline of one frame: tables, then for each pass pools, camera rays and shading, then the picture. */
#include "cpu/renderer.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "env/environment.h"
#include "sampling/estimate.h"
#include "sampling/strategy.h"

#include <time.h>

enum { MAX_SIZE = 16384, MAX_SPP = 1 << 20, MAX_AA = 4096, BATCH_TILES = 64 };

/* ---- creation ---- */

/* The only place where the defaults of a renderer live. */
static helio_status resolve_desc(const helio_renderer_desc *given, helio_renderer_desc *desc)
{
    *desc = *given;
    desc->width = desc->width ? desc->width : 1280;
    desc->height = desc->height ? desc->height : 720;
    desc->spp = desc->spp ? desc->spp : 64;
    desc->aa = desc->aa ? desc->aa : 1;
    if (desc->environment == NULL || desc->scene == NULL)
        return fail(HELIO_ERR_ARGUMENT, "a renderer needs an environment and a scene");
    if (desc->width > MAX_SIZE || desc->height > MAX_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "a picture of %ux%u pixels cannot be rendered; each side must be 1 to %d",
                    desc->width, desc->height, MAX_SIZE);
    if (desc->spp > MAX_SPP)
        return fail(HELIO_ERR_ARGUMENT, "%u samples per point are too many; use 1 to %d", desc->spp, MAX_SPP);
    if (desc->aa > MAX_AA)
        return fail(HELIO_ERR_ARGUMENT, "%u camera samples per pixel are too many; use 1 to %d", desc->aa, MAX_AA);
    if (desc->background < HELIO_BACKGROUND_DEFAULT || desc->background > HELIO_BACKGROUND_NONE)
        return fail(HELIO_ERR_ARGUMENT, "background %d is unknown; use a value of helio_background",
                    (int)desc->background);
    if (desc->brdf_share != 0.0f)
        HELIO_TRY(estimate_check_share(desc->brdf_share));
    bool catcher = desc->scene->ground == HELIO_GROUND_SHADOW;
    if (catcher && desc->no_visibility)
        return fail(HELIO_ERR_ARGUMENT, "a shadow catcher shows nothing without shadow rays; leave no_visibility off");
    if (desc->background == HELIO_BACKGROUND_DEFAULT)
        desc->background = catcher ? HELIO_BACKGROUND_NONE : HELIO_BACKGROUND_ENVIRONMENT;
    return HELIO_OK;
}

static helio_status create_parts(helio_renderer *renderer)
{
    const helio_renderer_desc *desc = &renderer->desc;
    const helio_pools_desc pools = {.strategy = desc->strategy, .length = desc->pool_length};
    HELIO_TRY(helio_tables_create(desc->environment, desc->weighting, &renderer->tables));
    HELIO_TRY(helio_pools_create(renderer->tables, &pools, &renderer->pools));
    HELIO_TRY(film_create(renderer->context, desc->width, desc->height,
                          desc->background == HELIO_BACKGROUND_ENVIRONMENT, desc->aovs, &renderer->film));
    renderer->hits = context_allocate(renderer->context, (size_t)desc->width * desc->height, sizeof *renderer->hits);
    return renderer->hits ? HELIO_OK : HELIO_ERR_MEMORY;
}

helio_status helio_renderer_create(helio_context *context, const helio_renderer_desc *given, helio_renderer **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || given == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_renderer_create needs a context, a desc and a place for the result");
    helio_renderer_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    helio_renderer *renderer = context_allocate(context, 1, sizeof *renderer);
    if (renderer == NULL)
        return HELIO_ERR_MEMORY;
    renderer->context = context;
    renderer->desc = desc;
    helio_status status = create_parts(renderer);
    if (status != HELIO_OK) {
        helio_renderer_destroy(renderer);
        return status;
    }
    *out = renderer;
    return HELIO_OK;
}

void helio_renderer_destroy(helio_renderer *renderer)
{
    if (renderer == NULL)
        return;
    helio_context *context = renderer->context;
    context_release(context, renderer->hits);
    film_destroy(context, &renderer->film);
    helio_pools_destroy(renderer->pools);
    helio_tables_destroy(renderer->tables);
    context_release(context, renderer);
}

/* ---- the plan of a frame ---- */

/* Light samples of a camera sample come in this many parts, each from new pools. */
static uint32_t parts_per_camera_sample(const helio_renderer *renderer)
{
    uint32_t limit = helio_pools_sample_limit(renderer->pools);
    return (renderer->desc.spp + limit - 1) / limit;
}

/* Where one part is enough, several camera samples share a pass, so that all together take what one point may take. */
static uint32_t camera_samples_per_pass(const helio_renderer *renderer)
{
    uint32_t fitting = helio_pools_sample_limit(renderer->pools) / renderer->desc.spp;
    return fitting > 1 ? fitting : 1;
}

static uint32_t step_count(const helio_renderer *renderer)
{
    return renderer->desc.aa * parts_per_camera_sample(renderer);
}

static frame_step plan_step(const helio_renderer *renderer, uint32_t index)
{
    uint32_t parts = parts_per_camera_sample(renderer), spp = renderer->desc.spp;
    uint32_t part = index % parts;
    return (frame_step){
        .pass = parts > 1 ? index : index / camera_samples_per_pass(renderer),
        .camera_sample = index / parts,
        .part = part,
        .samples = (uint32_t)((uint64_t)spp * (part + 1) / parts - (uint64_t)spp * part / parts),
    };
}

uint32_t helio_renderer_passes(const helio_renderer *renderer)
{
    return plan_step(renderer, step_count(renderer) - 1).pass + 1;
}

/* ---- a frame ---- */

static double milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static size_t tile_count(const struct frame *frame)
{
    const struct film *film = &frame->renderer->film;
    return (size_t)frame->tiles_across * ((film->height + TILE - 1) / TILE);
}

static void run_batch(struct frame *frame, size_t tiles, helio_frame_info *info)
{
    helio_context *context = frame->renderer->context;
    double start = milliseconds();
    if (frame->step.part == 0)
        context_parallel_for(context, tiles, primary_tile, frame);
    double traced = milliseconds();
    context_parallel_for(context, tiles, shade_tile, frame);
    info->primary_ms += traced - start;
    info->shade_ms += milliseconds() - traced;
}

/* Batches of tiles, so that the caller hears of progress and can stop. */
static bool run_step(struct frame *frame, const helio_frame_desc *desc, float done, float part, helio_frame_info *info)
{
    size_t tiles = tile_count(frame);
    size_t batch = (size_t)BATCH_TILES * helio_context_threads(frame->renderer->context);
    for (size_t first = 0; first < tiles; first += batch) {
        frame->first_tile = first;
        run_batch(frame, tiles - first < batch ? tiles - first : batch, info);
        float fraction = (float)(first + batch < tiles ? first + batch : tiles) / (float)tiles;
        if (desc->progress != NULL && !desc->progress(desc->user, done + part * fraction))
            return false;
    }
    return true;
}

static helio_status run_steps(helio_renderer *renderer, struct frame *frame, const helio_frame_desc *desc,
                              helio_frame_info *info)
{
    uint32_t steps = step_count(renderer);
    for (uint32_t index = 0; index < steps && !info->stopped; index++) {
        frame->step = plan_step(renderer, index);
        if (frame->step.pass == info->passes) {
            double start = milliseconds();
            HELIO_TRY(helio_pools_draw(renderer->pools, desc->seed, frame->step.pass));
            info->pools_ms += milliseconds() - start;
            info->passes++;
        }
        frame->settings.samples = frame->step.samples;
        HELIO_TRY(estimate_resolve(renderer->pools, &frame->settings, &frame->estimate));
        info->stopped = !run_step(frame, desc, (float)index / (float)steps, 1.0f / (float)steps, info);
    }
    return HELIO_OK;
}

helio_status helio_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc, helio_frame_info *out)
{
    if (renderer == NULL || desc == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_renderer_render needs a renderer and a desc");
    const helio_renderer_desc *settings = &renderer->desc;
    helio_frame_info info = {0};
    camera_frame camera;
    HELIO_TRY(camera_frame_create(&desc->camera, (float)settings->width / (float)settings->height, &camera));
    double start = milliseconds();
    HELIO_TRY(helio_tables_update(renderer->tables));
    info.tables_ms = milliseconds() - start;

    struct frame frame = {
        .renderer = renderer,
        .camera = camera,
        .seed = hash(desc->seed),
        .tiles_across = (settings->width + TILE - 1) / TILE,
        .settings = {.brdf_share = settings->brdf_share,
                     .no_beta = settings->no_beta,
                     .visibility = shade_visibility(renderer),
                     .user = (void *)(uintptr_t)settings->scene},
    };
    film_clear(&renderer->film);
    HELIO_TRY(run_steps(renderer, &frame, desc, &info));
    film_develop(renderer->context, &renderer->film);
    info.samples = frame.samples;
    info.samples_useful = frame.useful;
    info.rays = frame.rays;
    info.points = frame.points;
    if (out != NULL)
        *out = info;
    return HELIO_OK;
}

helio_picture helio_renderer_picture(const helio_renderer *renderer)
{
    return film_picture(&renderer->film);
}
