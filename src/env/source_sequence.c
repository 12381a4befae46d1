/* SPDX-License-Identifier: MIT
 *
 * Pictures one after the other, by number or by name. */
#include "env/source_reader.h"

#include "core/context.h"
#include "core/error.h"
#include "env/source_names.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct sequence {
    source_reader base;
    bool has_names;
    glob_t names;           /* by a pattern of the shell */
    source_pattern pattern; /* or by numbers */
    source_numbers numbers; /* for which there was a file when the sequence was opened */
    uint64_t first, next, last;
    bool has_frame; /* was there a good one? */
} sequence;

/* ---- reading ---- */

static helio_status name_frame(const sequence *self, uint64_t index, char name[SOURCE_PATH_SIZE])
{
    bool fits = self->has_names ? snprintf(name, SOURCE_PATH_SIZE, "%s", self->names.gl_pathv[index]) < SOURCE_PATH_SIZE
                                : source_pattern_format(&self->pattern, (uint32_t)index, name);
    return fits ? HELIO_OK
                : fail(HELIO_ERR_ARGUMENT, "the name of frame %" PRIu64 " of %s is too long", index, self->base.label);
}

/* A frame that is not there, in a run of others that are not: the first number after them. */
static uint64_t end_of_gap(const sequence *self, uint64_t index, const char *name)
{
    if (self->has_names || access(name, F_OK) == 0)
        return index + 1;
    size_t next = source_numbers_from(&self->numbers, index + 1);
    uint64_t number = next < self->numbers.count ? self->numbers.numbers[next] : self->last + 1;
    return number > self->last ? self->last + 1 : number;
}

static void skip_frames(sequence *self, uint64_t index, const char *name)
{
    self->next = end_of_gap(self, index, name);
    if (self->next == index + 1)
        context_log(self->base.context, HELIO_LOG_WARNING, "frame %" PRIu64 " of %s is skipped: %s", index,
                    self->base.label, helio_last_error());
    else
        context_log(self->base.context, HELIO_LOG_WARNING,
                    "frames %" PRIu64 " to %" PRIu64 " of %s are skipped: there are no such files", index,
                    self->next - 1, self->base.label);
}

static void hold_frame(sequence *self, uint64_t index, source_slot *slot)
{
    slot->frame.is_held = true;
    self->next = index + 1;
    context_log(self->base.context, HELIO_LOG_WARNING, "frame %" PRIu64 " of %s is the one before it again: %s", index,
                self->base.label, helio_last_error());
}

static helio_status fail_frame(const sequence *self, uint64_t index, helio_status status)
{
    if (status == HELIO_ERR_MEMORY)
        return fail(status, "frame %" PRIu64 " of %s: %s", index, self->base.label, helio_last_error());
    return fail(status,
                "frame %" PRIu64 " of %s: %s; to go on without it, choose skip or hold for missing frames "
                "(--on-missing)",
                index, self->base.label, helio_last_error());
}

static helio_status finish_sequence(const sequence *self)
{
    if (self->has_frame || atomic_load(self->base.stopping))
        return HELIO_OK;
    return fail(HELIO_ERR_DATA, "%s has not one frame that can be read; the last failure is: %s", self->base.label,
                helio_last_error());
}

static helio_status read_sequence(source_reader *reader, source_slot *slot)
{
    sequence *self = (sequence *)reader;
    while (self->next <= self->last && !atomic_load(reader->stopping)) {
        uint64_t index = self->next;
        HELIO_TRY(name_frame(self, index, slot->name));
        slot->frame.index = index;
        slot->frame.seconds = (double)(index - self->first) / reader->desc.fps;
        slot->frame.name = slot->name;
        helio_status status = source_read_picture(reader, slot->name, slot);
        if (status == HELIO_OK) {
            self->has_frame = true;
            self->next++;
            return HELIO_OK;
        }
        if (status == HELIO_ERR_MEMORY || reader->desc.on_missing == HELIO_ON_MISSING_STOP)
            return fail_frame(self, index, status);
        if (reader->desc.on_missing == HELIO_ON_MISSING_HOLD && self->has_frame) {
            hold_frame(self, index, slot);
            return HELIO_OK;
        }
        skip_frames(self, index, slot->name);
    }
    return finish_sequence(self);
}

static void destroy_sequence(source_reader *reader)
{
    sequence *self = (sequence *)reader;
    globfree(&self->names);
    context_release(reader->context, self->numbers.numbers);
    context_release(reader->context, self);
}

static const source_reader_kind SEQUENCE_KIND = {read_sequence, destroy_sequence};

/* ---- opening ---- */

static helio_status find_names(sequence *self, uint64_t *count)
{
    HELIO_TRY(source_names_find(self->base.label, &self->names));
    *count = self->names.gl_pathc;
    HELIO_TRY(source_limit_frames(&self->base.desc, self->base.label, &self->first, count));
    self->last = self->first + *count - 1;
    return HELIO_OK;
}

/* How many frames will come if all files that are there can be read. */
static helio_status find_numbers(sequence *self, uint64_t *count)
{
    const helio_source_desc *desc = &self->base.desc;
    source_numbers *numbers = &self->numbers;
    HELIO_TRY(source_numbers_find(self->base.context, &self->pattern, numbers));
    self->first = desc->has_frames ? desc->first : numbers->numbers[0];
    self->last = desc->has_frames ? desc->last : numbers->numbers[numbers->count - 1];
    size_t begin = source_numbers_from(numbers, self->first), end = source_numbers_from(numbers, self->last + 1);
    char name[SOURCE_PATH_SIZE];
    if (begin == end && self->first == self->last && source_pattern_format(&self->pattern, desc->first, name))
        return fail(HELIO_ERR_IO,
                    "there is no %s, the only frame of %s that is asked for; its files are %" PRIu32 " to %" PRIu32,
                    name, self->base.label, numbers->numbers[0], numbers->numbers[numbers->count - 1]);
    if (begin == end)
        return fail(
            HELIO_ERR_IO, "%s has no frame from %" PRIu64 " to %" PRIu64 "; its files are %" PRIu32 " to %" PRIu32,
            self->base.label, self->first, self->last, numbers->numbers[0], numbers->numbers[numbers->count - 1]);
    switch (desc->on_missing) {
    case HELIO_ON_MISSING_SKIP: *count = end - begin; break;
    case HELIO_ON_MISSING_HOLD: *count = self->last - numbers->numbers[begin] + 1; break;
    case HELIO_ON_MISSING_STOP: *count = self->last - self->first + 1; break;
    }
    return HELIO_OK;
}

helio_status source_sequence_open(const source_opening *opening, source_reader **reader)
{
    sequence *self = source_reader_allocate(opening, sizeof *self, &SEQUENCE_KIND);
    if (self == NULL)
        return HELIO_ERR_MEMORY;
    self->has_names = opening->specification->is_shell_pattern;
    self->pattern = opening->specification->pattern;
    helio_status status = self->has_names ? find_names(self, &opening->info->frame_count)
                                          : find_numbers(self, &opening->info->frame_count);
    if (status != HELIO_OK) {
        destroy_sequence(&self->base);
        return status;
    }
    self->next = self->first;
    *reader = &self->base;
    return HELIO_OK;
}
