/* SPDX-License-Identifier: MIT
 *
 * References that are written and taken up again. */
#include "core/context.h"
#include "core/error.h"
#include "eval/reference.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- records ---- */

static bool has_catcher(const helio_reference *reference)
{
    return reference->desc.renderer.scene->ground == HELIO_GROUND_SHADOW;
}

/* Where the numbers of a pixel's record are, in the order of the file. Returns how many there are. */
static uint32_t find_numbers(const helio_reference *reference, reference_pixel *pixel,
                             double *numbers[CHECKPOINT_NUMBERS])
{
    film_light *light = &pixel->light;
    uint32_t count = 0;
    for (int c = 0; c < 3; c++) {
        numbers[count++] = &light->rgb[c];
        numbers[count++] = &pixel->squares[c];
    }
    numbers[count++] = &light->covered;
    numbers[count++] = &light->object;
    for (int c = 0; c < 3 && has_catcher(reference); c++)
        numbers[count++] = &light->catcher_background[c];
    if (has_catcher(reference)) {
        numbers[count++] = &light->catcher;
        numbers[count++] = &light->reaching;
        numbers[count++] = &light->unoccluded;
    }
    for (int c = 0; c < 3 && reference->quadrature != NULL; c++)
        numbers[count++] = &pixel->bound[c];
    return count;
}

static void get_record(const void *user, size_t index, double *record)
{
    const helio_reference *reference = user;
    double *numbers[CHECKPOINT_NUMBERS];
    uint32_t count = find_numbers(reference, &reference->pixels[index], numbers);
    for (uint32_t i = 0; i < count; i++)
        record[i] = *numbers[i];
}

/* ---- files ---- */

static checkpoint_head make_head(const helio_reference *reference)
{
    reference_pixel pixel;
    double *numbers[CHECKPOINT_NUMBERS];
    checkpoint_head head = {
        .version = helio_version(),
        .width = reference->desc.renderer.width,
        .height = reference->desc.renderer.height,
        .numbers = find_numbers(reference, &pixel, numbers),
        .subject = reference->subject,
        .pieces = reference->pieces,
    };
    snprintf(head.isa, sizeof head.isa, "%s", helio_context_isa(reference->context));
    return head;
}

helio_status helio_reference_save(const helio_reference *reference, const char *path)
{
    if (reference == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_reference_save needs a reference and a path");
    const checkpoint_head head = make_head(reference);
    return checkpoint_write(path, &head, get_record, reference);
}

typedef struct resumption {
    helio_reference *reference;
    const char *path;
    checkpoint_head head; /* of the file */
} resumption;

/* What differs, in words, or NULL. */
static const char *find_difference(const checkpoint_head *own, const checkpoint_head *found)
{
    if (found->subject.map != own->subject.map)
        return "another map, or one that is turned or scaled otherwise";
    if (found->subject.scene != own->subject.scene)
        return "another mesh, material or ground";
    if (found->subject.view != own->subject.view || found->width != own->width || found->height != own->height)
        return "another camera or size";
    if (found->subject.settings != own->subject.settings || found->numbers != own->numbers)
        return "another method or other settings";
    return NULL;
}

static helio_status check_head(void *user, const checkpoint_head *found)
{
    resumption *r = user;
    const helio_reference *reference = r->reference;
    const checkpoint_head own = make_head(reference);
    const helio_reference_info info = helio_reference_get_info(reference);
    if (found->version != own.version)
        return fail(HELIO_ERR_DATA,
                    "the checkpoint %s was made by version %u.%u.%u, whose samples may be others; remove it and begin "
                    "anew",
                    r->path, found->version >> 16, found->version >> 8 & 255, found->version & 255);
    const char *difference = find_difference(&own, found);
    if (difference != NULL)
        return fail(HELIO_ERR_DATA,
                    "the checkpoint %s is of another reference: of %s; give the options that it was begun with, or "
                    "remove it",
                    r->path, difference);
    if (found->pieces > (info.piece_count > 0 ? info.piece_count : UINT32_MAX))
        return fail(HELIO_ERR_DATA, "the checkpoint %s is damaged: it claims %" PRIu64 " pieces", r->path,
                    found->pieces);
    if (strcmp(found->isa, own.isa) != 0)
        context_log(
            reference->context, HELIO_LOG_WARNING,
            "the checkpoint %s was made by kernels for %s, and goes on with those for %s: as right, but not the "
            "same to the last bit",
            r->path, found->isa, own.isa);
    r->head = *found;
    return HELIO_OK;
}

static void put_record(void *user, size_t index, const double *record)
{
    const helio_reference *reference = ((const resumption *)user)->reference;
    double *numbers[CHECKPOINT_NUMBERS];
    uint32_t count = find_numbers(reference, &reference->pixels[index], numbers);
    for (uint32_t i = 0; i < count; i++)
        *numbers[i] = record[i];
}

/* As it was created. */
static void clear(helio_reference *reference)
{
    size_t count = (size_t)reference->desc.renderer.width * reference->desc.renderer.height;
    memset(reference->pixels, 0, count * sizeof *reference->pixels);
    reference->pieces = 0;
}

helio_status helio_reference_resume(helio_reference *reference, const char *path)
{
    if (reference == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_reference_resume needs a reference and a path");
    resumption r = {.reference = reference, .path = path};
    const checkpoint_reader reader = {.check = check_head, .put = put_record, .user = &r};
    clear(reference);
    helio_status status = checkpoint_read(path, &reader);
    if (status == HELIO_OK)
        reference->pieces = r.head.pieces;
    else
        clear(reference);
    return status;
}
