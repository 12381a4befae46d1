/* SPDX-License-Identifier: MIT
 *
 * A new frame: pixels are summed into the cube, and those that are no light counted, if there are any. */
#include "core/context.h"
#include "core/error.h"
#include "env/environment.h"
#include "env/exposure.h"
#include "env/map_sink.h"
#include "env/resampler.h"
#include "image/pixel_fault.h"
#include "sampling/kernels.h"

typedef struct hygiene {
    helio_environment *environment;
    const kernel_set *kernels;
    map_pixels pixels;
} hygiene;

static void count_faults(const hygiene *work, size_t row, uint32_t first, uint32_t end, helio_bad_pixels *bad)
{
    uint64_t faults[PIXEL_GOOD + 1] = {0};
    for (uint32_t column = first; column < end; column++) {
        float rgb[3];
        map_pixels_read(&work->pixels, (int64_t)row, column, rgb);
        faults[pixel_fault_of(rgb)]++;
    }
    bad->nan += faults[PIXEL_NAN];
    bad->infinite += faults[PIXEL_INFINITE];
    bad->negative += faults[PIXEL_NEGATIVE];
}

static void check_row(void *data, size_t row)
{
    enum { PIECE = 256 }; /* pixels that are looked at one by one if there is a fault among them */
    hygiene *work = data;
    environment_map *map = &work->environment->map;
    const uint32_t numbers = work->pixels.pixel_bytes / map_number_bytes(work->pixels.numbers);
    helio_bad_pixels bad = {0};
    for (uint32_t first = 0; first < map->width; first += PIECE) {
        uint32_t count = map->width - first < PIECE ? map->width - first : PIECE;
        const void *piece = map_pixels_at(&work->pixels, (int64_t)row, first);
        if (work->kernels->may_have_faults(piece, count * numbers, work->pixels.numbers))
            count_faults(work, row, first, first + count, &bad);
    }
    map->row_faults[row] = bad;
}

static helio_bad_pixels count_all_faults(hygiene *work)
{
    const environment_map *map = &work->environment->map;
    context_parallel_for(work->environment->context, map->height, check_row, work);
    helio_bad_pixels bad = {0};
    for (uint32_t row = 0; row < map->height; row++) {
        bad.nan += map->row_faults[row].nan;
        bad.infinite += map->row_faults[row].infinite;
        bad.negative += map->row_faults[row].negative;
    }
    return bad;
}

void environment_finish_frame(helio_environment *environment, helio_bad_pixels bad, helio_environment_info *info)
{
    environment->frame++;
    environment->is_late = false;
    if (info == NULL)
        return;
    *info = (helio_environment_info){.bad = bad};
    exposure_measure(environment, info);
}

static helio_status resolve_pixels(const environment_map *map, const helio_pixels *given, map_pixels *pixels)
{
    static const map_numbers kinds[] = {MAP_FLOATS, MAP_FLOATS, MAP_HALVES, MAP_HALVES, MAP_WORDS};
    static const uint32_t channels[] = {3, 4, 3, 4, 1};
    if ((unsigned)given->format > HELIO_PIXELS_RGB9E5)
        return fail(HELIO_ERR_ARGUMENT, "pixel format %d is unknown; use a value of helio_pixel_format",
                    (int)given->format);
    const uint32_t number = map_number_bytes(kinds[given->format]);
    *pixels = (map_pixels){.first = given->data,
                           .row_bytes = given->row_bytes,
                           .pixel_bytes = channels[given->format] * number,
                           .numbers = kinds[given->format]};
    ptrdiff_t least = (ptrdiff_t)map->width * pixels->pixel_bytes;
    if (pixels->row_bytes == 0)
        pixels->row_bytes = least;
    if (pixels->row_bytes < least && pixels->row_bytes > -least)
        return fail(HELIO_ERR_ARGUMENT, "rows of %u pixels take %td bytes; row_bytes cannot be %td", map->width, least,
                    given->row_bytes);
    if (pixels->row_bytes % number != 0 || (uintptr_t)given->data % number != 0)
        return fail(HELIO_ERR_ARGUMENT, "pixels and row_bytes (%td) must be multiples of a number's size, %u bytes",
                    given->row_bytes, number);
    return HELIO_OK;
}

helio_status helio_environment_update_pixels(helio_environment *environment, const helio_pixels *given,
                                             helio_environment_info *info)
{
    if (environment == NULL || given == NULL || given->data == NULL)
        return fail(HELIO_ERR_ARGUMENT, "an update needs an environment and pixels");
    const environment_map *map = &environment->map;
    if (map->resampler == NULL)
        return fail(HELIO_ERR_ARGUMENT, "this environment was created without a map; call "
                                        "helio_environment_reshape() before it is updated from one");
    hygiene work = {.environment = environment, .kernels = kernels_of(context_isa(environment->context))};
    HELIO_TRY(resolve_pixels(map, given, &work.pixels));
    if (info == NULL && map_sink_offer(environment, &work.pixels)) {
        environment->frame++;
        return HELIO_OK;
    }
    bool faults = resampler_run(environment->context, map->resampler, &work.pixels, environment->cube);
    helio_bad_pixels bad = {0};
    if (faults || !resampler_sees_all(map->resampler))
        bad = count_all_faults(&work);
    environment_finish_frame(environment, bad, info);
    return HELIO_OK;
}

helio_status helio_environment_update(helio_environment *environment, const float *rgb, helio_environment_info *info)
{
    return helio_environment_update_pixels(environment, &(helio_pixels){.data = rgb}, info);
}
