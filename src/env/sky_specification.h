/* SPDX-License-Identifier: MIT
 * sky_specification.h - reads "sky:lat=44.8,lon=-0.6,date=2026-06-21,time=12:00,turbidity=3,albedo=0.2". */
#ifndef HELIOSTAT_SRC_SKY_SPECIFICATION_H
#define HELIOSTAT_SRC_SKY_SPECIFICATION_H

#include <heliostat/sky.h>

typedef struct sky_specification {
    helio_sky_place place; /* where and when, unless has_sun; of a day all but the hours counts */
    bool has_sun;          /* azimuth and elevation were given in place of place, date and time */
    bool is_day;           /* sky:day, from sunrise to sunset of the date */
    helio_sky_desc desc;   /* complete, but for the sun of a day */
} sky_specification;

/* text: all of it, from "sky" on. Keys: lat lon date time zone, or azimuth elevation; turbidity albedo disc; what is
 * not given is as in the example above, zone is that of the longitude, round(lon / 15). HELIO_ERR_ARGUMENT for keys and
 * values that cannot be used. */
helio_status sky_specification_parse(const char *text, sky_specification *specification);

#endif
