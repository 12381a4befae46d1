/* SPDX-License-Identifier: MIT
 * map_sink.h - somebody who makes cubes of an environment's maps and skies elsewhere, so that the CPU makes its own
 * only if it is asked for. */
#ifndef HELIOSTAT_SRC_MAP_SINK_H
#define HELIOSTAT_SRC_MAP_SINK_H

#include "env/environment.h"
#include "env/sky_cube.h"

struct map_sink {
    helio_environment *environment; /* outlives the sink; NULL: none */
    void *owner;
    /* Copies the map of the frame after this one, of the environment's present shape. The copy must last until the next
     * call that returns true, or until the sink leaves. False: it cannot, and the CPU makes the cube. */
    bool (*take)(void *owner, const map_pixels *pixels, map_pixels *copy);
    /* The same of a sky. NULL: it cannot. */
    const sky_parts *(*take_sky)(void *owner, const sky_parts *parts);
};

/* An environment has one sink at the most: else the sink's environment is NULL and nothing comes. */
void map_sink_join(map_sink *sink, helio_environment *environment);
void map_sink_leave(map_sink *sink);

/* For the environment. */
bool map_sink_offer(helio_environment *environment, const map_pixels *pixels);
bool map_sink_offer_sky(helio_environment *environment, const sky_parts *parts);

#endif
