/* SPDX-License-Identifier: MIT */
#include "study_light.h"

#include "digest.h"
#include "study_plan.h"

#include <stdlib.h>
#include <string.h>

/* What the library has no sentence for. */
static helio_status fail_for_memory(study_light *light)
{
    light->is_out_of_memory = true;
    return HELIO_ERR_MEMORY;
}

static helio_status store(study_light *light, const helio_source_frame *frame)
{
    helio_source_frame *kept = &light->frames[light->stored];
    *kept = *frame;
    kept->name = NULL;
    if (frame->sky != NULL) {
        light->skies[light->stored] = *frame->sky;
        kept->sky = &light->skies[light->stored++];
        light->digest = digest_add(light->digest, &kept->sky->sun, sizeof kept->sky->sun);
        light->digest = digest_add(light->digest, &kept->sky->turbidity, sizeof kept->sky->turbidity);
        light->digest = digest_add(light->digest, &kept->sky->albedo, sizeof kept->sky->albedo);
        return HELIO_OK;
    }
    size_t bytes = (size_t)frame->width * frame->height * 3 * sizeof(float);
    float *pixels = malloc(bytes);
    if (pixels == NULL)
        return fail_for_memory(light);
    memcpy(pixels, frame->rgb, bytes);
    kept->rgb = pixels;
    kept->pixels = (helio_pixels){.data = pixels}; /* the source's own are overwritten by frames to come */
    light->stored++;
    light->digest = digest_add(light->digest, pixels, bytes);
    return HELIO_OK;
}

static helio_status read_frames(study_light *light, uint32_t frames)
{
    helio_source_frame frame;
    while (light->stored < frames) {
        helio_status status = helio_source_next(light->source, &frame);
        if (status != HELIO_OK)
            return status;
        if (frame.rgb == NULL && frame.sky == NULL)
            return HELIO_OK;
        status = store(light, &frame);
        if (status != HELIO_OK)
            return status;
    }
    return HELIO_OK;
}

/* Of what stands still --frames means how often it is turned. */
static helio_source_desc describe(const char *specification, const helio_source_desc *desc)
{
    helio_source_desc own = *desc;
    helio_source_kind kind = HELIO_SOURCE_FILE;
    bool is_known = helio_source_check(specification, &kind) == HELIO_OK;
    if (is_known && (kind == HELIO_SOURCE_FILE || kind == HELIO_SOURCE_CONSTANT || kind == HELIO_SOURCE_SKY))
        own.has_frames = false;
    return own;
}

helio_status study_light_open(helio_context *context, const char *specification, const helio_source_desc *desc,
                              uint32_t frames, study_light *light)
{
    *light = (study_light){.digest = DIGEST_START};
    light->frames = calloc(frames, sizeof *light->frames);
    light->skies = calloc(frames, sizeof *light->skies);
    if (light->frames == NULL || light->skies == NULL)
        return fail_for_memory(light);
    const helio_source_desc own = describe(specification, desc);
    helio_status status = helio_source_open(context, specification, &own, &light->source);
    if (status != HELIO_OK)
        return status;
    light->turns = !helio_source_get_info(light->source).is_dynamic;
    status = read_frames(light, light->turns ? 1 : frames);
    light->count = light->turns ? frames : light->stored;
    return status;
}

void study_light_release(study_light *light)
{
    for (uint32_t i = 0; i < light->stored; i++)
        free((float *)light->frames[i].rgb);
    free(light->frames);
    free(light->skies);
    helio_source_close(light->source);
    *light = (study_light){0};
}

helio_status study_light_apply(const study_light *light, uint32_t index, const study_turn *turn,
                               helio_environment *environment, helio_environment_info *info)
{
    double steps = light->turns ? (double)index - study_plan_still(light->count) : 0;
    const helio_orientation orientation = {
        .rotate = (float)(turn->rotate + steps * turn->step), .flip = turn->flip, .intensity = turn->intensity};
    helio_status status = helio_environment_orient(environment, &orientation);
    if (status != HELIO_OK)
        return status;
    return helio_source_apply(light->source, &light->frames[light->turns ? 0 : index], environment, info);
}
