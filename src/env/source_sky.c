/* SPDX-License-Identifier: MIT
 *
 * Skies: a moment, or a day from sunrise to sunset. */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"

#include <math.h>

typedef struct sky {
    source_reader base;
    sky_specification specification;
    double sunrise, sunset; /* of a day, local hours */
    uint64_t steps;         /* frames of the whole day, those included that nobody wants */
    uint64_t first, next, end;
} sky;

static double find_hours(const sky *self, uint64_t index)
{
    if (!self->specification.is_day)
        return self->specification.has_sun ? (double)NAN : self->specification.place.hours;
    double part = self->steps > 1 ? (double)index / (double)(self->steps - 1) : 0.0;
    return self->sunrise + part * (self->sunset - self->sunrise);
}

static helio_status find_sun(const sky *self, double hours, helio_sun *sun)
{
    helio_sky_place place = self->specification.place;
    place.hours = hours;
    return helio_sun_find(&place, sun);
}

static helio_status read_sky(source_reader *reader, source_slot *slot)
{
    sky *self = (sky *)reader;
    if (self->next == self->end)
        return HELIO_OK;
    slot->sky = self->specification.desc;
    double hours = find_hours(self, self->next);
    if (self->specification.is_day)
        HELIO_TRY(find_sun(self, hours, &slot->sky.sun));
    /* Far from the zone's meridian the sun of a date may set on the next. */
    slot->frame.hours = hours > 24.0 || hours < 0.0 ? hours - 24.0 * floor(hours / 24.0) : hours;
    slot->frame.sky = &slot->sky;
    slot->frame.index = self->next;
    slot->frame.seconds = (double)(self->next - self->first) / reader->desc.fps;
    self->next++;
    return HELIO_OK;
}

static void destroy_sky(source_reader *reader)
{
    context_release(reader->context, reader);
}

static const source_reader_kind SKY_KIND = {read_sky, destroy_sky};

static helio_status plan_frames(sky *self, uint64_t *count)
{
    self->steps = 1;
    if (self->specification.is_day) {
        self->steps = self->base.desc.frames;
        HELIO_TRY(helio_sun_day(&self->specification.place, &self->sunrise, &self->sunset));
    }
    *count = self->steps;
    HELIO_TRY(source_limit_frames(&self->base.desc, self->base.label, &self->first, count));
    self->next = self->first;
    self->end = self->first + *count;
    return HELIO_OK;
}

helio_status source_sky_open(const source_opening *opening, source_reader **reader)
{
    sky *self = source_reader_allocate(opening, sizeof *self, &SKY_KIND);
    if (self == NULL)
        return HELIO_ERR_MEMORY;
    self->specification = opening->specification->sky;
    helio_status status = plan_frames(self, &opening->info->frame_count);
    if (status != HELIO_OK) {
        destroy_sky(&self->base);
        return status;
    }
    *reader = &self->base;
    return HELIO_OK;
}
