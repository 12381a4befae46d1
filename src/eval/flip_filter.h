/* SPDX-License-Identifier: MIT
 * flip_filter.h - what FLIP's viewer sees of a picture from a distance: colours without detail that is too fine, and
 * where edges and points are. */
#ifndef HELIOSTAT_SRC_EVAL_FLIP_FILTER_H
#define HELIOSTAT_SRC_EVAL_FLIP_FILTER_H

#include <stdint.h>

#define FLIP_PIXELS_PER_DEGREE_LIMIT 200

/* FLIP_RADIUS: that of the widest kernel, see flip_filter_make(). FLIP_CHUNK: pixels of a row that are filtered at
 * once, so few that all of it lies on the stack. */
enum {
    FLIP_RADIUS = 28,
    FLIP_TAPS = 2 * FLIP_RADIUS + 1,
    FLIP_CHUNK = 128,
    FLIP_WINDOW = FLIP_CHUNK + 2 * FLIP_RADIUS
};

/* One direction of a kernel; those of two dimensions are products of two. */
typedef struct flip_kernel {
    int radius;
    float weights[FLIP_TAPS];
} flip_kernel;

typedef struct flip_filter {
    flip_kernel achromatic, red_green, blue_yellow[2]; /* each sums to 1 */
    float blue_yellow_shares[2];                       /* of the two, which sum to 1 */
    flip_kernel smooth;                                /* across an edge or point; sums to 1 */
    flip_kernel edge, point;                           /* along it: positive weights sum to 1, negative ones to -1 */
} flip_filter;

/* pixels_per_degree: 1..FLIP_PIXELS_PER_DEGREE_LIMIT */
void flip_filter_make(flip_filter *filter, double pixels_per_degree);

/* A picture in YCxCz, the opponent space of linear colours that CIELAB becomes without its cube root. */
typedef struct flip_picture {
    uint32_t width, height;
    float *planes[3]; /* [height][width] each: achromatic -16..100, red-green, blue-yellow */
} flip_picture;

/* Some pixels of a row as they are seen. */
typedef struct flip_view {
    float colours[3][FLIP_CHUNK];                /* YCxCz */
    float edges[FLIP_CHUNK], points[FLIP_CHUNK]; /* their strengths, 0..sqrt(2) */
} flip_view;

/* Sees the pixels column ... column + count - 1 of a row, count <= FLIP_CHUNK. Past its border the picture goes on as
 * at the border. */
void flip_filter_see(const flip_filter *filter, const flip_picture *picture, uint32_t row, uint32_t column,
                     uint32_t count, flip_view *view);

#endif
