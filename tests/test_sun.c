/* SPDX-License-Identifier: MIT
 *
 * Where the sun stands, against published ephemeris values, and the text that says where and when. */
#include "support.h"

#include "core/vector.h"
#include "env/sky_specification.h"

#include <math.h>
#include <string.h>

static const double TO_RADIANS = PI / 180.0;

static helio_sun find(helio_sky_place place)
{
    helio_sun sun;
    assert_ok(helio_sun_find(&place, &sun));
    return sun;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.6f is not within %g of %.6f", value, tolerance, expected);
}

/* ---- published values ---------------------------------------------------------------------- */

/* I. Reda, A. Andreas, "Solar Position Algorithm for Solar Radiation Applications", NREL/TP-560-34302, 2003 (2008),
 * appendix A.5; there for 820 hPa, which makes 0.004 degrees of refraction less. It counts days in universal time, so
 * its sunset is that of the day before. */
static void example_of_the_solar_position_algorithm(void **state)
{
    (void)state;
    helio_sky_place place = {39.742476, -105.1786, 2003, 10, 17, 12 + 30.0 / 60 + 30.0 / 3600, -7};
    helio_sun sun = find(place);
    assert_near(sun.elevation, 90 - 50.11162, 0.01);
    assert_near(sun.azimuth, 194.34024, 0.01);
    assert_near(sun.distance, 0.9965422974, 1e-4);
    double sunrise, sunset;
    assert_ok(helio_sun_day(&place, &sunrise, &sunset));
    assert_near(sunrise, 6 + 12.0 / 60 + 43.46 / 3600, 10.0 / 3600);
    place.day = 16;
    assert_ok(helio_sun_day(&place, &sunrise, &sunset));
    assert_near(sunset, 17 + 20.0 / 60 + 19.19 / 3600, 10.0 / 3600);
}

/* J. Meeus, "Astronomical Algorithms", 2nd edition 1998, examples 25.a, 25.b and 28.a for 1992 October 13, 0h TD, which
 * is 59 s before 0h UT: declination, distance, equation of time in degrees. */
static void example_of_astronomical_algorithms(void **state)
{
    (void)state;
    double declination = -7.78507 * TO_RADIANS, hour_angle = (180.0 + 3.427351 - 59.0 / 240) * TO_RADIANS;
    for (double latitude = -75; latitude <= 75; latitude += 25) {
        helio_sky_place place = {latitude, 0, 1992, 10, 13, -59.0 / 3600, 0};
        helio_sun sun = find(place);
        double l = latitude * TO_RADIANS;
        double up = sin(declination) * sin(l) + cos(declination) * cos(hour_angle) * cos(l);
        if (asin(up) > -10 * TO_RADIANS) /* refraction would be in the way */
            continue;
        double azimuth = atan2(-cos(declination) * sin(hour_angle),
                               sin(declination) * cos(l) - cos(declination) * cos(hour_angle) * sin(l));
        assert_near(sun.elevation, asin(up) / TO_RADIANS, 0.006);
        assert_near(remainder(sun.azimuth - azimuth / TO_RADIANS, 360) * cos(asin(up)), 0, 0.006);
        assert_near(sun.distance, 0.99760775, 1e-4);
    }
}

/* Times in UTC as the U.S. Naval Observatory publishes them. Seen from the north pole an equinox is a sunrise (0.483
 * degrees of refraction by Saemundsson's formula), and a solstice is at the obliquity of the ecliptic, 23.437 degrees,
 * and 0.038 degrees of refraction. */
static void equinoxes_and_solstices(void **state)
{
    (void)state;
    static const struct {
        int year, month, day, hour, minute;
    } equinoxes[] = {{2004, 3, 20, 6, 49},  {2010, 3, 20, 17, 32}, {2017, 3, 20, 10, 28},
                     {2004, 9, 22, 16, 30}, {2010, 9, 23, 3, 9},   {2017, 9, 22, 20, 2}},
      solstices[] = {{2004, 6, 21, 0, 57}, {2010, 6, 21, 11, 28}, {2017, 6, 21, 4, 24}};
    for (int i = 0; i < 6; i++) {
        double hours = equinoxes[i].hour + equinoxes[i].minute / 60.0;
        helio_sky_place place = {90, 0, equinoxes[i].year, equinoxes[i].month, equinoxes[i].day, hours, 0};
        assert_near(find(place).elevation, 0.483 - 0.0024, 0.01); /* parallax */
    }
    for (int i = 0; i < 3; i++) {
        double hours = solstices[i].hour + solstices[i].minute / 60.0;
        helio_sky_place place = {90, 0, solstices[i].year, solstices[i].month, solstices[i].day, hours, 0};
        assert_near(find(place).elevation, 23.437 + 0.038, 0.01);
    }
}

/* The Earth is nearest in early January and farthest in early July. */
static void distance_follows_the_seasons(void **state)
{
    (void)state;
    assert_near(find((helio_sky_place){0, 0, 2026, 1, 3, 17, 0}).distance, 0.98330, 1e-4);
    assert_near(find((helio_sky_place){0, 0, 2026, 7, 6, 18, 0}).distance, 1.01664, 1e-4);
}

/* ---- what must hold anywhere --------------------------------------------------------------- */

static void zones_and_longitudes_name_the_same_moment(void **state)
{
    (void)state;
    helio_sun a = find((helio_sky_place){50, 20, 2026, 5, 1, 23.5, 0});
    helio_sun b = find((helio_sky_place){50, 20, 2026, 5, 2, 1.5, 2});
    helio_sun c = find((helio_sky_place){50, 20, 2026, 5, 2, -0.5, 0});
    helio_sun d = find((helio_sky_place){50, 20, 2026, 4, 30, 47.5, 0});
    assert_near(a.azimuth, b.azimuth, 1e-6);
    assert_near(a.elevation, b.elevation, 1e-6);
    assert_near(a.azimuth, c.azimuth, 1e-6);
    assert_near(a.azimuth, d.azimuth, 1e-6);
    /* The last days of February, and of the year. */
    assert_near(find((helio_sky_place){50, 20, 2028, 2, 29, 24, 0}).azimuth,
                find((helio_sky_place){50, 20, 2028, 3, 1, 0, 0}).azimuth, 1e-6);
    assert_near(find((helio_sky_place){50, 20, 2099, 12, 31, 24, 0}).azimuth,
                find((helio_sky_place){50, 20, 2100, 1, 1, 0, 0}).azimuth, 1e-6);
}

static void mornings_are_in_the_east(void **state)
{
    (void)state;
    assert_near(find((helio_sky_place){45, 0, 2026, 3, 20, 6.2, 0}).azimuth, 90, 4);
    assert_near(find((helio_sky_place){45, 0, 2026, 3, 20, 12.1, 0}).azimuth, 180, 2);
    assert_near(find((helio_sky_place){45, 0, 2026, 3, 20, 18.2, 0}).azimuth, 270, 4);
    helio_sun south = find((helio_sky_place){-45, 0, 2026, 3, 20, 12.1, 0});
    assert_true(south.azimuth < 2 || south.azimuth > 358);
}

/* Refraction comes in below the horizon without a step or a corner, and never turns the sun's course around. */
static void elevation_changes_smoothly(void **state)
{
    (void)state;
    double before = 0, step_before = 0;
    for (int second = 0; second < 24 * 3600; second += 10) {
        double elevation = find((helio_sky_place){0, 0, 2026, 3, 20, second / 3600.0, 0}).elevation;
        double step = elevation - before, expected = 10.0 / 240;
        if (second > 0)
            assert_true(fabs(step) < 1.6 * expected);
        if (second > 10 && fabs(elevation) < 80)
            assert_true(fabs(step - step_before) < 0.035 * expected && fabs(step) > 0.5 * expected);
        before = elevation;
        step_before = step;
    }
}

static void day_is_from_the_upper_edge_to_the_upper_edge(void **state)
{
    (void)state;
    for (double latitude = -66; latitude <= 65; latitude += 13.1)
        for (int month = 1; month <= 12; month++) {
            helio_sky_place place = {latitude, 151, 2026, month, 15, 0, 10};
            double sunrise, sunset;
            if (helio_sun_day(&place, &sunrise, &sunset) != HELIO_OK)
                continue;
            assert_true(sunrise < sunset && sunset < sunrise + 24);
            place.hours = sunrise;
            double rising = find(place).elevation;
            place.hours = sunset;
            /* 0.833 below the horizon, lifted by Saemundsson's 0.62 */
            assert_near(rising, -0.22, 0.02);
            assert_near(find(place).elevation, -0.22, 0.02);
        }
}

static void polar_days_and_nights_are_told(void **state)
{
    (void)state;
    double sunrise = -1, sunset = -1;
    assert_int_equal(helio_sun_day(&(helio_sky_place){69.65, 18.96, 2026, 6, 21, 0, 1}, &sunrise, &sunset),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "does not set"));
    assert_int_equal(helio_sun_day(&(helio_sky_place){69.65, 18.96, 2026, 12, 21, 0, 1}, &sunrise, &sunset),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "does not rise"));
    assert_non_null(strstr(helio_last_error(), "2026-12-21"));
    assert_true(sunrise == -1 && sunset == -1);
    assert_ok(helio_sun_day(&(helio_sky_place){69.65, 18.96, 2026, 3, 21, 0, 1}, &sunrise, &sunset));
}

static void places_and_dates_that_are_none_are_refused(void **state)
{
    (void)state;
    static const helio_sky_place wrong[] = {
        {91, 0, 2026, 1, 1, 0, 0},   {0, 181, 2026, 1, 1, 0, 0},         {0, 0, 1899, 1, 1, 0, 0},
        {0, 0, 2101, 1, 1, 0, 0},    {0, 0, 2026, 0, 1, 0, 0},           {0, 0, 2026, 13, 1, 0, 0},
        {0, 0, 2026, 2, 29, 0, 0},   {0, 0, 2100, 2, 29, 0, 0},          {0, 0, 2026, 4, 31, 0, 0},
        {0, 0, 2026, 1, 0, 0, 0},    {0, 0, 2026, 1, 1, 49, 0},          {0, 0, 2026, 1, 1, -25, 0},
        {0, 0, 2026, 1, 1, 0, 14.5}, {0, 0, 2026, 1, 1, (double)NAN, 0}, {(double)NAN, 0, 2026, 1, 1, 0, 0}};
    helio_sun sun;
    double sunrise, sunset;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(helio_sun_find(&wrong[i], &sun), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sun_day(&wrong[0], &sunrise, &sunset), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sun_find(NULL, &sun), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_sun_day(NULL, &sunrise, &sunset), HELIO_ERR_ARGUMENT);
    assert_ok(helio_sun_find(&(helio_sky_place){0, 0, 2000, 2, 29, 0, 0}, &sun));
}

/* ---- specifications ------------------------------------------------------------------------ */

static sky_specification parse(const char *text)
{
    sky_specification s;
    assert_ok(sky_specification_parse(text, &s));
    return s;
}

static void specification_without_keys_is_noon_in_midsummer(void **state)
{
    (void)state;
    sky_specification plain = parse("sky"), full = parse("sky:lat=44.8,lon=-0.6,date=2026-06-21,time=12:00,"
                                                         "turbidity=3,albedo=0.2,zone=0,disc=1");
    sky_specification colon = parse("sky:");
    assert_memory_equal(&plain.place, &full.place, sizeof plain.place);
    assert_memory_equal(&plain.place, &colon.place, sizeof plain.place);
    assert_true(plain.desc.sun.azimuth == full.desc.sun.azimuth && plain.desc.sun.elevation > 68);
    assert_true(plain.desc.turbidity == 3 && plain.desc.albedo == 0.2f && !plain.desc.no_disc);
    assert_false(plain.is_day || plain.has_sun);
}

static void specification_names_place_date_and_time(void **state)
{
    (void)state;
    sky_specification s = parse("sky:time=06:30:36,date=1999-12-31,lat=-33.87,lon=151.2,turbidity=5.5,albedo=1,disc=0");
    assert_near(s.place.hours, 6.51, 1e-9);
    assert_true(s.place.year == 1999 && s.place.month == 12 && s.place.day == 31);
    assert_near(s.place.latitude, -33.87, 1e-5);
    assert_near(s.place.zone, 10, 0); /* 151.2 / 15 */
    assert_true(s.desc.turbidity == 5.5f && s.desc.albedo == 1 && s.desc.no_disc);
    assert_near(parse("sky:zone=-5.5").place.zone, -5.5, 0);
    assert_near(parse("sky:time=24:00").place.hours, 24, 0);
}

static void specification_may_name_the_sun_itself(void **state)
{
    (void)state;
    sky_specification s = parse("sky:azimuth=120,elevation=-3.5,albedo=0");
    assert_true(s.has_sun && s.desc.sun.azimuth == 120 && s.desc.sun.elevation == -3.5 && s.desc.sun.distance == 1);
    assert_true(s.desc.albedo == 0);
}

static void specification_may_name_a_day(void **state)
{
    (void)state;
    assert_true(parse("sky:day").is_day);
    sky_specification s = parse("sky:day,lat=10,turbidity=2");
    assert_true(s.is_day && s.desc.turbidity == 2);
    assert_near(s.place.latitude, 10, 0);
}

static void specifications_with_mistakes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *told;
    } wrong[] = {{"sky:turbidty=3", "turbidity"},
                 {"sky:turbidity=11", "1 to 10"},
                 {"sky:albedo=-1", "0 to 1"},
                 {"sky:lat=100", "-90 to 90"},
                 {"sky:date=2026-02-30", "1 to 28"},
                 {"sky:date=21.6.2026", "YYYY-MM-DD"},
                 {"sky:date=2026-6", "YYYY-MM-DD"},
                 {"sky:date=", "characters"},
                 {"sky:date=1850-01-01", "1900 to 2100"},
                 {"sky:time=12", "HH:MM"},
                 {"sky:time=12:60", "HH:MM"},
                 {"sky:time=24:01", "24:00"},
                 {"sky:time=12:00,time=13:00", "twice"},
                 {"sky:azimuth=10", "elevation"},
                 {"sky:azimuth=10,elevation=5,lat=3", "lat"},
                 {"sky:azimuth=10,elevation=5,time=12:00", "time"},
                 {"sky:day,time=12:00", "sunset"},
                 {"sky:day,azimuth=1,elevation=2", "sunset"},
                 {"sky:lat=1,day", "lat"},
                 {"sky:disc=0.5", "disc"},
                 {"sky:noon", "key=value"}};
    sky_specification s;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(sky_specification_parse(wrong[i].text, &s), HELIO_ERR_ARGUMENT);
        if (strstr(helio_last_error(), wrong[i].told) == NULL)
            fail_msg("\"%s\" does not tell of %s", helio_last_error(), wrong[i].told);
    }
    char longest[5000];
    memset(longest, 'x', sizeof longest);
    memcpy(longest, "sky:day,", 8);
    longest[sizeof longest - 1] = 0;
    assert_int_equal(sky_specification_parse(longest, &s), HELIO_ERR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_the_solar_position_algorithm),
        cmocka_unit_test(example_of_astronomical_algorithms),
        cmocka_unit_test(equinoxes_and_solstices),
        cmocka_unit_test(distance_follows_the_seasons),
        cmocka_unit_test(zones_and_longitudes_name_the_same_moment),
        cmocka_unit_test(mornings_are_in_the_east),
        cmocka_unit_test(elevation_changes_smoothly),
        cmocka_unit_test(day_is_from_the_upper_edge_to_the_upper_edge),
        cmocka_unit_test(polar_days_and_nights_are_told),
        cmocka_unit_test(places_and_dates_that_are_none_are_refused),
        cmocka_unit_test(specification_without_keys_is_noon_in_midsummer),
        cmocka_unit_test(specification_names_place_date_and_time),
        cmocka_unit_test(specification_may_name_the_sun_itself),
        cmocka_unit_test(specification_may_name_a_day),
        cmocka_unit_test(specifications_with_mistakes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
