/* SPDX-License-Identifier: MIT
 *
 * Where the sun stands: the low-precision theory of J. Meeus, "Astronomical Algorithms", 2nd edition 1998 (chapters 7,
 * 12, 13, 22, 25), good to 0.01 degrees, and refraction by Saemundsson's formula (chapter 16) at 1010 hPa and 10 C. */
#include "core/error.h"
#include "core/vector.h"

#include <heliostat/sky.h>

static const double DEGREE = PI / 180.0;

/* ---- dates ---- */

static int days_in_month(int year, int month)
{
    static const int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    bool is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return days[month - 1] + (month == 2 && is_leap ? 1 : 0);
}

static helio_status check_place(const helio_sky_place *place)
{
    if (!(fabs(place->latitude) <= 90.0))
        return fail(HELIO_ERR_ARGUMENT, "a latitude of %g degrees does not exist; use -90 to 90", place->latitude);
    if (!(fabs(place->longitude) <= 180.0))
        return fail(HELIO_ERR_ARGUMENT, "a longitude of %g degrees does not exist; use -180 to 180", place->longitude);
    if (!(fabs(place->zone) <= 14.0))
        return fail(HELIO_ERR_ARGUMENT, "a time zone of %g hours cannot be used; give -14 to 14", place->zone);
    if (place->year < 1900 || place->year > 2100)
        return fail(HELIO_ERR_ARGUMENT, "the sun's place is not known in the year %d; use 1900 to 2100", place->year);
    if (place->month < 1 || place->month > 12)
        return fail(HELIO_ERR_ARGUMENT, "there is no month %d; use 1 to 12", place->month);
    int days = days_in_month(place->year, place->month);
    if (place->day < 1 || place->day > days)
        return fail(HELIO_ERR_ARGUMENT, "there is no day %d in month %d of %d; use 1 to %d", place->day, place->month,
                    place->year, days);
    return HELIO_OK;
}

/* Days from the epoch J2000.0, universal time. */
static double days_since_2000(const helio_sky_place *place, double hours)
{
    int year = place->year, month = place->month;
    if (month <= 2) {
        year--;
        month += 12;
    }
    int leap_days = 2 - year / 100 + year / 400; /* that the Gregorian calendar left out, from the Julian one */
    double julian_day = floor(365.25 * (year + 4716)) + floor(30.6001 * (month + 1)) + place->day + leap_days - 1524.5;
    return julian_day - 2451545.0 + (hours - place->zone) / 24.0;
}

/* ---- the sun among the stars ---- */

typedef struct sun_on_sky {
    double right_ascension, declination; /* apparent, radians */
    double sidereal_time;                /* apparent, at Greenwich, radians */
    double distance;                     /* astronomical units */
} sun_on_sky;

static sun_on_sky find_on_sky(double days)
{
    /* Dynamical time less universal time, seconds: Espenak and Meeus 2006. Good to a second or two about 2015 and to 90
     * s from 1900 to 2100, in which the sun moves by 0.001 degrees. */
    double years = days / 365.25, clock_difference = 62.92 + years * (0.32217 + years * 0.005589);
    double t = (days + clock_difference / 86400.0) / 36525.0;
    double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * DEGREE;
    double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
    double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sin(anomaly) +
                    (0.019993 - t * 0.000101) * sin(2 * anomaly) + 0.000289 * sin(3 * anomaly);
    double node = (125.04 - 1934.136 * t) * DEGREE;
    double longitude = (mean_longitude + centre - 0.00569 - 0.00478 * sin(node)) * DEGREE;
    double obliquity = (23.4392911 - t * (0.0130042 + t * 0.00000016) + 0.00256 * cos(node)) * DEGREE;

    double sidereal =
        280.46061837 + 360.98564736629 * days + 0.000387933 * t * t - 0.00478 * sin(node) * cos(obliquity);
    return (sun_on_sky){
        .right_ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude)),
        .declination = asin(sin(obliquity) * sin(longitude)),
        .sidereal_time = fmod(sidereal, 360.0) * DEGREE,
        .distance =
            1.000001018 * (1 - eccentricity * eccentricity) / (1 + eccentricity * cos(anomaly + centre * DEGREE)),
    };
}

/* ---- the sun above the horizon ---- */

/* Elevation without refraction. */
static helio_sun find_geometric(const helio_sky_place *place, double hours)
{
    sun_on_sky s = find_on_sky(days_since_2000(place, hours));
    double hour_angle = s.sidereal_time + place->longitude * DEGREE - s.right_ascension;
    double latitude = place->latitude * DEGREE;
    double north = sin(s.declination) * cos(latitude) - cos(s.declination) * cos(hour_angle) * sin(latitude);
    double east = -cos(s.declination) * sin(hour_angle);
    double up = sin(s.declination) * sin(latitude) + cos(s.declination) * cos(hour_angle) * cos(latitude);
    double azimuth = atan2(east, north) / DEGREE, horizontal = sqrt(north * north + east * east);
    double parallax = 8.794 / 3600.0 / s.distance;
    return (helio_sun){azimuth < 0 ? azimuth + 360.0 : azimuth, atan2(up, horizontal) / DEGREE - parallax * horizontal,
                       s.distance};
}

/* Degrees that refraction lifts the sun. Saemundsson's formula ends near the horizon; what is below is not seen, and
 * there it fades with a continuous derivative. */
static double refraction(double elevation)
{
    const double lowest = -1.0, faded = -10.0;
    double h = elevation > lowest ? elevation : lowest, angle = (h + 10.3 / (h + 5.11)) * DEGREE;
    double lift = 1.02 / 60.0 / tan(angle) + 0.0019279 / 60.0; /* 0 at the zenith */
    if (elevation >= lowest)
        return lift;
    if (elevation <= faded)
        return 0.0;
    double slope = -1.02 / 60.0 / (sin(angle) * sin(angle)) * (1.0 - 10.3 / ((h + 5.11) * (h + 5.11))) * DEGREE;
    double x = (elevation - faded) / (lowest - faded), width = lowest - faded;
    return x * x * (lift * (3.0 - 2.0 * x) + slope * width * (x - 1.0));
}

helio_status helio_sun_find(const helio_sky_place *place, helio_sun *sun)
{
    if (place == NULL || sun == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_sun_find needs a place and a place for the result");
    HELIO_TRY(check_place(place));
    if (!(place->hours >= -24.0 && place->hours <= 48.0))
        return fail(HELIO_ERR_ARGUMENT,
                    "a local time of %g hours cannot be used; give 0 to 24, or -24 to 48 to run "
                    "over into the days around",
                    place->hours);
    *sun = find_geometric(place, place->hours);
    sun->elevation = fmin(sun->elevation + refraction(sun->elevation), 90.0);
    return HELIO_OK;
}

/* ---- a day ---- */

static const double RISING_ELEVATION = -0.833; /* 34' of refraction and 16' of the sun's radius */

/* When, 0 to 24, the sun is due south, or north in the tropics and beyond. */
static double find_noon(const helio_sky_place *place)
{
    double hours = 12.0 + place->zone - place->longitude / 15.0;
    hours -= 24.0 * floor(hours / 24.0);
    for (int i = 0; i < 3; i++) {
        sun_on_sky s = find_on_sky(days_since_2000(place, hours));
        double hour_angle = s.sidereal_time + place->longitude * DEGREE - s.right_ascension;
        hours -= remainder(hour_angle, 2 * PI) * 12.0 / PI;
    }
    return hours;
}

/* The time between two at which the sun crosses the elevation of rising, which it does once. */
static double find_crossing(const helio_sky_place *place, double below, double above)
{
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (below + above);
        if (find_geometric(place, middle).elevation < RISING_ELEVATION)
            below = middle;
        else
            above = middle;
    }
    return 0.5 * (below + above);
}

helio_status helio_sun_day(const helio_sky_place *place, double *sunrise, double *sunset)
{
    if (place == NULL || sunrise == NULL || sunset == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_sun_day needs a place and places for the results");
    HELIO_TRY(check_place(place));
    double noon = find_noon(place);
    if (find_geometric(place, noon).elevation < RISING_ELEVATION)
        return fail(HELIO_ERR_DATA,
                    "the sun does not rise at latitude %g on %04d-%02d-%02d; choose another date or place",
                    place->latitude, place->year, place->month, place->day);
    if (find_geometric(place, noon - 12.0).elevation >= RISING_ELEVATION ||
        find_geometric(place, noon + 12.0).elevation >= RISING_ELEVATION)
        return fail(HELIO_ERR_DATA,
                    "the sun does not set at latitude %g on %04d-%02d-%02d; choose another date or place",
                    place->latitude, place->year, place->month, place->day);
    *sunrise = find_crossing(place, noon - 12.0, noon);
    *sunset = find_crossing(place, noon + 12.0, noon);
    return HELIO_OK;
}
