/* SPDX-License-Identifier: MIT
 * rules.h - numbers by which samples are shared out, found by trying (docs/method.md has the tables). Read by C and by
 * GLSL, so that processors and devices take the same samples: any other numbers would be unbiased as well, and no test
 * of the mean would notice that they differ. */
#ifndef HELIOSTAT_SRC_RULES_H
#define HELIOSTAT_SRC_RULES_H

/* Faces, by what they are worth. One with light is worth 2^-60 at least, where the brightest is worth 1 or more. Less
 * than 2^-90 to a point a face is worth by rounding alone, when it has just come above the horizon, and machines may
 * take that for 0. And 2^-18 of the light samples each face gets beyond its part: more than what counts are rounded by,
 * so that no face is lost to that. */
#define RULE_FACE_BITS 60
#define RULE_FACE_LEAST 8.07793567e-28f    /* 2^-90 */
#define RULE_FACE_EXTRA 3.814697265625e-6f /* 2^-18 */

/* Bins of normals, in parts of a bin's reach: up to where the cosine is bent, and what each tile within has at least;
 * half of what the cosines of the control variate are apart. */
#define RULE_BIN_EDGE 0.6f
#define RULE_BIN_LEAST 0.01f
#define RULE_CONTROL_HALF 0.4f

/* Variance of a face's light at a small scale, as part of the square of the mean, up to which it is even. */
#define RULE_EVEN_VARIANCE 0.016f

/* Points that weigh tiles: part of a tile's radius which a lobe is wide where light and BRDF get equally many samples;
 * where a lobe of cos^n has fallen to a quarter, x 1 / sqrt(n); and what a tile adds to its variance, x edge^2. */
#define RULE_EVEN_WIDTH 1.25f
#define RULE_PHONG_WIDTH 1.665f
#define RULE_PHONG_TILE 0.3f

/* Calm lobes, by class: up to which width, in relation to that of a tile, and up to which variance; what of that is
 * left where rays are cast. One sample of so many reads the pool, whose samples leave so much of the variance of as
 * many that do not follow each other. Groups whose middle has this cosine to the axis are looked at tile by tile. */
#define RULE_LOBE_WIDTH_0 1.4f
#define RULE_LOBE_WIDTH_1 2.8f
#define RULE_LOBE_WIDTH_2 5.6f
#define RULE_LOBE_MOST_0 1.6f
#define RULE_LOBE_MOST_1 0.55f
#define RULE_LOBE_MOST_2 0.2f
#define RULE_LOBE_WITH_RAYS 0.3f
#define RULE_LOBE_SAMPLES_PER_POOL 16
#define RULE_LOBE_POOL_VARIANCE 0.5f
#define RULE_LOBE_NEAR_COSINE 0.82f

#endif
