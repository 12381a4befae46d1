/* SPDX-License-Identifier: MIT */
#include "env/map_sink.h"

#include "env/resampler.h"

void map_sink_join(map_sink *sink, helio_environment *environment)
{
    if (environment->sink != NULL)
        return;
    sink->environment = environment;
    environment->sink = sink;
}

void map_sink_leave(map_sink *sink)
{
    if (sink->environment == NULL)
        return;
    environment_settle(sink->environment); /* the map goes with the sink */
    sink->environment->sink = NULL;
    sink->environment = NULL;
}

bool map_sink_offer(helio_environment *environment, const map_pixels *pixels)
{
    map_pixels copy;
    if (environment->sink == NULL || !environment->sink->take(environment->sink->owner, pixels, &copy))
        return false;
    environment->late = copy;
    environment->late_sky = NULL;
    environment->is_late = true;
    return true;
}

bool map_sink_offer_sky(helio_environment *environment, const sky_parts *parts)
{
    const sky_parts *copy =
        environment->sink != NULL ? environment->sink->take_sky(environment->sink->owner, parts) : NULL;
    if (copy == NULL)
        return false;
    environment->late_sky = copy;
    environment->is_late = true;
    return true;
}

void environment_make_late_cube(helio_environment *environment)
{
    environment->is_late = false;
    if (environment->late_sky != NULL)
        sky_cube_fill(environment->late_sky, environment);
    else
        resampler_run(environment->context, environment->map.resampler, &environment->late, environment->cube);
}
