/* SPDX-License-Identifier: MIT */
#include "stats.h"

#include "json_file.h"
#include "machine.h"

#include <math.h>

static json_t *frame_object(const stats_frame *frame)
{
    json_t *bad = json_pack("{so so so so}", "nan", json_whole(frame->nan), "inf", json_whole(frame->infinite),
                            "negative", json_whole(frame->negative), "out_of_gamut", json_whole(frame->out_of_gamut));
    json_t *object = json_object();
    json_object_set_new(object, "index", json_whole(frame->index));
    json_object_set_new(object, "source_ms", json_number(frame->source_ms));
    json_object_set_new(object, "cube_ms", json_number(frame->cube_ms));
    json_object_set_new(object, "tables_ms", json_number(frame->tables_ms));
    json_object_set_new(object, "pools_ms", json_number(frame->pools_ms));
    json_object_set_new(object, "primary_ms", json_number(frame->primary_ms));
    json_object_set_new(object, "shade_ms", json_number(frame->shade_ms));
    json_object_set_new(object, "write_ms", json_number(frame->write_ms));
    json_object_set_new(object, "total_ms", json_number(frame->total_ms));
    json_object_set_new(object, "samples", json_whole(frame->samples));
    json_object_set_new(object, "samples_useful", json_whole(frame->samples_useful));
    json_object_set_new(object, "bad_texels", bad);
    json_object_set_new(object, "flux", json_number(frame->flux));
    return object;
}

static json_t *summary_object(const stats_frame *frames, size_t count, const stats_summary *summary)
{
    double milliseconds = 0, samples = 0;
    for (size_t i = 0; i < count; i++) {
        milliseconds += frames[i].total_ms;
        samples += (double)frames[i].samples;
    }
    double seconds = fmax(milliseconds, 1e-6) / 1e3;
    char processor[256];
    machine_processor(processor, sizeof processor);

    json_t *object = json_object();
    json_object_set_new(object, "frames", json_whole(count));
    json_object_set_new(object, "fps", json_number((double)count / seconds));
    json_object_set_new(object, "samples_per_second", json_number(samples / seconds));
    json_object_set_new(object, "strategy", json_string(summary->strategy));
    json_object_set_new(object, "spp", json_whole(summary->spp));
    json_object_set_new(object, "passes", json_whole(summary->passes));
    json_object_set_new(object, "ev", json_number(summary->ev));
    json_object_set_new(object, "size", json_pack("[oo]", json_whole(summary->width), json_whole(summary->height)));
    json_object_set_new(object, "backend", json_string("cpu"));
    json_object_set_new(object, "device", json_string(processor));
    json_object_set_new(object, "isa", json_string(summary->isa));
    json_object_set_new(object, "threads", json_whole(summary->threads));
    return object;
}

int stats_write(const char *path, const stats_frame *frames, size_t count, const stats_summary *summary)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(list, frame_object(&frames[i]));
    json_t *object = json_object();
    json_object_set_new(object, "frames", list);
    json_object_set_new(object, "summary", summary_object(frames, count, summary));
    int code = json_file_write("stats", path, object);
    json_decref(object);
    return code;
}
