/* SPDX-License-Identifier: MIT */
#include "env/sky_specification.h"

#include "core/error.h"
#include "core/specification.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What was written, as numbers and texts; begins as the defaults. */
typedef struct sky_text {
    float latitude, longitude, zone, azimuth, elevation, turbidity, albedo, disc;
    char date[SPECIFICATION_TEXT_SIZE], time[SPECIFICATION_TEXT_SIZE];
} sky_text;

enum { LATITUDE, LONGITUDE, DATE, TIME, ZONE, AZIMUTH, ELEVATION, TURBIDITY, ALBEDO, DISC, FIELDS };

/* Reads count decimal numbers with these separators before and after; widths: the most digits of each. */
static bool read_digits(const char *text, int count, const char *separators, const int *widths, int *numbers)
{
    for (int i = 0; i < count; i++) {
        size_t digits = strspn(text, "0123456789");
        if (digits == 0 || digits > (size_t)widths[i])
            return false;
        numbers[i] = (int)strtol(text, NULL, 10);
        text += digits;
        if (*text != separators[i])
            return false;
        if (*text != 0)
            text++;
    }
    return true;
}

static helio_status read_date(const char *text, const char *date, helio_sky_place *place)
{
    int numbers[3];
    if (!read_digits(date, 3, "--", (const int[]){4, 2, 2}, numbers))
        return fail(HELIO_ERR_ARGUMENT, "environment \"%.200s\": date is \"%s\"; write YYYY-MM-DD, such as 2026-06-21",
                    text, date);
    place->year = numbers[0];
    place->month = numbers[1];
    place->day = numbers[2];
    return HELIO_OK;
}

static helio_status read_time(const char *text, const char *time, helio_sky_place *place)
{
    int numbers[3] = {0};
    bool is_read = read_digits(time, 2, ":", (const int[]){2, 2}, numbers) ||
                   read_digits(time, 3, "::", (const int[]){2, 2, 2}, numbers);
    double hours = numbers[0] + numbers[1] / 60.0 + numbers[2] / 3600.0;
    if (!is_read || numbers[1] > 59 || numbers[2] > 59 || hours > 24.0)
        return fail(HELIO_ERR_ARGUMENT,
                    "environment \"%.200s\": time is \"%s\"; write HH:MM or HH:MM:SS, from 00:00 to 24:00", text, time);
    place->hours = hours;
    return HELIO_OK;
}

/* The sun is given either by azimuth and elevation or by place, date and time; a day is never given by the former, and
 * needs no time. */
static helio_status check_keys(const char *text, const specification_field *fields, bool is_day)
{
    bool by_angle = fields[AZIMUTH].given || fields[ELEVATION].given;
    if (is_day && (by_angle || fields[TIME].given))
        return fail(HELIO_ERR_ARGUMENT,
                    "environment \"%.200s\": a day goes from sunrise to sunset; give it no time, azimuth or elevation",
                    text);
    if (!by_angle)
        return HELIO_OK;
    if (!fields[AZIMUTH].given || !fields[ELEVATION].given)
        return fail(HELIO_ERR_ARGUMENT, "environment \"%.200s\": azimuth and elevation need each other; give both",
                    text);
    for (int i = LATITUDE; i <= ZONE; i++)
        if (fields[i].given)
            return fail(HELIO_ERR_ARGUMENT,
                        "environment \"%.200s\": azimuth and elevation already tell where the sun is; leave out %s",
                        text, fields[i].key);
    return HELIO_OK;
}

static helio_status resolve(const char *text, const sky_text *given, const specification_field *fields,
                            sky_specification *s)
{
    s->desc = (helio_sky_desc){.turbidity = given->turbidity, .albedo = given->albedo, .no_disc = given->disc == 0.0f};
    s->has_sun = fields[AZIMUTH].given;
    s->desc.sun = (helio_sun){(double)given->azimuth, (double)given->elevation, 1.0};
    if (s->has_sun)
        return HELIO_OK;
    s->place.latitude = (double)given->latitude;
    s->place.longitude = (double)given->longitude;
    s->place.zone = fields[ZONE].given ? (double)given->zone : round((double)given->longitude / 15.0) + 0.0; /* no -0 */
    HELIO_TRY(read_date(text, given->date, &s->place));
    HELIO_TRY(read_time(text, given->time, &s->place));
    helio_status status = helio_sun_find(&s->place, &s->desc.sun);
    return status == HELIO_OK ? status : fail(status, "environment \"%.200s\": %s", text, helio_last_error());
}

enum { DAY_TEXT_SIZE = 512 };

/* "day" is not a key: what is parsed is the text without it. */
static helio_status cut_day(const char *text, char rest[DAY_TEXT_SIZE], bool *is_day)
{
    static const char day[] = "sky:day";
    const size_t length = sizeof day - 1;
    *is_day = strncmp(text, day, length) == 0 && (text[length] == 0 || text[length] == ',');
    if (!*is_day)
        return HELIO_OK;
    const char *keys = text + length;
    if (strlen(keys) + sizeof "sky" > DAY_TEXT_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "environment \"%.60s...\" has more than %d characters", text, DAY_TEXT_SIZE);
    snprintf(rest, DAY_TEXT_SIZE, keys[0] == ',' ? "sky:%s" : "sky%s", keys[0] == ',' ? keys + 1 : keys);
    return HELIO_OK;
}

helio_status sky_specification_parse(const char *text, sky_specification *specification)
{
    sky_text t = {.latitude = 44.8f,
                  .longitude = -0.6f,
                  .turbidity = 3.0f,
                  .albedo = 0.2f,
                  .disc = 1.0f,
                  .date = "2026-06-21",
                  .time = "12:00"};
    specification_field fields[FIELDS] = {
        [LATITUDE] = {.key = "lat", .count = 1, .least = -90, .greatest = 90, .values = &t.latitude},
        [LONGITUDE] = {.key = "lon", .count = 1, .least = -180, .greatest = 180, .values = &t.longitude},
        [DATE] = {.key = "date", .count = 1, .text = t.date},
        [TIME] = {.key = "time", .count = 1, .text = t.time},
        [ZONE] = {.key = "zone", .count = 1, .least = -14, .greatest = 14, .values = &t.zone},
        [AZIMUTH] = {.key = "azimuth", .count = 1, .least = -360, .greatest = 360, .values = &t.azimuth},
        [ELEVATION] = {.key = "elevation", .count = 1, .least = -90, .greatest = 90, .values = &t.elevation},
        [TURBIDITY] = {.key = "turbidity", .count = 1, .least = 1, .greatest = 10, .values = &t.turbidity},
        [ALBEDO] = {.key = "albedo", .count = 1, .least = 0, .greatest = 1, .values = &t.albedo},
        [DISC] = {.key = "disc", .count = 1, .no_between = true, .least = 0, .greatest = 1, .values = &t.disc},
    };
    char rest[DAY_TEXT_SIZE];
    bool is_day = false;
    HELIO_TRY(cut_day(text, rest, &is_day));
    const char *keys = is_day ? rest : strcmp(text, "sky:") == 0 ? "sky" : text;
    HELIO_TRY(specification_parse("environment", keys, fields, FIELDS));
    HELIO_TRY(check_keys(text, fields, is_day));
    sky_specification s = {.is_day = is_day};
    HELIO_TRY(resolve(text, &t, fields, &s));
    *specification = s;
    return HELIO_OK;
}
