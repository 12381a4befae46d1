/* SPDX-License-Identifier: MIT
 *
 * References: life, and one piece after the other. */
#include "eval/reference.h"

#include "core/context.h"
#include "core/error.h"
#include "core/random.h"

#include <string.h>

static const double DEFAULT_TOLERANCE = 1e-5, LEAST_TOLERANCE = 1e-9, GREATEST_TOLERANCE = 0.1;
enum { DEFAULT_SPP = 64 };

/* ---- creation ---- */

/* The only place where the defaults of a reference live, but for those of the renderer. */
static helio_status resolve_desc(const helio_reference_desc *given, helio_reference_desc *desc)
{
    *desc = *given;
    helio_renderer_desc *renderer = &desc->renderer;
    bool is_quadrature = desc->method == HELIO_REFERENCE_QUADRATURE;
    if (desc->method != HELIO_REFERENCE_SAMPLING && !is_quadrature)
        return fail(HELIO_ERR_ARGUMENT, "method %d is unknown; use a value of helio_reference_method",
                    (int)desc->method);
    desc->tolerance = desc->tolerance != 0.0 ? desc->tolerance : DEFAULT_TOLERANCE;
    if (!(desc->tolerance >= LEAST_TOLERANCE && desc->tolerance <= GREATEST_TOLERANCE))
        return fail(HELIO_ERR_ARGUMENT, "a tolerance of %g cannot be used; give a number from %g to %g",
                    desc->tolerance, LEAST_TOLERANCE, GREATEST_TOLERANCE);
    if (renderer->aovs)
        return fail(HELIO_ERR_ARGUMENT, "a reference has no aovs; render them");
    if (is_quadrature && !renderer->no_visibility)
        return fail(HELIO_ERR_ARGUMENT,
                    "quadrature traces no rays, so nothing shadows; set no_visibility, or take samples");
    if (renderer->strategy == HELIO_STRATEGY_AUTO || is_quadrature)
        renderer->strategy = HELIO_STRATEGY_COSINE;
    renderer->aa = renderer->aa ? renderer->aa : 1;
    uint32_t spp = renderer->spp ? renderer->spp : DEFAULT_SPP;
    renderer->spp = is_quadrature ? 1 : (spp - 1) / renderer->aa + 1;
    return HELIO_OK;
}

static helio_status check_environment(const helio_reference_desc *desc)
{
    const helio_environment *environment = desc->renderer.environment;
    if (environment != NULL && environment->frame == 0)
        return fail(HELIO_ERR_ARGUMENT, "a reference needs an environment that holds its map; update it first");
    return HELIO_OK;
}

/* Lights a point for the renderer. */
static void light_by_quadrature(void *user, size_t pixel, const helio_shading_point *point, estimate_result *result)
{
    helio_reference *reference = user;
    quadrature_result sum;
    quadrature_point(reference->quadrature, point, &sum);
    for (int c = 0; c < 3; c++) {
        result->visible[c] = result->unoccluded[c] = (float)sum.rgb[c];
        result->control[c] = 0.0f;
        reference->bounds[pixel][c] = (float)sum.bound[c];
    }
    result->info = (helio_estimate_info){.samples = (uint32_t)sum.evaluations};
}

static helio_status allocate_pixels(helio_reference *reference)
{
    helio_context *context = reference->context;
    size_t count = (size_t)reference->desc.renderer.width * reference->desc.renderer.height;
    bool has_bounds = reference->quadrature != NULL;
    reference->pixels = context_allocate(context, count, sizeof *reference->pixels);
    reference->rgba = context_allocate(context, count, 4 * sizeof(float));
    reference->object = context_allocate(context, count, sizeof(float));
    reference->standard_error = context_allocate(context, count, 3 * sizeof(float));
    reference->rows = context_allocate(context, reference->desc.renderer.height, sizeof *reference->rows);
    if (has_bounds)
        reference->bounds = context_allocate(context, count, sizeof *reference->bounds);
    return reference->pixels != NULL && reference->rgba != NULL && reference->object != NULL &&
                   reference->standard_error != NULL && reference->rows != NULL &&
                   (reference->bounds != NULL || !has_bounds)
               ? HELIO_OK
               : HELIO_ERR_MEMORY;
}

static helio_status create_parts(helio_reference *reference)
{
    helio_reference_desc *desc = &reference->desc;
    renderer_extras extras = {.keeps_sums = true};
    if (desc->method == HELIO_REFERENCE_QUADRATURE) {
        extras.lighting = light_by_quadrature;
        extras.user = reference;
    }
    HELIO_TRY(renderer_create(reference->context, &desc->renderer, &extras, &reference->renderer));
    desc->renderer = reference->renderer->desc;
    float aspect = (float)desc->renderer.width / (float)desc->renderer.height;
    HELIO_TRY(camera_frame_create(&desc->camera, aspect, &reference->camera));
    if (desc->method == HELIO_REFERENCE_QUADRATURE)
        HELIO_TRY(quadrature_create(desc->renderer.environment, desc->tolerance, &reference->quadrature));
    HELIO_TRY(allocate_pixels(reference));
    reference->frame = desc->renderer.environment->frame;
    reference->subject = reference_describe(reference);
    return HELIO_OK;
}

helio_status helio_reference_create(helio_context *context, const helio_reference_desc *given, helio_reference **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || given == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_reference_create needs a context, a desc and a place for the result");
    helio_reference_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    HELIO_TRY(check_environment(&desc));
    helio_reference *reference = context_allocate(context, 1, sizeof *reference);
    if (reference == NULL)
        return HELIO_ERR_MEMORY;
    reference->context = context;
    reference->desc = desc;
    helio_status status = create_parts(reference);
    if (status != HELIO_OK) {
        helio_reference_destroy(reference);
        return status;
    }
    *out = reference;
    return HELIO_OK;
}

void helio_reference_destroy(helio_reference *reference)
{
    if (reference == NULL)
        return;
    helio_context *context = reference->context;
    context_release(context, reference->pixels);
    context_release(context, reference->bounds);
    context_release(context, reference->rgba);
    context_release(context, reference->object);
    context_release(context, reference->standard_error);
    context_release(context, reference->rows);
    quadrature_destroy(reference->quadrature);
    helio_renderer_destroy(reference->renderer);
    context_release(context, reference);
}

/* ---- how far it is ---- */

uint32_t reference_bands(const helio_reference *reference)
{
    return (reference->desc.renderer.height + TILE - 1) / TILE;
}

uint64_t reference_passes(const helio_reference *reference, uint32_t row)
{
    if (reference->quadrature == NULL)
        return reference->pieces;
    uint32_t bands = reference_bands(reference), band = row / TILE;
    return reference->pieces / bands + (reference->pieces % bands > band);
}

static uint64_t piece_count(const helio_reference *reference)
{
    return reference->quadrature != NULL ? (uint64_t)reference_bands(reference) * reference->desc.renderer.aa : 0;
}

helio_reference_info helio_reference_get_info(const helio_reference *reference)
{
    const helio_renderer_desc *desc = &reference->desc.renderer;
    bool is_quadrature = reference->quadrature != NULL;
    uint64_t piece_spp = is_quadrature ? 0 : (uint64_t)desc->spp * desc->aa;
    return (helio_reference_info){
        .pieces = reference->pieces,
        .piece_count = piece_count(reference),
        .spp = reference->pieces * piece_spp,
        .piece_spp = piece_spp,
        .complete = is_quadrature && reference->pieces == piece_count(reference),
        .samples = reference->samples,
    };
}

/* ---- one piece ---- */

/* Of what the renderer has just summed up for a pixel. passes: that it had before. */
static void add_pass(helio_reference *reference, size_t index, uint64_t passes)
{
    reference_pixel *pixel = &reference->pixels[index];
    const film_light *pass = &reference->renderer->film.lights[index];
    bool shows_background = reference_shows_background(reference);
    double weight = reference_weight(reference), before[3], here[3], after[3];
    film_colour(&pixel->light, shows_background, weight * (double)passes, before);
    film_colour(pass, shows_background, weight, here);
    film_light_add(&pixel->light, pass);
    film_colour(&pixel->light, shows_background, weight * (double)(passes + 1), after);
    for (int c = 0; c < 3; c++) { /* Welford's way, which loses nothing where passes differ by little */
        if (passes > 0)
            pixel->squares[c] += fmax(0.0, (here[c] - before[c]) * (here[c] - after[c]));
        if (reference->bounds != NULL)
            pixel->bound[c] += (double)reference->bounds[index][c];
    }
}

typedef struct row_range {
    helio_reference *reference;
    uint32_t first;
} row_range;

static void add_row(void *data, size_t index)
{
    const row_range *range = data;
    helio_reference *reference = range->reference;
    uint32_t width = reference->desc.renderer.width, row = range->first + (uint32_t)index;
    uint64_t passes = reference_passes(reference, row);
    for (size_t column = 0; column < width; column++)
        add_pass(reference, (size_t)row * width + column, passes);
}

static void add_rows(helio_reference *reference, uint32_t first, uint32_t end)
{
    row_range range = {reference, first};
    context_parallel_for(reference->context, end - first, add_row, &range);
    reference->pieces++;
}

/* A pass is a frame whose seed no other pass has. Seeds go on from a place that the reference's own seed chooses, far
 * from the small numbers that people give to frames. */
static helio_status sample(helio_reference *reference, bool (*progress)(void *, float), void *user, bool *is_stopped)
{
    const helio_frame_desc desc = {
        .camera = reference->desc.camera,
        .seed = hash(reference->desc.seed ^ 0x7ef52a3bu) + (uint32_t)reference->pieces,
        .progress = progress,
        .user = user,
    };
    helio_frame_info info;
    HELIO_TRY(helio_renderer_render(reference->renderer, &desc, &info));
    *is_stopped = info.stopped;
    reference->samples = info.samples;
    if (!info.stopped)
        add_rows(reference, 0, reference->desc.renderer.height);
    return HELIO_OK;
}

static const double SLICE_MS = 75.0;

/* The tiles of one band, for one camera sample. Tells whether they are done. */
static bool light_band(helio_reference *reference, struct frame *frame, uint32_t band, bool (*progress)(void *, float),
                       void *user)
{
    helio_frame_info unused = {0};
    size_t first = band * frame->tiles_across, done;
    uint32_t width = reference->desc.renderer.width, low = band * TILE, height = reference->desc.renderer.height;
    uint32_t end = low + TILE < height ? low + TILE : height;
    frame->next_tile = first;
    frame->tile_count = first + frame->tiles_across;
    memset(reference->bounds[(size_t)low * width], 0, (size_t)(end - low) * width * sizeof *reference->bounds);
    do {
        done = frame_work(frame, progress != NULL ? SLICE_MS : HUGE_VAL, &unused) - first;
        if (progress != NULL && !progress(user, (float)done / (float)frame->tiles_across))
            return false;
    } while (done < frame->tiles_across);
    reference->samples = frame->samples;
    add_rows(reference, low, end);
    return true;
}

static helio_status integrate(helio_reference *reference, bool (*progress)(void *, float), void *user, bool *is_stopped)
{
    helio_renderer *renderer = reference->renderer;
    uint32_t bands = reference_bands(reference);
    uint32_t step = (uint32_t)(reference->pieces / bands), band = (uint32_t)(reference->pieces % bands);
    HELIO_TRY(helio_tables_update(renderer->tables));
    HELIO_TRY(helio_pools_draw(renderer->pools, reference->desc.seed, 0));
    struct frame frame = frame_begin(renderer, &reference->camera, reference->desc.seed);
    HELIO_TRY(frame_begin_step(renderer, &frame, step, false));
    frame.step.is_first = frame.step.is_last = true; /* a camera sample is a pass of its own */
    *is_stopped = !light_band(reference, &frame, band, progress, user);
    return HELIO_OK;
}

helio_status helio_reference_advance(helio_reference *reference, bool (*progress)(void *user, float done), void *user,
                                     helio_reference_info *info)
{
    if (reference == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_reference_advance needs a reference");
    if (reference->desc.renderer.environment->frame != reference->frame)
        return fail(HELIO_ERR_ARGUMENT, "the environment has a new map since the reference was begun; create another");
    bool is_quadrature = reference->quadrature != NULL, is_stopped = false;
    if (!is_quadrature && reference->pieces == UINT32_MAX)
        return fail(HELIO_ERR_ARGUMENT, "a reference has no more than %u passes", UINT32_MAX);
    if (!is_quadrature)
        HELIO_TRY(sample(reference, progress, user, &is_stopped));
    else if (reference->pieces < piece_count(reference))
        HELIO_TRY(integrate(reference, progress, user, &is_stopped));
    if (info != NULL) {
        *info = helio_reference_get_info(reference);
        info->stopped = is_stopped;
    }
    return HELIO_OK;
}
