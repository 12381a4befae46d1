/* SPDX-License-Identifier: MIT
 * environment.h - the environment from inside: what resampling, tables and renderer need of it. */
#ifndef HELIOSTAT_SRC_ENVIRONMENT_H
#define HELIOSTAT_SRC_ENVIRONMENT_H

#include "core/vector.h"
#include "env/cube.h"
#include "env/map_pixels.h"

#include <heliostat/environment.h>

typedef struct resampler resampler;
typedef struct map_sink map_sink;   /* see map_sink.h */
typedef struct sky_parts sky_parts; /* see sky_cube.h */

/* What depends on the shape of the maps to come. */
typedef struct environment_map {
    uint32_t width, height; /* 0: no map is expected, and there is nothing else here */
    helio_layout layout;
    resampler *resampler;
    helio_bad_pixels *row_faults; /* [height] */
} environment_map;

struct helio_environment {
    helio_context *context;
    uint32_t size; /* R */
    uint64_t frame;
    float *cube;        /* [6][R][R][3]; old while it is late: call environment_settle() before it is read */
    float *solid_angle; /* [R][R], sr, the same for all faces */
    environment_map map;
    map_sink *sink;            /* or NULL */
    bool is_late;              /* the sink has the map or sky of this frame, and the cube is not made yet ... */
    map_pixels late;           /* ... of its copy of the map ... */
    const sky_parts *late_sky; /* ... or of this sky; else NULL */
    vec3 map_axes[3]; /* world axes X Y Z as seen in the map's space: rows of an orthogonal matrix's transpose */
    float intensity;
};

/* World directions to the map's space and back. The matrix is orthogonal, perhaps with a reflection. */
static inline vec3 environment_to_map(const helio_environment *environment, vec3 d)
{
    const vec3 *axes = environment->map_axes;
    return add_scaled(add_scaled(scale(axes[0], d.x), axes[1], d.y), axes[2], d.z);
}

static inline vec3 environment_to_world(const helio_environment *environment, vec3 d)
{
    const vec3 *axes = environment->map_axes;
    return (vec3){dot(axes[0], d), dot(axes[1], d), dot(axes[2], d)};
}

static inline const float *environment_texel(const helio_environment *environment, uint32_t face, uint32_t row,
                                             uint32_t column)
{
    size_t size = environment->size;
    return environment->cube + ((face * size + row) * size + column) * 3;
}

/* Checks the shape of a map and guesses its layout where it is AUTO; FACES becomes STRIP, which is the same in memory.
 */
helio_status environment_resolve_map(uint32_t width, uint32_t height, helio_layout *layout);

/* Makes the cube of this frame if it is late. On the thread that updates, and not inside of a loop of the context. */
void environment_make_late_cube(helio_environment *environment);

static inline void environment_settle(const helio_environment *environment)
{
    if (environment->is_late)
        environment_make_late_cube((helio_environment *)environment); /* nobody sees that it was not there */
}

/* Call when the cube of a new frame is there, whoever made it. bad: of the map, zero where there is none. info may be
 * NULL. */
void environment_finish_frame(helio_environment *environment, helio_bad_pixels bad, helio_environment_info *info);

#endif
