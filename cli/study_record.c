/* SPDX-License-Identifier: MIT */
#include "study_record.h"

#include "json_file.h"
#include "message.h"
#include "study_summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER(name, meaning)                                                                                          \
    {                                                                                                                  \
#name, meaning, offsetof(study_cell, name)                                                                     \
    }

const study_number study_numbers[STUDY_NUMBERS] = {
    NUMBER(relmse, "relative mean square error"),
    NUMBER(rmse, "root mean square error of radiance"),
    NUMBER(lab_mean, "mean difference in CIE 1976 L*a*b*"),
    NUMBER(de2000_mean, "mean difference by CIEDE2000"),
    NUMBER(psnr, "dB, of what is shown"),
    NUMBER(flip, "mean LDR-FLIP, 0 to 1"),
    NUMBER(flicker, "relative mean square change of the error from frame to frame"),
    NUMBER(flicker_rmse, "root mean square change of the error from frame to frame"),
    NUMBER(sequence_relmse, "relative mean square error of the frames whose flicker that is"),
    NUMBER(flicker_ratio, "flicker / sequence_relmse: 1 where errors are new in each frame, 0 where they stand still"),
    NUMBER(total_ms, "whole frame, from the map in memory to the picture: median"),
    NUMBER(low_ms, "its lower quartile"),
    NUMBER(high_ms, "its upper quartile"),
    NUMBER(cube_ms, "map into cube"),
    NUMBER(tables_ms, "tables"),
    NUMBER(pools_ms, "pools"),
    NUMBER(primary_ms, "camera rays"),
    NUMBER(shade_ms, "shading"),
    NUMBER(samples, "samples taken"),
    NUMBER(useful_share, "part of them with light and a BRDF above 0"),
    NUMBER(rays, "shadow rays"),
    NUMBER(passes, "pools drawn"),
    NUMBER(reference_rmse, "standard error of the reference, as an RMSE"),
};

double study_number_of(const study_cell *cell, const study_number *number)
{
    double value;
    memcpy(&value, (const char *)cell + number->offset, sizeof value);
    return value;
}

static void set_number(study_cell *cell, const study_number *number, double value)
{
    memcpy((char *)cell + number->offset, &value, sizeof value);
}

/* ---- making -------------------------------------------------------------------------------- */

int study_record_open(study_record *record, const study_plan *plan, json_t *settings, json_t *scene)
{
    *record = (study_record){.plan = plan, .settings = settings, .scene = scene};
    record->cells = calloc(study_plan_count(plan), sizeof *record->cells);
    record->digests = calloc(plan->environment_count, sizeof *record->digests);
    if (record->cells != NULL && record->digests != NULL && settings != NULL && scene != NULL)
        return EXIT_CODE_OK;
    return message_failure("no memory for a study of %zu points", study_plan_count(plan));
}

void study_record_release(study_record *record)
{
    free(record->digests);
    free(record->cells);
    json_decref(record->settings);
    json_decref(record->scene);
    *record = (study_record){0};
}

/* Files have nine digits: a study that was resumed has the same ones. */
static double round_number(double value)
{
    char text[64];
    if (!isfinite(value))
        return (double)NAN;
    snprintf(text, sizeof text, "%.9g", value);
    return strtod(text, NULL);
}

void study_record_keep(study_record *record, size_t index, const study_cell *cell)
{
    study_cell *kept = &record->cells[index];
    *kept = *cell;
    for (int i = 0; i < STUDY_NUMBERS; i++)
        set_number(kept, &study_numbers[i], round_number(study_number_of(cell, &study_numbers[i])));
    kept->exposure = round_number(cell->exposure);
    kept->is_done = true;
}

bool study_record_note_digest(study_record *record, uint32_t environment, uint64_t digest)
{
    char text[STUDY_DIGEST], *known = record->digests[environment];
    snprintf(text, sizeof text, "%016" PRIx64, digest);
    bool has_changed = known[0] != 0 && strcmp(known, text) != 0;
    size_t count = study_plan_count(record->plan);
    for (size_t i = 0; has_changed && i < count; i++)
        if (study_plan_point(record->plan, i).environment == environment)
            record->cells[i].is_done = false;
    strcpy(known, text);
    return has_changed;
}

/* ---- writing ------------------------------------------------------------------------------- */

static json_t *cell_object(const study_record *record, size_t index)
{
    const study_plan *plan = record->plan;
    const study_cell *cell = &record->cells[index];
    study_point point = study_plan_point(plan, index);
    json_t *object = json_object();
    json_object_set_new(object, "environment", json_string(plan->environments[point.environment].name));
    json_object_set_new(object, "material", json_string(plan->materials[point.material].name));
    json_object_set_new(object, "strategy", json_string(plan->strategies[point.strategy].name));
    json_object_set_new(object, "spp", json_whole(plan->spp[point.spp]));
    for (int i = 0; i < STUDY_NUMBERS; i++)
        json_object_set_new(object, study_numbers[i].name, json_number(study_number_of(cell, &study_numbers[i])));
    json_object_set_new(object, "exposure", json_number(cell->exposure));
    return object;
}

static json_t *environment_list(const study_record *record)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < record->plan->environment_count; i++) {
        json_t *object = json_object();
        json_object_set_new(object, "name", json_string(record->plan->environments[i].name));
        json_object_set_new(object, "source", json_string(record->plan->environments[i].specification));
        json_object_set_new(object, "digest", json_string(record->digests[i]));
        json_array_append_new(list, object);
    }
    return list;
}

int study_record_write(const study_record *record, const char *path)
{
    json_t *object = json_object(), *cells = json_array();
    size_t count = study_plan_count(record->plan);
    for (size_t i = 0; i < count; i++)
        if (record->cells[i].is_done)
            json_array_append_new(cells, cell_object(record, i));
    json_object_set(object, "settings", record->settings);
    json_object_set(object, "scene", record->scene);
    json_object_set_new(object, "environments", environment_list(record));
    json_object_set_new(object, "points", json_whole(count));
    json_object_set_new(object, "cells", cells);
    study_summary_describe(record, object);
    int code = json_file_write("out", path, object);
    json_decref(object);
    return code;
}

/* ---- resuming ------------------------------------------------------------------------------ */

static int check_settings(const study_record *record, const char *path, const json_t *found)
{
    const char *key;
    json_t *value;
    json_object_foreach(record->settings, key, value)
    {
        const json_t *old = json_object_get(found, key);
        if (json_equal(old, value))
            continue;
        char *was = json_dumps(old, JSON_ENCODE_ANY | JSON_COMPACT);
        char *now = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
        int code =
            message_failure("the study in %s was made with another %s: %s, and not %s; give --out another folder "
                            "for a new study",
                            path, key, was != NULL ? was : "none", now != NULL ? now : "none");
        free(was);
        free(now);
        return code;
    }
    return EXIT_CODE_OK;
}

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

static bool find_point(const study_plan *plan, const json_t *object, study_point *point)
{
    json_int_t spp = json_integer_value(json_object_get(object, "spp"));
    *point = (study_point){0};
    while (point->environment < plan->environment_count &&
           strcmp(plan->environments[point->environment].name, text_of(object, "environment")) != 0)
        point->environment++;
    while (point->material < plan->material_count &&
           strcmp(plan->materials[point->material].name, text_of(object, "material")) != 0)
        point->material++;
    while (point->strategy < plan->strategy_count &&
           strcmp(plan->strategies[point->strategy].name, text_of(object, "strategy")) != 0)
        point->strategy++;
    while (point->spp < plan->spp_count && plan->spp[point->spp] != spp)
        point->spp++;
    return point->environment < plan->environment_count && point->material < plan->material_count &&
           point->strategy < plan->strategy_count && point->spp < plan->spp_count;
}

static int load_cell(study_record *record, const char *path, const json_t *object)
{
    study_point point;
    if (!find_point(record->plan, object, &point))
        return message_failure("the study in %s has %s, %s, %s at %" JSON_INTEGER_FORMAT " spp, which the lists leave "
                               "out; name all that it has, or give --out another folder",
                               path, text_of(object, "environment"), text_of(object, "material"),
                               text_of(object, "strategy"), json_integer_value(json_object_get(object, "spp")));
    study_cell cell = {0};
    for (int i = 0; i < STUDY_NUMBERS; i++) {
        const json_t *number = json_object_get(object, study_numbers[i].name);
        set_number(&cell, &study_numbers[i], json_is_number(number) ? json_number_value(number) : (double)NAN);
    }
    cell.exposure = json_number_value(json_object_get(object, "exposure"));
    study_record_keep(record, study_plan_index(record->plan, &point), &cell);
    return EXIT_CODE_OK;
}

static void load_digests(study_record *record, const json_t *list)
{
    size_t index;
    json_t *object;
    json_array_foreach(list, index, object)
    {
        for (uint32_t i = 0; i < record->plan->environment_count; i++)
            if (strcmp(record->plan->environments[i].name, text_of(object, "name")) == 0)
                snprintf(record->digests[i], STUDY_DIGEST, "%s", text_of(object, "digest"));
    }
}

int study_record_load(study_record *record, const char *path)
{
    size_t index;
    json_error_t error;
    json_t *object, *cell;
    object = json_load_file(path, 0, &error);
    if (object == NULL)
        return message_failure("%s cannot be resumed from: %s; remove it, or give --out another folder", path,
                               error.text);
    int code = check_settings(record, path, json_object_get(object, "settings"));
    json_array_foreach(json_object_get(object, "cells"), index, cell)
    {
        if (code == EXIT_CODE_OK)
            code = load_cell(record, path, cell);
    }
    if (code == EXIT_CODE_OK)
        load_digests(record, json_object_get(object, "environments"));
    json_decref(object);
    return code;
}
