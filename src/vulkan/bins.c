/* SPDX-License-Identifier: MIT
 *
 * Pools of bins of normals on a device. Where tiles and bins lie is the CPU's work, at creation. */
#include "core/context.h"
#include "core/error.h"
#include "sampling/point_tiles.h"
#include "vulkan/light.h"

enum { THREADS = 64, THREADS_OF_TILE = 32, BINS_OF_SOFTWARE = 4 };
_Static_assert(sizeof(control_matrix) == LAYOUT_CONTROL_ROWS * 4 * sizeof(float) &&
                   (int)LAYOUT_CONTROL_CHUNK == (int)CONTROL_CHUNK,
               "as in control.h");
_Static_assert((int)LAYOUT_TILE_GROUP == (int)TILE_GROUP && (int)LAYOUT_TILE_RUN == (int)TILE_RUN &&
                   (int)LAYOUT_TILES_MOST == (int)TILES_MOST && (int)LAYOUT_REFINED_PARTS == (int)POINT_REFINED_PARTS &&
                   (int)LAYOUT_REFINED_TIMES == (int)POINT_REFINED_TIMES,
               "as in tiles.h and point_tiles.h");
_Static_assert((int)LAYOUT_LOBE_CLASSES == (int)LOBE_CLASSES, "as in lobe_variance.h");

/* ---- creation ----------------------------------------------------------------------------- */

/* May the strategy be left where the light is even? */
static bool is_automatic(const vulkan_light *light)
{
    return light->shape->is_automatic;
}

/* Will points ask how uneven the light in their lobes is? */
static bool has_lobes(const vulkan_light *light)
{
    return light->shape->bins->lobe_variances != NULL;
}

static helio_status create_buffers(vulkan_light *light)
{
    const normal_bins *bins = light->shape->bins;
    const tiles *t = bins->tiles;
    const uint64_t segments = CUBE_FACES * (uint64_t)t->size * t->per_edge;
    const light_buffer all[] = {
        {&light->tile_grid, BUFFER_ON_DEVICE, t->count, sizeof(uint32_t), "the order of tiles"},
        {&light->tile_positions, BUFFER_ON_DEVICE, t->count, sizeof(uint32_t), "the order of tiles"},
        {&light->tiles, BUFFER_ON_DEVICE, t->count, 4 * sizeof(float), "the tiles"},
        {&light->tile_totals, BUFFER_ON_DEVICE, t->count, sizeof(struct layout_row_sum), "the sums of tiles"},
        {&light->tile_sums, BUFFER_ON_DEVICE, (uint64_t)t->count * t->stride, sizeof(uint32_t), "the rows of tiles"},
        {&light->segment_densities, BUFFER_ON_DEVICE, segments, sizeof(float), "the densities of tiles"},
        {&light->tile_spreads, BUFFER_ON_DEVICE, t->count, sizeof(float), "the spreads of tiles"},
        {&light->tile_angles, BUFFER_ON_DEVICE, t->count, sizeof(float), "the angles of tiles"},
        {&light->groups, BUFFER_ON_DEVICE, t->groups.count, LAYOUT_GROUP_ROWS * 4 * sizeof(float),
         "the groups of tiles"},
        {&light->bins, BUFFER_ON_DEVICE, bins->count, 4 * sizeof(float), "the bins"},
        {&light->bin_sums, BUFFER_ON_DEVICE, (uint64_t)bins->count * (t->count + 1), sizeof(uint32_t),
         "the sums of bins"},
        {&light->bin_shares, BUFFER_ON_DEVICE, bins->count, sizeof(float), "the shares of bins"},
        {&light->lobe_variances, BUFFER_ON_DEVICE, has_lobes(light) ? bins->count : 0, LOBE_CLASSES * sizeof(float),
         "the light in lobes"},
        {&light->greatest, BUFFER_ON_DEVICE, t->count, sizeof(float), "the probabilities of tiles"},
        {&light->list_starts, BUFFER_ON_DEVICE, t->count + 1, sizeof(uint32_t), "the lengths of lists"},
        {&light->moments, BUFFER_ON_DEVICE, is_automatic(light) ? t->count : 0, 3 * sizeof(float),
         "the moments of tiles"},
        {&light->tile_light, BUFFER_ON_DEVICE, t->count, sizeof(control_matrix), "the known light of tiles"},
        {&light->tile_hues, BUFFER_ON_DEVICE, t->count + 1, 4 * sizeof(float), "the hues of tiles"},
        {&light->known, BUFFER_ON_DEVICE, bins->count, sizeof(control_matrix), "the known light of bins"},
        {&light->control_sums, BUFFER_ON_DEVICE, bins->count * (light->shape->control->chunks + (uint64_t)1),
         sizeof(control_matrix), "the sums of pools"},
        {&light->listed, BUFFER_ON_DEVICE, 2 * (uint64_t)bins->capacity, 4 * sizeof(float), "the lists of tiles"},
    };
    return light_create_buffers(light, all, sizeof all / sizeof *all);
}

static void tell(vulkan_light *light)
{
    const normal_bins *bins = light->shape->bins;
    struct layout_state *state = &light->state;
    state->tile_grid = light->tile_grid.address;
    state->tile_positions = light->tile_positions.address;
    state->tiles = light->tiles.address;
    state->tile_totals = light->tile_totals.address;
    state->tile_sums = light->tile_sums.address;
    state->segment_densities = light->segment_densities.address;
    state->tile_spreads = light->tile_spreads.address;
    state->tile_angles = light->tile_angles.address;
    state->lobe_variances = light->lobe_variances.address;
    state->bins = light->bins.address;
    state->bin_sums = light->bin_sums.address;
    state->bin_shares = light->bin_shares.address;
    state->greatest = light->greatest.address;
    state->list_starts = light->list_starts.address;
    state->listed = light->listed.address;
    state->moments = light->moments.address;
    state->tile_light = light->tile_light.address;
    state->tile_hues = light->tile_hues.address;
    state->known = light->known.address;
    state->control_sums = light->control_sums.address;
    state->groups = light->groups.address;
    state->is_automatic = is_automatic(light);
    state->tiles_per_edge = bins->tiles->per_edge;
    state->tile_count = bins->tiles->count;
    state->tile_stride = bins->tiles->stride;
    state->bins_per_edge = bins->per_edge;
    state->bin_count = bins->count;
    state->list_capacity = bins->capacity;
    state->shake = bins->shake;
    state->tile_radius = bins->tiles->radius;
    state->tile_edge = bins->tiles->edge;
}

/* Of a work group, see known.comp. */
static uint32_t bins_at_once(const vulkan_light *light)
{
    return device_is_software(light->device) ? BINS_OF_SOFTWARE : 1;
}

static helio_status create_passes(vulkan_light *light)
{
    const uint32_t threads = light_threads(light);
    const struct {
        light_pass pass;
        pipeline_desc desc;
    } all[] = {
        {PASS_MOMENTS, {"moments", 1, {threads}}},
        {PASS_EVENNESS, {"evenness", 1, {threads}}},
        {PASS_TILES, {"tiles", 1, {threads < THREADS_OF_TILE ? threads : THREADS_OF_TILE}}},
        {PASS_TILE_LIGHT, {"tile_light", 1, {threads}}},
        {PASS_BINS, {"bins", 1, {threads}}},
        {PASS_LOBES, {"lobes", 1, {threads}}},
        {PASS_GREATEST, {"greatest", 1, {THREADS}}},
        {PASS_LISTS, {"lists", 1, {threads}}},
        {PASS_DRAW_LISTS, {"draw_lists", 1, {THREADS}}},
        {PASS_DRAW_BINS, {"draw_bins", 1, {THREADS}}},
        {PASS_TILE_CONTROL, {"tile_control", 1, {threads}}},
        {PASS_KNOWN, {"known", 2, {threads, bins_at_once(light)}}},
        {PASS_CONTROL_SUMS, {"control_sums", 1, {threads < THREADS ? threads : THREADS}}},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        HELIO_TRY(pipeline_create(light->device, &all[i].desc, &light->passes[all[i].pass]));
    return HELIO_OK;
}

/* Where tiles and bins lie, as the shaders have it. */
typedef struct geometry {
    uint32_t grid[TILES_MOST], positions[TILES_MOST];
    float tiles[TILES_MOST][4], angles[TILES_MOST];
    float groups[TILE_GROUPS][LAYOUT_GROUP_ROWS][4];
    float bins[CUBE_FACES * NORMAL_BINS_MOST * NORMAL_BINS_MOST][4];
} geometry;

static void fill_geometry(const normal_bins *bins, geometry *g)
{
    const tiles *t = bins->tiles;
    for (uint32_t i = 0; i < t->count; i++) {
        g->grid[i] = t->grid[i];
        g->positions[i] = t->positions[i];
        g->tiles[i][0] = t->x[i];
        g->tiles[i][1] = t->y[i];
        g->tiles[i][2] = t->z[i];
        g->angles[i] = t->angle[i];
    }
    for (uint32_t i = 0; i < t->groups.count; i++) {
        vec3_to((vec3){t->groups.x[i], t->groups.y[i], t->groups.z[i]}, g->groups[i][0]);
        g->groups[i][0][3] = t->groups.edge[i];
        g->groups[i][2][3] = t->groups.inner[i];
    }
    for (uint32_t i = 0; i < bins->count; i++) {
        vec3_to(bins->bins[i].centre, g->bins[i]);
        g->bins[i][3] = bins->bins[i].reach;
    }
}

static helio_status upload_geometry(vulkan_light *light, vulkan_commands *commands, const geometry *g)
{
    const uint32_t tile_count = light->state.tile_count, bin_count = light->state.bin_count;
    HELIO_TRY(commands_upload(commands, &light->tile_grid, g->grid, tile_count * sizeof *g->grid));
    HELIO_TRY(commands_upload(commands, &light->tile_positions, g->positions, tile_count * sizeof *g->positions));
    HELIO_TRY(commands_upload(commands, &light->tiles, g->tiles, tile_count * sizeof *g->tiles));
    HELIO_TRY(commands_upload(commands, &light->tile_angles, g->angles, tile_count * sizeof *g->angles));
    HELIO_TRY(commands_upload(commands, &light->groups, g->groups,
                              light->shape->bins->tiles->groups.count * sizeof *g->groups));
    return commands_upload(commands, &light->bins, g->bins, bin_count * sizeof *g->bins);
}

helio_status light_create_bins(vulkan_light *light, vulkan_commands *commands)
{
    helio_context *context = light->device->context;
    HELIO_TRY(create_buffers(light));
    HELIO_TRY(create_passes(light));
    tell(light);
    geometry *g = context_allocate(context, 1, sizeof *g);
    if (g == NULL)
        return HELIO_ERR_MEMORY;
    fill_geometry(light->shape->bins, g);
    helio_status status = upload_geometry(light, commands, g);
    context_release(context, g);
    return status;
}

/* ---- a frame ------------------------------------------------------------------------------ */

static uint64_t groups(uint64_t threads)
{
    return (threads + THREADS - 1) / THREADS;
}

/* What follows from the tables alone. */
static void record_weights(vulkan_light *light, vulkan_commands *commands)
{
    const struct layout_state *state = &light->state;
    const uint32_t at_once = bins_at_once(light);
    const struct layout_push push = light_push(light, 0, 0);
    const struct layout_push greatest = light_push(light, 0, normal_bins_step(light->shape->bins));
    struct layout_push lists = light_push(light, 0, LIST_FACTOR * light->shape->bins->pool_length);
    lists.parameter[1] = LIST_LEAST;
    if (is_automatic(light)) {
        commands_dispatch(commands, light->passes[PASS_MOMENTS], &push, state->tile_count);
        commands_barrier(commands);
        commands_dispatch(commands, light->passes[PASS_EVENNESS], &push, CUBE_FACES);
    }
    commands_dispatch(commands, light->passes[PASS_TILE_CONTROL], &push, state->tile_count);
    commands_dispatch(commands, light->passes[PASS_TILES], &push, state->tile_count);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_TILE_LIGHT], &push, 1);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_KNOWN], &push, (state->bin_count + at_once - 1) / at_once);
    commands_dispatch(commands, light->passes[PASS_BINS], &push, state->bin_count);
    if (has_lobes(light))
        commands_dispatch(commands, light->passes[PASS_LOBES], &push, state->bin_count);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_GREATEST], &greatest, groups(state->tile_count));
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_LISTS], &lists, 1);
    commands_barrier(commands);
}

void light_record_bins(vulkan_light *light, vulkan_commands *commands, uint64_t step, bool is_first_pass)
{
    const struct layout_push push = light_push(light, step, 0);
    const struct layout_push draw = light_push(light, step, pools_run_of_bin(light->shape));
    if (is_first_pass)
        record_weights(light, commands);
    commands_dispatch(commands, light->passes[PASS_DRAW_LISTS], &push, groups(light->state.list_capacity));
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_DRAW_BINS], &draw, groups(light->state.pool_stride));
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_CONTROL_SUMS], &push, light->state.bin_count);
}
