/* SPDX-License-Identifier: MIT */
#include "reference_report.h"

#include "json_file.h"
#include "machine.h"

#include <math.h>

json_t *reference_report_frame(const reference_run *run, uint64_t index)
{
    bool is_quadrature = run->plan->method == HELIO_REFERENCE_QUADRATURE;
    json_t *object = json_object();
    json_object_set_new(object, "index", json_whole(index));
    json_object_set_new(object, "out", json_string(run->out));
    if (!is_quadrature) {
        json_object_set_new(object, "spp", json_whole(run->info.spp));
        json_object_set_new(object, "passes", json_whole(run->info.pieces));
        json_object_set_new(object, "resumed_passes", json_whole(run->resumed));
    }
    json_object_set_new(object, "error", json_number(run->error));
    json_object_set_new(object, "seconds", json_number(run->seconds));
    json_object_set_new(object, is_quadrature ? "evaluations" : "samples", json_whole(run->samples));
    json_object_set_new(object, is_quadrature ? "evaluations_per_second" : "samples_per_second",
                        json_number((double)run->samples / fmax(run->seconds, 1e-9)));
    return object;
}

int reference_report_write(const reference_plan *plan, const render_job *job, json_t *frames)
{
    const cli_options *options = &plan->render;
    char processor[256];
    machine_processor(processor, sizeof processor);
    json_t *summary = json_object();
    json_object_set_new(summary, "method", json_string(reference_plan_name(plan)));
    json_object_set_new(summary, "size", json_pack("[oo]", json_whole(options->size[0]), json_whole(options->size[1])));
    json_object_set_new(summary, "aa", json_whole(options->aa));
    json_object_set_new(summary, "visibility", json_string(options->visibility));
    json_object_set_new(summary, "backend", json_string("cpu"));
    json_object_set_new(summary, "device", json_string(processor));
    json_object_set_new(summary, "isa", json_string(helio_context_isa(job->context)));
    json_object_set_new(summary, "threads", json_whole(helio_context_threads(job->context)));
    json_t *object = json_object();
    json_object_set_new(object, "frames", frames);
    json_object_set_new(object, "summary", summary);
    int code = json_file_write_or_print("stats", options->stats, object);
    json_decref(object);
    return code;
}
