/* SPDX-License-Identifier: MIT
 * lobe_variance.h - how uneven the light in a specular lobe is, by where the lobe points and how wide it is: what a
 * point can look up before it weighs a single tile.
 *
 * Where light is calm in the lobe, but for what is small and bright in its tail, to weigh tiles gains a point nothing:
 * BRDF samples see to the lobe, and a few samples of its bin's pool to what is bright, for part of the time. Cells are
 * those of the bins of normals, here for the mirror images of views; docs/method.md has the formulas. */
#ifndef HELIOSTAT_SRC_LOBE_VARIANCE_H
#define HELIOSTAT_SRC_LOBE_VARIANCE_H

#include "sampling/rules.h"

#include <stdbool.h>
#include <stdint.h>

/* Lobes come in classes by their width, each twice as wide (in square) as the one before, the first as wide as a tile.
 * Those of the last are not asked about: wider ones, or with a diffuse one beside. */
enum { LOBE_CLASSES = 3, LOBE_UNASKED = LOBE_CLASSES };

/* One of so many samples of a point in a calm lobe reads the pool. */
enum { LOBE_SAMPLES_PER_POOL = RULE_LOBE_SAMPLES_PER_POOL };

static const float LOBE_POOL_PART = 1.0f / LOBE_SAMPLES_PER_POOL;

/* GGX's alpha^2 of the lobes of a class, widened by a tile, in relation to the square of tiles.edge. */
static inline float lobe_class_width(uint32_t class)
{
    return (float)(1u << class);
}

/* The variance from which on it pays to weigh tiles, which resolve wide lobes better: by what both leave, and the time
 * that they take. That is little beside the time of rays, where it is not known that nothing is in the way. */
static inline float lobe_class_most(uint32_t class, bool is_free)
{
    const float most = class == 0 ? RULE_LOBE_MOST_0 : class == 1 ? RULE_LOBE_MOST_1 : RULE_LOBE_MOST_2;
    return is_free ? most : RULE_LOBE_WITH_RAYS * most;
}

/* Of lobes that shine alone. alpha2: GGX's alpha^2, or 1 / exponent; edge: tiles.edge. */
static inline uint32_t lobe_class(float alpha2, float edge)
{
    const float width = alpha2 / (edge * edge) + 1.0f;
    return (width >= RULE_LOBE_WIDTH_0) + (width >= RULE_LOBE_WIDTH_1) + (width >= RULE_LOBE_WIDTH_2);
}

#endif
