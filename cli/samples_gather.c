/* SPDX-License-Identifier: MIT
 *
 * What the renderer does at a pixel, asked step by step: which samples it takes, and what becomes of them. */
#include "face.h"
#include "samples.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_RAYS = 64 }; /* in one call of a visibility function */

/* ---- memory ------------------------------------------------------------------------------- */

bool samples_make(samples_findings *found, const render_job *job)
{
    const helio_pools *pools = helio_renderer_pools(job->renderer);
    *found = (samples_findings){
        .source = job->plan.light.specification,
        .is_dynamic = job->source_info.is_dynamic,
        .strategy = helio_strategy_resolve(job->plan.strategy),
        .passes = helio_renderer_steps(job->renderer),
        .pool_count = helio_pools_techniques(pools),
        .capacity = job->plan.options->spp,
    };
    found->samples = malloc(found->capacity * sizeof *found->samples);
    return found->samples != NULL;
}

void samples_release(samples_findings *found)
{
    free(found->pools);
    free(found->samples);
    *found = (samples_findings){0};
}

/* ---- one step ----------------------------------------------------------------------------- */

/* A step of the pixel while its samples are looked at. */
typedef struct gathered_step {
    const helio_environment *environment;
    const helio_pools *pools;
    uint32_t number;
    double share; /* of all samples of the pixel */
    const helio_pixel_step *pixel;
    helio_counts counts;
    helio_sample *samples; /* [count] */
    uint32_t count;
} gathered_step;

/* Appends what a pool holds. */
static helio_status read_pool(samples_findings *found, const helio_pools *pools, uint32_t pool, uint32_t length)
{
    helio_pool_sample *grown = realloc(found->pools, ((size_t)found->pooled + length + 1) * sizeof *found->pools);
    if (grown == NULL)
        return HELIO_ERR_MEMORY;
    found->pools = grown;
    helio_pool_sample *to = found->pools + found->pooled;
    helio_status status = helio_pools_read(pools, pool, 0, length, to);
    for (uint32_t i = 0; status == HELIO_OK && i < length; i++)
        if (to[i].density > 0) /* there is none in a pool without light */
            found->pools[found->pooled++] = to[i];
    return status;
}

/* Those that the point reads. */
static helio_status read_pools(samples_findings *found, const gathered_step *step)
{
    helio_status status = HELIO_OK;
    for (uint32_t k = 0; k < found->pool_count && status == HELIO_OK; k++) {
        const uint32_t pool = step->counts.pool[k];
        const bool is_of_tiles = pool == HELIO_POOL_OF_TILES;
        const uint32_t length = is_of_tiles ? helio_pools_listed(step->pools) : helio_pools_length(step->pools);
        found->reads_tiles |= is_of_tiles;
        found->reads_pools |= !is_of_tiles;
        found->pool_length = length > found->pool_length ? length : found->pool_length;
        status = read_pool(found, step->pools, pool, length);
    }
    return status;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* As long as nothing is known of shadows. */
static sample_fate judge(const helio_shading_point *point, const helio_sample *sample)
{
    const float *rgb = sample->contribution;
    if (rgb[0] != 0 || rgb[1] != 0 || rgb[2] != 0) /* below 0 where what is left out as known is more */
        return SAMPLE_USED;
    bool is_above = dot(point->normal, sample->direction) > 0 && dot(point->geometric_normal, sample->direction) > 0;
    return is_above ? SAMPLE_DARK : SAMPLE_BELOW;
}

static void find_texel(const helio_environment *environment, point_sample *sample)
{
    const double direction[3] = {(double)sample->direction[0], (double)sample->direction[1],
                                 (double)sample->direction[2]};
    uint32_t size = helio_environment_cube_size(environment);
    size_t texel = face_texel(size, direction);
    sample->column = (uint32_t)(texel % size);
    sample->row = (uint32_t)(texel / size % size);
    sample->face = (uint32_t)(texel / size / size);
}

static point_sample describe(const samples_findings *found, const gathered_step *step, const helio_sample *sample)
{
    point_sample described = {
        .density = (double)sample->density / step->share,
        .technique = sample->technique,
        .pass = step->number,
        .fate = judge(&step->pixel->point, sample),
    };
    memcpy(described.world_direction, sample->direction, sizeof described.world_direction);
    for (int c = 0; c < 3; c++)
        described.contribution[c] = (double)sample->contribution[c] * step->share;
    if (sample->technique < found->pool_count) {
        described.pool = sample->technique;
        described.number = sample->number;
        described.is_of_tiles = step->counts.pool[sample->technique] == HELIO_POOL_OF_TILES;
        helio_pool_sample pooled = {0}; /* as it is there, not turned to and fro */
        helio_pools_read(step->pools, step->counts.pool[sample->technique], sample->number, 1, &pooled);
        memcpy(described.direction, pooled.direction, sizeof described.direction);
    } else {
        helio_environment_to_map(step->environment, sample->direction, described.direction);
    }
    find_texel(step->environment, &described);
    return described;
}

/* Asks for as many rays at once as the renderer does, so that it is told the same. samples: [count] */
static void find_shadows(const helio_pixel_step *pixel, point_sample *samples, uint32_t count)
{
    float x[MOST_RAYS], y[MOST_RAYS], z[MOST_RAYS];
    point_sample *asked[MOST_RAYS];
    bool visible[MOST_RAYS];
    uint32_t rays = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (samples[i].fate != SAMPLE_USED)
            continue;
        x[rays] = samples[i].world_direction[0];
        y[rays] = samples[i].world_direction[1];
        z[rays] = samples[i].world_direction[2];
        asked[rays++] = &samples[i];
    }
    if (rays > 0)
        pixel->estimate.visibility(pixel->estimate.user, &pixel->point, rays, x, y, z, visible);
    for (uint32_t i = 0; i < rays; i++)
        if (!visible[i])
            asked[i]->fate = SAMPLE_SHADOWED;
}

static void count_sample(samples_findings *found, const point_sample *sample)
{
    technique_count *const counts[] = {&found->techniques[sample->technique], &found->all};
    for (int i = 0; i < 2; i++) {
        counts[i]->realised++;
        counts[i]->fates[sample->fate]++;
    }
    found->fallen[sample->face]++;
    for (int c = 0; c < 3 && sample->fate == SAMPLE_USED; c++)
        found->radiance[c] += sample->contribution[c];
}

static void add_step(samples_findings *found, const gathered_step *step)
{
    point_sample *samples = found->samples + found->sample_count;
    for (uint32_t i = 0; i < step->count; i++)
        samples[i] = describe(found, step, &step->samples[i]);
    for (uint32_t first = 0; step->pixel->estimate.visibility != NULL && first < step->count; first += MOST_RAYS)
        find_shadows(step->pixel, samples + first, step->count - first < MOST_RAYS ? step->count - first : MOST_RAYS);
    for (uint32_t i = 0; i < step->count; i++)
        count_sample(found, &samples[i]);
    for (int c = 0; c < 3; c++) {
        const double control = (double)step->counts.control[c] * step->share;
        found->control[c] += control;
        found->radiance[c] += control;
    }
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++) {
        found->techniques[technique].expected += (double)step->counts.expected[technique];
        found->all.expected += (double)step->counts.expected[technique];
    }
    found->sample_count += step->count;
}

static helio_status gather_step(samples_findings *found, render_job *job, const helio_frame_desc *frame,
                                uint32_t number, helio_sample *samples)
{
    helio_pixel_step pixel;
    gathered_step step = {.environment = job->environment,
                          .pools = helio_renderer_pools(job->renderer),
                          .number = number,
                          .pixel = &pixel,
                          .samples = samples};
    helio_status status = helio_renderer_pixel(job->renderer, frame, found->x, found->y, number, &pixel);
    if (status == HELIO_OK && number == 0)
        found->pixel = pixel;
    if (status != HELIO_OK || pixel.hit != HELIO_HIT_OBJECT)
        return status;
    step.share = (double)pixel.estimate.samples / job->plan.options->spp;
    status = helio_count(step.pools, &pixel.point, &pixel.estimate, &step.counts);
    if (status == HELIO_OK)
        status = read_pools(found, &step);
    if (status == HELIO_OK)
        status = helio_gather(step.pools, &pixel.point, &pixel.estimate, samples, &step.count);
    if (status == HELIO_OK)
        add_step(found, &step);
    return status;
}

/* ---- all steps ---------------------------------------------------------------------------- */

static void forget(samples_findings *found)
{
    found->sample_count = found->pooled = 0;
    found->reads_tiles = found->reads_pools = false;
    found->all = (technique_count){0};
    memset(found->techniques, 0, sizeof found->techniques);
    memset(found->fallen, 0, sizeof found->fallen);
    memset(found->control, 0, sizeof found->control);
    memset(found->radiance, 0, sizeof found->radiance);
}

helio_status samples_gather(samples_findings *found, render_job *job, uint64_t index)
{
    const helio_frame_desc frame = render_job_frame(job, index);
    helio_sample *samples = malloc(found->capacity * sizeof *samples);
    if (samples == NULL)
        return HELIO_ERR_MEMORY;
    helio_status status = HELIO_OK;
    forget(found);
    found->pool_length = helio_pools_length(helio_renderer_pools(job->renderer));
    for (uint32_t step = 0; step < found->passes && status == HELIO_OK; step++)
        status = gather_step(found, job, &frame, step, samples);
    free(samples);
    helio_environment_to_map(job->environment, found->pixel.point.normal, found->normal);
    helio_environment_to_map(job->environment, found->pixel.point.geometric_normal, found->geometric_normal);
    return status;
}
