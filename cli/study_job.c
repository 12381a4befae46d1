/* SPDX-License-Identifier: MIT */
#include "study_job.h"

#include "digest.h"
#include "input_source.h"
#include "interrupt.h"
#include "machine.h"
#include "message.h"
#include "study_measure.h"
#include "study_settings.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int failure(void)
{
    return message_failure("%s", helio_last_error());
}

static int check(helio_status status)
{
    if (status == HELIO_OK)
        return EXIT_CODE_OK;
    return status == HELIO_ERR_ARGUMENT ? message_usage("%s", helio_last_error()) : failure();
}

static int tell_stop(const study_job *job)
{
    message_failure("stopped; %s has what is finished, and --resume goes on with it", job->plan->options->study.out);
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

/* ---- files --------------------------------------------------------------------------------- */

void study_job_path(const study_plan *plan, const char *name, char path[STUDY_PATH])
{
    const char *out = plan->options->study.out;
    size_t length = strlen(out);
    snprintf(path, STUDY_PATH, "%s%s%s", out, out[length - 1] == '/' ? "" : "/", name);
}

/* Letters and digits of a name; what it may have lost is made up for by the numbers beside it. */
static void make_slug(const char *name, char slug[64])
{
    size_t used = 0;
    for (; *name != 0 && used < 40; name++) {
        bool is_plain = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z') ||
                        (*name >= '0' && *name <= '9') || *name == '_';
        if (is_plain || (used > 0 && slug[used - 1] != '-'))
            slug[used++] = is_plain ? *name : '-';
    }
    while (used > 0 && slug[used - 1] == '-')
        used--;
    slug[used] = 0;
}

void study_job_pair_name(const study_plan *plan, uint32_t environment, uint32_t material, char name[160])
{
    char first[64], second[64];
    make_slug(plan->environments[environment].name, first);
    make_slug(plan->materials[material].name, second);
    snprintf(name, 160, "%u-%s-%u-%s", environment + 1, first, material + 1, second);
}

void study_job_picture_path(const study_plan *plan, const study_point *point, const char *what, char path[STUDY_PATH])
{
    char pair[160], name[320], strategy[64];
    study_job_pair_name(plan, point->environment, point->material, pair);
    make_slug(plan->strategies[point->strategy].name, strategy);
    if (strcmp(what, "reference") == 0)
        snprintf(name, sizeof name, "pictures/%s-reference.png", pair);
    else
        snprintf(name, sizeof name, "pictures/%s-%u-%s-%u-%s.png", pair, point->strategy + 1, strategy,
                 plan->spp[point->spp], what);
    study_job_path(plan, name, path);
}

int study_job_folder(const study_plan *plan, const char *name)
{
    char path[STUDY_PATH];
    study_job_path(plan, name, path);
    if (mkdir(path, 0777) == 0 || errno == EEXIST)
        return EXIT_CODE_OK;
    return message_failure("the folder %s cannot be made: %s; give --out another path", path, strerror(errno));
}

/* A study in the folder is gone on with, or left alone. */
static int open_folder(study_job *job)
{
    char path[STUDY_PATH];
    struct stat status;
    int code = study_job_folder(job->plan, "");
    study_job_path(job->plan, "study.json", path);
    bool exists = code == EXIT_CODE_OK && stat(path, &status) == 0;
    if (exists && !job->plan->options->study.resume)
        return message_failure("%s holds a study already; go on with it by --resume, or give --out another folder",
                               job->plan->options->study.out);
    if (code == EXIT_CODE_OK)
        code = study_job_folder(job->plan, "references");
    if (code == EXIT_CODE_OK && study_job_has_pictures())
        code = study_job_folder(job->plan, "pictures");
    return code == EXIT_CODE_OK && exists ? study_record_load(&job->record, path) : code;
}

static int write_record(study_job *job)
{
    char path[STUDY_PATH];
    study_job_path(job->plan, "study.json", path);
    return study_record_write(&job->record, path);
}

/* ---- opening ------------------------------------------------------------------------------- */

static helio_status load_mesh(study_job *job)
{
    const cli_options *options = job->plan->options;
    const helio_mesh_load_desc limits = {.max_memory = (uint64_t)options->max_mesh_memory << 20,
                                         .max_seconds = options->max_mesh_seconds,
                                         .max_pixels = options->max_pixels};
    float aspect = (float)options->size[0] / (float)options->size[1];
    helio_status status = helio_mesh_load(job->context, job->plan->mesh, &limits, &job->mesh);
    if (status != HELIO_OK)
        return status;
    const helio_mesh *mesh = job->mesh;
    job->mesh_digest = digest_add(DIGEST_START, mesh->positions, (size_t)mesh->vertex_count * 3 * sizeof(float));
    job->mesh_digest =
        digest_add(job->mesh_digest, mesh->triangles, (size_t)mesh->triangle_count * 3 * sizeof(uint32_t));
    return helio_camera_parse(options->camera, mesh, aspect, &job->camera);
}

static helio_status make_comparisons(study_job *job)
{
    const uint32_t *size = job->plan->options->size;
    helio_comparison_desc desc = {.width = size[0], .height = size[1], .without_lab = !helio_comparison_has_lab()};
    helio_status status = helio_comparison_create(job->context, &desc, &job->full);
    desc.without_lab = desc.without_flip = desc.flicker = true;
    return status == HELIO_OK ? helio_comparison_create(job->context, &desc, &job->plain) : status;
}

int study_job_open(study_job *job, const study_plan *plan)
{
    const helio_environment_desc desc = {.cube_size = plan->options->env_size};
    *job = (study_job){.plan = plan};
    helio_status status = input_source_context(plan->options, &job->warnings, &job->context);
    if (status == HELIO_OK)
        status = load_mesh(job);
    if (status == HELIO_OK)
        status = helio_environment_create(job->context, &desc, &job->environment);
    if (status == HELIO_OK)
        status = make_comparisons(job);
    if (status != HELIO_OK)
        return check(status);
    int code = study_record_open(&job->record, plan, study_settings(job), study_scene(job));
    return code == EXIT_CODE_OK ? open_folder(job) : code;
}

static void release_truths(study_job *job)
{
    for (uint32_t i = 0; job->truths != NULL && i < job->light.count; i++)
        study_truth_release(&job->truths[i]);
    free(job->truths);
    job->truths = NULL;
}

void study_job_close(study_job *job)
{
    release_truths(job);
    study_light_release(&job->light);
    helio_scene_destroy(job->scene);
    helio_comparison_destroy(job->full);
    helio_comparison_destroy(job->plain);
    helio_environment_destroy(job->environment);
    if (job->mesh != NULL)
        helio_mesh_destroy(job->context, job->mesh);
    helio_context_destroy(job->context);
    study_record_release(&job->record);
}

/* ---- environments and materials ------------------------------------------------------------ */

static bool has_pictures(const study_job *job, const study_point *point)
{
    struct stat status;
    char path[STUDY_PATH];
    if (!study_job_has_pictures() || !study_plan_shows(job->plan, point->environment, point->material))
        return true;
    static const char *const names[] = {"reference", "picture", "error"};
    for (int i = 0; i < 3; i++) {
        study_job_picture_path(job->plan, point, names[i], path);
        if (stat(path, &status) != 0)
            return false;
    }
    return true;
}

/* With flicker and pictures, where they are shown. */
static bool is_finished(const study_job *job, const study_point *point)
{
    const study_cell *cell = &job->record.cells[study_plan_index(job->plan, point)];
    if (!cell->is_done || !job->plan->is_shown[point->spp])
        return cell->is_done;
    return (job->plan->sequence < 2 || !isnan(cell->flicker)) && has_pictures(job, point);
}

static bool has_work(const study_job *job, const study_point *pair)
{
    study_point point = *pair;
    for (point.strategy = 0; point.strategy < job->plan->strategy_count; point.strategy++)
        for (point.spp = 0; point.spp < job->plan->spp_count; point.spp++)
            if (!is_finished(job, &point))
                return true;
    return false;
}

static int open_light(study_job *job, uint32_t index)
{
    const study_environment *environment = &job->plan->environments[index];
    helio_status status = study_light_open(job->context, environment->specification, &job->plan->source,
                                           job->plan->sequence, &job->light);
    if (status != HELIO_OK && job->light.is_out_of_memory)
        return message_failure("no memory for the frames of %s", environment->specification);
    if (status != HELIO_OK)
        return check(status);
    if (job->light.count == 0)
        return message_failure("%s has no frame", environment->specification);
    if (study_record_note_digest(&job->record, index, job->light.digest))
        message_warning("%s is not what it was: what was measured with it is measured again",
                        environment->specification);
    return EXIT_CODE_OK;
}

static int make_scene(study_job *job, const study_material *material)
{
    const helio_scene_desc desc = {
        .mesh = job->mesh, .material = material->is_of_mesh ? NULL : &material->material, .ground = job->plan->ground};
    helio_scene_destroy(job->scene);
    job->scene = NULL;
    return check(helio_scene_create(job->context, &desc, &job->scene));
}

/* ---- references ---------------------------------------------------------------------------- */

static void make_truth_path(const study_job *job, const study_point *pair, uint32_t frame, char path[STUDY_PATH])
{
    char pair_name[160], name[320];
    uint64_t digest = digest_add(job->light.digest, &job->mesh_digest, sizeof job->mesh_digest);
    const char *material = job->plan->materials[pair->material].name;
    digest = digest_add(digest, material, strlen(material));
    digest = digest_add(digest, &frame, sizeof frame);
    study_job_pair_name(job->plan, pair->environment, pair->material, pair_name);
    snprintf(name, sizeof name, "references/%s-%08" PRIx32 ".exr", pair_name, (uint32_t)(digest ^ digest >> 32));
    study_job_path(job->plan, name, path);
}

/* Flicker can do with less. */
static uint32_t truth_spp(const study_job *job, uint32_t frame)
{
    uint32_t spp = job->plan->options->study.reference_spp, shown = job->plan->spp[job->plan->spp_count - 1];
    if (frame == study_plan_still(job->light.count) || spp / 4 < 16 * shown)
        return spp;
    return spp / 4;
}

static study_truth_desc describe_truth(const study_job *job, uint32_t frame)
{
    return (study_truth_desc){.renderer = study_renderer_desc(job),
                              .camera = job->camera,
                              .is_quadrature = study_plan_has_quadrature(job->plan),
                              .spp = truth_spp(job, frame),
                              .seed = study_seed_of(job, frame, 0)};
}

static int render_truth(study_job *job, uint32_t frame, const char *path)
{
    bool is_whole;
    const study_turn turn = study_turn_of(job->plan);
    study_truth_desc desc = describe_truth(job, frame);
    desc.progress = &job->progress;
    int code = check(study_light_apply(&job->light, frame, &turn, job->environment, NULL));
    if (code != EXIT_CODE_OK)
        return code;
    helio_status status = study_truth_make(job->context, &desc, &job->truths[frame], &is_whole);
    if (status == HELIO_ERR_MEMORY)
        return message_failure("no memory for a reference of %ux%u pixels", desc.renderer.width, desc.renderer.height);
    if (status != HELIO_OK || !is_whole)
        return status != HELIO_OK ? check(status) : tell_stop(job);
#ifdef HELIO_WITH_OPENEXR
    return check(study_truth_write(job->context, path, &job->truths[frame]));
#else
    (void)path;
    return EXIT_CODE_OK;
#endif
}

static int find_truths(study_job *job, const study_point *pair)
{
    int code = EXIT_CODE_OK;
    char path[STUDY_PATH];
    release_truths(job);
    job->truths = calloc(job->light.count, sizeof *job->truths);
    if (job->truths == NULL)
        return message_failure("no memory for references");
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < job->light.count; i++) {
        make_truth_path(job, pair, i, path);
        bool is_there = job->plan->options->study.resume &&
                        study_truth_read(job->context, path, job->plan->options->size, &job->truths[i]);
        if (!is_there)
            code = render_truth(job, i, path);
    }
    return code;
}

/* Of the studied frame, and with it how all its pictures are shown. */
static int choose_view(study_job *job, const study_point *pair)
{
    char path[STUDY_PATH];
    const uint32_t *size = job->plan->options->size;
    const study_truth *truth = &job->truths[study_plan_still(job->light.count)];
    const helio_comparison_pair seen = {.picture = truth->rgb, .reference = truth->rgb, .mask = truth->object};
    helio_status status = HELIO_OK;
    job->window = study_window_find(truth->object, size, job->plan->options->study.picture_size);
    job->exposure = (float)job->plan->options->study.exposure;
    if (isnan(job->exposure)) /* auto */
        status = helio_comparison_auto_exposure(job->plain, &seen, &job->exposure);
    study_job_picture_path(job->plan, pair, "reference", path);
    if (status == HELIO_OK && study_job_has_pictures() &&
        study_plan_shows(job->plan, pair->environment, pair->material))
        status = study_picture_write(job->context, path, &job->window, truth->rgb, size[0], 3, job->exposure,
                                     job->plan->tonemap);
    return check(status);
}

/* ---- the run ------------------------------------------------------------------------------- */

static int measure_point(study_job *job, const study_point *point)
{
    if (is_finished(job, point))
        return EXIT_CODE_OK;
    study_cell cell;
    bool is_whole = true;
    helio_status status = study_measure(job, point, &cell, &is_whole);
    if (status != HELIO_OK)
        return check(status);
    if (!is_whole)
        return tell_stop(job);
    study_record_keep(&job->record, study_plan_index(job->plan, point), &cell);
    if (job->plan->options->verbose)
        message_note("%s, %s, %s, %u spp: relmse %.4g, lab_mean %.4g in %.1f ms",
                     job->plan->environments[point->environment].name, job->plan->materials[point->material].name,
                     job->plan->strategies[point->strategy].name, job->plan->spp[point->spp], cell.relmse,
                     cell.lab_mean, cell.total_ms);
    return write_record(job);
}

static int measure_pair(study_job *job, const study_point *pair)
{
    study_point point = *pair;
    int code = make_scene(job, &job->plan->materials[pair->material]);
    if (code == EXIT_CODE_OK)
        code = find_truths(job, pair);
    if (code == EXIT_CODE_OK)
        code = choose_view(job, pair);
    for (point.strategy = 0; code == EXIT_CODE_OK && point.strategy < job->plan->strategy_count; point.strategy++)
        for (point.spp = 0; code == EXIT_CODE_OK && point.spp < job->plan->spp_count; point.spp++)
            code = measure_point(job, &point);
    return code;
}

static int measure_environment(study_job *job, uint32_t environment)
{
    int code = open_light(job, environment);
    for (uint32_t material = 0; code == EXIT_CODE_OK && material < job->plan->material_count; material++) {
        const study_point pair = {.environment = environment, .material = material};
        if (has_work(job, &pair))
            code = measure_pair(job, &pair);
        if (code == EXIT_CODE_OK && interrupt_signal() != 0)
            code = tell_stop(job);
    }
    release_truths(job);
    study_light_release(&job->light);
    return code;
}

/* What is not finished. */
static double count_work(const study_job *job)
{
    const study_plan *plan = job->plan;
    const study_truth_desc truth = describe_truth(job, 0);
    double work = 0;
    for (size_t i = 0; i < study_plan_count(plan); i++) {
        study_point point = study_plan_point(plan, i);
        if (point.strategy == 0 && point.spp == 0 && has_work(job, &point))
            work += plan->sequence * study_truth_work(&truth);
        if (!is_finished(job, &point))
            work += study_measure_work(plan, &point);
    }
    return work;
}

int study_job_run(study_job *job)
{
    const study_plan *plan = job->plan;
    int code = write_record(job);
    job->progress.total = count_work(job);
    progress_start(&job->progress.bar, 1, 0, plan->options->quiet);
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < plan->environment_count; i++)
        code = measure_environment(job, i);
    progress_end(&job->progress.bar);
    frame_warnings_end(&job->warnings);
    return code == EXIT_CODE_OK ? write_record(job) : code;
}

/* ---- what is shown ------------------------------------------------------------------------- */

bool study_job_has_pictures(void)
{
#ifdef HELIO_WITH_PNG
    return true;
#else
    return false;
#endif
}

helio_error_map study_job_error_map(double *range)
{
    *range = helio_comparison_has_lab() ? 20 : 1;
    return helio_comparison_has_lab() ? HELIO_ERROR_MAP_LAB : HELIO_ERROR_MAP_FLIP;
}
