/* SPDX-License-Identifier: MIT */
#include "stats.h"

#include "json_file.h"
#include "machine.h"

#include <math.h>
#include <stdlib.h>

void stats_note_bad_pixels(stats_frame *frame, const helio_bad_pixels *stored, const helio_bad_pixels *seen)
{
    frame->nan = seen->nan;
    frame->infinite = seen->infinite;
    frame->negative = stored->negative;
    frame->out_of_gamut = seen->negative > stored->negative ? seen->negative - stored->negative : 0;
}

static json_t *frame_object(const stats_frame *frame)
{
    json_t *bad = json_pack("{so so so so}", "nan", json_whole(frame->nan), "inf", json_whole(frame->infinite),
                            "negative", json_whole(frame->negative), "out_of_gamut", json_whole(frame->out_of_gamut));
    json_t *object = json_object();
    json_object_set_new(object, "index", json_whole(frame->index));
    json_object_set_new(object, "read_ms", json_number(frame->read_ms));
    json_object_set_new(object, "source_ms", json_number(frame->source_ms));
    json_object_set_new(object, "cube_ms", json_number(frame->cube_ms));
    json_object_set_new(object, "tables_ms", json_number(frame->tables_ms));
    json_object_set_new(object, "pools_ms", json_number(frame->pools_ms));
    json_object_set_new(object, "primary_ms", json_number(frame->primary_ms));
    json_object_set_new(object, "shade_ms", json_number(frame->shade_ms));
    if (frame->has_device) {
        json_object_set_new(object, "upload_ms", json_number(frame->upload_ms));
        json_object_set_new(object, "read_back_ms", json_number(frame->read_back_ms));
    }
    json_object_set_new(object, "write_ms", json_number(frame->write_ms));
    json_object_set_new(object, "total_ms", json_number(frame->total_ms));
    json_object_set_new(object, "samples", json_whole(frame->samples));
    json_object_set_new(object, "samples_useful", json_whole(frame->samples_useful));
    json_object_set_new(object, "bad_texels", bad);
    json_object_set_new(object, "flux", json_number(frame->flux));
    if (frame->has_error)
        json_object_set_new(
            object, "error",
            json_pack("{so so}", "relmse", json_number(frame->relmse), "lab_mean", json_number(frame->lab_mean)));
    return object;
}

static json_t *summary_object(const stats_list *list, const stats_summary *summary)
{
    double milliseconds = 0, samples = 0;
    for (size_t i = 0; i < list->count; i++) {
        milliseconds += list->frames[i].total_ms;
        samples += (double)list->frames[i].samples;
    }
    double seconds = fmax(milliseconds, 1e-6) / 1e3;
    char processor[256];
    machine_processor(processor, sizeof processor);

    json_t *object = json_object();
    json_object_set_new(object, "frames", json_whole(list->count));
    json_object_set_new(object, "skipped", json_whole(summary->skipped));
    json_object_set_new(object, "fps", json_number((double)list->count / seconds));
    json_object_set_new(object, "samples_per_second", json_number(samples / seconds));
    json_object_set_new(object, "strategy", json_string(summary->strategy));
    json_object_set_new(object, "spp", json_whole(summary->spp));
    json_object_set_new(object, "passes", json_whole(summary->passes));
    json_object_set_new(object, "ev", json_number(summary->ev));
    json_object_set_new(object, "size", json_pack("[oo]", json_whole(summary->width), json_whole(summary->height)));
    json_object_set_new(object, "backend", json_string(summary->device ? "vulkan" : "cpu"));
    json_object_set_new(object, "device", json_string(summary->device ? summary->device : processor));
    json_object_set_new(object, "isa", json_string(summary->isa));
    json_object_set_new(object, "threads", json_whole(summary->threads));
    if (summary->error != NULL)
        json_object_set_new(object, "error", json_string(summary->error));
    return object;
}

bool stats_list_add(stats_list *list, const stats_frame *frame)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity > 0 ? list->capacity * 2 : 16;
        stats_frame *frames = realloc(list->frames, capacity * sizeof frames[0]);
        if (frames == NULL)
            return false;
        list->frames = frames;
        list->capacity = capacity;
    }
    list->frames[list->count++] = *frame;
    return true;
}

void stats_list_release(stats_list *list)
{
    free(list->frames);
    *list = (stats_list){0};
}

int stats_write(const char *path, const stats_list *list, const stats_summary *summary)
{
    json_t *frames = json_array();
    for (size_t i = 0; i < list->count; i++)
        json_array_append_new(frames, frame_object(&list->frames[i]));
    json_t *object = json_object();
    json_object_set_new(object, "frames", frames);
    json_object_set_new(object, "summary", summary_object(list, summary));
    int code = json_file_write_or_print("stats", path, object);
    json_decref(object);
    return code;
}
