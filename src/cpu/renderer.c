/* SPDX-License-Identifier: MIT
 *
 * The pipeline of one frame: tables, then for each pass pools, camera rays and shading, then the picture. */
#include "cpu/renderer.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "env/environment.h"
#include "image/tonemap.h"
#include "sampling/estimate.h"
#include "sampling/strategy.h"
#include "vulkan/renderer.h"

enum { MAX_SIZE = 16384, MAX_SPP = 1 << 20, MAX_AA = 4096 };

/* Samples in a pool of a bin of normals, where nobody says how many. */
enum { LEAST_LENGTH_OF_BIN = 128, GREATEST_LENGTH_OF_BIN = 1024 };

/* How often the caller hears of progress, roughly. */
static const double SLICE_MS = 75.0;

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

uint32_t frame_step_count(const helio_renderer *renderer)
{
    return renderer->desc.aa * parts_per_camera_sample(renderer);
}

frame_step frame_plan_step(const helio_renderer *renderer, uint32_t index)
{
    uint32_t parts = parts_per_camera_sample(renderer), spp = renderer->desc.spp;
    uint32_t part = index % parts;
    return (frame_step){
        .pass = parts > 1 ? index : index / camera_samples_per_pass(renderer),
        .camera_sample = index / parts,
        .part = part,
        .samples = (uint32_t)((uint64_t)spp * (part + 1) / parts - (uint64_t)spp * part / parts),
        .is_first = index == 0,
        .is_last = index + 1 == frame_step_count(renderer),
    };
}

uint32_t helio_renderer_passes(const helio_renderer *renderer)
{
    return frame_plan_step(renderer, frame_step_count(renderer) - 1).pass + 1;
}

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

/* M for pools of bins: so long that one pass holds all samples of a pixel, as samples of one pool are spread out more
 * evenly than those of several; pools then cost a part of a frame that hardly depends on its samples. For others 0, the
 * default. */
static uint32_t pool_length_for(const helio_renderer_desc *desc)
{
    const helio_strategy strategy = helio_strategy_resolve(desc->strategy);
    const uint64_t samples = (uint64_t)desc->spp * desc->aa;
    uint32_t length = LEAST_LENGTH_OF_BIN;
    if (strategy_divide(strategy).light != STRATEGY_LIGHT_BINS)
        return 0;
    while (length < POOL_SHARE_OF_BIN * samples && length < GREATEST_LENGTH_OF_BIN)
        length *= 2;
    return length;
}

static helio_status create_parts(helio_renderer *renderer)
{
    const helio_renderer_desc *desc = &renderer->desc;
    const helio_pools_desc pools = {.strategy = desc->strategy,
                                    .length = desc->pool_length != 0 ? desc->pool_length : pool_length_for(desc),
                                    .bins = desc->bins};
    HELIO_TRY(helio_tables_create(desc->environment, desc->weighting, &renderer->tables));
    HELIO_TRY(helio_pools_create(renderer->tables, &pools, &renderer->pools));
    const film_desc film = {
        .width = desc->width,
        .height = desc->height,
        .shows_background = desc->background == HELIO_BACKGROUND_ENVIRONMENT,
        .has_surfaces = desc->aovs,
        .has_steps = (desc->device == NULL || renderer->extras.cpu_rays) &&
                     (frame_step_count(renderer) > 1 || renderer->extras.keeps_sums),
    };
    HELIO_TRY(film_create(renderer->context, &film, &renderer->film));
    HELIO_TRY(hits_create(renderer->context, desc->scene, desc->width, desc->height, &renderer->hits));
    return desc->device != NULL ? vulkan_renderer_create(renderer) : HELIO_OK;
}

helio_status renderer_create(helio_context *context, const helio_renderer_desc *given, const renderer_extras *extras,
                             helio_renderer **out)
{
    helio_renderer_desc desc;
    *out = NULL;
    HELIO_TRY(resolve_desc(given, &desc));
    helio_renderer *renderer = context_allocate(context, 1, sizeof *renderer);
    if (renderer == NULL)
        return HELIO_ERR_MEMORY;
    renderer->context = context;
    renderer->desc = desc;
    renderer->extras = *extras;
    helio_status status = create_parts(renderer);
    if (status != HELIO_OK) {
        helio_renderer_destroy(renderer);
        return status;
    }
    *out = renderer;
    return HELIO_OK;
}

helio_status helio_renderer_create(helio_context *context, const helio_renderer_desc *desc, helio_renderer **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || desc == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_renderer_create needs a context, a desc and a place for the result");
    return renderer_create(context, desc, &(renderer_extras){0}, out);
}

void helio_renderer_destroy(helio_renderer *renderer)
{
    if (renderer == NULL)
        return;
    helio_context *context = renderer->context;
    vulkan_renderer_destroy(renderer->vulkan);
    hits_destroy(context, &renderer->hits);
    film_destroy(context, &renderer->film);
    helio_pools_destroy(renderer->pools);
    helio_tables_destroy(renderer->tables);
    context_release(context, renderer);
}

/* ---- a frame ---- */

/* Tells whether to go on. */
static bool run_step(struct frame *frame, const helio_frame_desc *desc, helio_frame_info *info, float done, float part)
{
    double slice_ms = desc->progress != NULL ? SLICE_MS : HUGE_VAL;
    size_t tiles_done;
    frame->next_tile = 0;
    do {
        tiles_done = frame_work(frame, slice_ms, info);
        float fraction = (float)tiles_done / (float)frame->tile_count;
        info->stopped = desc->progress != NULL && !desc->progress(desc->user, done + part * fraction);
    } while (!info->stopped && tiles_done < frame->tile_count);
    if (info->stopped)
        frame_finish(frame, tiles_done);
    return tiles_done == frame->tile_count;
}

helio_status frame_begin_step(helio_renderer *renderer, struct frame *frame, uint32_t index, bool keeps_hits)
{
    frame->step = frame_plan_step(renderer, index);
    frame->weight += frame->step.samples;
    frame->step_seed = hash_combine(hash_combine(frame->seed, frame->step.camera_sample), frame->step.part);
    frame->traces = frame->step.part == 0 && !keeps_hits;
    frame->settings.samples = frame->step.samples;
    return estimate_resolve(renderer->pools, &frame->settings, &frame->estimate);
}

static helio_status run_steps(helio_renderer *renderer, struct frame *frame, const helio_frame_desc *desc,
                              helio_frame_info *info)
{
    uint32_t steps = frame_step_count(renderer);
    bool keeps_hits = !desc->retrace && hits_belong_to(&renderer->hits, &frame->camera);
    for (uint32_t index = 0; index < steps && !info->stopped; index++) {
        if (frame_plan_step(renderer, index).pass == info->passes) {
            double start = frame_milliseconds();
            HELIO_TRY(helio_pools_draw(renderer->pools, desc->seed, info->passes));
            info->pools_ms += frame_milliseconds() - start;
            info->passes++;
        }
        HELIO_TRY(frame_begin_step(renderer, frame, index, keeps_hits));
        if (frame->traces)
            renderer->hits.complete = false;
        bool is_done = run_step(frame, desc, info, (float)index / (float)steps, 1.0f / (float)steps);
        if (frame->traces && is_done && renderer->desc.aa == 1) {
            renderer->hits.camera = frame->camera;
            renderer->hits.complete = true;
        }
    }
    return HELIO_OK;
}

struct frame frame_begin(const helio_renderer *renderer, const camera_frame *camera, uint32_t seed)
{
    const helio_renderer_desc *desc = &renderer->desc;
    size_t tiles_across = (desc->width + TILE - 1) / TILE;
    return (struct frame){
        .renderer = renderer,
        .camera = *camera,
        .background = background_prepare(desc->environment, kernels_of(context_isa(renderer->context)), camera,
                                         desc->width, desc->height),
        .seed = hash(seed),
        .tiles_across = tiles_across,
        .tile_count = tiles_across * ((desc->height + TILE - 1) / TILE),
        .settings = {.brdf_share = desc->brdf_share,
                     .no_beta = desc->no_beta,
                     .no_control = desc->no_control,
                     .visibility = shade_visibility(renderer),
                     .user = (void *)(uintptr_t)desc->scene},
    };
}

static helio_status render_on_cpu(helio_renderer *renderer, const helio_frame_desc *desc, helio_frame_info *info)
{
    camera_frame camera;
    HELIO_TRY(camera_frame_create(&desc->camera, (float)renderer->desc.width / (float)renderer->desc.height, &camera));
    double start = frame_milliseconds();
    HELIO_TRY(helio_tables_update(renderer->tables));
    info->tables_ms = frame_milliseconds() - start;
    helio_tables_flux(renderer->tables, info->flux);
    struct frame frame = frame_begin(renderer, &camera, desc->seed);
    HELIO_TRY(run_steps(renderer, &frame, desc, info));
    info->samples = frame.samples;
    info->samples_useful = frame.useful;
    info->rays = frame.rays;
    info->points = frame.points;
    info->camera_rays = frame.camera_rays;
    if (desc->shown != NULL)
        film_show(renderer->context, &renderer->film, desc->shown);
    return HELIO_OK;
}

helio_status helio_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc, helio_frame_info *out)
{
    helio_frame_info info = {0};
    if (renderer == NULL || desc == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_renderer_render needs a renderer and a desc");
    if (desc->shown != NULL)
        HELIO_TRY(tonemap_check(desc->shown, "a frame"));
    if (renderer->vulkan != NULL)
        HELIO_TRY(vulkan_renderer_render(renderer, desc, &info));
    else
        HELIO_TRY(render_on_cpu(renderer, desc, &info));
    if (renderer->vulkan == NULL || !desc->no_picture) {
        renderer->has_shown = desc->shown != NULL;
        renderer->has_no_radiance = desc->no_radiance;
    }
    if (out != NULL)
        *out = info;
    return HELIO_OK;
}

helio_picture helio_renderer_picture(const helio_renderer *renderer)
{
    helio_picture picture = film_picture(&renderer->film);
    if (!renderer->has_shown)
        picture.shown = NULL;
    if (renderer->has_no_radiance)
        picture.rgba = picture.object = NULL;
    return picture;
}
