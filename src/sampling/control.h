/* SPDX-License-Identifier: MIT
 * control.h - the control variate of matte points: light that is known exactly, to be added where samples stand for it.
 *
 * For the normals n of a bin and the directions w of a tile with centre t, max(0, n.w) is nearly a n.w + c t.w, with a
 * and c of this bin and this tile alone: 1 and 0 where the tile is in front of all of the normals, 0 and 0 where it is
 * behind them. The integral of radiance x (a n.w + c t.w) over the sphere, the known light, is linear in n and so a
 * matrix of each bin; so is the mean of the same / density over any samples of its pool. The difference of the two has
 * the expected value 0 and, as the samples' light is off by nearly as much, takes most of their error away. See
 * docs/method.md. */
#ifndef HELIOSTAT_SRC_CONTROL_H
#define HELIOSTAT_SRC_CONTROL_H

#include "sampling/normal_bins.h"

enum { CONTROL_CHUNK = 4 }; /* samples that are summed together */

/* What a normal (x, y, z, 1) is multiplied by: red, green, blue and nothing, so that a row is a vector register. */
typedef struct control_matrix {
    alignas(16) float rows[4][4];
} control_matrix;

typedef struct light_control {
    helio_context *context;
    uint32_t bins;         /* how many */
    uint32_t chunks;       /* of a pool */
    control_matrix *known; /* [bins] */
    /* [bins][chunks + 1]: prefix sums over the chunks of each pool of what samples stand for. */
    control_matrix *sums;
} light_control;

helio_status control_create(helio_context *context, const normal_bins *bins, light_control **out);
void control_destroy(light_control *c);

/* Finds the known light of the frame. */
void control_update(light_control *c, const normal_bins *bins);

/* The sums of a bin's pool: [chunks + 1], of which the first is 0. */
static inline control_matrix *control_sums(const light_control *c, uint32_t bin)
{
    return c->sums + (size_t)bin * (c->chunks + 1);
}

/* Irradiance, in the map's unit, to be added for `count` samples of a bin's pool, from `first` on, which is a multiple
 * of the chunk. */
vec3 control_difference(const light_control *c, uint32_t bin, uint32_t first, uint32_t count, vec3 normal);

/* x, or 0: sums of light next to the greatest of floats are infinite, and say nothing. */
float control_finite(float x);

/* Beyond this cosine, above 0 or below, all normals of a bin are on the same side of a tile. */
static inline float control_half(const normal_bin *bin)
{
    return RULE_CONTROL_HALF * bin->reach;
}

/* a and c for a bin and a tile whose centres' cosine is given: least squares over the cosines that normals and
 * directions mostly have, about as many each within half of what they can be apart. */
typedef struct control_line {
    float slope, offset;
} control_line;

static inline control_line control_line_of(const normal_bin *bin, float cosine)
{
    const float half = control_half(bin);
    float t = cosine / half;
    t = t < 1.0f ? t : 1.0f;
    t = t > -1.0f ? t : -1.0f;
    float slope = 0.5f + t * (0.75f - 0.25f * (t * t));
    return (control_line){slope, half * (0.25f * (1.0f + t) * (1.0f + t) - slope * t)};
}

#endif
