/* SPDX-License-Identifier: MIT */
#include "command.h"

#include "bench.h"
#include "bench_json.h"
#include "interrupt.h"
#include "machine.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int (*const stages[BENCH_STAGES])(bench *) = {
    [BENCH_MACHINE] = bench_run_machine, [BENCH_CUBE] = bench_run_cube,         [BENCH_TABLES] = bench_run_tables,
    [BENCH_POOLS] = bench_run_pools,     [BENCH_ESTIMATE] = bench_run_estimate, [BENCH_SCENE] = bench_run_scene,
    [BENCH_RAYS] = bench_run_rays,       [BENCH_FRAME] = bench_run_frame,       [BENCH_DEVICE] = bench_run_device,
};

static int open_context(bench *b)
{
    const cli_options *options = b->plan->options;
    const helio_context_desc desc = {.threads = b->plan->threads.values[0], .isa = b->plan->isas[0]};
    const helio_device_desc device = {.name = options->device};
    helio_status status = helio_context_create(&desc, &b->context);
    if (status == HELIO_OK && options->backend[0] == 'v')
        status = helio_device_create(b->context, &device, &b->device);
    return bench_check(status);
}

/* The cube of the first frame of --env. */
static helio_status make_light(bench *b, helio_source *source)
{
    const helio_environment_desc desc = {0};
    helio_source_frame frame;
    helio_status status = helio_environment_create(b->context, &desc, &b->source);
    if (status == HELIO_OK)
        status = helio_source_next(source, &frame);
    return status == HELIO_OK ? helio_source_apply(source, &frame, b->source, NULL) : status;
}

static int load_source(bench *b)
{
    const helio_source_desc desc = {.layout = b->plan->layout, .max_pixels = b->plan->options->max_pixels};
    helio_source *source;
    helio_status status = helio_source_open(b->context, b->plan->light.specification, &desc, &source);
    if (status == HELIO_OK)
        status = make_light(b, source);
    helio_source_close(source);
    return bench_check(status);
}

static void print_heading(const bench *b)
{
    char processor[256];
    machine_processor(processor, sizeof processor);
    const bench_point first = bench_first_point(b);
    printf("heliostat %s on %s, %u cores\n", HELIO_VERSION_TEXT, processor, machine_cores());
    printf("Where nothing else is said: %s, %u threads, map %ux%u, cube 6x%ux%u, %u spp, %s, %s\n", first.isa,
           first.threads, first.map[0], first.map[1], first.env_size, first.env_size, first.spp,
           helio_strategy_name(first.strategy), first.material->name);
    printf("Medians of at most %u repetitions, and the quartiles between which half of them lie\n", b->plan->repeat);
    fflush(stdout);
}

static int run_stages(bench *b)
{
    int code = EXIT_CODE_OK;
    for (int stage = 0; code == EXIT_CODE_OK && stage < BENCH_STAGES; stage++) {
        b->stage = (bench_stage)stage;
        if ((stage == BENCH_MACHINE && b->device == NULL) || b->plan->stages[stage])
            code = stages[stage](b);
        bench_light_list_release(&b->lights);
    }
    return code;
}

static int run_bench(bench *b)
{
    int code = open_context(b);
    if (code == EXIT_CODE_OK)
        code = load_source(b);
    if (code == EXIT_CODE_OK && b->shows_table)
        print_heading(b);
    if (code == EXIT_CODE_OK)
        code = run_stages(b);
    if (code == EXIT_CODE_OK && b->plan->options->bench.json != NULL)
        code = bench_json_write(b);
    if (code > EXIT_CODE_SIGNAL)
        message_failure("stopped before all was measured");
    return code;
}

static void release(bench *b)
{
    bench_results_release(&b->results);
    bench_mesh_release(&b->mesh);
    helio_environment_destroy(b->source);
    helio_device_destroy(b->device);
    helio_context_destroy(b->context);
}

int command_bench(const cli_options *options)
{
    interrupt_install();
    bench_plan plan;
    int code = bench_plan_make(&plan, options);
    if (code != EXIT_CODE_OK)
        return code;
    const char *json = options->bench.json;
    bench b = {
        .plan = &plan,
        .shows_table = !options->quiet && (json == NULL || strcmp(json, "-") != 0),
        .shows_progress = !options->quiet && isatty(STDERR_FILENO),
    };
    code = run_bench(&b);
    release(&b);
    return code;
}
