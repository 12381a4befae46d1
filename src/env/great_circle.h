/* SPDX-License-Identifier: MIT
 * great_circle.h - great circles in the coordinates of lat-long maps, where areas are solid angles.
 *
 * Solid angle is d(longitude) d(sin latitude). A great circle is
 *
 *   sin(latitude) = k cos t / sqrt(1 - k^2 sin^2 t),   with integral   asin(k sin t),
 *
 * t the longitude from the circle's highest point, k the sine of its latitude there. Where it crosses a latitude
 * follows from the same formula. Angles are kept as sine and cosine, and only their differences are wanted, which are
 * mostly small: a series gives them, and hardly any function of the C library is called. */
#ifndef HELIOSTAT_SRC_GREAT_CIRCLE_H
#define HELIOSTAT_SRC_GREAT_CIRCLE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

typedef struct angle {
    double cosine, sine;
} angle;

/* From one angle to another, at most a quarter turn away. */
static inline double angle_between(angle from, angle to)
{
    double sine = from.cosine * to.sine - from.sine * to.cosine, s = sine * sine;
    if (s < 1.0 / 256) /* asin's series */
        return sine *
               (1 + s * (1.0 / 6 + s * (3.0 / 40 + s * (15.0 / 336 + s * (105.0 / 3456 + s * (945.0 / 42240))))));
    return atan2(sine, from.cosine * to.cosine + from.sine * to.sine);
}

/* A half of a great circle, north or south of the equator, as if in the north. */
typedef struct great_circle {
    double height, depth; /* k: sine of the greatest latitude, >= 0, and its cosine */
    bool south;
    bool highest_at_x; /* above or below the x axis rather than the z axis */
} great_circle;

/* Where a circle meets a meridian or a latitude. */
typedef struct circle_point {
    angle t, integral;
    double sine; /* of latitude */
} circle_point;

/* meridian: sine and cosine of the longitude, which is the angle to the z axis. */
static inline circle_point meet_meridian(const great_circle *circle, angle meridian)
{
    double sine = fabs(meridian.sine), cosine = fabs(meridian.cosine);
    angle t = circle->highest_at_x ? (angle){sine, cosine} : (angle){cosine, sine};
    double root = sqrt(circle->depth * circle->depth + circle->height * circle->height * t.cosine * t.cosine);
    return (circle_point){t, {root, circle->height * t.sine}, circle->height * t.cosine / root};
}

/* For a latitude, given by its sine and cosine, above the equator and below the circle's highest point. */
static inline circle_point meet_latitude(const great_circle *circle, double sine, double cosine)
{
    double k = circle->height, root = k > sine ? sqrt((k - sine) * (k + sine)) : 0.0, scale_by = 1.0 / cosine;
    angle integral = {circle->depth * scale_by, root * scale_by};
    return (circle_point){{sine * integral.cosine / k, integral.sine / k}, integral, sine};
}

/* A piece of a circle between two meridians, from its higher to its lower end. */
typedef struct arc {
    const great_circle *circle; /* NULL: the pole itself, which is above everything */
    const circle_point *high, *low;
} arc;

/* The piece between two points of a circle. */
static inline arc arc_cut(const great_circle *circle, const circle_point *a, const circle_point *b)
{
    bool a_is_higher = a->t.cosine >= b->t.cosine;
    return (arc){circle, a_is_higher ? a : b, a_is_higher ? b : a};
}

static inline double arc_highest(const arc *a)
{
    return a->circle == NULL ? 1.0 : a->circle->south ? -a->low->sine : a->high->sine;
}

static inline double arc_lowest(const arc *a)
{
    return a->circle == NULL ? 1.0 : a->circle->south ? -a->high->sine : a->low->sine;
}

/* A row of the map, or its mirror image. */
typedef struct band {
    double top, bottom;               /* sines of latitude */
    double top_cosine, bottom_cosine; /* of the same */
} band;

/* Area below a northern arc inside of a band. */
static inline double arc_northern_area(const arc *a, const band *b, double width)
{
    if (a->low->sine >= b->top)
        return (b->top - b->bottom) * width;
    if (a->high->sine <= b->bottom)
        return 0.0;
    circle_point enter = *a->high, leave = *a->low; /* of the band */
    double area = 0;
    if (a->high->sine > b->top) {
        enter = meet_latitude(a->circle, b->top, b->top_cosine);
        area = (b->top - b->bottom) * angle_between(a->high->t, enter.t);
    }
    if (a->low->sine < b->bottom)
        leave = meet_latitude(a->circle, b->bottom, b->bottom_cosine);
    return area + angle_between(enter.integral, leave.integral) - b->bottom * angle_between(enter.t, leave.t);
}

/* The southern half is the northern one upside down. */
static inline double arc_area_below(const arc *a, const band *b, double width)
{
    if (a->circle == NULL)
        return (b->top - b->bottom) * width;
    if (!a->circle->south)
        return arc_northern_area(a, b, width);
    band mirrored = {-b->bottom, -b->top, b->bottom_cosine, b->top_cosine};
    return (b->top - b->bottom) * width - arc_northern_area(a, &mirrored, width);
}

#endif
