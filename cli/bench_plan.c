/* SPDX-License-Identifier: MIT */
#include "bench_plan.h"

#include "asset.h"
#include "bench_series.h"
#include "machine.h"
#include "message.h"
#include "number.h"
#include "output_file.h"

#include <stdio.h>
#include <string.h>

static const char SHIPPED_MESH[] = "dragon.ply.gz";
static const double MS_PER_REPEAT = 100;
enum { REPEATS_QUICK = 3, LEAST_REPEATS = 3 };

#ifdef HELIO_WITH_EMBREE
static const bool HAS_RAYS = true;
#else
static const bool HAS_RAYS = false;
#endif
#ifdef HELIO_WITH_ASSIMP
static const bool HAS_MESHES = true;
#else
static const bool HAS_MESHES = false;
#endif

static const char *const stage_names[BENCH_STAGES] = {
    [BENCH_MACHINE] = "machine", [BENCH_CUBE] = "cube",         [BENCH_TABLES] = "tables",
    [BENCH_POOLS] = "pools",     [BENCH_ESTIMATE] = "estimate", [BENCH_SCENE] = "scene",
    [BENCH_RAYS] = "rays",       [BENCH_FRAME] = "frame",       [BENCH_DEVICE] = "device",
};

const char *bench_stage_name(bench_stage stage)
{
    return stage_names[stage];
}

/* ---- lists ---------------------------------------------------------------------------- */

/* Adds the item to the plan; false if it is none of the values that the option takes. */
typedef bool add_item(bench_plan *plan, const char *item);

static bool add_number(bench_numbers *list, const char *item, uint32_t maximum)
{
    return list->count < BENCH_LIST && number_parse_whole(item, 1, maximum, &list->values[list->count++]);
}

static bool add_threads(bench_plan *plan, const char *item)
{
    return add_number(&plan->threads, item, 1024);
}

static bool add_env_size(bench_plan *plan, const char *item)
{
    return add_number(&plan->env_sizes, item, 4096);
}

static bool add_spp(bench_plan *plan, const char *item)
{
    return add_number(&plan->spp, item, 1 << 16);
}

static bool add_mesh_size(bench_plan *plan, const char *item)
{
    return add_number(&plan->mesh_sizes, item, 1 << 26);
}

static bool add_map_size(bench_plan *plan, const char *item)
{
    char width[LIST_ITEM];
    const char *cross = strchr(item, 'x');
    bench_sizes *list = &plan->map_sizes;
    if (cross == NULL || list->count == BENCH_LIST)
        return false;
    snprintf(width, sizeof width, "%.*s", (int)(cross - item), item);
    uint32_t *size = list->values[list->count++];
    return number_parse_whole(width, 1, 16384, &size[0]) && number_parse_whole(cross + 1, 1, 16384, &size[1]);
}

static bool add_strategy(bench_plan *plan, const char *item)
{
    return plan->strategy_count < BENCH_LIST &&
           helio_strategy_parse(item, &plan->strategies[plan->strategy_count++]) == HELIO_OK;
}

static bool add_material(bench_plan *plan, const char *item)
{
    bench_material *material = &plan->materials[plan->material_count];
    if (plan->material_count == BENCH_LIST || helio_material_parse(item, &material->material) != HELIO_OK)
        return false;
    strcpy(material->name, item);
    plan->material_count++;
    return true;
}

static bool add_stage(bench_plan *plan, const char *item)
{
    bool all = strcmp(item, "all") == 0, known = all;
    for (int stage = 0; stage < BENCH_STAGES; stage++)
        if ((all && stage < BENCH_DEVICE && (stage < BENCH_SCENE || HAS_RAYS)) || strcmp(item, stage_names[stage]) == 0)
            plan->stages[stage] = known = true;
    return known;
}

static void add_isa_once(bench_plan *plan, const char *name)
{
    for (uint32_t i = 0; i < plan->isa_count; i++)
        if (strcmp(plan->isas[i], name) == 0)
            return;
    if (plan->isa_count < BENCH_LIST)
        plan->isas[plan->isa_count++] = name;
}

/* The name, as the library holds it, of the instruction set that a context takes by itself; NULL if it takes none. */
static const char *default_isa(void)
{
    helio_context *context;
    const helio_context_desc desc = {.threads = 1};
    if (helio_context_create(&desc, &context) != HELIO_OK)
        return NULL;
    const char *name = helio_context_isa(context);
    helio_context_destroy(context);
    return name;
}

static bool add_isa(bench_plan *plan, const char *item)
{
    uint32_t before = plan->isa_count, count = 0;
    bool all = strcmp(item, "all") == 0;
    const char *best = all || strcmp(item, "best") == 0 ? default_isa() : NULL;
    if (best != NULL)
        add_isa_once(plan, best);
    while (helio_isa_name(count) != NULL)
        count++;
    for (uint32_t i = count; i > 0; i--)
        if (all || strcmp(item, helio_isa_name(i - 1)) == 0)
            add_isa_once(plan, helio_isa_name(i - 1));
    return plan->isa_count > before;
}

typedef struct list_option {
    const char *name;
    const char *takes; /* for the sentence about what it does not take; NULL: the library's */
    add_item *add;
    bool holds_specifications;
} list_option;

static const list_option list_options[] = {
    {"stages", "all, or some of machine, cube, tables, pools, estimate, scene, rays, frame and device", add_stage,
     false},
    {"isa", "all, best, or some of those that heliostat info names", add_isa, false},
    {"threads", "up to 16 whole numbers from 1 to 1024", add_threads, false},
    {"env-size", "up to 16 whole numbers from 1 to 4096", add_env_size, false},
    {"map-size", "up to 16 sizes such as 1024x512, each from 1 to 16384", add_map_size, false},
    {"spp", "up to 16 whole numbers from 1 to 65536", add_spp, false},
    {"strategy", "up to 16 of cosine, brdf, light, light+brdf, face, face+brdf, product, product+brdf and auto",
     add_strategy, false},
    {"material", NULL, add_material, true},
    {"mesh-size", "up to 16 whole numbers from 1 to 67108864", add_mesh_size, false},
};

static int parse_list(bench_plan *plan, const list_option *option, const char *text)
{
    char item[LIST_ITEM];
    for (const char *rest = text; rest != NULL;) {
        bool is_item = option->holds_specifications ? list_take_specification(&rest, item) : list_take(&rest, item);
        if (is_item && option->add(plan, item))
            continue;
        if (is_item && option->takes == NULL)
            return message_usage("--%s: %s", option->name, helio_last_error());
        return message_usage("--%s takes %s, separated by commas, not '%s'", option->name,
                             option->takes ? option->takes : "materials", text);
    }
    return EXIT_CODE_OK;
}

/* All cores, half of them, and so on to one. */
static void choose_threads(bench_plan *plan)
{
    for (unsigned threads = machine_cores(); threads > 0 && plan->threads.count < BENCH_LIST; threads /= 2)
        plan->threads.values[plan->threads.count++] = threads < 1024 ? threads : 1024;
}

/* With a graphics processor nothing else is measured unless it is named. */
static int choose_stages(bench_plan *plan)
{
    const bool is_vulkan = plan->options->backend[0] == 'v';
    if (plan->stages[BENCH_DEVICE] && !is_vulkan)
        return message_usage("the stage device of --stages is for graphics processors; give --backend vulkan as well");
    if (is_vulkan && strcmp(plan->options->bench.stages, "all") == 0)
        for (int stage = 0; stage < BENCH_STAGES; stage++)
            plan->stages[stage] = stage == BENCH_DEVICE;
    return EXIT_CODE_OK;
}

static void keep_first_values(bench_plan *plan)
{
    plan->isa_count = plan->strategy_count = plan->material_count = 1;
    plan->threads.count = plan->env_sizes.count = plan->map_sizes.count = plan->spp.count = 1;
    plan->mesh_sizes.count = 1;
}

static int parse_lists(bench_plan *plan)
{
    const bench_options *b = &plan->options->bench;
    /* As in list_options. */
    const char *const texts[] = {b->stages, b->isas,       b->threads,   b->env_sizes, b->map_sizes,
                                 b->spp,    b->strategies, b->materials, b->mesh_sizes};
    int code = EXIT_CODE_OK;
    for (size_t i = 0; code == EXIT_CODE_OK && i < sizeof texts / sizeof texts[0]; i++)
        code = parse_list(plan, &list_options[i], texts[i]);
    if (code == EXIT_CODE_OK)
        code = choose_stages(plan);
    if (plan->threads.count == 0)
        choose_threads(plan);
    if (b->quick)
        keep_first_values(plan);
    return code;
}

/* ---- files ---------------------------------------------------------------------------- */

/* The dragon comes with the sources only: where it is not found a mesh is made. */
static int choose_mesh(bench_plan *plan)
{
    const char *mesh = plan->options->mesh;
    if (mesh != NULL && strlen(mesh) >= sizeof plan->mesh)
        return message_usage("--mesh takes a path of less than %zu bytes, not one of %zu", sizeof plan->mesh,
                             strlen(mesh));
    if (mesh != NULL)
        strcpy(plan->mesh, mesh);
    else if (!HAS_MESHES || !asset_find(SHIPPED_MESH, plan->mesh, sizeof plan->mesh))
        plan->mesh[0] = 0;
    const char *slash = strrchr(plan->mesh, '/');
    plan->mesh_name = plan->mesh[0] == 0 ? BENCH_MADE_MESH : slash != NULL ? slash + 1 : plan->mesh;
    return EXIT_CODE_OK;
}

static int check_json(const bench_plan *plan)
{
    const char *path = plan->options->bench.json;
    const char *const inputs[] = {plan->light.specification, plan->mesh, NULL};
    return path != NULL && strcmp(path, "-") != 0 ? output_file_check("json", path, NULL, inputs) : EXIT_CODE_OK;
}

int bench_plan_make(bench_plan *plan, const cli_options *options)
{
    *plan = (bench_plan){.options = options, .repeat = options->bench.repeat, .least_repeats = LEAST_REPEATS};
    if (options->bench.quick) {
        plan->repeat = plan->repeat < REPEATS_QUICK ? plan->repeat : REPEATS_QUICK;
        plan->least_repeats = 1;
    }
    plan->job_ms = plan->repeat * MS_PER_REPEAT;
    int code = parse_lists(plan);
    if (code == EXIT_CODE_OK && helio_layout_parse(options->layout, &plan->layout) != HELIO_OK)
        code = message_usage("%s", helio_last_error());
    if (code == EXIT_CODE_OK)
        code = light_source_choose(options->env, false, &plan->light);
    if (code == EXIT_CODE_OK)
        code = choose_mesh(plan);
    if (code == EXIT_CODE_OK)
        code = check_json(plan);
    return code;
}
