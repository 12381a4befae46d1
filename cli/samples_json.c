/* SPDX-License-Identifier: MIT */
#include "samples_json.h"

#include "face.h"
#include "json_file.h"
#include "message.h"

#include <stdio.h>
#include <string.h>

static json_t *floats(const float *numbers)
{
    return json_pack("[fff]", (double)numbers[0], (double)numbers[1], (double)numbers[2]);
}

json_t *samples_json_make(const render_job *job)
{
    const cli_options *options = job->plan.options;
    json_t *object = json_object();
    json_object_set_new(object, "env", json_text(job->plan.light.specification));
    json_object_set_new(object, "mesh", json_text(job->plan.mesh));
    json_object_set_new(object, "size", json_pack("[oo]", json_whole(options->size[0]), json_whole(options->size[1])));
    json_object_set_new(object, "strategy",
                        json_string(helio_strategy_name(helio_strategy_resolve(job->plan.strategy))));
    json_object_set_new(object, "weighting", json_string(options->weighting));
    json_object_set_new(object, "visibility", json_string(options->visibility));
    json_object_set_new(object, "beta", json_boolean(!options->no_beta));
    json_object_set_new(object, "control", json_boolean(!options->no_control));
    json_object_set_new(object, "spp", json_whole(options->spp));
    json_object_set_new(object, "seed", json_whole(options->seed));
    json_object_set_new(object, "frames", json_array());
    return object;
}

static json_t *point_object(const helio_shading_point *point)
{
    static const char *const kinds[] = {"diffuse", "phong", "ggx"};
    json_t *object = json_object();
    json_object_set_new(object, "position", floats(point->position));
    json_object_set_new(object, "normal", floats(point->normal));
    json_object_set_new(object, "geometric_normal", floats(point->geometric_normal));
    json_object_set_new(object, "view", floats(point->view));
    json_object_set_new(object, "material", json_string(kinds[point->material.kind]));
    json_object_set_new(object, "seed", json_whole(point->seed));
    return object;
}

static json_t *count_object(const technique_count *count)
{
    json_t *object = json_object();
    json_object_set_new(object, "expected", json_number(count->expected));
    json_object_set_new(object, "realised", json_whole(count->realised));
    for (int fate = 0; fate < SAMPLE_FATES; fate++)
        json_object_set_new(object, sample_fate_name((sample_fate)fate), json_whole(count->fates[fate]));
    return object;
}

/* Of all pools, and of the surface where it is sampled. */
static json_t *techniques_object(const samples_findings *found)
{
    json_t *object = json_object();
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++)
        if (technique < found->pool_count || found->techniques[technique].expected > 0)
            json_object_set_new(object, samples_technique_name(found, technique),
                                count_object(&found->techniques[technique]));
    return object;
}

static json_t *faces_object(const samples_findings *found)
{
    json_t *object = json_object();
    for (int face = 0; face < FACE_COUNT; face++)
        json_object_set_new(
            object, face_names[face],
            json_pack("{so so}", "flux", json_number(found->flux[face]), "samples", json_whole(found->fallen[face])));
    return object;
}

static json_t *sample_object(const samples_findings *found, const point_sample *sample)
{
    bool has_pool = sample->technique < found->pool_count;
    json_t *object = json_object();
    json_object_set_new(object, "technique", json_string(samples_technique_name(found, sample->technique)));
    json_object_set_new(object, "fate", json_string(sample_fate_name(sample->fate)));
    json_object_set_new(object, "direction", floats(sample->world_direction));
    json_object_set_new(object, "face", json_string(face_names[sample->face]));
    json_object_set_new(object, "texel", json_pack("[oo]", json_whole(sample->row), json_whole(sample->column)));
    json_object_set_new(object, "density", json_number(sample->density));
    json_object_set_new(object, "contribution",
                        json_pack("[fff]", sample->contribution[0], sample->contribution[1], sample->contribution[2]));
    json_object_set_new(object, "pass", json_whole(sample->pass));
    json_object_set_new(object, "number", has_pool ? json_whole(sample->number) : json_null());
    json_object_set_new(object, "of_tiles", json_boolean(sample->is_of_tiles));
    return object;
}

static json_t *samples_array(const samples_findings *found)
{
    json_t *array = json_array();
    for (uint32_t i = 0; i < found->sample_count; i++)
        json_array_append_new(array, sample_object(found, &found->samples[i]));
    return array;
}

bool samples_json_add(json_t *object, const samples_findings *found, const float picture[3])
{
    const double *radiance = found->radiance;
    json_t *frame = json_object();
    json_object_set_new(frame, "index", json_whole(found->index));
    json_object_set_new(frame, "label", json_string(found->label));
    json_object_set_new(frame, "exposure", json_number((double)found->exposure));
    json_object_set_new(frame, "pixel", json_pack("[oo]", json_whole(found->x), json_whole(found->y)));
    json_object_set_new(frame, "point", point_object(&found->pixel.point));
    json_object_set_new(frame, "control", json_pack("[fff]", found->control[0], found->control[1], found->control[2]));
    json_object_set_new(frame, "radiance", json_pack("[fff]", radiance[0], radiance[1], radiance[2]));
    json_object_set_new(frame, "picture", floats(picture));
    json_object_set_new(frame, "passes", json_whole(found->passes));
    json_object_set_new(frame, "pools", json_whole(found->pool_count));
    json_object_set_new(frame, "pool_length", json_whole(found->pool_length));
    json_object_set_new(frame, "pool_samples", json_whole(found->pooled));
    json_object_set_new(frame, "counts", count_object(&found->all));
    json_object_set_new(frame, "techniques", techniques_object(found));
    json_object_set_new(frame, "faces", faces_object(found));
    json_object_set_new(frame, "samples", samples_array(found));
    return json_array_append_new(json_object_get(object, "frames"), frame) == 0;
}

int samples_json_write(const char *path, const json_t *object)
{
    return json_file_write_or_print("json", path, object);
}
