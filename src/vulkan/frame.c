/* SPDX-License-Identifier: MIT
 *
 * A frame on a device: the cube goes up, tables and pools are made of it, points are found and lit, the picture comes
 * back.
 */
#include "vulkan/frame.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"
#include "env/environment.h"

#include <string.h>

/* ---- the numbers of a step ---------------------------------------------------------------- */

static void put_vectors(const vec3 *vectors, int count, float *to)
{
    for (int i = 0; i < count; i++)
        vec3_to(vectors[i], to + (size_t)i * 3);
}

static uint32_t ground_hit(const helio_scene *scene)
{
    if (scene->ground == HELIO_GROUND_NONE)
        return 0;
    return scene->ground == HELIO_GROUND_SHADOW ? LAYOUT_HIT_CATCHER : LAYOUT_HIT_PLANE;
}

static struct layout_step describe_step(const struct vulkan_renderer *v, const struct frame *frame, uint32_t seed)
{
    const helio_renderer_desc *desc = &frame->renderer->desc;
    const vec3 background[3] = {frame->background.corner, frame->background.across, frame->background.down};
    struct layout_step step = {
        .points = v->points.points.address,
        .materials = v->points.materials.address,
        .picture = v->picture.address,
        .object = v->object.address,
        .caught = v->caught.address,
        .misses = v->points.misses.address,
        .counts = v->counts.address,
        .origins = v->points.origins.address,
        .nodes = v->nodes.address,
        .triangles = v->triangles.address,
        .ground_hit = ground_hit(desc->scene),
        .intensity = desc->environment->intensity,
        .pool_seed = hash_combine(seed, frame->step.pass),
        .point_seed = frame->step_seed,
        .same_seed = desc->no_decorrelation,
        .samples = frame->step.samples,
        .brdf_share = estimate_brdf_share(desc->brdf_share),
        .no_beta = desc->no_beta,
        .control_part = estimate_control_part(desc->no_control, !desc->no_visibility),
        .normals = v->normals.address,
        .textures = v->textures.all.address,
        .surfaces = v->surfaces.address,
        .seen = v->raster.seen.address,
        .counts_of_lists = v->points.counts.address,
        .groups_of_lists = v->points.groups.address,
        .camera = {[12] = frame->camera.tan_half_fov, [13] = frame->camera.aspect},
        .ground_height = desc->scene->ground_height,
        .extent = desc->scene->extent,
        .sphere = {(float)desc->scene->centre[0], (float)desc->scene->centre[1], (float)desc->scene->centre[2],
                   (float)scene_far_squared(desc->scene)},
        .casts_rays = casts_rays(frame->renderer),
        .points_of_group = v->shape.points,
        .width = desc->width,
        .height = desc->height,
        .camera_seed = frame->seed,
        .camera_sample = desc->aa == 1 ? UINT32_MAX : frame->step.camera_sample,
        .is_first = frame->step.is_first,
        .is_last = frame->step.is_last,
        .shows_background = frame->renderer->film.shows_background,
        .weight = (float)frame->weight,
    };
    const vec3 camera[4] = {frame->camera.eye, frame->camera.forward, frame->camera.right, frame->camera.up};
    put_vectors(desc->environment->map_axes, 3, step.map_axes);
    put_vectors(background, 3, step.background);
    put_vectors(camera, 4, step.camera);
    return step;
}

/* ---- frames that are on their way --------------------------------------------------------- */

static uint64_t whole_count(const uint32_t halves[2])
{
    return (uint64_t)halves[1] << 32 | halves[0];
}

static void add_times(const vulkan_light *light, const frame_slot *slot, uint32_t index, helio_frame_info *info)
{
    const vulkan_commands *commands = &slot->commands;
    const step_marks *marks = &slot->marks;
    if (info->upload_ms == 0.0)
        info->upload_ms = light_send_milliseconds(light, index);
    info->upload_ms += commands_milliseconds(commands, marks->start, marks->uploaded);
    info->primary_ms += commands_milliseconds(commands, marks->uploaded, marks->traced);
    info->cube_ms += commands_milliseconds(commands, marks->traced, marks->cube);
    info->tables_ms += commands_milliseconds(commands, marks->cube, marks->tables);
    info->pools_ms += commands_milliseconds(commands, marks->tables, marks->pools);
    info->shade_ms += commands_milliseconds(commands, marks->pools, marks->shaded);
    info->read_back_ms += commands_milliseconds(commands, marks->shaded, marks->back);
}

/* What came back of the map itself. */
static void tell_light(const vulkan_light *light, uint32_t index, helio_frame_info *info)
{
    if (light->slots[index].is_map)
        info->bad = map_bad_pixels(&light->map, index);
    const struct layout_row_sum *flux = light_sums(light, index)->flux;
    for (int face = 0; face < CUBE_FACES; face++)
        info->flux[face] = tables_flux(light->state.size, (row_sum){flux[face].sum, flux[face].exponent});
}

/* Waits for the slot's list and learns what it took and counted. */
static helio_status finish_slot(struct vulkan_renderer *v, uint32_t index)
{
    frame_slot *slot = &v->slots[index];
    if (!slot->is_pending)
        return HELIO_OK;
    slot->is_pending = false;
    HELIO_TRY(commands_wait(&slot->commands));
    HELIO_TRY(commands_wait(&v->light.slots[index].upload));
    const struct layout_counts *counts = slot->counts_back.mapped;
    add_times(&v->light, slot, index, &slot->info);
    tell_light(&v->light, index, &slot->info);
    if (slot->counts_points)
        slot->info.points += *(const uint32_t *)slot->lists_back.mapped;
    slot->info.samples = whole_count(counts->samples);
    slot->info.samples_useful = whole_count(counts->useful);
    slot->info.rays = v->points.casts_rays ? slot->info.samples_useful : 0;
    v->latest_info = slot->info;
    return HELIO_OK;
}

/* The older one first. */
static helio_status finish_all(struct vulkan_renderer *v)
{
    HELIO_TRY(finish_slot(v, v->next));
    return finish_slot(v, 1 - v->next);
}

/* ---- camera rays -------------------------------------------------------------------------- */

static void trace_tile(void *data, size_t index)
{
    const struct frame *frame = data;
    primary_tile(frame, frame_tile(frame, index));
}

/* Adds what a tile's pixels see to their layers, and finishes these with the last camera sample. */
static void add_surfaces(void *data, size_t index)
{
    const struct frame *frame = data;
    const helio_renderer *renderer = frame->renderer;
    const struct film *film = &renderer->film;
    const struct tile tile = frame_tile(frame, index);
    for (uint32_t y = tile.y0; y < tile.y1; y++)
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            const size_t pixel = (size_t)y * film->width + x;
            film_surface sums = {0};
            helio_shading_point point;
            if (film->surfaces != NULL && frame->step.camera_sample > 0)
                sums = film->surfaces[pixel];
            if (renderer->hits.kinds[pixel] == HIT_OBJECT || renderer->hits.kinds[pixel] == HIT_PLANE) {
                shade_point(frame, pixel, (vec3){0, 0, 0}, &point);
                shade_add_surface(frame, &point, &sums);
            }
            if (film->surfaces != NULL)
                film->surfaces[pixel] = sums;
            if (frame->step.camera_sample + 1 == renderer->desc.aa)
                film_develop_surface(film, pixel, &sums);
        }
}

/* What the CPU does for the lists of points of a step, where it traces the camera rays. */
static helio_status trace_on_cpu(helio_renderer *renderer, struct frame *frame)
{
    renderer->hits.complete = false;
    context_parallel_for(renderer->context, frame->tile_count, trace_tile, frame);
    if (renderer->desc.aovs)
        context_parallel_for(renderer->context, frame->tile_count, add_surfaces, frame);
    renderer->hits.camera = frame->camera;
    renderer->hits.complete = renderer->desc.aa == 1;
    HELIO_TRY(finish_all(renderer->vulkan)); /* nobody copies the lists before */
    points_stage(&renderer->vulkan->points, frame);
    return HELIO_OK;
}

/* Are the lists of points those of this step, or are they yet to be made? */
static helio_status find_points(helio_renderer *renderer, struct frame *frame, bool keeps_hits, helio_frame_info *info)
{
    struct vulkan_renderer *v = renderer->vulkan;
    const double start = frame_milliseconds();
    v->has_points = keeps_hits || frame->step.part > 0;
    if (v->has_points)
        return HELIO_OK;
    v->seen.complete = false;
    if (!v->traces)
        HELIO_TRY(trace_on_cpu(renderer, frame));
    v->has_new_surfaces = finds_layers(v, renderer);
    v->seen.camera = frame->camera;
    v->seen.complete = renderer->desc.aa == 1;
    info->camera_rays += (uint64_t)renderer->desc.width * renderer->desc.height;
    info->primary_ms += v->traces ? 0.0 : frame_milliseconds() - start;
    return HELIO_OK;
}

/* ---- a step ------------------------------------------------------------------------------- */

static void record_primary(struct vulkan_renderer *v, const helio_renderer_desc *desc, vulkan_commands *commands,
                           primary_way way)
{
    const struct layout_push push = light_push(&v->light, v->step.address, 0);
    const uint64_t across = (desc->width + PRIMARY_EDGE - 1) / PRIMARY_EDGE;
    const uint64_t down = (desc->height + PRIMARY_EDGE - 1) / PRIMARY_EDGE;
    if (way == PRIMARY_BY_RASTER)
        raster_record(&v->raster, commands, &push);
    commands_dispatch(commands, way == PRIMARY_BY_RASTER ? v->primary_drawn : v->primary, &push, across * down);
}

/* Finds out which way is faster, by trying both twice: the first time is a warm-up. */
static helio_status choose_way(struct vulkan_renderer *v, frame_slot *slot, const struct frame *frame,
                               const helio_frame_desc *desc)
{
    static const primary_way ways[2] = {PRIMARY_BY_RAYS, PRIMARY_BY_RASTER};
    vulkan_commands *commands = &slot->commands;
    const struct layout_step step = describe_step(v, frame, desc->seed);
    uint32_t starts[2], ends[2];
    HELIO_TRY(commands_begin(commands));
    commands_write(commands, &v->step, &step, sizeof step);
    for (int i = 0; i < 4; i++) {
        commands_clear(commands, &v->points.counts);
        commands_barrier(commands);
        starts[i % 2] = commands_mark(commands);
        record_primary(v, &frame->renderer->desc, commands, ways[i % 2]);
        commands_barrier(commands);
        ends[i % 2] = commands_mark(commands);
    }
    HELIO_TRY(commands_submit(commands));
    HELIO_TRY(commands_wait(commands));
    const double by_rays = commands_milliseconds(commands, starts[0], ends[0]);
    const double by_raster = commands_milliseconds(commands, starts[1], ends[1]);
    v->way = by_raster < by_rays ? PRIMARY_BY_RASTER : PRIMARY_BY_RAYS;
    context_log(v->context, HELIO_LOG_INFO, "camera rays: %.3f ms by rays, %.3f ms by the rasteriser", by_rays,
                by_raster);
    return HELIO_OK;
}

/* The lists of points and misses: found by the device, or by the CPU and on their way. */
static void record_lists(struct vulkan_renderer *v, const helio_renderer_desc *desc, vulkan_commands *commands)
{
    const struct layout_push push = light_push(&v->light, v->step.address, MISSES_OF_GROUP);
    commands_label(commands, "camera rays");
    if (v->traces)
        record_primary(v, desc, commands, v->way);
    commands_barrier(commands);
    commands_dispatch(commands, v->list_groups, &push, 1);
    commands_barrier(commands);
    commands_label_end(commands);
}

static void record_shading(struct vulkan_renderer *v, vulkan_commands *commands)
{
    const struct layout_push push = light_push(&v->light, v->step.address, 0);
    const vulkan_buffer *groups = &v->points.groups;
    const uint64_t row = 3 * sizeof(uint32_t); /* of groups_of_lists */
    commands_label(commands, "shading");
    commands_dispatch_indirect(commands, v->shade, &push, groups, 0);
    if (v->shade_tiles != VK_NULL_HANDLE)
        commands_dispatch_indirect(commands, v->shade_tiles, &push, groups, row);
    commands_dispatch_indirect(commands, v->background, &push, groups, 2 * row);
    commands_barrier(commands);
    commands_label_end(commands);
}

/* Sums that are developed here: of a shadow catcher where a frame stopped, and of layers. */
static void record_sums(const struct vulkan_renderer *v, vulkan_commands *commands, bool has_stopped)
{
    if (has_stopped && v->catches)
        commands_copy(commands, &v->caught, &v->caught_back, v->caught.bytes);
    if (v->has_new_surfaces)
        commands_copy(commands, &v->surfaces, &v->surfaces_back, v->surfaces.bytes);
}

/* What a step has counted, and after the last the picture. */
static void record_read_back(const struct vulkan_renderer *v, frame_slot *slot, const helio_frame_desc *desc,
                             bool is_last)
{
    vulkan_commands *commands = &slot->commands;
    commands_copy(commands, &v->counts, &slot->counts_back, sizeof(struct layout_counts));
    commands_copy(commands, &v->points.counts, &slot->lists_back, 2 * sizeof(uint32_t));
    if (!is_last)
        return;
    read_back_record(&v->back, commands, desc);
    if (!desc->no_picture)
        record_sums(v, commands, false);
}

/* Starts with what the step needs that is not there yet: the tables of the frame, the pools of the pass, the points. */
static void record_step(struct vulkan_renderer *v, frame_slot *slot, const struct frame *frame,
                        const helio_frame_desc *desc, bool is_new_pass)
{
    vulkan_commands *commands = &slot->commands;
    step_marks *marks = &slot->marks;
    const struct layout_step step = describe_step(v, frame, desc->seed);
    marks->start = commands_mark(commands);
    commands_write(commands, &v->step, &step, sizeof step);
    if (frame->step.is_first)
        commands_clear(commands, &v->counts);
    if (!v->has_points && v->traces)
        commands_clear(commands, &v->points.counts);
    else if (!v->has_points)
        points_record_upload(&v->points, commands);
    commands_barrier(commands);
    marks->uploaded = commands_mark(commands);
    if (!v->has_points)
        record_lists(v, &frame->renderer->desc, commands);
    marks->traced = commands_mark(commands);
    if (frame->step.is_first)
        light_record_resampling(&v->light, commands);
    marks->cube = commands_mark(commands);
    if (frame->step.is_first) {
        light_record_tables(&v->light, commands);
        light_record_report(&v->light, commands);
    }
    marks->tables = commands_mark(commands);
    if (is_new_pass)
        light_record_pools(&v->light, commands, v->step.address, frame->step.is_first);
    marks->pools = commands_mark(commands);
    record_shading(v, commands);
    marks->shaded = commands_mark(commands);
    record_read_back(v, slot, desc, frame->step.is_last);
    marks->back = commands_mark(commands);
}

static helio_status run_step(struct vulkan_renderer *v, frame_slot *slot, const struct frame *frame,
                             const helio_frame_desc *desc)
{
    const bool is_new_pass = frame->step.pass == slot->info.passes;
    if (v->way == PRIMARY_BY_FASTER)
        HELIO_TRY(choose_way(v, slot, frame, desc));
    HELIO_TRY(commands_begin(&slot->commands));
    record_step(v, slot, frame, desc, is_new_pass);
    HELIO_TRY(commands_submit_between(&slot->commands, frame->step.is_first ? light_sent(&v->light) : VK_NULL_HANDLE,
                                      VK_NULL_HANDLE));
    if (frame->step.is_first)
        light_heard(&v->light);
    slot->is_pending = true;
    slot->counts_points = frame->step.part == 0;
    slot->info.passes += is_new_pass;
    return HELIO_OK;
}

/* ---- a frame ------------------------------------------------------------------------------ */

/* The sums that the steps have left in a pixel. */
static film_light sums_of_pixel(const struct vulkan_renderer *v, size_t pixel)
{
    const float *rgba = (const float *)v->back.picture_back.mapped + 4 * pixel;
    film_light sums = {.covered = (double)rgba[3],
                       .object = (double)((const float *)v->back.object_back.mapped)[pixel]};
    for (int c = 0; c < 3; c++)
        sums.rgb[c] = (double)rgba[c];
    if (v->catches) {
        const float *caught = (const float *)v->caught_back.mapped + 8 * pixel;
        for (int c = 0; c < 3; c++)
            sums.catcher_background[c] = (double)caught[c];
        sums.catcher = (double)caught[3];
        sums.reaching = (double)caught[4];
        sums.unoccluded = (double)caught[5];
    }
    return sums;
}

/* What a frame that stopped has in its pixels are sums. */
static void develop_stopped(helio_renderer *renderer, double weight)
{
    const struct film *film = &renderer->film;
    const size_t pixels = (size_t)film->width * film->height;
    for (size_t i = 0; i < pixels; i++) {
        const film_light sums = sums_of_pixel(renderer->vulkan, i);
        film_develop_light(&sums, film->shows_background, weight, film->rgba + 4 * i, film->object + i);
        if (film->surfaces != NULL)
            film_develop_surface(film, i, &film->surfaces[i]);
    }
}

/* The layers of a tile, of which the device has the sums. */
static void take_surfaces(void *data, size_t index)
{
    const struct frame *frame = data;
    const struct film *film = &frame->renderer->film;
    const float *all = frame->renderer->vulkan->surfaces_back.mapped;
    const struct tile tile = frame_tile(frame, index);
    for (uint32_t y = tile.y0; y < tile.y1; y++)
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            const size_t pixel = (size_t)y * film->width + x;
            const float *sums = all + 12 * pixel;
            film_surface surface = {.count = (double)sums[3], .depth = (double)sums[7]};
            for (size_t c = 0; c < 3; c++) {
                surface.albedo[c] = (double)sums[c];
                surface.normal[c] = (double)sums[4 + c];
                surface.position[c] = (double)sums[8 + c];
            }
            film_develop_surface(film, pixel, &surface);
        }
}

/* The sums of such a frame come back now, and the rest is done here. */
static helio_status take_stopped(helio_renderer *renderer, frame_slot *slot, const helio_frame_desc *desc,
                                 double weight)
{
    const struct vulkan_renderer *v = renderer->vulkan;
    const helio_frame_desc sums = {.no_picture = desc->no_picture};
    if (desc->no_picture)
        return HELIO_OK;
    HELIO_TRY(commands_begin(&slot->commands));
    read_back_record(&v->back, &slot->commands, &sums);
    record_sums(v, &slot->commands, true);
    HELIO_TRY(commands_submit(&slot->commands));
    HELIO_TRY(commands_wait(&slot->commands));
    read_back_take(&v->back, &sums, &renderer->film);
    develop_stopped(renderer, weight);
    if (desc->shown != NULL)
        film_show(renderer->context, &renderer->film, desc->shown);
    return HELIO_OK;
}

static helio_status take_picture(helio_renderer *renderer, frame_slot *slot, struct frame *frame,
                                 const helio_frame_desc *desc)
{
    struct vulkan_renderer *v = renderer->vulkan;
    if (slot->info.stopped && !frame->step.is_last)
        HELIO_TRY(take_stopped(renderer, slot, desc, frame->weight));
    else
        read_back_take(&v->back, desc, &renderer->film);
    if (v->has_new_surfaces && !desc->no_picture) {
        context_parallel_for(renderer->context, frame->tile_count, take_surfaces, frame);
        v->has_new_surfaces = false;
    }
    return HELIO_OK;
}

/* All steps but the last are waited for, so that progress can be told. */
static helio_status run_steps(helio_renderer *renderer, uint32_t index, struct frame *frame,
                              const helio_frame_desc *desc)
{
    struct vulkan_renderer *v = renderer->vulkan;
    helio_frame_info *info = &v->slots[index].info;
    const uint32_t steps = frame_step_count(renderer);
    const bool keeps_hits = !desc->retrace && hits_belong_to(&v->seen, &frame->camera);
    for (uint32_t step = 0; step < steps && !info->stopped; step++) {
        frame->step = frame_plan_step(renderer, step);
        frame->weight += frame->step.samples;
        frame->step_seed = hash_combine(hash_combine(frame->seed, frame->step.camera_sample), frame->step.part);
        HELIO_TRY(find_points(renderer, frame, keeps_hits, info));
        HELIO_TRY(run_step(v, &v->slots[index], frame, desc));
        if (step + 1 < steps || !desc->no_picture)
            HELIO_TRY(finish_slot(v, index));
        info->stopped = desc->progress != NULL && !desc->progress(desc->user, (float)(step + 1) / (float)steps);
    }
    if (!v->slots[index].is_pending) /* which was over before it was known that it would be stopped */
        v->latest_info = *info;
    return HELIO_OK;
}

helio_status vulkan_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc, helio_frame_info *info)
{
    struct vulkan_renderer *v = renderer->vulkan;
    const uint32_t index = v->next;
    camera_frame camera;
    if (renderer->desc.environment->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "the environment holds no map yet; call helio_environment_update first");
    HELIO_TRY(camera_frame_create(&desc->camera, (float)renderer->desc.width / (float)renderer->desc.height, &camera));
    struct frame frame = frame_begin(renderer, &camera, desc->seed);
    HELIO_TRY(finish_slot(v, index));
    v->slots[index].info = (helio_frame_info){0};
    HELIO_TRY(light_send(&v->light, index));
    const helio_status status = run_steps(renderer, index, &frame, desc);
    if (status != HELIO_OK) {
        v->seen.complete = false; /* nobody knows how far it came */
        return status;
    }
    v->next = 1 - index;
    HELIO_TRY(take_picture(renderer, &v->slots[index], &frame, desc));
    *info = desc->no_picture ? v->latest_info : v->slots[index].info;
    return HELIO_OK;
}
