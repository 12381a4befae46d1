/* SPDX-License-Identifier: MIT */
#include "study_settings.h"

#include "json_file.h"
#include "machine.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Options that change no number of a point, and those that are told in another way. */
static bool is_left_out(const cli_option *option)
{
    static const char *const names[] = {"study",
                                        "strategies",
                                        "spp",
                                        "envs",
                                        "materials",
                                        "out",
                                        "resume",
                                        "pictures",
                                        "mesh",
                                        "threads",
                                        "quiet",
                                        "verbose",
                                        "help",
                                        "picture-size",
                                        "max-pixels",
                                        "backend",
                                        "layout",
                                        "show-spp",
                                        "max-mesh-memory",
                                        "max-mesh-seconds"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(option->name, names[i]) == 0)
            return true;
    return false;
}

static json_t *text_or_null(const char *text)
{
    return text != NULL ? json_string(text) : json_null();
}

static json_t *range_or_null(const frame_range *range)
{
    return range->is_given ? json_pack("[II]", (json_int_t)range->first, (json_int_t)range->last) : json_null();
}

static json_t *value_of(const cli_option *option, const cli_options *options)
{
    const void *member = (const char *)options + option->offset;
    switch (option->kind) {
    case OPTION_FLAG: return json_boolean(*(const bool *)member);
    case OPTION_TEXT:
    case OPTION_CHOICE: return text_or_null(*(const char *const *)member);
    case OPTION_WHOLE:
    case OPTION_POWER: return json_whole(*(const uint32_t *)member);
    case OPTION_NUMBER: return json_number(*(const double *)member);
    case OPTION_EXPOSURE:
        return isnan(*(const double *)member) ? json_string("auto") : json_number(*(const double *)member);
    case OPTION_SIZE: return json_pack("[ii]", (int)((const uint32_t *)member)[0], (int)((const uint32_t *)member)[1]);
    case OPTION_RANGE: return range_or_null(member);
    }
    return json_null();
}

json_t *study_settings(const study_job *job)
{
    char digest[32], processor[256];
    json_t *settings = json_object();
    for (size_t i = 0; i < option_count; i++)
        if ((option_table[i].commands & COMMAND_STUDY) && !is_left_out(&option_table[i]))
            json_object_set_new(settings, option_table[i].name, value_of(&option_table[i], job->plan->options));
    snprintf(digest, sizeof digest, "%016" PRIx64, job->mesh_digest);
    machine_processor(processor, sizeof processor);
    json_object_set_new(settings, "mesh", json_string(digest));
    json_object_set_new(settings, "layout", json_string(job->plan->options->layout));
    json_object_set_new(settings, "threads", json_whole(helio_context_threads(job->context)));
    json_object_set_new(settings, "isa", json_string(helio_context_isa(job->context)));
    json_object_set_new(settings, "processor", json_string(processor));
    json_object_set_new(settings, "version", json_string(HELIO_VERSION_TEXT));
    return settings;
}

static json_t *vector_of(const float vector[3])
{
    json_t *list = json_array();
    for (int i = 0; i < 3; i++)
        json_array_append_new(list, json_number((double)vector[i]));
    return list;
}

json_t *study_scene(const study_job *job)
{
    const char *slash = strrchr(job->plan->mesh, '/');
    json_t *scene = json_object(), *camera = json_object();
    json_object_set_new(scene, "mesh", json_string(slash != NULL ? slash + 1 : job->plan->mesh));
    json_object_set_new(scene, "triangles", json_whole(job->mesh->triangle_count));
    json_object_set_new(scene, "cores", json_whole(machine_cores()));
    json_object_set_new(camera, "eye", vector_of(job->camera.eye));
    json_object_set_new(camera, "at", vector_of(job->camera.at));
    json_object_set_new(camera, "fov", json_number((double)job->camera.fov));
    json_object_set_new(scene, "camera", camera);
    return scene;
}
