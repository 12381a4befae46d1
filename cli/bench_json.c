/* SPDX-License-Identifier: MIT */
#include "bench_json.h"

#include "json_file.h"
#include "machine.h"
#include "message.h"

#include <stdio.h>
#include <string.h>

static void set_text(json_t *object, const char *key, const char *text)
{
    if (text != NULL)
        json_object_set_new(object, key, json_string(text));
}

static void set_whole(json_t *object, const char *key, uint32_t value)
{
    if (value > 0)
        json_object_set_new(object, key, json_whole(value));
}

static void set_size(json_t *object, const char *key, const uint32_t size[2])
{
    if (size[0] > 0)
        json_object_set_new(object, key, json_pack("[oo]", json_whole(size[0]), json_whole(size[1])));
}

static void set_number(json_t *object, const char *key, double value)
{
    if (value > 0)
        json_object_set_new(object, key, json_number(value));
}

static void set_parameters(json_t *object, const bench_result *result)
{
    set_text(object, "stage", result->stage);
    set_text(object, "isa", result->isa);
    set_whole(object, "threads", result->threads);
    set_size(object, "map", result->map);
    set_whole(object, "env_size", result->env_size);
    set_text(object, "strategy", result->strategy);
    set_text(object, "material", result->material);
    set_whole(object, "spp", result->spp);
    set_text(object, "mesh", result->mesh);
    set_whole(object, "triangles", result->triangles);
    set_size(object, "size", result->size);
    set_text(object, "visibility", result->visibility);
    set_text(object, "camera_rays", result->camera_rays);
    set_number(object, "coverage", result->coverage);
}

static json_t *parts_object(const bench_result *result)
{
    json_t *parts = json_object();
    for (int i = 0; i < BENCH_PARTS && result->part_names[i] != NULL; i++)
        json_object_set_new(parts, result->part_names[i], json_number(result->parts[i].median));
    return parts;
}

static json_t *result_object(const bench_result *result)
{
    json_t *object = json_object();
    set_parameters(object, result);
    set_text(object, "unit", result->unit);
    json_object_set_new(object, "median", json_number(result->value.median));
    json_object_set_new(object, "quartile_low", json_number(result->value.low));
    json_object_set_new(object, "quartile_high", json_number(result->value.high));
    json_object_set_new(object, "repeats", json_whole(result->value.repeats));
    set_number(object, "ratio_to_memcpy", result->ratio_to_memcpy);
    set_number(object, "samples_per_second", result->samples_per_second);
    set_number(object, "flops_per_sample", result->flops_per_sample);
    set_number(object, "share_of_fma_peak", result->share_of_fma_peak);
    if (result->part_names[0] != NULL)
        json_object_set_new(object, "parts", parts_object(result));
    return object;
}

static json_t *machine_object(const bench *b)
{
    char processor[256];
    machine_processor(processor, sizeof processor);
    json_t *object = json_object(), *sets = json_array();
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++)
        json_array_append_new(sets, json_string(helio_isa_name(i)));
    json_object_set_new(object, "processor", json_string(processor));
    json_object_set_new(object, "cores", json_whole(machine_cores()));
    json_object_set_new(object, "isa", sets);
    json_object_set_new(object, "version", json_string(HELIO_VERSION_TEXT));
    json_object_set_new(object, "threads", json_whole(b->plan->threads.values[0]));
    if (b->device != NULL) {
        const helio_device_info device = helio_device_get_info(b->device);
        json_object_set_new(object, "device", json_string(device.name));
        json_object_set_new(object, "driver", json_string(device.driver));
    }
    return object;
}

static json_t *report_object(const bench *b)
{
    json_t *object = json_object(), *list = json_array();
    for (size_t i = 0; i < b->results.count; i++)
        json_array_append_new(list, result_object(&b->results.items[i]));
    json_object_set_new(object, "machine", machine_object(b));
    json_object_set_new(object, "env", json_string(b->plan->light.specification));
    if (b->device == NULL) { /* else it was not measured */
        json_object_set_new(object, "fma_peak_gflops", json_number(b->fma_peak_gflops));
        json_object_set_new(object, "memcpy_gb_per_s", json_number(b->memcpy_gb_per_s));
    }
    json_object_set_new(object, "results", list);
    return object;
}

int bench_json_write(const bench *b)
{
    json_t *object = report_object(b);
    int code = json_file_write_or_print("json", b->plan->options->bench.json, object);
    json_decref(object);
    return code;
}
